//! A net of ropes that hangs by its corners.

use strands::assembly::{Assembly, AssemblyError, Joint, JointKind, Member};
use strands::load::NodalLoads;
use strands::math::{Mat3, Pose, Vec3};
use strands::rod::{
    Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, RodError, Section, Station,
};
use strands::statics::{Problem, Support};

/// From rope to rope, m.
const MESH: f64 = 0.05;

/// Why there is no net.
#[derive(Debug, thiserror::Error)]
pub enum NetError {
    /// A rope could not be made.
    #[error(transparent)]
    Rod(#[from] RodError),
    /// Two ropes could not be tied.
    #[error(transparent)]
    Joint(#[from] AssemblyError),
}

/// So many ropes of nylon, 4 mm thick, along x and as many along y, flat, tied by balls where they cross, with so many elements from one to the next, held
/// at the corners.
///
/// # Errors
/// Where there are fewer than two ropes, or no elements.
pub fn net(ropes: usize, elements: usize) -> Result<Assembly, NetError> {
    let far = MESH * (ropes.max(2) - 1) as f64;
    let last = elements * (ropes.max(2) - 1);
    let mut net = Assembly::default();
    let across = [Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X), Mat3::from_cols(Vec3::Z, Vec3::X, Vec3::Y)];
    for (rotation, aside) in [(across[0], Vec3::Y), (across[1], Vec3::X)] {
        for rope in 0..ropes {
            let base = Pose { rotation, position: aside * (MESH * rope as f64) };
            net.strands.push(Problem::cantilever(self::rope(base, far, last)?).into());
        }
    }
    for strand in &mut net.strands {
        let rod = &strand.problem.rod;
        strand.problem.loads = NodalLoads::none(rod).with_gravity(rod, Vec3::new(0.0, 0.0, -9.81));
        strand.problem.start = Support::free(rod.description().base);
    }
    for rod in [0, ropes - 1] {
        let ends = net.strands[rod].problem.rod.rest_poses();
        let problem = &mut net.strands[rod].problem;
        (problem.start, problem.end) = (Support::pinned(ends[0]), Support::pinned(ends[last]));
    }
    for i in 0..ropes {
        for j in 0..ropes {
            let crossing = [
                Member::Node { rod: i, node: j * elements },
                Member::Node { rod: ropes + j, node: i * elements },
            ];
            let joint = Joint::at_rest(&net, JointKind::Ball, crossing, None, Vec3::ZERO)?;
            net.joints.push(joint);
        }
    }
    Ok(net)
}

fn rope(base: Pose, length: f64, elements: usize) -> Result<Rod, RodError> {
    let nylon = Material::from_poisson(2e9, 0.39, 1140.0)?;
    let description = RodDescription {
        length,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 2e-3 },
            material: nylon,
        }]),
        rest: RestShape::default(),
        base,
    };
    Rod::with_elements(description, elements, &[], Order::Second)
}
