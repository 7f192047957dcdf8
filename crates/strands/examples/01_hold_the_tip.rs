//! The hand holds the tip of a strand and turns it about its axis until the strand loops; what does the hand feel?
//!
//! `cargo run --release -p strands --example 01_hold_the_tip`

use strands::load::NodalLoads;
use strands::math::{Mat3, Pose, Quat, Vec3};
use strands::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};
use strands::statics::{Problem, Settings, Support, Workspace, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let polypropylene = Material::from_poisson(1.5e9, 0.4, 910.0)?;
    let section = Section::Circle { radius: 75e-6 };
    let description = RodDescription {
        length: 0.1,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Stations(vec![Station { s: 0.0, section, material: polypropylene }]),
        rest: RestShape::Constant(Vec3::new(0.0, 5.0, 0.0)),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 100, &[], Order::Second)?;
    let loads = NodalLoads::none(&rod);
    let mut problem = Problem { loads, ..Problem::cantilever(rod) };
    let (settings, mut workspace) = (Settings::default(), Workspace::default());
    let mut guess = None;
    for turn in (0..=360).step_by(45) {
        let twist = Quat::from_rotation_vector(Vec3::new(0.0, 0.0, f64::from(turn).to_radians()));
        let hand =
            Pose { rotation: Mat3::IDENTITY * twist.to_matrix(), position: Vec3::new(0.01, 0.0, 0.085) };
        problem.end = Support::clamped(hand);
        match solve(&problem, &settings, guess.as_ref(), &mut workspace) {
            Ok(solution) => {
                let felt = solution.end_reaction();
                println!(
                    "turned by {turn:3}°: force {:6.2} µN, torque about the axis {:6.3} µN·m, {} iterations, Morse index {:?}",
                    felt.force.norm() * 1e6,
                    felt.moment.z * 1e6,
                    solution.report.iterations,
                    solution.report.morse_index
                );
                guess = Some(solution.guess);
            }
            Err(failure) => println!("turned by {turn:3}°: {failure}"),
        }
    }
    Ok(())
}
