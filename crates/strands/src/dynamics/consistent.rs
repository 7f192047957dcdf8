//! What the consistent mass matrix has beside the lumped one: elements couple the momenta of their nodes.
//!
//! With velocities that are linear along the elements, `v` of places in the world and `Ω` of turns in the axes that turn along, the kinetic energy is
//!
//! ```text
//! ½ Σ_nodes (m v·v + Ω·J Ω) − ½ Σ_elements (μ |v_b − v_a|² + (Ω_b − Ω_a)·K (Ω_b − Ω_a))
//! ```
//!
//! with `m`, `J` of the lumped matrix and `μ`, `K` the [inertia that couples](crate::rod::Rod::coupling_inertia). It does not depend on where the frames
//! are, so what acts changes momenta as ever, and their sums are kept: of the first node `d(m v_a + μ (v_b − v_a))/dt = f_a` and, with `R_a` how it is turned,
//! `d(R_a (J Ω_a + K (Ω_b − Ω_a)))/dt = m_a`.

use super::inertia::Turns;
use super::stage::Stage;
use crate::math::{Mat3, Pose, Vec6, Wrench};
use crate::rod::{NodeInertia, Rod};
use crate::statics::{Coupled, Slopes};

/// How the elements of a rod couple its nodes; of a rod with lumped inertia there are none.
#[derive(Clone, Debug, Default)]
pub(super) struct Couplings(Vec<NodeInertia>);

impl Couplings {
    pub fn new(rod: &Rod) -> Self {
        Self(rod.coupling_inertia().collect())
    }

    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes what the elements pass on into momenta that are those of the lumped matrix.
    pub fn couple(&self, velocities: &[Vec6], poses: &[Pose], momenta: &mut [Wrench]) {
        for (e, inertia) in self.0.iter().enumerate() {
            let passed = passed(inertia, velocities[e], velocities[e + 1]);
            let [near, far] = told_in([&poses[e].rotation, &poses[e + 1].rotation], passed);
            momenta[e] += near;
            momenta[e + 1] += far;
        }
    }

    /// By how much `v·M v` is less than with the lumped matrix, J, for the nodes' velocities.
    pub fn less(&self, velocity: impl Fn(usize) -> Vec6) -> f64 {
        let elements = self.0.iter().enumerate();
        elements.map(|(e, inertia)| inertia.twice_energy(velocity(e + 1) - velocity(e))).sum()
    }

    /// Takes what the elements pass on into a stage that has what lumped inertia exerts, from a rod's first frame and first element on.
    pub fn take(
        &self,
        stage: &mut Stage,
        [first, first_element]: [usize; 2],
        poses: &[Pose],
        lost: f64,
        slopes: Slopes,
    ) {
        if self.is_empty() {
            return;
        }
        let (exerted, by_place) = stage.of_momentum(lost);
        let mut near = (slopes == Slopes::Anew).then(|| Turns::of(stage, first, &poses[0]));
        for (e, inertia) in self.0.iter().enumerate() {
            let (a, b) = (first + e, first + e + 1);
            let far = near.as_ref().map(|_| Turns::of(stage, b, &poses[e + 1]));
            let passed = passed(inertia, stage.velocities[a], stage.velocities[b]);
            let axes = match (&near, &far) {
                (Some(near), Some(far)) => [&near.axes, &far.axes],
                // Where slopes are kept momenta are told in the frames' own axes.
                _ => [&poses[e].rotation, &poses[e + 1].rotation],
            };
            for (frame, momentum) in [a, b].into_iter().zip(told_in(axes, passed)) {
                stage.momenta[frame] += momentum;
                stage.inertial[frame].exerts -= momentum * exerted;
            }
            if let (Some(near), Some(far)) = (&near, &far) {
                let (less, shift) = (inertia.rotational * -1.0, inertia.mass * exerted * by_place);
                let gets = [passed.angular, passed.angular * -1.0];
                for ((frame, turns), gets) in [(a, near), (b, far)].into_iter().zip(gets) {
                    let of = &mut stage.inertial[frame];
                    of.by_turn = of.by_turn - turns.momentum_by_turn(less, gets).scaled(exerted);
                    of.by_shift = of.by_shift + Mat3::IDENTITY.scaled(shift);
                }
                let by = |on: &Turns, of: &Turns| {
                    (on.axes * Mat3::diagonal(inertia.rotational) * of.by_turn).scaled(-exerted)
                };
                stage.coupled[first_element + e] =
                    Coupled { near_by_far: by(near, far), far_by_near: by(far, near), by_shift: -shift };
            }
            near = far;
        }
    }
}

/// The momentum that an element passes from its far node to its near one, angular in the axes of either.
fn passed(inertia: &NodeInertia, near: Vec6, far: Vec6) -> Vec6 {
    let apart = far - near;
    Vec6::new(inertia.rotational.scale(apart.angular), apart.linear * inertia.mass)
}

/// What the near node gets and the far one loses of it, in the world.
fn told_in([near, far]: [&Mat3; 2], passed: Vec6) -> [Wrench; 2] {
    [
        Wrench::new(*near * passed.angular, passed.linear),
        Wrench::new(*far * passed.angular, passed.linear) * -1.0,
    ]
}
