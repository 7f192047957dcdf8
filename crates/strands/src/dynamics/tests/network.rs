//! Rods and bodies that joints tie together.

use super::{ALL, ALPHA, BOTH, G, rod, suture};
use crate::assembly::{Assembly, Body, Joint, JointKind, Member, Strand, ball};
use crate::dynamics::{Integrator, Past, Settings, Simulation, SimulationError, Start};
use crate::load::{Frame, NodalLoads, PointLoad};
use crate::math::{Mat3, Pose, Quat, Vec3, Vec6, Wrench};
use crate::rod::{
    Kinematics, Material, NodeInertia, Order, Profile, RestShape, Rod, RodDescription, Section, Station,
};
use crate::statics::{Problem, Support};

/// A rod of the suture's stuff between two places, straight, under gravity and free.
fn free_rod(from: Vec3, to: Vec3, elements: usize) -> Strand {
    let along = to - from;
    let third = along * (1.0 / along.norm());
    let first = third.any_orthonormal();
    let rotation = Mat3::from_cols(first, third.cross(first), third);
    let material = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    let description = RodDescription {
        length: along.norm(),
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 0.2e-3 },
            material,
        }]),
        rest: Default::default(),
        base: Pose { rotation, position: from },
    };
    let rod = Rod::with_elements(description, elements, &[], Order::Second).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, G);
    Problem { loads, start: Support::free(Pose { rotation, position: from }), ..Problem::cantilever(rod) }
        .into()
}

fn clamped(mut strand: Strand) -> Strand {
    strand.problem.start = Support::clamped(strand.problem.rod.description().base);
    strand
}

fn node(rod: usize, node: usize) -> Member {
    Member::Node { rod, node }
}

fn tie(assembly: &mut Assembly, kind: JointKind, a: Member, b: Member, axis: Vec3) {
    let joint = Joint::at_rest(assembly, kind, [a, b], None, axis).unwrap();
    assembly.joints.push(joint);
}

#[test]
fn two_halves_joined_rigidly_move_as_the_whole() {
    let middle = Vec3::new(0.0, 0.0, 0.05);
    let end = Vec3::new(0.0, 0.0, 0.1);
    let cases = [Integrator::Sdirk4, Integrator::Bdf2, Integrator::Midpoint];
    for (integrator, mass_matrix) in
        cases.into_iter().flat_map(|integrator| BOTH.map(|mass_matrix| (integrator, mass_matrix)))
    {
        let settings = Settings { integrator, time_step: 1e-3, ..Settings::default() };
        let free_rod = |from, to, elements| Strand { mass_matrix, ..free_rod(from, to, elements) };
        let whole = clamped(free_rod(Vec3::ZERO, end, 20));
        let mut one = Simulation::new(whole, settings, Start::Rest).unwrap();
        let mut halves = Assembly {
            strands: vec![clamped(free_rod(Vec3::ZERO, middle, 10)), free_rod(middle, end, 10)],
            ..Assembly::default()
        };
        tie(&mut halves, JointKind::Rigid, node(0, 10), node(1, 0), Vec3::ZERO);
        let mut two = Simulation::new(halves, settings, Start::Rest).unwrap();
        let mut iterations = [0, 0];
        for _ in 0..50 {
            iterations[0] += one.step().unwrap().iterations;
            iterations[1] += two.step().unwrap().iterations;
        }
        assert!(one.state().poses[20].position.x > 0.01);
        for (i, pose) in one.state().poses.iter().enumerate() {
            let other = two.state().poses[if i <= 10 { i } else { i + 1 }];
            let apart = (pose.position - other.position).norm();
            assert!(apart < 1e-9, "{}, {mass_matrix:?}: node {i} is {apart:e} off", integrator.name());
        }
        let [one, two] = iterations;
        assert!(two <= one + 10, "{two} iterations where the whole takes {one}");
    }
}

