//! The midpoint rule that keeps energy and momentum.
//!
//! A step from `(R₀, x₀)` to `(R₁, x₁)` has its middle at `R_m = R₀ Λ^½`, `x̄ = (x₀ + x₁)/2`, with `R₁ = R₀ Λ`. Turns are counted by their Cayley vector `Θ`,
//! `|Θ| = 2 tan(α/2)`, whose direction is the same in both frames; velocities are `(Ω₀ + Ω₁)/2 = Θ/h` and `(v₀ + v₁)/2 = (x₁ − x₀)/h`, and momenta `Π₁ − Π₀ =
//! h W` of a node about itself, with `W` acting at the middle. Then the kinetic energy grows by exactly the work of what acts, `Θ·m + Δx·f`, and for any
//! wrench that an element carries its two ends' momenta balance (Simo & Tarnow 1992).
//!
//! An element works by `σ·y`, where `y` is the rate of its exponent at the middle for these increments, and `y = Δξ` but for a term of third order. So its
//! stress is not only the mean one, `σ̄`, but also has a part `c` along `C⁻¹ y`, of second order, by which `(σ̄ + c)·y = σ̄·Δξ`, the growth of its energy (Gonzalez 1996).

use super::energy::Power;
use super::holds::Held;
use super::inertia::Turns;
use super::stage::{Resistance, Stage, viscous_point};
use super::{Simulation, StepFailure, Taken, Work};
use crate::element::DiagonalPoint;
use crate::math::{Mat3, Pose, Quat, Vec3, Vec6, Wrench, so3_tangent, so3_tangent_inverse, tangent_inverse};
use crate::rod::NodeInertia;
use crate::statics::{Inertial, Slopes};
use core::ops::Range;

/// An element whose exponent changes by less than this part of what bends it has no third-order term beside round-off.
const STILL: f64 = 1e-5;

/// The Cayley vector of twice the turn `b`, and its slope.
fn cayley(b: Vec3) -> (Vec3, Mat3) {
    let square = b.dot(b);
    let angle = square.sqrt();
    // tan β/β, and (sec² β − tan β/β)/β².
    let (ratio, slope) = if angle < 1e-3 {
        (1.0 + square / 3.0 + 2.0 / 15.0 * square * square, 2.0 / 3.0 + 8.0 / 15.0 * square)
    } else {
        let tan = angle.tan();
        (tan / angle, (1.0 + tan * tan - tan / angle) / square)
    };
    (b * (2.0 * ratio), (Mat3::IDENTITY.scaled(ratio) + Mat3::outer(b, b).scaled(slope)).scaled(2.0))
}

impl Turns {
    /// Of a frame in the middle of a step of `2 of_rate`: its momentum is told in the axes at the end.
    pub fn at_middle(base: &Pose, pose: &Pose, of_rate: f64) -> Self {
        let half = base.rotation.turn_to(&pose.rotation);
        let (_, by_half) = cayley(half);
        let half_by_turn = so3_tangent_inverse(half) * pose.rotation.transpose();
        Self {
            axes: base.rotation * Quat::from_rotation_vector(half * 2.0).to_matrix(),
            turning: so3_tangent(half * 2.0).scaled(2.0) * half_by_turn,
            by_turn: by_half.scaled(1.0 / of_rate) * half_by_turn,
        }
    }
}

impl Stage {
    /// What inertia and the air exert on some frames in the middle of a step of `2 of_rate`, from their poses there.
    pub fn take_inertia_at_middle(
        &mut self,
        frames: Range<usize>,
        inertia: &[NodeInertia],
        poses: &[Pose],
        resistance: &Resistance,
    ) {
        let per_step = 0.5 / self.of_rate;
        for (at, i) in frames.clone().enumerate() {
            let (base, pose) = (&self.base[i], &poses[at]);
            let NodeInertia { mass, rotational } = inertia[i];
            let known = self.known_momenta[i];
            let before = self.velocities_before[i];
            let half = base.rotation.turn_to(&pose.rotation);
            let (theta, _) = cayley(half);
            let turns = Turns::at_middle(base, pose, self.of_rate);
            let angular = theta * (2.0 * per_step) - before.angular;
            let moved = (pose.position - base.position) * 2.0;
            let linear = moved * (2.0 * per_step) - before.linear;
            let body_spin = rotational.scale(angular);
            let spin = turns.axes * body_spin;
            let momentum = linear * mass;
            let by_turn = turns.momentum_by_turn(rotational, body_spin);
            let lost = resistance.lost;
            let after = Wrench::new(spin, momentum);
            let (mean, change) = ((after + known) * 0.5, after - known);
            self.coordinate_rates[i] = Vec6::new(half, moved * 0.5) * (1.0 / self.of_rate);
            self.velocities[i] = Vec6::new(angular, linear);
            self.momenta[i] = after;
            self.inertial[i] = Inertial {
                exerts: change * (-per_step) - mean * lost,
                by_turn: by_turn.scaled(-per_step - 0.5 * lost),
                by_shift: Mat3::IDENTITY.scaled(-mass * per_step * (4.0 * per_step + 2.0 * lost)),
            };
        }
        self.take_drag(frames, poses, resistance, Slopes::Anew);
    }

