//! The kernel that linearises elements of order 2 with a diagonal law, several side by side.

use super::super::march::Record;
use super::{Axes, Link, Resists, parts};
use crate::element::{self, DiagonalPoint, Resistance, diagonal_resistance};
use crate::math::{
    Kernel, Lanes, Mat3, Pose, Real, SimdLevel, Vec3, Vec6, Wrench, dispatch, larger, largest, logs,
};
use crate::rod::Rod;

/// How many elements are linearised side by side.
const BATCH: usize = 8;
type Side = Vec3<Lanes<BATCH>>;

/// Elements of a rod of order 2 with a diagonal law, side by side, in the fixed axes.
struct Elements {
    compliance: Vec6<Side>,
    rest: Vec6<Side>,
    /// The wrenches that they carry through their far nodes.
    wrench: Wrench<Side>,
    /// The exponents between their frames.
    x: Vec6<Side>,
    /// How their far nodes are turned, and from the near ones to them.
    turned: Mat3<Side>,
    arm: Side,
}

impl Elements {
    /// From the first on as many as there are lanes; past the last element it repeats that.
    #[inline(always)]
    fn gather(rod: &Rod, points: &[DiagonalPoint], axes: &Axes, state: &Record, first: usize) -> Self {
        let [mut compliance, mut rest, mut wrench] = [Vec6::<Side>::zero(); 3];
        let mut near = Mat3 { cols: [Side::zero(); 3] };
        let (mut turned, mut arm) = (near, Side::zero());
        for i in 0..BATCH {
            let e = (first + i).min(rod.elements() - 1);
            let point = &points[e];
            compliance.put(i, axes.compliance(point.compliance));
            rest.put(i, axes.shift(point.rest));
            wrench.put(i, axes.wrench(state.wrenches[e]));
            let (a, b) = (&state.poses[e], &state.poses[e + 1]);
            near.put(i, &a.rotation);
            turned.put(i, &b.rotation);
            // Of the places as they are: round-off in others would be seen through the stiffness against stretching.
            arm.put(i, (b.position - a.position) * (1.0 / axes.length));
        }
        let relative = Pose { rotation: near.transpose() * turned, position: near.transpose_mul(arm) };
        Self { compliance, rest, wrench, x: logs(&relative), turned, arm }
    }
}

/// Gives elements of order 2 with a diagonal law the strains that belong to what they carry.
pub(crate) fn take_strains(rod: &Rod, points: &[DiagonalPoint], level: SimdLevel, state: &mut Record) {
    dispatch(level, TakeStrains { rod, points, state });
}

struct TakeStrains<'a> {
    rod: &'a Rod,
    points: &'a [DiagonalPoint],
    state: &'a mut Record,
}

impl Kernel for TakeStrains<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rod, points, state } = self;
        let axes = Axes::default();
        for first in (0..rod.elements()).step_by(BATCH) {
            let Elements { compliance, rest, wrench, x, .. } =
                Elements::gather(rod, points, &axes, state, first);
            let exponent = rest + compliance.scale(element::mean_wrench(x, wrench));
            for i in 0..BATCH.min(rod.elements() - first) {
                let e = first + i;
                state.strains[e] = [exponent.lane(i) * (1.0 / rod.element_length(e)); 2];
            }
        }
    }
}

/// Looks at the elements of a rod of order 2 with a diagonal law, several side by side: what they exert, and with slopes how that changes with
/// their nodes. Gives the largest slack.
pub(super) struct Look<'a, const SLOPES: bool> {
    pub rod: &'a Rod,
    pub points: &'a [DiagonalPoint],
    pub axes: &'a Axes,
    pub lent: f64,
    pub state: &'a Record,
    pub links: &'a mut Vec<Link<f64>>,
    pub resists: &'a mut Vec<Resists<f64>>,
}

impl<const SLOPES: bool> Kernel for Look<'_, SLOPES> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Self { rod, points, axes, lent, state, links, resists } = self;
        let n = rod.elements();
        links.resize(n, Link { arm: Vec3::ZERO, carried: Wrench::ZERO, pull: Wrench::ZERO });
        resists.resize(n, Resists { arm: Vec3::ZERO, stiffness: [[0.0; 6]; 6] });
        let mut largest_slack = Lanes::<BATCH>::splat(0.0);
        for first in (0..n).step_by(BATCH) {
            let Elements { compliance, rest, wrench, x, turned, arm } =
                Elements::gather(rod, points, axes, state, first);
            let share = Lanes::from_fn(|i| lent * rod.element_length((first + i).min(n - 1)) / rod.length());
            let Resistance { stiffness, pull, slack } =
                diagonal_resistance(compliance, rest, share, x, wrench, &turned);
            let carried = wrench.turned_by(&turned);
            largest_slack = larger(largest_slack, largest(&parts(slack)));
            for i in 0..BATCH.min(n - first) {
                let arm = arm.lane(i);
                links[first + i] = Link { arm, carried: carried.lane(i), pull: pull.lane(i) };
                if SLOPES {
                    let to = &mut resists[first + i];
                    to.arm = arm;
                    for r in 0..6 {
                        for c in 0..6 {
                            let column = &stiffness[r / 3][c / 3].cols[c % 3];
                            to.stiffness[r][c] = [&column.x, &column.y, &column.z][r % 3].0[i];
                        }
                    }
                }
            }
        }
        let mut worst = 0.0;
        for i in 0..BATCH {
            worst = larger(worst, largest_slack.0[i]);
        }
        worst
    }
}
