//! Rods that joints tie to each other and to bodies: what is read, and how it moves.

use std::path::Path;
use strands::assembly::{Assembly, Drag, JointKind, Member, block};
use strands::dynamics::{Integrator, Simulation, Start};
use strands::math::{Pose, Vec3, Wrench};
use strands_scene::{BodyShape, Model, Scene};

const THREAD: &str = r#"
format = 1
name = "thread"
gravity = [0.0, 0.0, -9.81]

[wind]
velocity = [2.0, 0.0, 0.0]

[materials.nylon]
youngs_modulus = 2e9
poisson_ratio = 0.4
density = 1140.0
damping = 2e-3

[rods.thread]
material = "nylon"
length = 0.1
elements = 10
section = { shape = "circle", radius = 0.2e-3 }
orientation = [0.0, 1.0, 0.0, 0.0]
drag = { quadratic = 1e-4 }

[[rods.thread.supports]]
at = "start"
fix = ["position", "orientation"]
motion = [{ t = 0.0 }, { t = 0.5, position = [0.0, 0.02, 0.0] }, { t = 1.0, orientation = [0.5, 0.5, 0.5, 0.5] }]
"#;

const NEEDLE: &str = r#"
[[bodies]]
name = "needle"
shape = { shape = "block", size = [1e-3, 2e-3, 20e-3] }
density = 7850.0
position = [0.0, 0.0, -0.11]
orientation = [0.0, 1.0, 0.0, 0.0]
velocity = [0.1, 0.0, 0.0]
angular_velocity = [0.0, 5.0, 0.0]

[[joints]]
kind = "ball"
between = [{ rod = "thread", at = "end" }, { body = "needle" }]
"#;

const BRANCH: &str = r#"
[rods.branch]
material = "nylon"
length = 0.05
elements = 5
section = { shape = "circle", radius = 0.1e-3 }
position = [0.0, 0.0, -0.037]
orientation = [0.5, 0.5, 0.5, 0.5]

[[joints]]
kind = "hinge"
between = [{ rod = "branch", at = "start" }, { rod = "thread", at = 0.037 }]
axis = [0.0, 3.0, 0.0]
"#;

fn read(parts: &[&str]) -> Model {
    let scene = Scene::parse(&parts.concat(), "scene.toml", None);
    scene.unwrap_or_else(|error| panic!("{error}")).model
}

fn from_file(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Scene::read(&folder.join(name)).unwrap_or_else(|error| panic!("{error}")).model
}

fn simulation(model: &Model, start: Start) -> Simulation {
    Simulation::new(model.assembly(), model.motion(), start).unwrap()
}

/// How far apart joints are that tie two places together, at most.
fn apart(assembly: &Assembly, poses: &[Pose]) -> f64 {
    let joints = assembly.joints.iter().map(|joint| {
        let [a, b] = joint.between.map(|at| poses[assembly.frame(at.member).unwrap()].compose(&at.frame));
        (a.position - b.position).norm()
    });
    joints.fold(0.0, f64::max)
}

#[test]
fn a_needle_on_a_thread_is_read_as_written() {
    let model = read(&[THREAD, NEEDLE]);
    let assembly = model.assembly();
    assert_eq!(assembly.wind, Vec3::new(2.0, 0.0, 0.0));
    assert_eq!(assembly.strands[0].viscosity, 2e-3);
    assert_eq!(assembly.strands[0].drag, Drag { linear: 0.0, quadratic: 1e-4 });
    assert_eq!(model.bodies[0].name, "needle");
    assert_eq!(model.bodies[0].shape, Some(BodyShape::Block { size: [1e-3, 2e-3, 20e-3] }));
    let needle = &assembly.bodies[0];
    assert_eq!(needle.inertia, block(7850.0, [1e-3, 2e-3, 20e-3]));
    assert_eq!(needle.load, Wrench::new(Vec3::ZERO, Vec3::new(0.0, 0.0, -9.81) * needle.inertia.mass));
    let [joint] = &assembly.joints[..] else { panic!("{:?}", assembly.joints) };
    assert_eq!(joint.kind, JointKind::Ball);
    let members = joint.between.map(|at| at.member);
    assert_eq!(members, [Member::Node { rod: 0, node: 10 }, Member::Body(0)]);
    assert!(apart(&assembly, &assembly.rest_poses()) < 1e-12);
}