/// A handful of rods and a body, tied by joints of all kinds.
fn mobile() -> Assembly {
    let (a, b, c) = (Vec3::new(0.0, 0.0, 0.05), Vec3::new(0.03, 0.0, 0.08), Vec3::new(-0.03, 0.01, 0.08));
    let d = Vec3::new(0.05, 0.0, 0.05);
    let mut assembly = Assembly {
        strands: vec![free_rod(Vec3::ZERO, a, 6), free_rod(a, b, 5), free_rod(a, c, 4), free_rod(b, d, 5)],
        ..Assembly::default()
    };
    let turned = Quat::from_rotation_vector(Vec3::new(0.3, -0.4, 0.2)).to_matrix();
    let place = Pose { rotation: turned, position: d + Vec3::new(0.004, 0.001, -0.003) };
    let inertia = NodeInertia { mass: 4e-5, rotational: Vec3::new(3e-10, 2e-10, 4e-10) };
    assembly.bodies.push(Body::new(inertia, place).with_gravity(G));
    tie(&mut assembly, JointKind::Rigid, node(0, 6), node(1, 0), Vec3::ZERO);
    tie(&mut assembly, JointKind::Ball, node(0, 6), node(2, 0), Vec3::ZERO);
    tie(&mut assembly, JointKind::Hinge, node(1, 5), node(3, 0), Vec3::Y);
    tie(&mut assembly, JointKind::Ball, node(3, 5), Member::Body(0), Vec3::ZERO);
    assembly
}

fn tumbling(assembly: &Assembly) -> Vec<Vec6> {
    let spin = Vec3::new(4.0, -7.0, 5.0);
    let poses = assembly.rest_poses();
    let of = |pose: &Pose| {
        Vec6::new(pose.rotation.transpose_mul(spin), Vec3::new(0.1, 0.2, -0.3) + spin.cross(pose.position))
    };
    poses.iter().map(of).collect()
}

#[test]
fn what_joints_tie_keeps_its_momentum_in_free_flight() {
    let mut weightless = mobile();
    for strand in &mut weightless.strands {
        strand.problem.loads = NodalLoads::none(&strand.problem.rod);
    }
    weightless.bodies[0].load = Wrench::ZERO;
    // With a body, the midpoint rule refuses it.
    let all = ALL.into_iter().filter(|integrator| *integrator != Integrator::Midpoint);
    for (integrator, mass_matrix) in all.flat_map(|integrator| BOTH.map(|matrix| (integrator, matrix))) {
        weightless.strands.iter_mut().for_each(|strand| strand.mass_matrix = mass_matrix);
        let settings = Settings { integrator, time_step: 5e-4, ..Settings::default() };
        let mut simulation = Simulation::new(weightless.clone(), settings, Start::Rest).unwrap();
        simulation.set_velocities(&tumbling(&weightless));
        let (momentum, angular) = simulation.momentum();
        for step in 0..400 {
            let taken = simulation.step();
            assert!(taken.is_ok(), "{} step {step}: {taken:?}", integrator.name());
        }
        let (later, turned) = simulation.momentum();
        let lost = (later - momentum).norm() / momentum.norm();
        let lost_angular = (turned - angular).norm() / angular.norm();
        let kept = if integrator == Integrator::ImplicitEuler { 0.01 } else { 2e-5 };
        assert!(lost < 1e-10 && lost_angular < kept, "{}: {lost:e} {lost_angular:e}", integrator.name());
    }
}

#[test]
fn newton_is_quadratic_through_joints_of_all_kinds() {
    for mass_matrix in BOTH {
        let mut held = mobile();
        held.strands[0] = clamped(held.strands[0].clone());
        held.strands.iter_mut().for_each(|strand| strand.mass_matrix = mass_matrix);
        let settings = Settings { integrator: Integrator::Sdirk4, time_step: 2e-3, ..Settings::default() };
        let mut simulation = Simulation::new(held, settings, Start::Rest).unwrap();
        for _ in 0..50 {
            simulation.step().unwrap();
            let history = &simulation.work.history;
            for three in history.windows(3) {
                let [a, b, c] = [three[0], three[1], three[2]];
                // Where the residual has begun to fall, its fall doubles.
                if b < 1e-2 * a && b > 1e-7 {
                    assert!(c < b.sqrt() * b * 10.0, "{mass_matrix:?}: {history:?}");
                }
            }
        }
    }
}

#[test]
fn the_midpoint_rule_keeps_the_energy_of_rods_that_joints_tie() {
    let mut rods = mobile();
    rods.joints.truncate(2);
    rods.bodies.clear();
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 5e-4,
        tolerance: 1e-12,
        ..Settings::default()
    };
    for mass_matrix in BOTH {
        rods.strands.iter_mut().for_each(|strand| strand.mass_matrix = mass_matrix);
        let mut simulation = Simulation::new(rods.clone(), settings, Start::Rest).unwrap();
        simulation.set_velocities(&tumbling(&rods));
        let began = simulation.energy().total();
        for _ in 0..500 {
            simulation.step().unwrap();
        }
        let energy = simulation.energy();
        let drift = (energy.total() - began).abs() / energy.kinetic;
        assert!(drift < 1e-8, "{mass_matrix:?}: {drift:e} of {energy:?}");
    }
}

