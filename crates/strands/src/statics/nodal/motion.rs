//! The system of a rod that moves: what the change of their momenta exerts on the nodes, beside what acts on a rod at rest.

use super::super::march::Record;
use super::super::problem::Problem;
use super::elimination::{Square, add, see_columns_from, transposed};
use super::{Axes, Distance, Nodal, Resists, Slopes};
use crate::element::DiagonalPoint;
use crate::math::{Mat3, SimdLevel, Wrench};

/// What motion adds to a rod at rest.
pub(crate) struct Motion<'a> {
    /// The laws of its elements, with what their rates add.
    pub points: &'a [DiagonalPoint],
    /// Of each node.
    pub inertial: &'a [Inertial],
    /// Of each element, where its nodes' momenta are coupled.
    pub coupled: &'a [Coupled],
}

/// What the change of its momentum exerts on a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertial {
    /// That, about the node, world axes, N·m and N.
    pub exerts: Wrench,
    /// How its moment changes with a turn of the node, N·m.
    pub by_turn: Mat3,
    /// How its force changes with a shift, N/m, symmetric.
    pub by_shift: Mat3,
}

/// How what the change of its momentum exerts on each of an element's nodes changes with the other one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupled {
    /// The moment on the near node with a turn of the far one, N·m.
    pub near_by_far: Mat3,
    /// The moment on the far node with a turn of the near one, N·m.
    pub far_by_near: Mat3,
    /// The force on either with a shift of the other, N/m.
    pub by_shift: f64,
}

/// How the equations of an element's nodes depend on each other where their momenta are coupled, the near node's and its variation as seen from the
/// far one's place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coupling<R> {
    /// Of what acts on the near node with the far one, beside what the element does.
    pub upper: Square<R>,
    /// Of what acts on the far node with the near one, with what the element does.
    pub lower: Square<R>,
}

impl Nodal {
    /// The same as [`Nodal::linearise`] of a rod that moves, about its state at some time, or where the slopes are kept a look at how far it is
    /// from what must hold.
    pub fn linearise_moving(
        &mut self,
        problem: &Problem,
        level: SimdLevel,
        lends: (f64, Slopes),
        motion: &Motion,
        state: &Record,
    ) -> Distance {
        self.linearise_in(Axes::new(problem, state), problem, level, lends, motion, state)
    }

    /// The same in axes that several rods share.
    pub fn linearise_in(
        &mut self,
        axes: Axes,
        problem: &Problem,
        level: SimdLevel,
        (lent, slopes): (f64, Slopes),
        motion: &Motion,
        state: &Record,
    ) -> Distance {
        self.axes = axes;
        let slack = self.look_at_elements(&problem.rod, motion.points, level, (lent, slopes), state);
        self.load(problem, state);
        for (load, node) in self.loads.iter_mut().zip(motion.inertial) {
            *load += axes.wrench(node.exerts);
        }
        if slopes == Slopes::Anew {
            self.inertial_slopes.clear();
            self.inertial_slopes.extend(motion.inertial.iter().map(|node| node.slopes(&axes)));
            self.couplings.clear();
            let coupled = motion.coupled.iter().zip(&self.resists);
            self.couplings.extend(coupled.map(|(coupled, after)| coupled.coupling(&axes, after)));
            self.since.clear();
            self.turned.clear();
            self.turned.extend(state.poses.iter().map(|pose| pose.rotation));
        }
        let distance = self.measure(problem, level, slack, state);
        if slopes == Slopes::Anew {
            self.held.clone_from(&self.holds);
        }
        distance
    }

    /// What acts on a node that is out of balance, in the world about itself: what its support bears, with the opposite sign, or what is left of a
    /// search.
    pub fn left_over(&self, node: usize) -> Wrench {
        self.axes.in_units(self.imbalance(node))
    }
}

impl Inertial {
    /// How what is exerted changes with the frame, in some axes: the moment with a turn, the force with a shift.
    #[inline]
    pub(super) fn slopes(&self, axes: &Axes) -> [Mat3; 2] {
        [self.by_turn.scaled(1.0 / axes.moment), self.by_shift.scaled(axes.length / axes.force)]
    }
}

impl Coupled {
    fn coupling(&self, axes: &Axes, after: &Resists<f64>) -> Coupling<f64> {
        let block = |by_turn: &Mat3| {
            let mut block: Square<f64> = [[0.0; 6]; 6];
            for r in 0..3 {
                for c in 0..3 {
                    block[r][c] = by_turn.cols[c].to_array()[r] / axes.moment;
                }
                block[3 + r][3 + r] = self.by_shift * axes.length / axes.force;
            }
            block
        };
        // Of the near node's equations the rows, of its variation the columns are seen from the far one's place.
        let mut upper = transposed(&block(&self.near_by_far));
        see_columns_from(&after.arm, &mut upper);
        let mut lower = block(&self.far_by_near);
        see_columns_from(&after.arm, &mut lower);
        add(&mut lower, &after.stiffness);
        Coupling { upper: transposed(&upper), lower }
    }
}
