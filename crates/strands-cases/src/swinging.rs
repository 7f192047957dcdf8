//! Thin rods of real numbers, clamped and straight, on which their weight begins to act: what other programs cannot swing at a millisecond a step.

use strands::load::NodalLoads;
use strands::math::{Pose, Vec3};
use strands::rod::{
    Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, RodError, Section, Station,
};
use strands::statics::Problem;

/// m/s².
pub(crate) const GRAVITY: f64 = 9.81;

/// A rod that swings.
#[derive(Clone, Copy, Debug)]
pub struct Swinging {
    /// What it is.
    pub name: &'static str,
    /// Its length, m.
    pub length: f64,
    /// Its section.
    pub section: Section,
    pub(crate) youngs_modulus: f64,
    pub(crate) shear_modulus: f64,
    pub(crate) density: f64,
}

/// A suture of 100 mm × 0.2 mm radius, 750 MPa, 1,300 kg/m³.
pub const SUTURE: Swinging = Swinging {
    name: "suture",
    length: 0.1,
    section: Section::Circle { radius: 0.2e-3 },
    youngs_modulus: 750e6,
    shear_modulus: 750e6 / 2.8,
    density: 1300.0,
};

/// A steel wire of 0.05 mm radius, as long.
pub const FINE_WIRE: Swinging = Swinging {
    name: "fine wire",
    length: 0.1,
    section: Section::Circle { radius: 0.05e-3 },
    youngs_modulus: 200e9,
    shear_modulus: 77e9,
    density: 7850.0,
};

/// A rubber tube of 5 mm outer and 3 mm inner radius, 200 mm long.
pub const TUBE: Swinging = Swinging {
    name: "rubber tube",
    length: 0.2,
    section: Section::Annulus { outer_radius: 5e-3, inner_radius: 3e-3 },
    youngs_modulus: 1e6,
    shear_modulus: 1e6 / 3.0,
    density: 1000.0,
};

/// A hair of 0.03 mm radius and a metre: it hardly bends its own weight, and cracks as a whip where it comes round.
pub const LONG_HAIR: Swinging = Swinging {
    name: "long hair",
    length: 1.0,
    section: Section::Circle { radius: 0.03e-3 },
    youngs_modulus: 3e9,
    shear_modulus: 3e9 / 2.8,
    density: 1300.0,
};

/// A steel wire of 0.25 mm radius and 0.8 m: its tip falls by three quarters of its length.
pub const LONG_WIRE: Swinging = Swinging {
    name: "long steel wire",
    length: 0.8,
    section: Section::Circle { radius: 0.25e-3 },
    youngs_modulus: 200e9,
    shear_modulus: 77e9,
    density: 7850.0,
};

/// Where the tip of [`LONG_WIRE`] comes to rest, along its first direction and down, m: of the planar Timoshenko rod by collocation to 1e-9, from outside
/// this project.
pub const LONG_WIRE_TIP: [f64; 2] = [0.466_607, 0.602_441];

impl Swinging {
    /// The rod along z, its weight along x.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn problem(&self, elements: usize) -> Result<Problem, RodError> {
        self.with(Kinematics::Cosserat, elements)
    }

    /// The same where it neither stretches nor shears.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn inextensible(&self, elements: usize) -> Result<Problem, RodError> {
        self.with(Kinematics::Kirchhoff, elements)
    }

    fn with(&self, kinematics: Kinematics, elements: usize) -> Result<Problem, RodError> {
        let material = Material::new(self.youngs_modulus, self.shear_modulus, self.density)?;
        let description = RodDescription {
            length: self.length,
            kinematics,
            profile: Profile::Stations(vec![Station { s: 0.0, section: self.section, material }]),
            rest: RestShape::default(),
            base: Pose::IDENTITY,
        };
        let rod = Rod::with_elements(description, elements, &[], Order::Second)?;
        let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::X * GRAVITY);
        Ok(Problem { loads, ..Problem::cantilever(rod) })
    }

    /// The circular frequency of its first mode as a beam of Euler's and Bernoulli's, rad/s.
    pub fn first_frequency(&self) -> f64 {
        let [second_moment, _] = self.section.second_moments();
        let stiffness = self.youngs_modulus * second_moment / (self.density * self.section.area());
        (1.875_104_068_711_961 / self.length).powi(2) * stiffness.sqrt()
    }
}