#[test]
fn a_step_that_is_not_solved_at_once_is_cut_into_pieces() {
    let mut held = mobile();
    held.strands[0] = clamped(held.strands[0].clone());
    let settings = Settings { integrator: Integrator::Bdf2, time_step: 3e-2, ..Settings::default() };
    let mut simulation = Simulation::new(held, settings, Start::Rest).unwrap();
    let mut step = || {
        let pieces = simulation.step().unwrap().pieces;
        // Nothing is to look back on a step that was cut.
        let looks_back = matches!(simulation.state().past, Past::Before { .. });
        assert_eq!(looks_back, pieces == 1);
        pieces
    };
    let pieces: Vec<usize> = (0..50).map(|_| step()).collect();
    assert!(pieces.iter().any(|pieces| *pieces > 1), "{pieces:?}");
    assert!((simulation.state().time - 1.5).abs() < 1e-12);
}

#[test]
fn a_ball_on_a_hinge_swings_as_a_pendulum() {
    // A short stiff rod, hinged, with a ball at its end.
    let steel = Material::from_poisson(200e9, 0.3, 8000.0).unwrap();
    let rod = rod(0.1, 1e-3, steel, Kinematics::Cosserat, 8);
    let mass_of_rod = rod.mass();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Z * 9.81);
    let base = rod.description().base;
    let start = Support::clamped(base).turning_about(Vec3::Y);
    let problem = Problem { loads, start, ..Problem::cantilever(rod) };
    let weight = ball(8000.0, 0.01);
    let mut assembly = Assembly::from(problem);
    let place = Pose { position: Vec3::new(0.0, 0.0, 0.11), ..Pose::IDENTITY };
    assembly.bodies.push(Body::new(weight, place).with_gravity(Vec3::Z * 9.81));
    tie(&mut assembly, JointKind::Rigid, node(0, 8), Member::Body(0), Vec3::ZERO);
    let inertia = weight.rotational.x + weight.mass * 0.11 * 0.11 + mass_of_rod * 0.01 / 3.0;
    let moment = 9.81 * (weight.mass * 0.11 + mass_of_rod * 0.05);
    let expected = 2.0 * core::f64::consts::PI * (inertia / moment).sqrt();
    let settings =
        Settings { integrator: Integrator::Bdf2, time_step: expected / 400.0, ..Settings::default() };
    let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
    let nudge = Vec3::Y * 0.05;
    let velocities: Vec<Vec6> =
        (simulation.state().poses.iter()).map(|pose| Vec6::new(nudge, nudge.cross(pose.position))).collect();
    simulation.set_velocities(&velocities);
    let (mut crossings, mut last) = (Vec::new(), 0.0);
    while crossings.len() < 5 {
        let time = simulation.step().unwrap().time;
        let x = simulation.state().poses[9].position.x;
        if x * last < 0.0 {
            crossings.push(time - settings.time_step * x / (x - last));
        }
        last = x;
    }
    let measured = (crossings[4] - crossings[0]) / 2.0;
    assert!((measured / expected - 1.0).abs() < 1e-3, "{measured} s, {expected} expected");
}

