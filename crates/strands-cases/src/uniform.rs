//! Rods of one section, by their stiffness.

use core::f64::consts::PI;
use strands::math::{Pose, Vec3};
use strands::rod::{Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, RodError, Stiffness};

/// A rod that is everywhere alike.
#[derive(Clone, Copy)]
pub(crate) struct Uniform {
    pub length: f64,
    pub kinematics: Kinematics,
    pub stiffness: Stiffness,
    /// Its mass and its inertia about its axes, over its length.
    pub mass: f64,
    pub inertia: Vec3,
}

impl Uniform {
    /// One that bends and twists only, against twist as stiff as in its first plane.
    pub fn inextensible(length: f64, bending: [f64; 2], mass: f64, inertia: Vec3) -> Self {
        let stiffness = Stiffness { bending, torsion: bending[0], axial: 1.0, shear: [1.0; 2] };
        Self { length, kinematics: Kinematics::Kirchhoff, stiffness, mass, inertia }
    }

    /// A round one that stretches and shears, of a shear factor of 1.
    pub fn round(length: f64, radius: f64, [young, shear]: [f64; 2], density: f64) -> Self {
        let area = PI * radius * radius;
        let second = 0.25 * area * radius * radius;
        let stiffness = Stiffness {
            bending: [young * second; 2],
            torsion: 2.0 * shear * second,
            axial: young * area,
            shear: [shear * area; 2],
        };
        Self {
            length,
            kinematics: Kinematics::Cosserat,
            stiffness,
            mass: density * area,
            inertia: Vec3::new(second, second, 2.0 * second) * density,
        }
    }

    /// It, with an even curvature at rest.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn rod(&self, base: Pose, curvature: Vec3, elements: usize) -> Result<Rod, RodError> {
        let description = RodDescription {
            length: self.length,
            kinematics: self.kinematics,
            profile: Profile::Given {
                law: Law::Diagonal(self.stiffness),
                mass_per_length: self.mass,
                rotational_inertia_per_length: self.inertia,
                half_extent: [0.01 * self.length; 2],
            },
            rest: RestShape::Constant(curvature),
            base,
        };
        Rod::with_elements(description, elements, &[], Order::Second)
    }
}
