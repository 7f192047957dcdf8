//! Rigid bodies of a scene.

use super::Held;
use strands::assembly::{self, Body};
use strands::contact::{Shape, Tissue};
use strands::math::Vec3;
use strands::rod::NodeInertia;

/// A rigid body of a scene.
#[derive(Clone, Debug)]
pub struct ModelBody {
    /// Its name.
    pub name: String,
    /// Its inertia, where it is at rest, its weight, and what holds it.
    pub body: Body,
    /// Its shape, to draw it; `None` where its inertia is given without one.
    pub shape: Option<BodyShape>,
    /// What it is that ends of rods pierce, if they do.
    pub tissue: Option<Tissue>,
    /// How fast it sets off where the motion starts from rest, world axes, m/s.
    pub velocity: Vec3,
    /// How fast it then turns, world axes, rad/s.
    pub angular_velocity: Vec3,
    pub(crate) held: Option<Held>,
}

/// The shape of a body, its centre of mass in its middle. What is long lies along its third axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyShape {
    /// A ball.
    Ball {
        /// Its radius, m.
        radius: f64,
    },
    /// A cylinder between two half balls.
    Capsule {
        /// Its radius, m.
        radius: f64,
        /// How long the cylinder is, m.
        length: f64,
    },
    /// A cylinder.
    Cylinder {
        /// Its radius, m.
        radius: f64,
        /// How long it is, m.
        length: f64,
    },
    /// A block.
    Block {
        /// Its edges along its axes, m.
        size: [f64; 3],
    },
    /// A ring of round wire about its third axis.
    Ring {
        /// The radius of its centre line, m.
        radius: f64,
        /// The radius of the wire, m.
        wire_radius: f64,
    },
}

impl BodyShape {
    /// Its surface, in its own axes.
    pub(super) fn surface(&self) -> Shape {
        let ends = |length: f64| [Vec3::Z * (-0.5 * length), Vec3::Z * (0.5 * length)];
        match *self {
            Self::Ball { radius } => Shape::Capsule { ends: [Vec3::ZERO; 2], radius },
            Self::Capsule { radius, length } => Shape::Capsule { ends: ends(length), radius },
            Self::Cylinder { radius, length } => Shape::Cylinder { ends: ends(length), radius },
            Self::Ring { radius, wire_radius } => {
                Shape::Ring { middle: Vec3::ZERO, axis: Vec3::Z, radius, wire_radius }
            }
            Self::Block { size } => {
                Shape::block(Vec3::ZERO, size.map(|edge| 0.5 * edge), [Vec3::X, Vec3::Y, Vec3::Z])
            }
        }
    }

    /// The inertia of the solid shape of a density, kg/m³.
    pub(crate) fn inertia(self, density: f64) -> NodeInertia {
        match self {
            Self::Ball { radius } => assembly::ball(density, radius),
            Self::Capsule { radius, length } => assembly::capsule(density, radius, length),
            Self::Cylinder { radius, length } => assembly::cylinder(density, radius, length),
            Self::Block { size } => assembly::block(density, size),
            Self::Ring { radius, wire_radius } => assembly::ring(density, radius, wire_radius),
        }
    }
}
