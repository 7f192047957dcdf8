//! What a rod is: its length, material, sections, law, rest shape and mesh.
//!
//! [`RodDescription`] says it as functions of arc length; [`Rod`] is the same, checked and cut into elements, ready to solve.

mod error;
mod law;
mod material;
mod mesh;
mod rest;
mod section;
mod shape;

pub use error::RodError;
pub use law::{Law, StiffeningEnergy, Stiffness, StoredEnergy};
pub use material::Material;
pub use mesh::{Mesh, Order};
pub use rest::{RestCurve, RestShape};
pub use section::Section;
pub(crate) use shape::exponents;

use crate::element::{DiagonalPoint, PointStrains, exponent};
use crate::math::{Mat3, Pose, Strain, Vec3, Vec6};

/// Which strains are free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kinematics {
    /// All six: the rod bends, twists, stretches and shears.
    #[default]
    Cosserat,
    /// Bending and twist only, `v = (0, 0, 1)`: the paper's inextensible, unshearable rod. The internal force is then what
    /// holds the constraint.
    Kirchhoff,
}

/// A section and its material at a place along the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Where, m from the rod's start.
    pub s: f64,
    /// The section there.
    pub section: Section,
    /// Its material.
    pub material: Material,
}

/// What gives the rod its stiffness and mass.
#[derive(Clone, Debug)]
pub enum Profile {
    /// Sections of a material: linear between stations, constant beyond the ends; two stations at the same `s` make a step.
    Stations(Vec<Station>),
    /// The same law everywhere, given directly.
    Given {
        /// The law.
        law: Law,
        /// Mass per unit length, kg/m.
        mass_per_length: f64,
        /// Rotational inertia per unit length about `d1`, `d2` and `d3`, kg·m. Only motion knows of it.
        rotational_inertia_per_length: Vec3,
        /// Half the extent along `d1` and `d2`, m, for drawing and contact.
        half_extent: [f64; 2],
    },
}

/// A rod as a function of arc length.
#[derive(Clone, Debug)]
pub struct RodDescription {
    /// Rest length `L`, m.
    pub length: f64,
    /// Which strains are free.
    pub kinematics: Kinematics,
    /// Its stiffness and mass.
    pub profile: Profile,
    /// Its shape when nothing acts on it.
    pub rest: RestShape,
    /// The frame of its start before anything acts.
    pub base: Pose,
}

impl RodDescription {
    /// Where the profile or the rest shape has steps or kinks, which the mesh must have as nodes, m.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks = self.rest.jumps();
        if let Profile::Stations(stations) = &self.profile {
            breaks.extend(stations.iter().map(|station| station.s));
        }
        breaks
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), RodError> {
        RodError::positive("length", self.length)?;
        self.rest.validate()?;
        let frame = self.base.rotation;
        let skew = (frame.transpose() * frame - Mat3::IDENTITY).max_abs();
        // Frames that were multiplied many times are still frames.
        if !(self.base.is_finite() && skew < 1e-6 && frame.determinant() > 0.0) {
            return Err(RodError::NotAFrame { what: "base" });
        }
        match &self.profile {
            Profile::Given { law, mass_per_length, rotational_inertia_per_length, half_extent } => {
                law.validate(self.kinematics)?;
                RodError::not_negative("mass_per_length", *mass_per_length)?;
                for inertia in rotational_inertia_per_length.to_array() {
                    RodError::not_negative("rotational_inertia_per_length", inertia)?;
                }
                RodError::not_negative("half_extent", half_extent[0])?;
                RodError::not_negative("half_extent", half_extent[1])
            }
            Profile::Stations(stations) => self.validate_stations(stations),
        }
    }

    fn validate_stations(&self, stations: &[Station]) -> Result<(), RodError> {
        if stations.is_empty() {
            return Err(RodError::TooFewPoints { what: "sections", needed: 1, got: 0 });
        }
        for station in stations {
            station.section.validate()?;
            station.material.validate()?;
            // Sizes that are fine by themselves can be too small or too large for their powers.
            station.section.stiffness(&station.material).validate()?;
            let mass = station.material.density * station.section.area();
            RodError::not_negative("mass_per_length", mass)?;
            if !(station.s >= 0.0 && station.s <= self.length * (1.0 + 1e-9)) {
                return Err(RodError::OutsideRod { what: "a section", s: station.s, length: self.length });
            }
        }
        for (i, pair) in stations.windows(2).enumerate() {
            let (from, to) = (pair[0].s, pair[1].s);
            if to < from {
                return Err(RodError::NotIncreasing { what: "section", index: i + 1 });
            }
            if to > from && pair[0].section.interpolate(&pair[1].section, 0.5).is_none() {
                return Err(RodError::CannotBlend { from, to, what: "shape of the section" });
            }
            if to > from && pair[0].material != pair[1].material {
                return Err(RodError::CannotBlend { from, to, what: "material" });
            }
        }
        Ok(())
    }

    /// What the rod is made of at `s`, on the side of `towards`.
    fn at(&self, s: f64, towards: f64) -> Slice {
        let stations = match &self.profile {
            Profile::Given { law, mass_per_length, rotational_inertia_per_length, half_extent } => {
                return Slice {
                    law: law.clone(),
                    mass: *mass_per_length,
                    rotational: *rotational_inertia_per_length,
                    half_extent: *half_extent,
                };
            }
            Profile::Stations(stations) => stations,
        };
        let after = if towards < s {
            stations.partition_point(|station| station.s < s)
        } else {
            stations.partition_point(|station| station.s <= s)
        };
        let (section, material) =
            match (after.checked_sub(1).and_then(|i| stations.get(i)), stations.get(after)) {
                (Some(a), Some(b)) if b.s > a.s => (
                    a.section.interpolate(&b.section, (s - a.s) / (b.s - a.s)).unwrap_or(a.section),
                    a.material,
                ),
                (Some(a), _) => (a.section, a.material),
                (None, Some(b)) => (b.section, b.material),
                (None, None) => unreachable!("validated: at least one station"),
            };
        let ([i1, i2], density) = (section.second_moments(), material.density);
        Slice {
            law: Law::Diagonal(section.stiffness(&material)),
            mass: density * section.area(),
            rotational: Vec3::new(i1, i2, i1 + i2) * density,
            half_extent: section.half_extent(),
        }
    }
}