/// Four million times what would bend it hangs from a thread that cannot stretch.
#[test]
fn a_ball_on_a_thread_swings_as_a_pendulum() {
    let nylon = Material::from_poisson(1e9, 0.4, 1140.0).unwrap();
    for integrator in [Integrator::Bdf2, Integrator::Sdirk4, Integrator::TrBdf2] {
        let rod = rod(1.0, 1e-4, nylon, Kinematics::Kirchhoff, 20);
        let gravity = Vec3::new(0.5_f64.sin(), 0.0, 0.5_f64.cos()) * 9.81;
        let loads = NodalLoads::none(&rod).with_gravity(&rod, gravity);
        let start = Support {
            fixed: [false, false, false, true, true, true],
            ..Support::clamped(rod.description().base)
        };
        let mut assembly = Assembly::from(Problem { loads, start, ..Problem::cantilever(rod) });
        let (weight, place) = (ball(8000.0, 0.01), Pose { position: Vec3::Z, ..Pose::IDENTITY });
        assembly.bodies.push(Body::new(weight, place).with_gravity(gravity));
        tie(&mut assembly, JointKind::Ball, node(0, 20), Member::Body(0), Vec3::ZERO);
        let settings = Settings { integrator, ..Settings::default() };
        let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
        let began = simulation.energy().total();
        // A quarter of the period of a pendulum of such an amplitude (Ω = π/2 √(g/l)/K(sin 0.25)).
        let quarter = 0.509_467;
        simulation.advance(quarter).unwrap();
        let at = simulation.state().poses[21].position;
        let aside = at.cross(gravity * (1.0 / 9.81)).norm();
        let energy = simulation.energy();
        let gained = (energy.total() - began) / energy.kinetic;
        assert!(aside < 3e-3, "{}: {aside} at {at:?}", integrator.name());
        assert!(gained.abs() < 1e-4, "{}: {gained} of {energy:?}", integrator.name());
    }
}

/// A thread of a thousandth of the mass of what hangs from it: its waves are as fast as the steps, and nothing damps them.
#[test]
fn a_thread_of_hardly_any_mass_gains_no_energy() {
    let light = Material::from_poisson(1e9, 0.4, 1.0).unwrap();
    let swing = |settings: Settings| {
        let rod = rod(1.0, 1e-4, light, Kinematics::Kirchhoff, 20);
        let gravity = Vec3::Z * 9.81;
        let loads = NodalLoads::none(&rod).with_gravity(&rod, gravity);
        let start = Support::pinned(rod.description().base);
        let mut assembly = Assembly::from(Problem { loads, start, ..Problem::cantilever(rod) });
        let (weight, place) = (ball(8000.0, 1e-3), Pose { position: Vec3::Z, ..Pose::IDENTITY });
        assembly.bodies.push(Body::new(weight, place).with_gravity(gravity));
        tie(&mut assembly, JointKind::Ball, node(0, 20), Member::Body(0), Vec3::ZERO);
        let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
        let sideways = Vec6::new(Vec3::ZERO, Vec3::X * 0.3);
        let mut velocities = [Vec6::ZERO; 22];
        velocities[20..].fill(sideways);
        simulation.set_velocities(&velocities);
        let began = simulation.energy();
        simulation.advance(3.5).unwrap();
        let gained = (simulation.energy().total() - began.total()) / began.kinetic;
        assert!((-2e-3..0.0).contains(&gained), "{}: {gained:e}", settings.integrator.name());
    };
    for integrator in
        [Integrator::Bdf2, Integrator::TrBdf2, Integrator::GeneralizedAlpha { spectral_radius: 0.5 }]
    {
        swing(Settings { integrator, ..Settings::default() });
    }
    let chosen = Settings { integrator: Integrator::TrBdf2, ..Settings::default() };
    swing(Settings { local_error: Some(1e-4), time_step: 0.02, ..chosen });
}

/// A net of rods along x and y, tied where they cross, held at its corners.
fn net(across: usize, elements: usize) -> Assembly {
    let pitch = 0.02;
    let mut assembly = Assembly::default();
    let far = pitch * (across - 1) as f64;
    let each = elements / (across - 1);
    for i in 0..across {
        let at = pitch * i as f64;
        assembly.strands.push(free_rod(Vec3::new(0.0, at, 0.0), Vec3::new(far, at, 0.0), elements));
    }
    for i in 0..across {
        let at = pitch * i as f64;
        assembly.strands.push(free_rod(Vec3::new(at, 0.0, 0.0), Vec3::new(at, far, 0.0), elements));
    }
    for strand in &mut assembly.strands {
        let rod = &strand.problem.rod;
        strand.problem.loads = NodalLoads::none(rod).with_gravity(rod, Vec3::new(0.0, 0.0, -9.81));
    }
    for i in 0..across {
        for j in 0..across {
            tie(&mut assembly, JointKind::Ball, node(i, j * each), node(across + j, i * each), Vec3::ZERO);
        }
    }
    for (rod, end) in [(0, 0), (0, elements), (across - 1, 0), (across - 1, elements)] {
        let rest = assembly.strands[rod].problem.rod.rest_poses()[end];
        *assembly.strands[rod].problem.support_mut(end).unwrap() = Support::pinned(rest);
    }
    assembly
}

