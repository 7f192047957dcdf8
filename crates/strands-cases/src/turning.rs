//! Slender rods that turn steadily, or nearly as rigid bodies do, and a column that a following force makes flutter.

use crate::table::Table;
use crate::uniform::Uniform;
use strands::assembly::{Assembly, Keyframes, Member};
use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Mat3, Pose, Quat, Vec3, Wrench};
use strands::rod::{Kinematics, Rod, RodError, Stiffness};
use strands::statics::{Problem, Support};

/// A straight rod of length, mass per length and, where it can bend at all, bending stiffness 1, its turns nearly without inertia, that neither
/// stretches nor shears.
///
/// # Errors
/// Where there are no elements.
fn unit_rod(bending: f64, base: Pose, elements: usize) -> Result<Rod, RodError> {
    Uniform::inextensible(1.0, [bending; 2], 1.0, Vec3::Z * 1e-9).rod(base, Vec3::ZERO, elements)
}

/// Along x, with the first direction along y and the second along z, turned by an angle about z.
fn along_x_turned(angle: f64) -> Pose {
    let turn = Quat::from_rotation_vector(Vec3::Z * angle).to_matrix();
    Pose { rotation: turn * Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X), position: Vec3::ZERO }
}

/// A cantilever that turns about an axis through its root, by its bending stiffness, mass and length.
#[derive(Clone, Copy, Debug)]
pub struct Rotor {
    /// How fast it turns, rad/s.
    pub turning: f64,
    /// The circular frequencies of its first three modes along the axis, rad/s: Wright et al., J. Appl. Mech. 49:197–202, 1982, and by
    /// Galerkin's method to all digits.
    pub flap: [f64; 3],
    /// That of the first across the axis, as seen from the rotor.
    pub lag: f64,
}

impl Rotor {
    /// Those that are known.
    pub fn all() -> Vec<Self> {
        let table = Table::read(include_str!("../data/rotating_cantilever.csv"));
        let records = table.records().map(|record| Self {
            turning: record.number("turning"),
            flap: ["flap1", "flap2", "flap3"].map(|column| record.number(column)),
            lag: record.number("lag1"),
        });
        records.collect()
    }

    /// It, along x at first, turning about z for so long.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn turned(&self, elements: usize, seconds: f64) -> Result<Assembly, RodError> {
        let rod = unit_rod(1.0, along_x_turned(0.0), elements)?;
        let mut assembly = Assembly::from(Problem::cantilever(rod));
        // A keyframe for each radian.
        let radians = (self.turning * seconds).ceil() as usize;
        let frame = |k: usize| (k as f64 / self.turning, along_x_turned(k as f64));
        if self.turning > 0.0 {
            let frames = (0..=radians).map(frame).collect();
            assembly.moving.push(Keyframes { member: Member::Node { rod: 0, node: 0 }, frames });
        }
        Ok(assembly)
    }

    /// It at rest, pulled as by what its turning makes of its mass: along the axis it vibrates so too.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn pulled(&self, elements: usize) -> Result<Problem, RodError> {
        let rod = unit_rod(1.0, along_x_turned(0.0), elements)?;
        let mut problem = Problem::cantilever(rod);
        let nodes = problem.rod.node_inertia().iter().zip(problem.rod.mesh().nodes());
        for (load, (node, s)) in problem.loads.world.iter_mut().zip(nodes) {
            load.linear = Vec3::X * (node.mass * s * self.turning * self.turning);
        }
        Ok(problem)
    }
}

/// A rod that turns about its end and is stretched by it: Simo & Vu-Quoc, J. Appl. Mech. 53:855–863, 1986.
#[derive(Clone, Copy, Debug)]
pub struct Whirled {
    /// Its length at rest, m.
    pub length: f64,
    /// Its axial stiffness, N.
    pub axial: f64,
    /// By how much it is stretched, m.
    pub extension: f64,
    /// What it is held with, N.
    pub tension: f64,
}

