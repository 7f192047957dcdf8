//! Straight rods that are pushed along themselves by more than they bear.
//!
//! A rod clamped at its foot stands up to `w L³/EI = 7.837` under its weight (Greenhill 1881) and to `P L²/EI = π²/4` under a force at its
//! head (Euler 1744); under both, up to a sum of the two parts of about one (Dunkerley). With its head guided along the axis it bears a
//! force of `4π²`, `20.19` or `π²`, as both of its ends, one or none is kept from turning.

use super::numbers::{Numbers, bend, softer_bending};
use super::{Remarks, View, metres, short};
use core::f64::consts::PI;
use strands::load::Frame;
use strands::math::{Mat3, Vec3};
use strands::statics::Support;

/// The critical weight of a rod clamped at its foot, over `EI/L³`.
const GREENHILL: f64 = 7.837_347;
/// The critical force at the head of a rod clamped at its foot, over `EI/L²`.
const EULER: f64 = PI * PI / 4.0;
/// The critical force of a rod clamped at one end and hinged at the other, over `EI/L²`.
const CLAMPED_HINGED: f64 = 20.190_73;
/// A rod is straight where it bends by less than this, rad, and pushed along itself where it is pushed aside by less than this part.
const STRAIGHT: f64 = 1e-3;

pub(super) fn look(remarks: &mut Remarks<'_>, view: &View<'_>) {
    let problem = &view.rod.problem;
    let rod = &problem.rod;
    let bent = (0..rod.elements()).map(|e| bend(rod.points(e)[0].rest.angular) * rod.element_length(e));
    if !problem.between.is_empty() || bent.sum::<f64>() > STRAIGHT {
        return;
    }
    let (start, end) = (&problem.start, &problem.end);
    // From the foot, which holds the place, to the head, which does not hold it along the rod.
    for (foot, head, up, head_s) in [(start, end, 1.0, rod.length()), (end, start, -1.0, 0.0)] {
        let from =
            if foot.fixed[..3] == [true; 3] { foot.pose.rotation } else { rod.description().base.rotation };
        let axis = from.cols[2] * up;
        if foot.holds_position()
            && let Some(column) = Column::of(foot, head, axis)
        {
            column.look(remarks, view, axis, head_s);
        }
    }
}

/// What a straight rod bears along itself.
struct Column {
    /// The critical weight, over `EI/L³`, where it is known.
    weight: Option<f64>,
    /// The critical force at its head, over `EI/L²`.
    force: f64,
    /// How it is held.
    held: &'static str,
}

impl Column {
    fn of(foot: &Support, head: &Support, axis: Vec3) -> Option<Self> {
        let clamped = foot.fixed == [true; 6];
        if clamped && head.fixed == [false; 6] && head.grip.is_none() {
            return Some(Self {
                weight: Some(GREENHILL),
                force: EULER,
                held: "clamped at its foot and free at its head",
            });
        }
        let free: Vec<usize> = (0..3).filter(|i| !head.fixed[3 + i]).collect();
        let [slides] = free[..] else { return None };
        let along = head.shift_axes.cols[slides].dot(axis).abs() > 1.0 - STRAIGHT;
        // A hinge about one axis bears differently to its two sides.
        let plain = |end: &Support| end.turn_axes == Mat3::IDENTITY && end.fixed[0] == end.fixed[1];
        if !along || !plain(foot) || !plain(head) {
            return None;
        }
        let (force, held) = match (foot.fixed[0], head.fixed[0]) {
            (true, true) => (4.0 * PI * PI, "kept from turning at both ends"),
            (false, false) => (PI * PI, "free to turn at both ends"),
            _ => (CLAMPED_HINGED, "kept from turning at one end"),
        };
        Some(Self { weight: None, force, held })
    }

    fn look(&self, remarks: &mut Remarks<'_>, view: &View<'_>, axis: Vec3, head: f64) {
        let rod = &view.rod.problem.rod;
        let (length, loads) = (rod.length(), &view.rod.loads);
        let at_head = || loads.points.iter().filter(|load| (load.at - head).abs() <= 1e-9 * length);
        let push: Vec3 = at_head()
            .filter(|load| load.frame == Frame::World)
            .fold(Vec3::ZERO, |sum, load| sum + load.wrench.linear);
        let own = loads.gravity * rod.mass();
        let all = push + own;
        let aside = (all - axis * all.dot(axis)).norm();
        let bent_anyway =
            aside > STRAIGHT * all.norm() || at_head().any(|load| load.wrench.angular != Vec3::ZERO);
        let pulled = !loads.pulls.is_empty() || !loads.pulled_stretches.is_empty();
        if bent_anyway || pulled || !loads.stretches.is_empty() || loads.points.len() > at_head().count() {
            return;
        }
        let stiffness = softer_bending(rod);
        let force = -push.dot(axis) * length.powi(2) / stiffness;
        let weight = -own.dot(axis) * length.powi(2) / stiffness;
        let part = force / self.force + self.weight.map_or(0.0, |critical| weight / critical);
        if part <= 1.0 {
            return;
        }
        let own_weight = Numbers::expected(view).weight > 0.0 && self.weight.is_some();
        let by = |what: &str, is: f64, bears: f64| {
            format!("{what} = {}, and {} is the most it bears", short(is), short(bears))
        };
        let (what, how) = match (own_weight && weight != 0.0, force > 0.0) {
            (true, false) => ("its own weight", by("w L³/EI", weight, GREENHILL)),
            (true, true) => (
                "its own weight and the force at its head",
                format!(
                    "w L³/EI = {} and P L²/EI = {}, and {} or {} alone is the most it bears",
                    short(weight),
                    short(force),
                    short(GREENHILL),
                    short(self.force)
                ),
            ),
            _ => ("the force at its head", by("P L²/EI", force, self.force)),
        };
        let shorter = length * part.powf(if force > 0.0 { -0.5 } else { -1.0 / 3.0 });
        remarks.warn(
            &view.path.key("length"),
            format!("the rod stands straight, {}, and buckles under {what}: {how}", self.held),
            format!(
                "it would stand if it were shorter than about {}; if it is meant to buckle, a small force across it or a small \
                 rest curvature says to which side",
                metres(shorter)
            ),
        );
    }
}