#[test]
fn keyframes_start_from_the_supports_own_target_and_go_on_from_it() {
    let moving = read(&[THREAD]).assembly().moving;
    assert_eq!(moving.len(), 1);
    assert_eq!(moving[0].member, Member::Node { rod: 0, node: 0 });
    let [down, turned] = [[0.0, 1.0, 0.0, 0.0], [0.5; 4]];
    let expected = [
        (0.0, [0.0; 3], down),
        (0.25, [0.0, 0.01, 0.0], down),
        (0.5, [0.0, 0.02, 0.0], down),
        (2.0, [0.0; 3], turned),
    ];
    for (time, position, orientation) in expected {
        let pose = moving[0].at(time);
        assert!((pose.position - Vec3::from(position)).norm() < 1e-15, "at {time}: {pose:?}");
        let off = pose.orientation().to_wxyz().iter().zip(orientation).map(|(a, b)| a * b).sum::<f64>();
        assert!((off.abs() - 1.0).abs() < 1e-12, "at {time}: {pose:?}");
    }
}

#[test]
fn a_support_that_moves_holds_where_it_is_at_the_beginning() {
    let later = THREAD.replace("motion = [{ t = 0.0 },", "motion = [{ t = -0.5 },");
    let model = read(&[&later]);
    assert!((model.rods[0].problem.start.pose.position - Vec3::new(0.0, 0.01, 0.0)).norm() < 1e-15);
}

#[test]
fn a_body_sets_off_as_written_and_takes_the_threads_end_with_it() {
    let model = read(&[THREAD, NEEDLE, "[dynamics]\nstart = \"rest\"\ntime_step = 1e-4\n"]);
    let velocities = model.velocities().unwrap();
    let mut simulation = simulation(&model, Start::Rest);
    simulation.set_velocities(&velocities);
    // 5 rad/s about y, 10 mm above the centre: 0.05 m/s along x more.
    assert!((velocities[10].linear - Vec3::new(0.15, 0.0, 0.0)).norm() < 1e-12, "{:?}", velocities[10]);
    assert_eq!(velocities[11].linear, Vec3::new(0.1, 0.0, 0.0));
    // Its own y lies along -y of the world.
    assert!((velocities[11].angular - Vec3::new(0.0, -5.0, 0.0)).norm() < 1e-12);
    for _ in 0..10 {
        simulation.step().unwrap();
    }
    let state = simulation.state();
    let went = state.poses[11].position - Vec3::new(0.0, 0.0, -0.11);
    assert!((went.x - 1e-4).abs() < 2e-5, "{went:?}");
    assert!(apart(simulation.assembly(), &state.poses) < 1e-9);
    assert!(read(&[THREAD]).velocities().is_none());
}

#[test]
fn a_branch_gets_a_node_of_the_rod_that_it_is_tied_to() {
    let model = read(&[THREAD, BRANCH]);
    let assembly = model.assembly();
    let [joint] = &assembly.joints[..] else { panic!("{:?}", assembly.joints) };
    let Member::Node { rod: 0, node } = joint.between[1].member else { panic!("{joint:?}") };
    assert!((model.rods[0].problem.rod.mesh().nodes()[node] - 0.037).abs() < 1e-12);
    assert_eq!(joint.kind, JointKind::Hinge);
    let poses = assembly.rest_poses();
    let third = poses[assembly.frame(joint.between[0].member).unwrap()]
        .compose(&joint.between[0].frame)
        .rotation
        .cols[2];
    assert!((third - Vec3::Y).norm() < 1e-12, "the hinge turns about {third:?}");
    assert!(
        model.rods[1].is_tied()
            && model.rods[1].problem.supports().all(|(_, support)| !support.holds_anything())
    );
    let mut simulation = simulation(&model, Start::Rest);
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    assert!(apart(simulation.assembly(), &simulation.state().poses) < 1e-9);
}

#[test]
fn tied_rods_are_not_solved_one_by_one() {
    assert_eq!(read(&[THREAD]).each_alone(), Ok(()));
    let refused = read(&[THREAD, BRANCH]).each_alone().unwrap_err();
    assert!(refused.to_string().contains("`strands simulate`"), "{refused}");
    let check = Scene::parse(&[THREAD, BRANCH].concat(), "scene.toml", None).unwrap().check();
    assert!(check.rods.iter().all(|rod| rod.trial == strands_scene::check::Trial::Tied));
    assert!(check.remarks.is_empty(), "{:?}", check.remarks);
}

