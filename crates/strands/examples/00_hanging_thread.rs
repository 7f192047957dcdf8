//! A suture that hangs from a clamp held level: how far does its tip fall?
//!
//! `cargo run --release -p strands --example 00_hanging_thread`

use strands::load::NodalLoads;
use strands::math::{Mat3, Pose, Vec3};
use strands::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};
use strands::statics::{Problem, Settings, Workspace, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 2-0 nylon: 0.32 mm across, 2 GPa, 1140 kg/m³.
    let nylon = Material::from_poisson(2e9, 0.4, 1140.0)?;
    let section = Section::Circle { radius: 0.16e-3 };
    // The clamp points along x: d3 = x, d1 = −z, d2 = y.
    let level = Mat3::from_cols(-Vec3::Z, Vec3::Y, Vec3::X);
    for length in [0.05, 0.1, 0.15, 0.2] {
        let description = RodDescription {
            length,
            kinematics: Kinematics::Kirchhoff,
            profile: Profile::Stations(vec![Station { s: 0.0, section, material: nylon }]),
            rest: RestShape::default(),
            base: Pose { rotation: level, position: Vec3::ZERO },
        };
        let rod = Rod::with_elements(description, 100, &[], Order::Second)?;
        let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.0, -9.81));
        let problem = Problem { loads, ..Problem::cantilever(rod) };
        let solution = solve(&problem, &Settings::default(), None, &mut Workspace::default())?;
        let tip = solution.poses[100].position;
        let moment = solution.start_reaction().moment.norm();
        println!(
            "{:3.0} mm long: the tip falls {:6.2} mm, the clamp holds {:.3} µN·m, {} sweeps",
            length * 1e3,
            -tip.z * 1e3,
            moment * 1e6,
            solution.report.sweeps
        );
    }
    Ok(())
}
