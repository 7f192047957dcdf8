//! A vine that branches, and hangs a fruit: rods and a rigid body, tied by joints, fall from where they are laid and come to rest.
//!
//! `cargo run --release -p strands --example 04_vine`

use std::error::Error;

use strands::assembly::{Assembly, Body, Joint, JointKind, Member, Strand, ball};
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::load::NodalLoads;
use strands::math::{Pose, Quat, Vec3};
use strands::rod::{Kinematics, Material, Order, Profile, Rod, RodDescription, Section, Station};
use strands::statics::{Problem, Support};

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// A green stem from a place, in the direction that `turn` (a rotation vector) gives to the vertical.
fn stem(length: f64, radius: f64, from: Vec3, turn: Vec3) -> Result<Strand, Box<dyn Error>> {
    let green_wood = Material::from_poisson(0.5e9, 0.35, 900.0)?;
    let description = RodDescription {
        length,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius },
            material: green_wood,
        }]),
        rest: Default::default(),
        base: Pose { rotation: Quat::from_rotation_vector(turn).to_matrix(), position: from },
    };
    let rod = Rod::with_elements(description, 20, &[], Order::Second)?;
    let loads = NodalLoads::none(&rod).with_gravity(&rod, GRAVITY);
    let start = Support::free(rod.description().base);
    let problem = Problem { loads, start, ..Problem::cantilever(rod) };
    Ok(Strand { viscosity: 0.02, ..problem.into() })
}

fn main() -> Result<(), Box<dyn Error>> {
    // A trunk that leans, two branches from its end, one of them with a fruit on a stalk that turns freely.
    let mut trunk = stem(0.4, 3e-3, Vec3::ZERO, Vec3::Y * 0.4)?;
    trunk.problem.start = Support::clamped(trunk.problem.rod.description().base);
    let fork = trunk.problem.rod.rest_poses()[20].position;
    let branches = [Vec3::Y * 1.1, Vec3::new(0.6, 0.5, 0.0)].map(|turn| stem(0.3, 2e-3, fork, turn));
    let [left, right] = branches;
    let (left, right) = (left?, right?);
    let hangs_at = left.problem.rod.rest_poses()[20].position;
    let fruit = Pose { position: hangs_at - Vec3::Z * 0.03, ..Pose::IDENTITY };
    let mut vine = Assembly { strands: vec![trunk, left, right], ..Assembly::default() };
    vine.bodies.push(Body::new(ball(600.0, 0.02), fruit).with_gravity(GRAVITY));
    let node = |rod, node| Member::Node { rod, node };
    for (kind, members) in [
        (JointKind::Rigid, [node(0, 20), node(1, 0)]),
        (JointKind::Rigid, [node(0, 20), node(2, 0)]),
        (JointKind::Ball, [node(1, 20), Member::Body(0)]),
    ] {
        let joint = Joint::at_rest(&vine, kind, members, None, Vec3::ZERO)?;
        vine.joints.push(joint);
    }

    let settings =
        Settings { integrator: Integrator::Bdf2, time_step: 2e-3, mass_damping: 2.0, ..Settings::default() };
    let mut falling = Simulation::new(vine.clone(), settings, Start::Rest)?;
    for _ in 0..6 {
        let step = falling.advance(falling.state().time + 1.0)?;
        let (fruit, energy) = (falling.state().poses[vine.first_body()].position, falling.energy());
        println!(
            "{:.1} s: the fruit is at ({:.3}, {:.3}, {:.3}) m; {:.1e} J of motion",
            step.time, fruit.x, fruit.y, fruit.z, energy.kinetic
        );
    }
    let resting = Simulation::new(vine, settings, Start::Equilibrium)?;
    let fruit = resting.assembly().first_body();
    let (now, rest) = (falling.state().poses[fruit].position, resting.state().poses[fruit].position);
    println!("it comes to rest at ({:.3}, {:.3}, {:.3}) m", rest.x, rest.y, rest.z);
    assert!((now - rest).norm() < 1e-3, "it has come near");
    let root = resting.reaction(node(0, 0));
    println!("the root bears {:.3} N and {:.4} N·m", root.linear.norm(), root.angular.norm());
    Ok(())
}
