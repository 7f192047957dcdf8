//! The system of a rod that moves: what the change of their momenta exerts on the nodes, beside what acts on a rod at rest.

use super::super::march::Record;
use super::super::problem::Problem;
use super::{Axes, Distance, Nodal, Slopes};
use crate::element::DiagonalPoint;
use crate::math::{Mat3, SimdLevel, Wrench};

/// What motion adds to a rod at rest.
pub(crate) struct Motion<'a> {
    /// The laws of its elements, with what their rates add.
    pub points: &'a [DiagonalPoint],
    /// Of each node.
    pub inertial: &'a [Inertial],
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
