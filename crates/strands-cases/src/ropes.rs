//! Ropes that hardly bend, of length, mass and gravity 1 or so: one that is skipped, and one that falls from where it is folded.

use crate::case::CaseError;
use crate::uniform::Uniform;
use strands::load::NodalLoads;
use strands::math::{Pose, Vec3};
use strands::rod::{Rod, RodError};
use strands::statics::{Method, Problem, Scheme, Settings, Support, Workspace, solve};

/// A skipping rope whose ends are 1 apart on the axis about which it turns at 1 rad/s, of mass 1 over its length: its length, how far it is from the
/// axis in the middle, and what its ends are held with. Of a string, by elliptic integrals: Mohazzabi & Schmidt, Can. J. Phys. 77:505, 1999.
pub const SKIPPED: [[f64; 3]; 3] = [
    [1.1, 0.207_512_569_994_966, 0.127_887_082_044_96],
    [1.5, 0.515_704_709_053_842, 0.258_921_738_653_291],
    [3.0, 1.349_773_201_783_75, 1.104_914_505_316_3],
];

/// A rope that neither stretches nor resists bending much, along z.
fn rope(length: f64, bending: f64, elements: usize) -> Result<Rod, RodError> {
    let rope = Uniform::inextensible(length, [bending; 2], 1.0, Vec3::new(1e-6, 1e-6, 2e-6));
    rope.rod(Pose::IDENTITY, Vec3::ZERO, elements)
}

/// The rope along z, its belly along x, held where it is as it turns about z: what pulls it is what its turning makes of its mass.
///
/// # Errors
/// Where there are no elements, or no such place is found.
pub fn skipped(length: f64, elements: usize) -> Result<Problem, CaseError> {
    let rod = rope(length, 1e-5, elements)?;
    let (start, end) = (Support::pinned(Pose::IDENTITY), Support::pinned(at(Vec3::Z)));
    let mut problem = Problem { start, end, ..Problem::cantilever(rod) };
    let settings = Settings { method: Method::Equilibrium, scheme: Scheme::Element, ..Settings::default() };
    let mut workspace = Workspace::default();
    let mut away = vec![1.0; elements + 1];
    // What turns pulls most where it is furthest away.
    for _ in 0..40 {
        let masses = problem.rod.node_inertia().iter().map(|node| node.mass);
        for (load, (mass, away)) in problem.loads.world.iter_mut().zip(masses.zip(&away)) {
            load.linear = Vec3::X * (mass * away);
        }
        let found = solve(&problem, &settings, None, &mut workspace)?;
        away = found.poses.iter().map(|pose| pose.position.x).collect();
    }
    Ok(problem)
}

fn at(position: Vec3) -> Pose {
    Pose { position, ..Pose::IDENTITY }
}

/// A rope that hangs, folded, from its ends, which are nearly at one place, down along z.
///
/// # Errors
/// Where there are no elements.
pub fn folded(elements: usize) -> Result<Problem, RodError> {
    let rod = rope(1.0, 1e-7, elements)?;
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Z);
    let (start, end) = (Support::pinned(Pose::IDENTITY), Support::pinned(at(Vec3::X * 0.02)));
    Ok(Problem { loads, start, end, ..Problem::cantilever(rod) })
}

/// How fast its end falls when it is let go, by how far it has fallen, where no energy is lost: Calkin & March, Am. J. Phys. 57:154, 1989.
pub fn speed_of_end(fallen: f64) -> f64 {
    (2.0 * fallen * (1.0 - 0.5 * fallen) / (1.0 - fallen)).sqrt()
}

/// The time until it has fallen by its whole length, over that of a free fall: Schagerl et al., Acta Mech. 121:155, 1997.
pub const OF_FREE_FALL: f64 = 0.847_213_084_793_977;
