//! What holds rods while they move, what slows them down, and steps that are chosen.

use super::{G, heavy, simulated, suture};
use crate::assembly::{Assembly, Drag, Keyframes, Member, Strand};
use crate::coupling::{Grip, VirtualCoupling};
use crate::dynamics::{Integrator, Settings, Simulation, Start};
use crate::load::NodalLoads;
use crate::math::{Pose, Quat, Vec3};
use crate::statics::{self, Method, Problem, Scheme, Support, Workspace};

fn free(problem: Problem) -> Problem {
    let base = problem.rod.description().base;
    Problem { start: Support::free(base), ..problem }
}

#[test]
fn a_rod_that_falls_through_air_comes_to_its_speed() {
    let rod = suture(10);
    let weight = rod.mass() * 9.81 / 0.1;
    for (drag, expected) in [
        (Drag { linear: 2.0 * weight, quadratic: 0.0 }, 0.5),
        (Drag { linear: 0.0, quadratic: weight / 4.0 }, 2.0),
    ] {
        let strand = Strand { drag, ..free(heavy(rod.clone())).into() };
        let settings = Settings { integrator: Integrator::Sdirk4, time_step: 0.01, ..Settings::default() };
        let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
        let began = simulation.energy().total();
        for _ in 0..300 {
            simulation.step().unwrap();
        }
        for velocity in &simulation.state().velocities {
            assert!((velocity.linear - Vec3::X * expected).norm() < 1e-6, "{velocity:?}");
        }
        let energy = simulation.energy();
        let missing = (energy.total() - began).abs() / energy.dissipated;
        assert!(missing < 1e-5, "{missing:e} of {energy:?}");
    }
}

#[test]
fn wind_takes_a_free_rod_along() {
    let strand = Strand {
        drag: Drag { linear: 1e-3, quadratic: 1e-3 },
        ..free(Problem::cantilever(suture(10))).into()
    };
    let wind = Vec3::new(1.0, 2.0, -0.5);
    let assembly = Assembly { wind, ..strand.into() };
    let mut simulation = Simulation::new(assembly, Settings::default(), Start::Rest).unwrap();
    for _ in 0..2000 {
        simulation.step().unwrap();
    }
    let (momentum, _) = simulation.momentum();
    let mass = simulation.assembly().strands[0].problem.rod.mass();
    assert!((momentum - wind * mass).norm() < 1e-3 * mass, "{:?}", momentum * (1.0 / mass));
}

#[test]
fn a_support_goes_where_its_keyframes_say_and_works() {
    for integrator in [Integrator::Bdf2, Integrator::Sdirk4, Integrator::Midpoint] {
        let mut assembly =
            Assembly::from(Strand { viscosity: 0.02, ..Problem::cantilever(suture(20)).into() });
        let from = Pose::IDENTITY;
        let turn = Quat::from_rotation_vector(Vec3::new(0.0, 0.8, 0.3)).to_matrix();
        let to = Pose { rotation: turn, position: Vec3::new(0.05, 0.02, -0.01) };
        let member = Member::Node { rod: 0, node: 0 };
        assembly.moving.push(Keyframes { member, frames: vec![(0.1, from), (0.6, to)] });
        let settings = Settings { integrator, time_step: 2e-3, ..Settings::default() };
        let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
        let rest = simulation.state().poses.clone();
        simulation.advance(0.35).unwrap();
        let half = simulation.state().poses[0].position;
        assert!((half - to.position * 0.5).norm() < 1e-12, "{half:?}");
        // All that the support has put in is in the rod, or has been taken out.
        let energy = simulation.energy();
        assert!(energy.worked > 0.0 && energy.kinetic > 0.0);
        // Its jerk goes into waves that are faster than the steps: those that lose what is fast take them.
        let change = energy.total() / energy.worked;
        let (gained, lost) = if integrator == Integrator::Midpoint { (1e-7, 1e-7) } else { (0.02, 0.25) };
        assert!(change < gained && change > -lost, "{}: {change} of {energy:?}", integrator.name());
        simulation.advance(4.0).unwrap();
        for (pose, rest) in simulation.state().poses.iter().zip(&rest) {
            let expected = to.compose(rest);
            assert!((pose.position - expected.position).norm() < 1e-8, "{}", integrator.name());
        }
    }
}

