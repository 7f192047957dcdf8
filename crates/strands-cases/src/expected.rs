//! What a reference answer says, and how far a solution is from it.

use core::fmt;
use strands::math::{Quat, Vec3};
use strands::statics::{Problem, Solution};

/// A measurable quantity of an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Where the rod is at `s`, m, world axes.
    Position {
        /// Where along the rod, m.
        s: f64,
    },
    /// How far a straight rod has moved aside at `s`, m: the position's part along a direction across it.
    Deflection {
        /// Where along the rod, m.
        s: f64,
        /// The direction, of length one, world axes.
        along: Vec3,
    },
    /// How the frame at `s` is turned, body to world.
    Orientation {
        /// Where along the rod, m.
        s: f64,
    },
    /// The internal force at the start, N, world axes: what the rod beyond exerts on its base.
    BaseForce,
    /// The internal moment at the start, N·m, world axes.
    BaseMoment,
    /// The internal force at the end, N, world axes: what acts on the tip there.
    TipForce,
    /// The part of that force along a direction, N.
    TipForceAlong {
        /// The direction, of length one, world axes.
        along: Vec3,
    },
    /// The moment of the support at the end, N·m, world axes.
    TipMoment,
    /// The force of the support at `s`, N, world axes.
    SupportForce {
        /// Where along the rod, m.
        s: f64,
    },
    /// The stored energy, J.
    ElasticEnergy,
    /// The energy of the dead forces, minus force times position, J.
    LoadEnergy,
}

/// What a quantity is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Scalar(f64),
    /// A vector in world axes.
    Vector(Vec3),
    /// An orientation; its opposite is the same.
    Orientation(Quat),
}

/// A quantity's reference value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Which quantity.
    pub quantity: Quantity,
    /// What it is.
    pub value: Value,
    /// What an error is measured by, in the quantity's unit: the rod's length for places, 1 rad for orientations, else the value's own
    /// size, unless a case says otherwise.
    pub scale: f64,
}

/// A quantity of a solution beside its reference value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// What was expected.
    pub expected: Expected,
    /// What the solution has.
    pub got: Value,
    /// Their difference over the scale.
    pub error: f64,
}

impl Expected {
    /// A position on a rod of the given length.
    pub fn position(s: f64, at: Vec3, length: f64) -> Self {
        Self { quantity: Quantity::Position { s }, value: Value::Vector(at), scale: length }
    }

    /// An orientation.
    pub fn orientation(s: f64, orientation: Quat) -> Self {
        Self { quantity: Quantity::Orientation { s }, value: Value::Orientation(orientation), scale: 1.0 }
    }

    /// A deflection, its error measured by itself.
    pub fn deflection(s: f64, along: Vec3, value: f64) -> Self {
        Self::scalar(Quantity::Deflection { s, along }, value)
    }

    /// A force, a moment.
    pub fn vector(quantity: Quantity, value: Vec3) -> Self {
        Self { quantity, value: Value::Vector(value), scale: value.norm() }
    }

    /// An energy, a deflection.
    pub fn scalar(quantity: Quantity, value: f64) -> Self {
        Self { quantity, value: Value::Scalar(value), scale: value.abs() }
    }

    /// The same, its error measured by `scale`.
    #[must_use]
    pub fn measured_by(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// Where along the rod it is taken, for quantities that need a node there.
    pub fn place(&self) -> Option<f64> {
        match self.quantity {
            Quantity::Position { s }
            | Quantity::Deflection { s, .. }
            | Quantity::Orientation { s }
            | Quantity::SupportForce { s } => Some(s),
            _ => None,
        }
    }

    /// Compares a solution.
    ///
    /// # Panics
    /// Where the problem's mesh has no node at the quantity's place; [`Row::problem`](crate::Row::problem) puts one there.
    pub fn compare(&self, problem: &Problem, solution: &Solution) -> Comparison {
        let got = self.quantity.of(problem, solution);
        let distance = self.value.distance(&got);
        // What is exactly right has no error, even where there is nothing to measure it by.
        let error = if distance == 0.0 { 0.0 } else { distance / self.scale };
        Comparison { expected: *self, got, error }
    }
}

impl Quantity {
    /// What a solution has.
    fn of(self, problem: &Problem, solution: &Solution) -> Value {
        let pose = |s: f64| {
            let node = problem.rod.mesh().node_at(s);
            &solution.poses[node.unwrap_or_else(|| panic!("the mesh has no node at {s}"))]
        };
        let (start, end) = (solution.start_reaction(), solution.end_reaction());
        match self {
            Self::Position { s } => Value::Vector(pose(s).position),
            Self::Deflection { s, along } => Value::Scalar(pose(s).position.dot(along)),
            Self::Orientation { s } => Value::Orientation(pose(s).orientation()),
            Self::BaseForce => Value::Vector(-start.force),
            Self::BaseMoment => Value::Vector(-start.moment),
            Self::TipForce => Value::Vector(end.force),
            Self::TipForceAlong { along } => Value::Scalar(end.force.dot(along)),
            Self::TipMoment => Value::Vector(end.moment),
            Self::SupportForce { s } => {
                let node =
                    problem.supports().position(|(node, _)| problem.rod.mesh().node_at(s) == Some(node));
                Value::Vector(solution.reactions[node.unwrap_or_else(|| panic!("nothing at {s}"))].force)
            }
            Self::ElasticEnergy => Value::Scalar(solution.energy.elastic),
            Self::LoadEnergy => Value::Scalar(solution.energy.load),
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position { s } => write!(f, "position at s = {s:.6}"),
            Self::Deflection { s, .. } => write!(f, "deflection at s = {s:.6}"),
            Self::Orientation { s } => write!(f, "orientation at s = {s:.6}"),
            Self::BaseForce => f.write_str("base force"),
            Self::BaseMoment => f.write_str("base moment"),
            Self::TipForce | Self::TipForceAlong { .. } => f.write_str("tip force"),
            Self::TipMoment => f.write_str("tip moment"),
            Self::SupportForce { s } => write!(f, "force of the support at s = {s:.6}"),
            Self::ElasticEnergy => f.write_str("elastic energy"),
            Self::LoadEnergy => f.write_str("load energy"),
        }
    }
}

impl Value {
    /// The size of the difference: for orientations, the angle between them, rad.
    fn distance(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Scalar(a), Self::Scalar(b)) => (a - b).abs(),
            (Self::Vector(a), Self::Vector(b)) => (*a - *b).norm(),
            (Self::Orientation(a), Self::Orientation(b)) => {
                let turn = a.to_matrix().transpose() * b.to_matrix();
                Quat::from_matrix(turn).to_rotation_vector().norm()
            }
            _ => unreachable!("a quantity has one kind of value"),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scalar(a) => write!(f, "{a:.9e}"),
            Self::Vector(v) => write!(f, "({:.9e}, {:.9e}, {:.9e})", v.x, v.y, v.z),
            Self::Orientation(q) => write!(f, "[{:.9}, {:.9}, {:.9}, {:.9}]", q.w, q.x, q.y, q.z),
        }
    }
}