#[test]
fn a_net_hangs_in_equilibrium_and_stays_there() {
    let net = net(5, 8);
    let settings = Settings { integrator: Integrator::Bdf2, ..Settings::default() };
    let weight: f64 = net.strands.iter().map(|strand| strand.problem.rod.mass() * 9.81).sum();
    let mut simulation = Simulation::new(net, settings, Start::Equilibrium).unwrap();
    let began = simulation.state().poses.clone();
    let lowest = began.iter().map(|pose| pose.position.z).fold(0.0, f64::min);
    assert!(lowest < -0.001, "it sags: {lowest}");
    for _ in 0..50 {
        simulation.step().unwrap();
    }
    for (now, then) in simulation.state().poses.iter().zip(&began) {
        assert!((now.position - then.position).norm() < 1e-8, "{now:?} {then:?}");
    }
    let corners = [(0, 0), (0, 8), (4, 0), (4, 8)];
    let held = corners.iter().map(|(rod, end)| simulation.reaction(node(*rod, *end)).linear);
    let held = held.fold(Vec3::ZERO, |sum, force| sum + force);
    assert!((held - Vec3::Z * weight).norm() < 1e-9 * weight, "{held:?}, {weight} expected");
}

/// By what each frame is out of balance without its joints, about the world's origin.
fn out_of_balance(simulation: &Simulation) -> Vec<Wrench> {
    let (assembly, state) = (simulation.assembly(), simulation.state());
    let mut acts = Vec::new();
    for (rod, strand) in assembly.strands.iter().enumerate() {
        let poses = &state.poses[assembly.nodes(rod)];
        let carried: Vec<Wrench> = (state.wrenches[assembly.elements(rod)].iter())
            .zip(&poses[1..])
            .map(|(wrench, far)| far.carry_wrench(*wrench))
            .collect();
        for (i, pose) in poses.iter().enumerate() {
            let load = strand.problem.loads.world[i];
            let mut sum = Wrench::new(load.angular + pose.position.cross(load.linear), load.linear);
            carried.get(i).into_iter().for_each(|after| sum += *after);
            i.checked_sub(1).into_iter().for_each(|before| sum -= carried[before]);
            acts.push(sum);
        }
    }
    for (body, pose) in assembly.bodies.iter().zip(&state.poses[assembly.first_body()..]) {
        acts.push(Wrench::new(pose.position.cross(body.load.linear), body.load.linear));
    }
    acts
}

#[test]
fn forces_and_moments_balance_at_every_junction() {
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let net = Simulation::new(net(5, 8), settings, Start::Equilibrium).unwrap();
    let weight = 9.81 * net.assembly().strands.iter().map(|strand| strand.problem.rod.mass()).sum::<f64>();
    let acts = out_of_balance(&net);
    for joint in &net.assembly().joints {
        let [a, b] = joint.between.map(|at| net.assembly().frame(at.member).unwrap());
        let place = net.state().poses[a].position;
        let held = [a, b].iter().any(|frame| {
            let support = net.assembly().support(net.assembly().member(*frame));
            support.is_some_and(Support::holds_anything)
        });
        let both = acts[a] + acts[b];
        if !held {
            assert!(both.linear.norm() < 1e-10 * weight, "{:e}", both.linear.norm() / weight);
        }
        // A ball bears no moment.
        for acts in [acts[a], acts[b]] {
            let moment = acts.angular - place.cross(acts.linear);
            assert!(moment.norm() < 1e-10 * weight * 0.08, "{:e}", moment.norm());
        }
    }
    let mut branched = mobile();
    branched.strands[0] = clamped(branched.strands[0].clone());
    // A hinge lets its branch down; there is but one place where it rests.
    let branched = Simulation::new(branched, settings, Start::Equilibrium).unwrap();
    let acts = out_of_balance(&branched);
    let node = |rod: usize, node: usize| branched.assembly().nodes(rod).start + node;
    let junctions = [
        vec![node(0, 6), node(1, 0), node(2, 0)],
        vec![node(1, 5), node(3, 0)],
        vec![node(3, 5), branched.assembly().first_body()],
    ];
    for junction in &junctions {
        let sum = junction.iter().fold(Wrench::ZERO, |sum, frame| sum + acts[*frame]);
        assert!(sum.linear.norm() < 1e-10 * weight, "{:e}", sum.linear.norm() / weight);
        assert!(sum.angular.norm() < 1e-10 * weight * 0.08, "{:e}", sum.angular.norm());
    }
}

