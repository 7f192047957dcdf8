//! Surfaces of triangles.

use crate::math::Vec3;
use std::collections::{BTreeMap, HashMap};
use thiserror::Error;

/// Two faces are as good as flat where the sine between their normals is less: their edge is none.
const FLAT: f64 = 1e-6;

/// A surface of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    corners: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    /// Those that faces bend at, or end.
    edges: Vec<[usize; 2]>,
}

/// Why triangles are no surface.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum MeshError {
    /// A triangle names a corner that there is not.
    #[error("triangle {triangle} has a corner {corner}, and there are {corners}")]
    Corner {
        /// The triangle's number.
        triangle: usize,
        /// What it names.
        corner: usize,
        /// How many there are.
        corners: usize,
    },
    /// A corner is not finite.
    #[error("corner {0} is not finite")]
    NotFinite(usize),
    /// There is no triangle with an area.
    #[error("no triangle has an area")]
    Empty,
}

impl Mesh {
    /// Of corners, m, and triangles between them; those without an area are left out.
    ///
    /// # Errors
    /// Where they are no surface.
    pub fn new(corners: Vec<Vec3>, triangles: Vec<[usize; 3]>) -> Result<Self, MeshError> {
        if let Some(at) = corners.iter().position(|corner| !corner.norm().is_finite()) {
            return Err(MeshError::NotFinite(at));
        }
        for (triangle, of) in triangles.iter().enumerate() {
            if let Some(&corner) = of.iter().find(|corner| **corner >= corners.len()) {
                return Err(MeshError::Corner { triangle, corner, corners: corners.len() });
            }
        }
        let mut mesh = Self { corners, triangles, edges: Vec::new() };
        mesh.join_corners();
        let corners = &mesh.corners;
        mesh.triangles.retain(|of| normal(corners, of).is_some());
        if mesh.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        mesh.find_edges();
        Ok(mesh)
    }

    /// A box about a middle, with half extents along unit axes, m.
    pub(super) fn block(middle: Vec3, half: [f64; 3], axes: [Vec3; 3]) -> Self {
        let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let corner =
            |k: usize| (0..3).fold(middle, |at, axis| at + axes[axis] * (half[axis] * sign((k >> axis) & 1)));
        let mut triangles = Vec::new();
        for axis in 0..3 {
            let (one, other) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            for side in [0, 1 << axis] {
                triangles.push([side, side | one, side | one | other]);
                triangles.push([side, side | one | other, side | other]);
            }
        }
        let mut mesh = Self { corners: (0..8).map(corner).collect(), triangles, edges: Vec::new() };
        mesh.find_edges();
        mesh
    }

    /// Whether it is closed: as many triangles on one side of each edge as on the other, so that there is an inside. Corners in one place are one.
    pub fn is_closed(&self) -> bool {
        let key = |corner: usize| self.corners[corner].to_array().map(|x| (x + 0.0).to_bits());
        let mut sides = HashMap::new();
        for triangle in &self.triangles {
            for k in 0..3 {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]].map(key);
                *sides.entry(if a < b { [a, b] } else { [b, a] }).or_insert(0_usize) += 1;
            }
        }
        sides.values().all(|count| count % 2 == 0)
    }

    /// The corners, m.
    pub fn corners(&self) -> &[Vec3] {
        &self.corners
    }

    /// The corners of its triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.triangles.iter().map(|of| of.map(|corner| self.corners[corner]))
    }

    /// The numbers of the corners of its triangles.
    pub fn indices(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// The ends of the edges at which faces bend or end.
    pub(super) fn edges(&self) -> impl Iterator<Item = [Vec3; 2]> {
        self.edges.iter().map(|of| of.map(|corner| self.corners[corner]))
    }

    /// Corners at the same place are one: files repeat them.
    fn join_corners(&mut self) {
        let mut first = BTreeMap::new();
        let one: Vec<usize> = (self.corners.iter().enumerate())
            .map(|(i, corner)| *first.entry(corner.to_array().map(|x| (x + 0.0).to_bits())).or_insert(i))
            .collect();
        self.triangles.iter_mut().flatten().for_each(|corner| *corner = one[*corner]);
    }

    fn find_edges(&mut self) {
        let mut beside: BTreeMap<[usize; 2], Vec<Vec3>> = BTreeMap::new();
        for of in &self.triangles {
            let Some(normal) = normal(&self.corners, of) else { continue };
            for k in 0..3 {
                let (a, b) = (of[k], of[(k + 1) % 3]);
                beside.entry([a.min(b), a.max(b)]).or_default().push(normal);
            }
        }
        let flat = |normals: &[Vec3]| matches!(normals, [a, b] if a.cross(*b).norm() < FLAT);
        self.edges = beside.into_iter().filter(|(_, normals)| !flat(normals)).map(|(edge, _)| edge).collect();
    }
}

fn normal(corners: &[Vec3], of: &[usize; 3]) -> Option<Vec3> {
    let [a, b, c] = of.map(|corner| corners[corner]);
    (b - a).cross(c - a).normalized()
}
