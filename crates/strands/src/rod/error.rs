//! What can be wrong with a rod's description.

use thiserror::Error;

/// Why a rod cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RodError {
    /// A number outside its range.
    #[error("{quantity} is {value}, but must be {expected}")]
    OutOfRange {
        /// The name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// A list with too few entries.
    #[error("{what}: {got} given, at least {needed} needed")]
    TooFewPoints {
        /// The list.
        what: &'static str,
        /// How many it needs.
        needed: usize,
        /// How many it has.
        got: usize,
    },
    /// An entry that is not finite.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// The list.
        what: &'static str,
        /// Which entry, from 0.
        index: usize,
    },
    /// Numbers that are no frame.
    #[error(
        "the {what} is no frame: its numbers must be finite and its axes unit vectors across one another, right-handed"
    )]
    NotAFrame {
        /// Which frame.
        what: &'static str,
    },
    /// Places that do not grow.
    #[error("{what} {index} lies before the one that precedes it: s must not fall")]
    NotIncreasing {
        /// The list.
        what: &'static str,
        /// Which entry, from 0.
        index: usize,
    },
    /// Two neighbouring points of a line are the same.
    #[error("point {index} is the same as the one before it: remove one of them")]
    PointsCoincide {
        /// Which point, from 0.
        index: usize,
    },
    /// A line that turns by half a turn at one point.
    #[error("the line folds back on itself at point {index}: give more points around the bend")]
    FoldsBack {
        /// Which point, from 0.
        index: usize,
    },
    /// A stiffness matrix that is not symmetric.
    #[error("the stiffness matrix is not symmetric: entries ({row}, {column}) and ({column}, {row}) differ")]
    NotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// A stiffness matrix that is not positive definite.
    #[error("the stiffness matrix is not positive definite (seen at row {row})")]
    NotPositiveDefinite {
        /// Row, from 0.
        row: usize,
    },
    /// Neighbouring sections of different shape or material, with a distance between them.
    #[error("from s = {from} to {to} the {what} changes: give two stations at the same s to make a step")]
    CannotBlend {
        /// Start of the stretch, m.
        from: f64,
        /// End of the stretch, m.
        to: f64,
        /// What differs: the shape or the material.
        what: &'static str,
    },
    /// Something placed outside the rod.
    #[error("{what} at s = {s} lies outside the rod, which is {length} m long")]
    OutsideRod {
        /// What is placed there.
        what: &'static str,
        /// Where, m.
        s: f64,
        /// The rod's length, m.
        length: f64,
    },
    /// A place between nodes for something that acts on nodes.
    #[error(
        "{what} at s = {s} lies between nodes, the nearest of them at s = {nearest}: give {s} among the mesh's breaks, or use a node"
    )]
    NotANode {
        /// What is placed there.
        what: &'static str,
        /// Where, m.
        s: f64,
        /// The place of the nearest node, m.
        nearest: f64,
    },
    /// A stretch that ends before it starts.
    #[error("{what} goes from s = {from} back to {to}: swap the two")]
    Backwards {
        /// What goes along the stretch.
        what: &'static str,
        /// Its start, m.
        from: f64,
        /// Its end, m.
        to: f64,
    },
    /// Fewer elements than the stretches between loads and steps need.
    #[error(
        "{elements} elements are too few: the rod's {spans} stretches between steps and loads need at least {needed}"
    )]
    TooFewElements {
        /// How many were asked for.
        elements: usize,
        /// How many stretches there are.
        spans: usize,
        /// How many elements they need.
        needed: usize,
    },
}

impl RodError {
    pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<(), Self> {
        if value > 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(Self::OutOfRange { quantity, value, expected: "a finite number greater than zero" })
    }

    pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<(), Self> {
        if value >= 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(Self::OutOfRange { quantity, value, expected: "a finite number, zero or greater" })
    }
}
