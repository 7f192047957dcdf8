//! What inertia exerts on frames in a stage, several side by side.

use super::coordinates::{SIDE, Side, side_by_side};
use super::stage::Stage;
use crate::math::{Kernel, Lanes, Mat3, Pose, Real, Vec3, Vec6, Wrench, exp_coefficients};
use crate::rod::NodeInertia;

/// Takes what inertia exerts on frames from the first on, and how they move; with slopes, how that changes with the frames.
pub(super) struct TakeInertia<'a, const SLOPES: bool> {
    pub stage: &'a mut Stage,
    pub first: usize,
    pub inertia: &'a [NodeInertia],
    pub poses: &'a [Pose],
    /// The momentum that is lost, over itself, 1/s.
    pub lost: f64,
}

impl<const SLOPES: bool> Kernel for TakeInertia<'_, SLOPES> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, first, inertia, poses, lost } = self;
        for begin in (0..poses.len()).step_by(SIDE) {
            let at = |lane: usize| (begin + lane).min(poses.len() - 1);
            let (rotation, q) = side_by_side(&stage.base[first..], poses, begin);
            let mut rotational = Side::zero();
            let [mut offset, mut known] = [Vec6::<Side>::zero(); 2];
            let mass = Lanes::from_fn(|lane| inertia[first + at(lane)].mass);
            for lane in 0..SIDE {
                let i = first + at(lane);
                rotational.put(lane, inertia[i].rotational);
                offset.put(lane, stage.offsets[i]);
                known.put(lane, stage.known_momenta[i]);
            }
            let per_rate = Lanes::splat(1.0 / stage.of_rate);
            let per_momentum = per_rate + Lanes::splat(lost);
            let rate = (q - offset) * per_rate;
            let turning = Turning::new(q.angular, rate.angular, per_rate);
            let spin = rotation * rotational.scale(turning.velocity);
            let linear = rate.linear * mass;
            let change = Vec6::new(spin - known.angular, linear - known.linear);
            let exerts = change * -per_rate - Vec6::new(spin, linear) * Lanes::splat(lost);
            let turned = rotation * Mat3::diagonal(rotational) * turning.by_turn * rotation.transpose();
            let by_turn = (turned - Mat3::hat(spin)).scaled(-per_momentum);
            for lane in 0..SIDE.min(poses.len() - begin) {
                let i = first + begin + lane;
                let rate = rate.lane(lane);
                stage.coordinate_rates[i] = rate;
                stage.velocities[i] = Vec6::new(turning.velocity.lane(lane), rate.linear);
                stage.momenta[i] = Wrench::new(spin.lane(lane), linear.lane(lane));
                let inertial = &mut stage.inertial[i];
                inertial.exerts = exerts.lane(lane);
                if SLOPES {
                    let per_shift = -per_momentum.0[lane] * per_rate.0[lane] * mass.0[lane];
                    inertial.by_turn = by_turn.lane(lane);
                    inertial.by_shift = Mat3::diagonal(Vec3::new(per_shift, per_shift, per_shift));
                }
            }
        }
    }
}

/// How the axes in which a frame's angular momentum is told, and its angular velocity in them, turn with a turn of the stage's frame in the world.
pub(super) struct Turns {
    pub axes: Mat3,
    /// Of those axes, in themselves.
    pub turning: Mat3,
    /// Of the angular velocity.
    pub by_turn: Mat3,
}

impl Turns {
    /// Of a frame of a stage whose rates were taken.
    pub fn of(stage: &Stage, frame: usize, pose: &Pose) -> Self {
        if stage.middle {
            return Self::at_middle(&stage.base[frame], pose, stage.of_rate);
        }
        let theta = stage.base[frame].rotation.turn_to(&pose.rotation);
        let turning = pose.rotation.transpose();
        let by_turn = Turning::new(theta, stage.coordinate_rates[frame].angular, 1.0 / stage.of_rate).by_turn;
        Self { axes: pose.rotation, turning, by_turn: by_turn * turning }
    }

    /// How a momentum that is told in those axes, and changes with the angular velocity by so much inertia, changes in the world.
    pub fn momentum_by_turn(&self, inertia: Vec3, momentum: Vec3) -> Mat3 {
        self.axes * (Mat3::diagonal(inertia) * self.by_turn - Mat3::hat(momentum) * self.turning)
    }
}

/// An angular velocity `T(θ) θ̇` in a frame's own axes.
struct Turning<R> {
    velocity: Vec3<R>,
    /// How it changes with a turn of the frame, in its own axes, which is `T(θ) δθ`, where `θ = Δ + a θ̇` with a known `Δ`.
    by_turn: Mat3<Vec3<R>>,
}

impl<R: Real> Turning<R> {
    #[inline(always)]
    fn new(theta: Vec3<R>, rate: Vec3<R>, per_rate: R) -> Self {
        let k = exp_coefficients(theta.dot(theta));
        let (hat, of_rate_hat) = (Mat3::hat(theta), Mat3::hat(rate));
        let one = Mat3::diagonal(Vec3::new(R::one(), R::one(), R::one()));
        let tangent = one - hat.scaled(k.b) + (hat * hat).scaled(k.c);
        // The change of T with θ, times θ̇.
        let (once, twice) = (theta.cross(rate), theta.cross(theta.cross(rate)));
        let by_theta = of_rate_hat.scaled(k.b) - (Mat3::hat(once) + hat * of_rate_hat).scaled(k.c)
            + Mat3::outer(twice * k.dc - once * k.db, theta + theta);
        let by_turn = (tangent.scaled(per_rate) + by_theta) * tangent.inverse();
        Self { velocity: tangent * rate, by_turn }
    }
}