#[test]
fn a_net_of_twenty_by_twenty_falls() {
    let net = net(20, 38);
    let settings = Settings { time_step: 2e-3, ..Settings::default() };
    let mut simulation = Simulation::new(net, settings, Start::Rest).unwrap();
    let began = simulation.energy().total();
    let mut most: f64 = 0.0;
    for _ in 0..25 {
        assert_eq!(simulation.step().unwrap().pieces, 1);
        most = most.max(simulation.energy().kinetic);
    }
    let lost = (began - simulation.energy().total()) / most;
    assert!((-1e-3..0.05).contains(&lost), "{lost}");
}

#[test]
fn joints_that_cannot_be_are_refused() {
    let refused = |assembly: Assembly| match Simulation::new(assembly, Settings::default(), Start::Rest) {
        Err(SimulationError::Assembly(error)) => error.to_string(),
        other => panic!("{:?}", other.map(|_| ())),
    };
    let mut twice = mobile();
    for rod in [1, 2] {
        let start = twice.strands[rod].problem.rod.rest_poses()[0];
        twice.strands[rod].problem.start = Support::pinned(start);
    }
    assert!(refused(twice).contains("ties together two places that are both held"));
    let mut ring = mobile();
    tie(&mut ring, JointKind::Ball, node(1, 0), node(2, 0), Vec3::ZERO);
    assert!(refused(ring).contains("joint 4 closes a ring of joints alone"));
    let apart = Joint::at_rest(&mobile(), JointKind::Rigid, [node(0, 0), node(1, 0)], None, Vec3::ZERO);
    assert!(apart.unwrap_err().to_string().contains("joint 4 ties together is 5.00e-2 m"));
}

#[test]
fn a_free_ring_keeps_its_shape() {
    // A rod that closes on itself by a joint of its ends.
    let around = suture(20);
    let radius = 0.1 / (2.0 * core::f64::consts::PI);
    let description = RodDescription {
        rest: RestShape::Constant(Vec3::new(0.0, 1.0 / radius, 0.0)),
        ..around.description().clone()
    };
    let ring = Rod::with_elements(description, 20, &[], Order::Second).unwrap();
    let base = ring.description().base;
    let problem = Problem { start: Support::free(base), ..Problem::cantilever(ring) };
    let mut assembly = Assembly::from(problem);
    tie(&mut assembly, JointKind::Rigid, node(0, 0), node(0, 20), Vec3::ZERO);
    let settings = Settings::default();
    let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let state = simulation.state();
    assert!((state.poses[0].position - state.poses[20].position).norm() < 1e-12);
    assert!((state.poses[10].position - state.poses[0].position).norm() - 2.0 * radius < 1e-6);
}

#[test]
fn a_ring_that_is_pulled_gains_no_energy() {
    let nylon = Material::from_poisson(2e9, 0.39, 1140.0).unwrap();
    let straight = rod(core::f64::consts::PI * 0.1, 0.5e-3, nylon, Kinematics::Cosserat, 32);
    let description = RodDescription {
        rest: RestShape::Constant(Vec3::new(0.0, 20.0, 0.0)),
        ..straight.description().clone()
    };
    let ring = Rod::with_elements(description, 32, &[0.1], Order::Second).unwrap();
    let pull = PointLoad { at: 0.1, wrench: Wrench::new(Vec3::ZERO, Vec3::Y * 0.02), frame: Frame::World };
    let loads = NodalLoads::none(&ring).with_gravity(&ring, G).with_point(&ring, &pull).unwrap();
    let start = Support::free(ring.description().base);
    let mut assembly = Assembly::from(Problem { loads, start, ..Problem::cantilever(ring) });
    tie(&mut assembly, JointKind::Rigid, node(0, 0), node(0, 32), Vec3::ZERO);
    for integrator in [Integrator::Bdf2, ALPHA, Integrator::Sdirk4] {
        let settings = Settings { integrator, ..Settings::default() };
        let mut simulation = Simulation::new(assembly.clone(), settings, Start::Rest).unwrap();
        let began = simulation.energy().total();
        for _ in 0..300 {
            simulation.step().unwrap();
        }
        let energy = simulation.energy();
        let gained = (energy.total() - began) / energy.kinetic;
        assert!(gained < 1e-4, "{}: {gained:e}", integrator.name());
    }
}