#[test]
fn steps_are_made_as_written() {
    let motion = |lines: &str| read(&[THREAD, "[dynamics]\n", lines]).motion();
    let default = motion("");
    assert_eq!(default, strands::dynamics::Settings::default());
    let alpha = motion("integrator = \"generalized_alpha\"\nmass_damping = 0.3\ntime_step = 2e-3");
    assert_eq!(alpha.integrator, Integrator::GeneralizedAlpha { spectral_radius: 0.5 });
    assert_eq!((alpha.mass_damping, alpha.time_step, alpha.bounded), (0.3, 2e-3, false));
    let radius = motion("integrator = \"generalized_alpha\"\nspectral_radius = 0.7").integrator;
    assert_eq!(radius, Integrator::GeneralizedAlpha { spectral_radius: 0.7 });
    let bounded = motion("newton_iterations = 2");
    assert_eq!((bounded.bounded, bounded.max_iterations), (true, 2));
    assert_eq!(motion("integrator = \"midpoint\"").integrator, Integrator::Midpoint);
    let chosen = motion("tolerance = 1e-3\noutput_rate = 50");
    assert_eq!((chosen.integrator, chosen.local_error), (Integrator::Sdirk4, Some(1e-3)));
    assert_eq!(chosen.time_step, 0.02);
    let stretchless = THREAD.replace("[rods.thread]", "[rods.thread]\nkinematics = \"kirchhoff\"");
    let chosen = read(&[&stretchless, "[dynamics]\ntolerance = 1e-3"]).motion();
    assert_eq!((chosen.integrator, chosen.local_error), (Integrator::TrBdf2, Some(1e-3)));
}

#[test]
fn what_has_no_effect_on_the_motion_is_said() {
    let remarks = |parts: &[&str]| {
        let scene = Scene::parse(&parts.concat(), "scene.toml", None).unwrap();
        scene.remarks().into_iter().map(|remark| remark.said.key().to_owned()).collect::<Vec<_>>()
    };
    let without_drag = THREAD.replace("drag = { quadratic = 1e-4 }\n", "");
    assert_eq!(remarks(&[&without_drag]), ["wind"]);
    assert_eq!(remarks(&[THREAD, NEEDLE]), ["bodies[0].velocity"]);
    assert_eq!(remarks(&[THREAD, NEEDLE, "[dynamics]\nstart = \"rest\"\n"]), [""; 0]);
}

#[test]
fn a_net_hangs_by_its_corners() {
    let model = from_file("hanging_net.toml");
    assert_eq!(model.joints.len(), 16);
    let mut simulation = simulation(&model, Start::Equilibrium);
    let began = simulation.state().poses.clone();
    for _ in 0..5 {
        simulation.step().unwrap();
    }
    let weight: f64 = model.rods.iter().map(|rod| rod.problem.rod.mass() * 9.81).sum();
    let corners = [(0, 0), (0, 12), (3, 0), (3, 12)];
    let held = corners.map(|(rod, node)| simulation.reaction(Member::Node { rod, node }).linear.z);
    assert!((held.iter().sum::<f64>() / weight - 1.0).abs() < 1e-6, "{held:?} for {weight}");
    assert!(held.iter().all(|force| (force / held[0] - 1.0).abs() < 1e-6), "{held:?}");
    let moved = simulation.state().poses.iter().zip(&began).map(|(a, b)| (a.position - b.position).norm());
    assert!(moved.fold(0.0, f64::max) < 1e-7);
    let lowest = began.iter().map(|pose| pose.position.z).fold(0.0, f64::min);
    assert!(lowest < -0.01, "it sags by {lowest}");
}

#[test]
fn a_needle_swings_behind_the_hand_that_holds_its_thread() {
    let model = from_file("needle_and_thread.toml");
    assert!(apart(&model.assembly(), &model.assembly().rest_poses()) < 1e-9);
    let mut simulation = simulation(&model, Start::Rest);
    let needle = model.assembly().first_body();
    for _ in 0..300 {
        simulation.step().unwrap();
    }
    let state = simulation.state();
    let hand = state.poses[0].position.x;
    assert!((hand - 0.05 * 2.0 / 3.0).abs() < 1e-9, "{hand}");
    assert!(state.poses[needle].position.x < hand - 0.01, "it stays behind: {:?}", state.poses[needle]);
    assert!(apart(simulation.assembly(), &state.poses) < 1e-8);
}
