//! The virtual coupling: a hand that holds the strand through a spring and damper with six freedoms.
//!
//! A hand is not a boundary condition (paper, section 4; Colgate, Stanley & Brown 1995): a haptic device gives finite forces at a finite
//! stiffness, so the strand sees the wrench of a coupling, and the hand feels its opposite. Force and torque saturate at the device's
//! limits: beyond, the hand moves on and the wrench keeps its size and turns with the pull.

use crate::math::{Mat3, Pose, Vec3, Wrench, so3_tangent_inverse};

/// The coupling's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualCoupling {
    /// Stiffness against shifts, N/m.
    pub linear_stiffness: f64,
    /// Stiffness against turns, N·m/rad.
    pub angular_stiffness: f64,
    /// Damping of shifts, N·s/m.
    pub linear_damping: f64,
    /// Damping of turns, N·m·s/rad.
    pub angular_damping: f64,
    /// The largest force the device gives, N.
    pub max_force: f64,
    /// The largest torque the device gives, N·m.
    pub max_torque: f64,
}

/// A hand at a place, holding on through a coupling. The damper works against the change since the last frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// The coupling.
    pub coupling: VirtualCoupling,
    /// Where the hand is.
    pub hand: Pose,
    /// Where the hand and the held frame were a time step ago, and how long that is in s; `None` leaves the damper out.
    pub last: Option<LastFrame>,
}

/// The state a time step ago, for the damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LastFrame {
    /// The hand's pose.
    pub hand: Pose,
    /// The held frame.
    pub held: Pose,
    /// The time since, s.
    pub time_step: f64,
}

impl Grip {
    /// The wrench that the coupling exerts on the held frame: world axes, about the frame's origin, N·m and N. The hand feels its
    /// opposite.
    pub fn wrench(&self, held: &Pose) -> Wrench {
        let (moment, force) = self.unlimited(held);
        Wrench::new(limit(moment, self.coupling.max_torque).0, limit(force, self.coupling.max_force).0)
    }

    /// Whether force or torque is at its limit.
    pub fn saturated(&self, held: &Pose) -> bool {
        let (moment, force) = self.unlimited(held);
        moment.norm() > self.coupling.max_torque || force.norm() > self.coupling.max_force
    }

    /// How [`wrench`](Grip::wrench) changes with the held frame: its moment by a turn in the frame's axes, and its force by a shift in
    /// the world's, both in world axes.
    pub(crate) fn stiffness(&self, held: &Pose) -> (Mat3, Mat3) {
        let c = &self.coupling;
        let (moment, force) = self.unlimited(held);
        let rate = self.last.map_or(0.0, |last| 1.0 / last.time_step);
        // ψ = log(R_hand Rᵀ) and R → R exp(δθ): exp(ψ) → exp(ψ) exp(−R δθ).
        let slope = |psi: Vec3| so3_tangent_inverse(psi) * held.rotation;
        let mut by_turn = slope(turn_between(held, &self.hand)).scaled(-c.angular_stiffness);
        if let Some(last) = &self.last {
            // log(R Rₗᵀ) grows with a left turn: exp(ψ) → exp(R δθ) exp(ψ), the transpose of the tangent above.
            let psi = turn_between(&last.held, held);
            let left = so3_tangent_inverse(psi).transpose() * held.rotation;
            by_turn = by_turn - left.scaled(c.angular_damping * rate);
        }
        let by_shift = Mat3::IDENTITY.scaled(-(c.linear_stiffness + c.linear_damping * rate));
        (limit(moment, c.max_torque).1 * by_turn, limit(force, c.max_force).1 * by_shift)
    }

    fn unlimited(&self, held: &Pose) -> (Vec3, Vec3) {
        let c = &self.coupling;
        let mut force = (self.hand.position - held.position) * c.linear_stiffness;
        let mut moment = turn_between(held, &self.hand) * c.angular_stiffness;
        if let Some(last) = &self.last {
            let rate = 1.0 / last.time_step;
            let slip = (self.hand.position - last.hand.position) - (held.position - last.held.position);
            force += slip * (c.linear_damping * rate);
            let spin = turn_between(&last.hand, &self.hand) - turn_between(&last.held, held);
            moment += spin * (c.angular_damping * rate);
        }
        (moment, force)
    }
}

/// The rotation vector, world axes, that turns one frame into the other.
fn turn_between(from: &Pose, to: &Pose) -> Vec3 {
    let turn = Pose { rotation: to.rotation * from.rotation.transpose(), position: Vec3::ZERO };
    turn.log().angular
}

/// A vector shortened to a length, and the derivative of that by the vector.
fn limit(v: Vec3, max: f64) -> (Vec3, Mat3) {
    let norm = v.norm();
    if norm <= max {
        return (v, Mat3::IDENTITY);
    }
    let unit = v * (1.0 / norm);
    (unit * max, (Mat3::IDENTITY - Mat3::outer(unit, unit)).scaled(max / norm))
}

#[cfg(test)]
mod tests;
