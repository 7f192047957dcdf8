//! Rigid bodies: a needle, a mass, a gripper.

use crate::math::{Pose, Vec3, Wrench};
use crate::rod::NodeInertia;
use crate::statics::Support;
use core::f64::consts::PI;

/// A rigid body. Its frame is at its centre of mass, along its principal axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its mass (kg), and its inertia about its axes (kg·m²).
    pub inertia: NodeInertia,
    /// Where it is at rest.
    pub pose: Pose,
    /// What acts on it at its centre, world axes, N·m and N: its weight, if it is to have one.
    pub load: Wrench,
    /// How it is held, if it is.
    pub support: Option<Support>,
}

impl Body {
    /// A body of some inertia at a place, free, with no weight.
    pub fn new(inertia: NodeInertia, pose: Pose) -> Self {
        Self { inertia, pose, load: Wrench::ZERO, support: None }
    }

    /// The same under gravity (m/s²).
    #[must_use]
    pub fn with_gravity(mut self, gravity: Vec3) -> Self {
        self.load.linear += gravity * self.inertia.mass;
        self
    }

    /// The same, held.
    #[must_use]
    pub fn held(mut self, support: Support) -> Self {
        self.support = Some(support);
        self
    }
}

/// The inertia of a solid ball.
pub fn ball(density: f64, radius: f64) -> NodeInertia {
    let mass = density * 4.0 / 3.0 * PI * radius.powi(3);
    NodeInertia { mass, rotational: Vec3::new(1.0, 1.0, 1.0) * (0.4 * mass * radius * radius) }
}

/// The inertia of a solid cylinder along its third axis.
pub fn cylinder(density: f64, radius: f64, length: f64) -> NodeInertia {
    let mass = density * PI * radius * radius * length;
    let across = mass * (3.0 * radius * radius + length * length) / 12.0;
    NodeInertia { mass, rotational: Vec3::new(across, across, 0.5 * mass * radius * radius) }
}

/// The inertia of a solid block with these edges.
pub fn block(density: f64, [a, b, c]: [f64; 3]) -> NodeInertia {
    let mass = density * a * b * c;
    let about = |p: f64, q: f64| mass * (p * p + q * q) / 12.0;
    NodeInertia { mass, rotational: Vec3::new(about(b, c), about(a, c), about(a, b)) }
}

/// The inertia of a ring of round wire about its third axis: a torus, by the radii of its centre line and of the wire.
pub fn ring(density: f64, radius: f64, wire_radius: f64) -> NodeInertia {
    let mass = density * 2.0 * PI * PI * radius * wire_radius * wire_radius;
    let [line, wire] = [radius, wire_radius].map(|radius| mass * radius * radius);
    let across = 0.5 * line + 0.625 * wire;
    NodeInertia { mass, rotational: Vec3::new(across, across, line + 0.75 * wire) }
}

/// The inertia of a solid capsule along its third axis: a cylinder of a length between two half balls.
pub fn capsule(density: f64, radius: f64, length: f64) -> NodeInertia {
    let (middle, ends) = (cylinder(density, radius, length), ball(density, radius));
    // A half ball's centre of mass is 3/8 of its radius from its flat side.
    let from_flat = 0.375 * radius;
    let away = 0.5 * length + from_flat;
    let across = ends.rotational.x + ends.mass * (away * away - from_flat * from_flat);
    NodeInertia {
        mass: middle.mass + ends.mass,
        rotational: middle.rotational + Vec3::new(across, across, ends.rotational.z),
    }
}
