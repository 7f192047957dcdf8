//! Loads towards a fixed point.

use super::*;
use crate::load::{DistributedPull, PointPull};
use core::f64::consts::PI;

const TOWARDS: Vec3 = Vec3::new(0.5, 0.4, -0.1);

/// A curved rod clamped at its start, its tip and its upper half pulled towards points, and its weight.
fn guyed(kinematics: Kinematics, order: Order, tension: f64) -> Problem {
    let description = description(kinematics, curved());
    let rod = Rod::with_elements(description, 60, &[0.4], order).unwrap();
    let tip = PointPull { at: 0.8, towards: TOWARDS, tension };
    let half =
        DistributedPull { from: 0.4, to: 0.8, towards: Vec3::new(-0.3, 0.2, 0.9), tension_per_length: 0.3 };
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 1.0, -9.81));
    let loads = loads.with_pull(&rod, &tip).unwrap().with_distributed_pull(&rod, &half).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

fn tight() -> Settings {
    Settings { tolerance: 1e-12, ..Settings::default() }
}

#[test]
fn pulls_hold_the_rod_where_dead_forces_of_the_same_direction_do() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            let problem = guyed(kinematics, order, 0.4);
            let pulled = solved(&problem, &tight());
            assert!(pulled.imbalance(&problem) < 1e-12, "{:e}", pulled.imbalance(&problem));
            let mut loads =
                NodalLoads::none(&problem.rod).with_gravity(&problem.rod, Vec3::new(0.0, 1.0, -9.81));
            for pull in problem.loads.pulls() {
                loads.world[pull.node].linear += pull.force(pulled.poses[pull.node].position);
            }
            let dead = Problem { loads, ..problem.clone() };
            let held = solve(&dead, &tight(), Some(&pulled.guess), &mut Workspace::default()).unwrap();
            for (a, b) in pulled.poses.iter().zip(&held.poses) {
                assert!(a.between(b).log().max_abs() < 1e-9, "{kinematics:?} {order:?}");
            }
        }
    }
}

#[test]
fn newtons_method_converges_as_it_does_with_the_exact_stiffness() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        let mut workspace = Workspace::default();
        let problem = guyed(kinematics, Order::Second, 0.4);
        let start = solve(&problem, &tight(), None, &mut workspace).unwrap();
        let next = guyed(kinematics, Order::Second, 0.401);
        let found = nearest(&next, &tight(), Some(&start.guess), &mut workspace).unwrap();
        assert!(found.report.iterations <= 4, "{:?}", found.report.residual_history);
    }
}

#[test]
fn the_energy_grows_with_the_tension_by_the_length_of_the_wire() {
    // dV/dT = ∂V/∂T at an equilibrium: the distance.
    let energy = |tension| {
        let solution = solved(&guyed(Kinematics::Kirchhoff, Order::Second, tension), &tight());
        solution.energy.elastic + solution.energy.load
    };
    let distance =
        (tip(&solved(&guyed(Kinematics::Kirchhoff, Order::Second, 0.4), &tight())).position - TOWARDS).norm();
    let slope = (energy(0.401) - energy(0.399)) / 0.002;
    assert!((slope - distance).abs() < 1e-6 * distance, "{slope} and {distance}");
}

#[test]
fn a_pulled_rod_that_is_moved_and_turned_with_its_points_keeps_its_shape() {
    let problem = guyed(Kinematics::Cosserat, Order::Fourth, 0.4);
    let motion = Pose::from_parts(Vec3::new(2.0, -1.0, 0.5), Quat::from_wxyz([0.3, -0.5, 0.7, 0.4]).unwrap());
    let description = RodDescription {
        base: motion.compose(&problem.rod.description().base),
        ..problem.rod.description().clone()
    };
    let rod = Rod::new(description, problem.rod.mesh().clone(), Order::Fourth).unwrap();
    let mut loads = NodalLoads::none(&rod);
    for (load, world) in loads.world.iter_mut().zip(&problem.loads.world) {
        load.linear = motion.rotation * world.linear;
    }
    for pull in problem.loads.pulls() {
        let (at, towards) = (rod.mesh().nodes()[pull.node], motion.position + motion.rotation * pull.towards);
        loads = loads.with_pull(&rod, &PointPull { at, towards, tension: pull.tension }).unwrap();
    }
    let moved = Problem { loads, ..Problem::cantilever(rod) };
    let (a, b) = (solved(&problem, &tight()), solved(&moved, &tight()));
    assert!((a.energy.elastic - b.energy.elastic).abs() < 1e-12, "{:?} and {:?}", a.energy, b.energy);
    assert_eq!(a.report.morse_index, b.report.morse_index);
    for (a, b) in a.poses.iter().zip(&b.poses) {
        assert!(motion.compose(a).between(b).log().max_abs() < 1e-9);
    }
}

#[test]
fn a_column_pulled_towards_its_own_foot_bears_as_much_as_one_between_pins() {
    // The force through a point c below its head: tan(k L) = k L (1 − c/L), k² = P/EI, so k L = π where that is its foot (Timoshenko & Gere,
    // Theory of Elastic Stability, 1961, ch. 2).
    let base = Pose::IDENTITY;
    let description = RodDescription { base, ..description(Kinematics::Kirchhoff, RestShape::default()) };
    let critical = 0.05 * PI * PI / (0.8 * 0.8);
    for (part, index) in [(0.99, 0), (1.01, 1)] {
        let rod = Rod::with_elements(description.clone(), 80, &[], Order::Fourth).unwrap();
        let pull = PointPull { at: 0.8, towards: Vec3::ZERO, tension: part * critical };
        let loads = NodalLoads::none(&rod).with_pull(&rod, &pull).unwrap();
        let problem = Problem { loads, ..Problem::cantilever(rod) };
        let straight = nearest(&problem, &Settings::default(), None, &mut Workspace::default()).unwrap();
        assert_eq!(straight.report.morse_index, Some(index), "{part}");
        let rests = solved(&problem, &Settings::default());
        assert_eq!(rests.report.morse_index, Some(0), "{part}");
        assert_eq!((tip(&rests).position - Vec3::Z * 0.8).norm() > 0.01, index > 0, "{part}");
    }
}

#[test]
fn shooting_is_refused_and_auto_moves_all_frames_at_once() {
    let problem = guyed(Kinematics::Kirchhoff, Order::Second, 0.4);
    for method in [Method::Shooting, Method::MultipleShooting, Method::Sweep] {
        let settings = Settings { method, ..Settings::default() };
        let reason = solve(&problem, &settings, None, &mut Workspace::default()).unwrap_err().reason;
        let refused = matches!(reason, FailureReason::PulledToAPoint | FailureReason::NotStandard { .. });
        assert!(refused, "{reason}");
    }
    let plan = plan(&problem, &Settings::default(), None);
    assert_eq!(plan.method, Method::Equilibrium);
    assert!(plan.why.contains("towards a point"));
}