/// Its node's speed jumps as the motion begins: what that takes is little, and all else goes into the rod.
#[test]
fn a_support_that_sets_off_at_once_works_no_more_than_the_rod_takes() {
    for integrator in
        [Integrator::Bdf2, Integrator::Sdirk4, Integrator::GeneralizedAlpha { spectral_radius: 0.5 }]
    {
        let mut assembly = Assembly::from(Problem::cantilever(suture(20)));
        let to = Pose { position: Vec3::X * 0.05, ..Pose::IDENTITY };
        let member = Member::Node { rod: 0, node: 0 };
        assembly.moving.push(Keyframes { member, frames: vec![(0.0, Pose::IDENTITY), (0.1, to)] });
        let settings = Settings { integrator, ..Settings::default() };
        let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
        simulation.advance(0.005).unwrap();
        let energy = simulation.energy();
        let lost = -energy.total() / energy.worked;
        assert!((-0.02..0.3).contains(&lost), "{}: {lost} of {energy:?}", integrator.name());
    }
}

#[test]
fn a_node_is_grasped_lifted_and_let_go() {
    for integrator in [Integrator::Bdf2, Integrator::Sdirk4, Integrator::Midpoint] {
        let mut simulation = simulated(heavy(suture(40)), integrator, 1e-3, Start::Equilibrium);
        let there = simulation.state().poses[20];
        let weight = simulation.assembly().strands[0].problem.rod.mass() * 9.81;
        let bears = simulation.reaction(Member::Node { rod: 0, node: 0 }).linear;
        assert!((bears + Vec3::X * weight).norm() < 1e-9 * weight, "{bears:?}");
        let hold = |simulation: &mut Simulation, lift: f64| {
            let pose = Pose { position: there.position - Vec3::X * lift, ..there };
            simulation.assembly_mut().strands[0].problem.between = vec![(20, Support::clamped(pose))];
        };
        for step in 1..=100 {
            hold(&mut simulation, 1e-4 * f64::from(step));
            simulation.step().unwrap();
        }
        let held = simulation.state().poses[20];
        assert!((held.position - (there.position - Vec3::X * 0.01)).norm() < 1e-12);
        assert!(simulation.reaction(Member::Node { rod: 0, node: 20 }).linear.x < 0.0, "it bears weight");
        simulation.assembly_mut().strands[0].problem.between.clear();
        let before = simulation.energy();
        for _ in 0..100 {
            simulation.step().unwrap();
        }
        let after = simulation.energy();
        let moved = (simulation.state().poses[20].position - held.position).norm();
        // What is let go vibrates at once, faster than the steps: that the integrators take, which lose what is fast.
        let change = (after.total() - before.total()) / before.elastic;
        let (gained, lost) = match integrator {
            Integrator::Midpoint => (1e-6, 1e-6),
            _ => (1e-2, 1.0),
        };
        assert!(moved > 1e-3, "{}: {moved}", integrator.name());
        assert!(change < gained && change > -lost, "{}: {change}", integrator.name());
    }
}

#[test]
fn a_collar_on_a_rail_falls_freely() {
    for integrator in [Integrator::Bdf2, Integrator::Sdirk4, Integrator::Midpoint] {
        let problem = heavy(suture(10));
        let base = problem.rod.description().base;
        let start = Support::clamped(base).sliding_along(G);
        let mut simulation = simulated(Problem { start, ..problem }, integrator, 1e-3, Start::Rest);
        let time = simulation.advance(0.1).unwrap().time;
        let fallen = 0.5 * 9.81 * time * time;
        for pose in &simulation.state().poses {
            // The first step of backward differences, and their own error: none for a parabola.
            assert!((pose.position.x - fallen).abs() < 1e-9, "{}: {pose:?}", integrator.name());
        }
    }
}

