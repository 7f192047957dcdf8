//! Canonical coordinates of frames about those at a step's beginning: a frame's turn as a rotation vector, and its shift in the world. Several side by
//! side.

use super::stage::Stage;
use crate::math::{Kernel, Lanes, Mat3, Pose, Quat, Vec3, Vec6, turns};

/// How many frames stand side by side.
pub(super) const SIDE: usize = 8;
pub(super) type Side = Vec3<Lanes<SIDE>>;

/// The coordinates of a frame about another.
pub(super) fn coordinates(base: &Pose, pose: &Pose) -> Vec6 {
    Vec6::new(base.rotation.turn_to(&pose.rotation), pose.position - base.position)
}

/// The frame with these coordinates.
pub(super) fn at_coordinates(base: &Pose, q: Vec6) -> Pose {
    let turn = Quat::from_rotation_vector(q.angular).to_matrix();
    Pose { rotation: base.rotation * turn, position: base.position + q.linear }
}

/// How frames are turned, and their coordinates about others, from one on as many as there are lanes; past the last it repeats that.
#[inline(always)]
pub(super) fn side_by_side(bases: &[Pose], poses: &[Pose], begin: usize) -> (Mat3<Side>, Vec6<Side>) {
    let mut base = Mat3 { cols: [Side::zero(); 3] };
    let (mut rotation, mut shift) = (base, Side::zero());
    for lane in 0..SIDE {
        let i = (begin + lane).min(poses.len() - 1);
        base.put(lane, &bases[i].rotation);
        rotation.put(lane, &poses[i].rotation);
        shift.put(lane, poses[i].position - bases[i].position);
    }
    (rotation, Vec6::new(turns(&(base.transpose() * rotation)), shift))
}

/// Takes what backward differences of order 2 know of the coordinates by the frames at the beginning of the step before, and guesses their rates: with `c`
/// the coordinates of those, the offsets are `−c/3`, and the parabola through both, with the velocities `v` at the later, has the rates `3 v + 2 c/h` at
/// the end of a step of length `h`.
pub(super) struct LookBack<'a> {
    pub stage: &'a mut Stage,
    pub before: &'a [Pose],
    pub velocities: &'a [Vec6],
}

impl Kernel for LookBack<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, before, velocities } = self;
        let frames = before.len();
        // A rate counts for two thirds of the step.
        let per_step = 2.0 / 3.0 / stage.of_rate;
        for first in (0..frames).step_by(SIDE) {
            let (_, c) = side_by_side(&stage.base, before, first);
            for lane in 0..SIDE.min(frames - first) {
                let (i, c) = (first + lane, c.lane(lane));
                stage.offsets[i] = c * (-1.0 / 3.0);
                stage.coordinate_rates[i] = velocities[i] * 3.0 + c * (2.0 * per_step);
            }
        }
    }
}

/// Puts frames where the rates of their coordinates lead.
pub(super) struct Follow<'a> {
    pub stage: &'a Stage,
    pub poses: &'a mut [Pose],
}

impl Kernel for Follow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, poses } = self;
        let frames = poses.len();
        for first in (0..frames).step_by(SIDE) {
            let (mut base, mut q) = (Mat3 { cols: [Side::zero(); 3] }, Vec6::<Side>::zero());
            for lane in 0..SIDE {
                let i = (first + lane).min(frames - 1);
                base.put(lane, &stage.base[i].rotation);
                q.put(lane, stage.offsets[i] + stage.coordinate_rates[i] * stage.of_rate);
            }
            let turn = Pose::exp(Vec6::new(q.angular, Side::zero())).rotation;
            let rotation = base * turn;
            for lane in 0..SIDE.min(frames - first) {
                let i = first + lane;
                let position = stage.base[i].position + q.linear.lane(lane);
                poses[i] = Pose { rotation: rotation.lane(lane), position };
            }
        }
    }
}