/// What a rod is made of at one place, per unit length.
struct Slice {
    law: Law,
    mass: f64,
    rotational: Vec3,
    half_extent: [f64; 2],
}

/// The inertia that a node carries: a share of the rod about it, lumped; or that by which an element couples two of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeInertia {
    /// Mass, kg.
    pub mass: f64,
    /// Rotational inertia about the node's `d1`, `d2` and `d3`, kg·m².
    pub rotational: Vec3,
}

impl NodeInertia {
    /// Twice the kinetic energy (J) of what turns in these axes and shifts at a velocity.
    pub(crate) fn twice_energy(&self, velocity: Vec6) -> f64 {
        let Vec6 { angular, linear } = velocity;
        angular.dot(self.rotational.scale(angular)) + linear.dot(linear) * self.mass
    }
}

/// The law and the rest strain at one place of an element.
#[derive(Clone, Debug)]
pub struct Point {
    /// The rest strain `ε̂`.
    pub rest: Strain,
    /// How stress follows from `ε − ε̂`.
    pub law: Law,
}

/// A rod, checked and cut into elements; it does not change.
#[derive(Clone, Debug)]
pub struct Rod {
    description: RodDescription,
    order: Order,
    mesh: Mesh,
    points: Vec<Point>,
    diagonal: Option<Vec<DiagonalPoint>>,
    node_inertia: Vec<NodeInertia>,
    half_extent: Vec<[f64; 2]>,
    scale: Scale,
}

/// Typical magnitudes of a rod, by which residuals are made dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The rod's length, m.
    pub length: f64,
    /// A typical bending stiffness over the length, N·m.
    pub moment: f64,
    /// A typical bending stiffness over the length squared, N.
    pub force: f64,
}

