//! Contact: surfaces that touch, and what they exert on each other.
//!
//! A rod's surface is that of capsules, one about the chord of each element. What touches is found by the distance between two segments, of which either
//! may be a point: two elements, a node and an element (beside each other elements touch all along, and nodes share the load), an element or node and a
//! piece of an obstacle (`meeting`). Forces and gaps are solved for with the frames (`law`), and no iteration takes the axis of anything through anything
//! (`distance`), so that nothing ever passes through.

mod aabb;
mod distance;
mod law;
mod meeting;
mod mesh;
mod obstacle;
mod passage;
mod tree;

pub(crate) use aabb::Aabb;
pub(crate) use distance::{Ends, Nearest};
pub(crate) use law::{Law, Multipliers, Response};
pub(crate) use meeting::{Kind, Meeting};
pub use mesh::{Mesh, MeshError};
pub(crate) use obstacle::Part;
pub use obstacle::{Obstacle, Shape};
pub(crate) use passage::{Axis, Held, weights};
pub use passage::{End, Eyelet, Hold, Passage, Through, Tissue};
pub(crate) use tree::Tree;

use crate::math::Vec3;
use core::fmt;

/// How surfaces touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// The coefficient of friction between any two of them, static and kinetic, where an obstacle has none of its own.
    pub friction: f64,
}

/// What touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Toucher {
    /// An element of a rod.
    Element {
        /// Which rod.
        rod: usize,
        /// Which of its elements.
        element: usize,
    },
    /// A node of a rod, as a ball of its radius.
    Node {
        /// Which rod.
        rod: usize,
        /// Which of its nodes.
        node: usize,
    },
    /// An obstacle.
    Obstacle {
        /// Which obstacle.
        obstacle: usize,
        /// Which of the pieces of its surface: a face or an edge.
        part: usize,
    },
}

impl Toucher {
    /// The rod that it is of.
    pub fn rod(&self) -> Option<usize> {
        match *self {
            Self::Element { rod, .. } | Self::Node { rod, .. } => Some(rod),
            Self::Obstacle { .. } => None,
        }
    }

    /// The obstacle that it is.
    pub(crate) fn obstacle(&self) -> Option<usize> {
        match *self {
            Self::Obstacle { obstacle, .. } => Some(obstacle),
            Self::Element { .. } | Self::Node { .. } => None,
        }
    }
}

impl fmt::Display for Toucher {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Element { rod, element } => write!(f, "element {element} of rod {rod}"),
            Self::Node { rod, node } => write!(f, "node {node} of rod {rod}"),
            Self::Obstacle { obstacle, .. } => write!(f, "obstacle {obstacle}"),
        }
    }
}

/// Two surfaces that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// What touches.
    pub between: [Toucher; 2],
    /// Where, in the middle between both surfaces, m.
    pub point: Vec3,
    /// The normal from the second to the first.
    pub normal: Vec3,
    /// How far the surfaces are apart, m.
    pub gap: f64,
    /// What the second exerts on the first, N.
    pub force: Vec3,
}

#[cfg(test)]
mod tests;