#[test]
fn a_hand_that_holds_on_through_a_spring_comes_to_rest_where_statics_says() {
    let mut problem = heavy(suture(20));
    let hand = Pose { position: Vec3::new(0.01, 0.02, 0.08), ..Pose::IDENTITY };
    let coupling = VirtualCoupling {
        linear_stiffness: 0.5,
        angular_stiffness: 1e-5,
        linear_damping: 2e-3,
        angular_damping: 1e-7,
        max_force: 1.0,
        max_torque: 1.0,
    };
    problem.end = Support::gripped(Grip { coupling, hand, last: None });
    let settings = statics::Settings {
        method: Method::Equilibrium,
        scheme: Scheme::Element,
        ..statics::Settings::default()
    };
    let rest = statics::solve(&problem, &settings, None, &mut Workspace::default()).unwrap().poses;
    for integrator in [Integrator::Bdf2, Integrator::Sdirk4, Integrator::Midpoint] {
        let settings = Settings { integrator, time_step: 2e-3, ..Settings::default() };
        let strand = Strand { viscosity: 0.02, ..problem.clone().into() };
        let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
        simulation.advance(3.0).unwrap();
        for (pose, rest) in simulation.state().poses.iter().zip(&rest) {
            let apart = (pose.position - rest.position).norm();
            assert!(apart < 1e-8, "{}: {apart:e}", integrator.name());
        }
    }
}

#[test]
fn steps_are_as_long_as_their_error_allows() {
    let tip = |settings: Settings| {
        let mut simulation = Simulation::new(heavy(suture(20)), settings, Start::Rest).unwrap();
        let step = simulation.advance(0.2).unwrap();
        assert!((step.time - 0.2).abs() < 1e-9);
        (simulation.state().poses[20].position, step.pieces)
    };
    let equal = Settings { integrator: Integrator::Sdirk4, time_step: 5e-5, ..Settings::default() };
    let (exact, _) = tip(equal);
    for integrator in [Integrator::Sdirk4, Integrator::TrBdf2] {
        let mut last = 0;
        for allowed in [1e-3, 1e-4, 1e-5, 1e-6] {
            let chosen = Settings { integrator, time_step: 0.1, local_error: Some(allowed), ..equal };
            let (chosen, tries) = tip(chosen);
            let error = (chosen - exact).norm() / 0.1;
            // The errors of all steps add up at most.
            assert!(error < tries as f64 * allowed, "{allowed:e}: {error:e} in {tries} steps");
            assert!(tries > last, "{allowed:e}: {tries} steps");
            last = tries;
        }
    }
    let refused = Settings { integrator: Integrator::Bdf2, local_error: Some(1e-5), ..equal };
    let refused = Simulation::new(heavy(suture(5)), refused, Start::Rest).unwrap_err();
    assert!(refused.to_string().contains("\"tr_bdf2\" only"), "{refused}");
}

#[test]
fn no_load_no_motion() {
    let rod = suture(5);
    let loads = NodalLoads::none(&rod);
    let problem = Problem { loads, ..Problem::cantilever(rod) };
    let mut simulation = simulated(problem, Integrator::Midpoint, 1e-3, Start::Rest);
    let rest = simulation.state().poses.clone();
    simulation.advance(0.01).unwrap();
    assert_eq!(simulation.state().poses, rest);
}

#[test]
fn viscosity_does_not_resist_a_turn_without_strain() {
    // A tenth of a radian a step, and as stiff against it as a rate of strain that is not there would make it.
    let strand = Strand { viscosity: 0.01, ..free(Problem::cantilever(suture(10))).into() };
    let spin = Vec3::new(0.0, 100.0, 0.0);
    for integrator in [Integrator::Bdf2, super::ALPHA, Integrator::Midpoint, Integrator::Sdirk4] {
        let settings = Settings { integrator, time_step: 1e-3, ..Settings::default() };
        let mut simulation = Simulation::new(strand.clone(), settings, Start::Rest).unwrap();
        let middle = Vec3::Z * 0.05;
        let velocities: Vec<_> = (simulation.state().poses.iter())
            .map(|pose| crate::math::Vec6::new(spin, spin.cross(pose.position - middle)))
            .collect();
        simulation.set_velocities(&velocities);
        let began = simulation.energy().kinetic;
        simulation.advance(0.2).unwrap();
        let dissipated = simulation.energy().dissipated / began;
        assert!(dissipated < 1e-3, "{}: {dissipated:e}", integrator.name());
    }
}