    /// Takes into the elements' laws that the mean of their exponents before and after has the mean stress, and works as their energy grows.
    pub fn take_secants(
        &mut self,
        elements: Range<usize>,
        first: usize,
        elastic: &[DiagonalPoint],
        viscosity: f64,
        poses: &[Pose],
    ) {
        let stiffer = viscosity / self.of_rate;
        for (e, elastic) in elastic.iter().enumerate() {
            let [(before_a, a), (before_b, b)] =
                [e, e + 1].map(|node| (&self.base[first + node], &poses[node]));
            let middle = a.between(b);
            let x = middle.log();
            let (x_before, x_after) =
                (before_a.between(before_b).log(), after(before_a, a).between(&after(before_b, b)).log());
            let (mean, change) = ((x_before + x_after) * 0.5, x_after - x_before);
            // How the exponent changes by the increments, at the middle.
            let increment = |before: &Pose, pose: &Pose| {
                let (theta, _) = cayley(before.rotation.turn_to(&pose.rotation));
                let moved = (pose.position - before.position) * 2.0;
                // The Cayley vector is along the axis of the turn, so it is the same in the middle's frame.
                Vec6::new(theta, pose.rotation.transpose_mul(moved))
            };
            let apart = increment(before_b, b) - middle.inverse().adjoint(increment(before_a, a));
            let y = tangent_inverse(x).mul_vec(apart);
            let stress = over(mean - elastic.rest + change * (0.5 * stiffer), elastic.compliance);
            let along = over(y, elastic.compliance);
            let (work, square) = (stress.dot(y - change), y.dot(along));
            let strained = stress.dot(elastic.compliance.scale(stress));
            let part = if square > STILL * STILL * strained { work / square } else { 0.0 };
            // The stress is the mean one less `part` of that along the increments.
            let mut point = viscous_point(elastic, x_before, stiffer);
            point.rest += (x - mean) + point.compliance.scale(along) * part;
            self.points[elements.start + e] = point;
            self.strain_rates[elements.start + e] = change * (0.5 / self.of_rate);
        }
    }

    /// The frames at the end of a step of which these are the middle.
    pub fn to_end(&self, poses: &mut [Pose]) {
        poses.iter_mut().zip(&self.base).for_each(|(pose, before)| *pose = after(before, pose));
    }
}

/// The frame at a step's end, from those at its beginning and in its middle.
fn after(before: &Pose, middle: &Pose) -> Pose {
    let half = before.rotation.turn_to(&middle.rotation);
    let turn = Quat::from_rotation_vector(half * 2.0).to_matrix();
    Pose { rotation: before.rotation * turn, position: middle.position * 2.0 - before.position }
}

/// `x/c`, where a strain that is not free has none.
fn over(x: Vec6, compliance: Vec6) -> Vec6 {
    let (x, c) = (x.to_array(), compliance.to_array());
    Vec6::from(core::array::from_fn::<f64, 6, _>(|k| if c[k] > 0.0 { x[k] / c[k] } else { 0.0 }))
}

impl Simulation {
    /// A piece of a step, of which the middle and the length are given over the whole.
    pub(super) fn midpoint(&mut self, held: &Held, middle: f64, length: f64) -> Result<Taken, StepFailure> {
        let step = self.work.step * length;
        self.begin();
        let stage = &mut self.work.stage;
        stage.set_up(0.5 * step, &self.state);
        held.halfway(middle, self);
        let Work { level, stage, poses, .. } = &mut self.work;
        stage.middle = true;
        stage.velocities_before.clone_from(&self.state.velocities);
        stage.predict(&self.state.velocities, poses, *level);
        let solved = self.solve_stage();
        let mut lost = Power::default();
        lost.add(self.power(), step);
        self.work.stage.middle = false;
        let taken = solved?;
        let Work { stage, poses, .. } = &mut self.work;
        stage.to_end(poses);
        self.take(lost, step);
        Ok(taken)
    }
}