impl Whirled {
    /// How fast it turns, rad/s.
    pub const TURNING: f64 = 6.0;
    const MASS: f64 = 1.2;
    /// Those that are known.
    pub const ALL: [Self; 2] = [
        Self {
            length: 10.0,
            axial: 28e6,
            extension: 0.000_514_317_455_042_601,
            tension: 2_160.138_865_855_64,
        },
        Self {
            length: 1.5,
            axial: 2000.0,
            extension: 0.024_781_871_312_637_1,
            tension: 49.603_991_711_381_3,
        },
    ];

    /// It, along x, pinned at its start and not stretched.
    ///
    /// # Errors
    /// Where there are no elements.
    pub fn problem(&self, elements: usize) -> Result<Problem, RodError> {
        let stiffness = Stiffness { bending: [14e3; 2], torsion: 10e3, axial: self.axial, shear: [10e6; 2] };
        let (base, inertia) = (along_x_turned(0.0), Vec3::new(6e-4, 6e-4, 12e-4));
        let (length, mass, kinematics) = (self.length, Self::MASS, Kinematics::Cosserat);
        let rod = Uniform { length, kinematics, stiffness, mass, inertia }.rod(base, Vec3::ZERO, elements)?;
        Ok(Problem { start: Support::pinned(base), ..Problem::cantilever(rod) })
    }

    /// How far from its start a place along it is as it turns, m: `sin(k s) / (k cos(k L))`.
    pub fn place(&self, s: f64) -> f64 {
        let k = Self::TURNING * (Self::MASS / self.axial).sqrt();
        (k * s).sin() / (k * (k * self.length).cos())
    }
}

/// The periods of a stiff rod that swings about its end, in the time that its length and gravity make: amplitudes in degrees, and periods. By elliptic
/// integrals.
pub const PENDULUM: [(f64, f64); 6] = [
    (5.0, 5.132_642_180_411_58),
    (30.0, 5.219_509_922_247_52),
    (60.0, 5.505_637_604_008_74),
    (90.0, 6.055_382_539_204_99),
    (120.0, 7.043_150_611_602_4),
    (150.0, 9.040_456_375_942_58),
];

/// A rod that hardly bends.
const STIFF: f64 = 1e4;

/// A pendulum of length, mass and gravity 1, hinged, at an angle (rad) from where it hangs along z.
///
/// # Errors
/// Where there are no elements.
pub fn pendulum(angle: f64, elements: usize) -> Result<Problem, RodError> {
    let base =
        Pose { rotation: Quat::from_rotation_vector(Vec3::Y * angle).to_matrix(), position: Vec3::ZERO };
    let rod = unit_rod(STIFF, base, elements)?;
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Z);
    let start = Support::clamped(base).turning_about(Vec3::Y);
    Ok(Problem { loads, start, ..Problem::cantilever(rod) })
}

/// A stiff thick rod along z that nothing holds, of length and mass 1, with such inertia per length about its axes.
///
/// # Errors
/// Where there are no elements.
pub fn top(inertia: Vec3, elements: usize) -> Result<Problem, RodError> {
    let rod = Uniform::inextensible(1.0, [STIFF; 2], 1.0, inertia);
    let rod = rod.rod(Pose::IDENTITY, Vec3::ZERO, elements)?;
    Ok(Problem { start: Support::free(Pose::IDENTITY), ..Problem::cantilever(rod) })
}

/// The thrust that follows the tip of a cantilever of length, mass and stiffness 1 and makes it flutter, and the circular frequency at which its first
/// two modes meet there: Beck, ZAMP 3:225–228, 1952.
pub const BECK: (f64, f64) = (20.050_953_618_973_8, 11.015_557_640_922_9);

/// That column, along z, under a thrust.
///
/// # Errors
/// Where there are no elements.
pub fn beck(thrust: f64, elements: usize) -> Result<Problem, RodError> {
    let rod = unit_rod(1.0, Pose::IDENTITY, elements)?;
    let wrench = Wrench::new(Vec3::ZERO, Vec3::Z * -thrust);
    let follower = PointLoad { at: 1.0, wrench, frame: Frame::Body };
    let loads = NodalLoads::none(&rod).with_point(&rod, &follower)?;
    Ok(Problem { loads, ..Problem::cantilever(rod) })
}