impl Rod {
    /// Cuts a rod into elements of the given order along a mesh.
    ///
    /// # Errors
    /// What is wrong with the description, or a mesh that does not end at the rod's length.
    pub fn new(description: RodDescription, mesh: Mesh, order: Order) -> Result<Self, RodError> {
        description.validate()?;
        let end = mesh.nodes()[mesh.elements()];
        if (end - description.length).abs() > 1e-9 * description.length {
            return Err(RodError::OutsideRod { what: "the mesh's end", s: end, length: description.length });
        }
        let mut points = Vec::with_capacity(mesh.elements() * order.places().len());
        for pair in mesh.nodes().windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            for place in order.places() {
                let s = pair[0] + place * (pair[1] - pair[0]);
                let rest = Strain::new(description.rest.curvature(s, middle), Vec3::Z);
                points.push(Point { rest, law: description.at(s, middle).law });
            }
        }
        let per_element = order.places().len();
        let diagonal = (points.iter().enumerate())
            .map(|(i, point)| {
                let e = i / per_element;
                let h = mesh.nodes()[e + 1] - mesh.nodes()[e];
                DiagonalPoint::new(description.kinematics, h, point)
            })
            .collect();
        let mut node_inertia = vec![NodeInertia { mass: 0.0, rotational: Vec3::ZERO }; mesh.nodes().len()];
        mesh.distribute(order, 0.0, description.length, |node, s, towards, weight| {
            let slice = description.at(s, towards);
            node_inertia[node].mass += weight * slice.mass;
            node_inertia[node].rotational += slice.rotational * weight;
        });
        let half_extent = mesh.nodes().iter().map(|&s| description.at(s, s).half_extent).collect();
        let bending: f64 = points
            .iter()
            .map(|point| {
                let c = point.law.tangent(Strain::ZERO).blocks[0][0];
                (c.cols[0].x * c.cols[1].y).abs().sqrt()
            })
            .sum::<f64>()
            / points.len() as f64;
        let length = description.length;
        let scale = Scale { length, moment: bending / length, force: bending / (length * length) };
        Ok(Self { description, order, mesh, points, diagonal, node_inertia, half_extent, scale })
    }

    /// A rod of equal elements, with nodes at its own steps and at further `breaks`.
    ///
    /// # Errors
    /// As [`Rod::new`] and [`Mesh::even`].
    pub fn with_elements(
        description: RodDescription,
        elements: usize,
        breaks: &[f64],
        order: Order,
    ) -> Result<Self, RodError> {
        description.validate()?;
        let breaks: Vec<f64> = description.breaks().into_iter().chain(breaks.iter().copied()).collect();
        let mesh = Mesh::even(description.length, elements, &breaks)?;
        Self::new(description, mesh, order)
    }

    /// What the rod was made from.
    pub fn description(&self) -> &RodDescription {
        &self.description
    }

    /// Rest length, m.
    pub fn length(&self) -> f64 {
        self.description.length
    }

    /// Which strains are free.
    pub fn kinematics(&self) -> Kinematics {
        self.description.kinematics
    }

    /// The order of the discretisation.
    pub fn order(&self) -> Order {
        self.order
    }

    /// The same rod on the same nodes, its elements of order 2.
    pub(crate) fn of_second_order(self) -> Self {
        let (description, mesh) = (self.description, self.mesh);
        Self::new(description, mesh, Order::Second).unwrap_or_else(|_| unreachable!("it was checked before"))
    }

    /// The nodes.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// How many elements there are.
    pub fn elements(&self) -> usize {
        self.mesh.elements()
    }

    /// Rest length of an element, m.
    pub fn element_length(&self, element: usize) -> f64 {
        self.mesh.nodes()[element + 1] - self.mesh.nodes()[element]
    }

    /// The places of an element at which its law is taken: one, or two for order 4.
    pub fn points(&self, element: usize) -> &[Point] {
        let n = self.order.places().len();
        &self.points[element * n..(element + 1) * n]
    }

    /// The rest strains at the places of an element; where there is but one, twice the same.
    pub(crate) fn rest_strains(&self, element: usize) -> PointStrains {
        let points = self.points(element);
        [points[0].rest, points[points.len() - 1].rest]
    }

    /// All points, packed for the fast kernels, where every law is diagonal.
    pub(crate) fn diagonal_points(&self) -> Option<&[DiagonalPoint]> {
        self.diagonal.as_deref()
    }

    /// The rod's mass, kg.
    pub fn mass(&self) -> f64 {
        self.node_inertia.iter().map(|node| node.mass).sum()
    }

    /// The inertia that each node carries.
    pub fn node_inertia(&self) -> &[NodeInertia] {
        &self.node_inertia
    }

    /// The inertia by which each element couples its two nodes in the consistent mass matrix: beside its diagonal, and taken from what
    /// [nodes carry](Self::node_inertia) on it, so that rows have the sums that these do. Of a rod that is the same all along an element, `∫ N_a N_b` of its inertia per
    /// length, with `N` linear. With `m_a` and `m_b` of the element's shares at its nodes it is `2 m_a m_b / 3 (m_a + m_b)`, which keeps the matrix positive
    /// however an element tapers.
    pub fn coupling_inertia(&self) -> impl Iterator<Item = NodeInertia> {
        self.mesh.nodes().windows(2).map(|pair| {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            let [a, b] = [pair[0], pair[1]].map(|s| self.description.at(s, middle));
            let between = |a: f64, b: f64| if a + b > 0.0 { 2.0 / 3.0 * half * a * b / (a + b) } else { 0.0 };
            let [x, y, z] = [|v: Vec3| v.x, |v: Vec3| v.y, |v: Vec3| v.z]
                .map(|of| between(of(a.rotational), of(b.rotational)));
            NodeInertia { mass: between(a.mass, b.mass), rotational: Vec3::new(x, y, z) }
        })
    }

    /// Half the extent along `d1` and `d2` at each node, m.
    pub fn half_extent(&self) -> &[[f64; 2]] {
        &self.half_extent
    }

    /// Typical magnitudes.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// The frames of the nodes, in the world, when nothing acts on the rod: from [`RodDescription::base`] on, each element with its rest
    /// strain. It is what a solve finds without loads, so an end held in the last of them bears nothing.
    pub fn rest_poses(&self) -> Vec<Pose> {
        let mut pose = self.description.base;
        let mut poses = Vec::with_capacity(self.elements() + 1);
        poses.push(pose);
        for e in 0..self.elements() {
            let strain = self.rest_strains(e);
            pose = pose.compose(&Pose::exp(exponent(self.order, self.element_length(e), &strain)));
            poses.push(pose);
        }
        poses
    }
}

#[cfg(test)]
mod tests;
