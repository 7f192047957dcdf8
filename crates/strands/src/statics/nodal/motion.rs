//! The system of a rod that moves: what the change of their momenta exerts on the nodes, beside what acts on a rod at rest.

use super::super::march::Record;
use super::super::problem::Problem;
use super::{Axes, Distance, Nodal, force_slope};
use crate::element::DiagonalPoint;
use crate::math::{Mat3, Mat6, SimdLevel, Wrench};

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
    /// The same as [`Nodal::linearise`] of a rod that moves, about its state at some time.
    pub fn linearise_moving(
        &mut self,
        problem: &Problem,
        level: SimdLevel,
        lent: f64,
        motion: &Motion,
        state: &mut Record,
    ) -> Option<Distance> {
        self.linearise_in(Axes::new(problem, state), problem, level, lent, motion, state)
    }

    /// The same in axes that several rods share.
    pub fn linearise_in(
        &mut self,
        axes: Axes,
        problem: &Problem,
        level: SimdLevel,
        lent: f64,
        motion: &Motion,
        state: &mut Record,
    ) -> Option<Distance> {
        self.axes = axes;
        self.linearise_in_its_axes(problem, level, lent, Some(motion), state)
    }

    /// Adds what the change of its momentum exerts on each node.
    pub(super) fn move_with(&mut self, inertial: &[Inertial], axes: &Axes) {
        for (i, node) in inertial.iter().enumerate() {
            self.loads[i] += axes.wrench(node.exerts);
            self.load_slopes.push((i, node.slope(axes).to_rows()));
        }
    }

    /// What acts on a node that is out of balance, in the world about itself: what its support bears, with the opposite sign, or what is left of a
    /// search.
    pub fn left_over(&self, node: usize) -> Wrench {
        self.axes.in_units(self.imbalance(node))
    }
}

impl Inertial {
    /// How what is exerted changes with the frame, in some axes.
    #[inline]
    pub(super) fn slope(&self, axes: &Axes) -> Mat6 {
        force_slope(self.by_turn.scaled(1.0 / axes.moment), self.by_shift.scaled(axes.length / axes.force))
    }
}
