//! What is touched beside rods, and of what its surface is made.

use super::Nearest;
use super::meeting::from_triangle;
use super::mesh::Mesh;
use super::passage::Tissue;
use crate::math::Vec3;
use std::sync::Arc;

/// A thing that rods touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape: in the world, or in the axes of the body that it is of.
    pub shape: Shape,
    /// The coefficient of friction on it, where it has one of its own.
    pub friction: Option<f64>,
    /// The body that it is of; else it stands still.
    pub body: Option<usize>,
    /// What it is that ends of rods pierce, if they do.
    pub tissue: Option<Tissue>,
}

/// The shape of an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// All behind a plane.
    Plane {
        /// A point on it, m.
        point: Vec3,
        /// The unit normal, away from what is behind.
        normal: Vec3,
    },
    /// All that is no further than a radius from a segment: a capsule, or a ball where its ends are the same.
    Capsule {
        /// The ends of the segment, m.
        ends: [Vec3; 2],
        /// The radius, m.
        radius: f64,
    },
    /// A cylinder with flat ends, whose rims are polygons of 64 corners.
    Cylinder {
        /// The middles of its ends, m.
        ends: [Vec3; 2],
        /// The radius, m.
        radius: f64,
    },
    /// A ring of round wire: 24 capsules about the least polygon around a circle, so that its hole is as wide as that of a torus or wider.
    Ring {
        /// Its middle, m.
        middle: Vec3,
        /// The unit direction of its axis.
        axis: Vec3,
        /// The radius of the circle, m.
        radius: f64,
        /// The radius of the wire, m.
        wire_radius: f64,
    },
    /// All around a bore without end: rods are inside.
    Bore {
        /// A point on its axis, m.
        point: Vec3,
        /// The unit direction of its axis.
        axis: Vec3,
        /// The radius, m.
        radius: f64,
    },
    /// A surface of triangles, touched from either side.
    Mesh(Arc<Mesh>),
}

/// A piece of a surface, as a rod meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    /// Nodes meet it.
    Plane { point: Vec3, normal: Vec3 },
    /// Elements meet it, and where it is long nodes too: all of a capsule, or only what is between its ends.
    Round { ends: [Vec3; 2], radius: f64, capped: bool },
    /// Nodes meet it, from the inside.
    Bore { point: Vec3, axis: Vec3, radius: f64 },
    /// Nodes meet it, where they are above or below.
    Face { corners: [Vec3; 3] },
}

/// So many corners has the rim of a cylinder.
const RIM: usize = 64;
/// So many capsules make a ring.
const RING: usize = 24;

impl Shape {
    /// A box about a middle, with half extents along unit axes, m.
    pub fn block(middle: Vec3, half: [f64; 3], axes: [Vec3; 3]) -> Self {
        Self::Mesh(Arc::new(Mesh::block(middle, half, axes)))
    }

    /// How far a point is from its surface, m, less than nothing inside. Inside of a mesh is what its triangles are all around.
    pub fn distance(&self, point: Vec3) -> f64 {
        match self {
            Self::Plane { point: on, normal } => (point - *on).dot(*normal),
            Self::Capsule { ends: [a, b], radius } => {
                Nearest::of(&[point, point, *a, *b]).apart.norm() - radius
            }
            Self::Cylinder { ends: [a, b], radius } => {
                let (middle, axis) = ((*a + *b) * 0.5, *b - *a);
                let (length, unit) = (axis.norm(), axis * (1.0 / axis.norm()));
                let along = (point - middle).dot(unit);
                let out = [(point - middle - unit * along).norm() - radius, along.abs() - 0.5 * length];
                let [across, beyond] = out;
                if across > 0.0 && beyond > 0.0 { across.hypot(beyond) } else { across.max(beyond) }
            }
            Self::Bore { point: on, axis, radius } => {
                let from = point - *on;
                radius - (from - *axis * from.dot(*axis)).norm()
            }
            Self::Ring { middle, axis, radius, wire_radius } => {
                let from = point - *middle;
                let along = from.dot(*axis);
                ((from - *axis * along).norm() - radius).hypot(along) - wire_radius
            }
            Self::Mesh(mesh) => {
                let nearest = mesh.triangles().map(|[a, b, c]| from_triangle(&[point, a, b, c]));
                let apart = nearest.fold(f64::INFINITY, f64::min);
                let crossed = mesh.triangles().filter(|corners| is_ahead(point, corners)).count();
                if crossed % 2 == 1 { -apart } else { apart }
            }
        }
    }

    /// Of what its surface is made.
    pub(crate) fn parts(&self) -> Vec<Part> {
        match self {
            Self::Plane { point, normal } => vec![Part::Plane { point: *point, normal: *normal }],
            Self::Capsule { ends, radius } => {
                vec![Part::Round { ends: *ends, radius: *radius, capped: true }]
            }
            Self::Bore { point, axis, radius } => {
                vec![Part::Bore { point: *point, axis: *axis, radius: *radius }]
            }
            Self::Cylinder { ends, radius } => cylinder(*ends, *radius),
            Self::Ring { middle, axis, radius, wire_radius } => {
                let around = radius / (core::f64::consts::PI / RING as f64).cos();
                let wire = polygon(*middle, *axis, around, RING);
                wire.map(|ends| Part::Round { ends, radius: *wire_radius, capped: true }).collect()
            }
            Self::Mesh(mesh) => {
                let faces = mesh.triangles().map(|corners| Part::Face { corners });
                faces.chain(mesh.edges().map(edge)).collect()
            }
        }
    }
}

/// Whether a ray from a point goes through a triangle (Möller & Trumbore 1997). It points where hardly any edge of a mesh is in its way.
fn is_ahead(point: Vec3, [a, b, c]: &[Vec3; 3]) -> bool {
    let ray = Vec3::new(0.5417, 0.3391, 0.7691);
    let (one, other, from) = (*b - *a, *c - *a, point - *a);
    let normal = ray.cross(other);
    let volume = one.dot(normal);
    let u = from.dot(normal) / volume;
    let turned = from.cross(one);
    let v = ray.dot(turned) / volume;
    volume != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && other.dot(turned) / volume > 0.0
}

fn edge(ends: [Vec3; 2]) -> Part {
    Part::Round { ends, radius: 0.0, capped: true }
}

fn cylinder(ends: [Vec3; 2], radius: f64) -> Vec<Part> {
    let mut parts = vec![Part::Round { ends, radius, capped: false }];
    let axis = (ends[1] - ends[0]).normalized().unwrap_or(Vec3::Z);
    for middle in ends {
        for rim in polygon(middle, axis, radius, RIM) {
            parts.push(edge(rim));
            parts.push(Part::Face { corners: [middle, rim[0], rim[1]] });
        }
    }
    parts
}

/// The sides of a regular polygon across a unit axis, whose corners are as far from its middle as the radius.
fn polygon(middle: Vec3, axis: Vec3, radius: f64, sides: usize) -> impl Iterator<Item = [Vec3; 2]> {
    let first = axis.any_orthonormal();
    let second = axis.cross(first);
    let corner = move |k: usize| {
        let (sin, cos) = (core::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
        middle + (first * cos + second * sin) * radius
    };
    (0..sides).map(move |k| [corner(k), corner((k + 1) % sides)])
}
