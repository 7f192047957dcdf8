//! Rods that move far, against where they are known to be.

use strands::dynamics::{Integrator, Settings};
use strands::math::Vec3;
use strands_cases::{MotionCase, all_motions};

fn case(name: &str) -> MotionCase {
    all_motions().into_iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no case {name}"))
}

fn check(name: &str) {
    let case = case(name);
    let [fine, beyond] = case.on_two_meshes().unwrap_or_else(|error| panic!("{name}: {error}"));
    for (known, (fine, beyond)) in case.moments.iter().zip(fine.iter().zip(&beyond)) {
        assert!((fine.time - known.time).abs() < 1e-9, "{name}: {} s", fine.time);
        let apart = [known.apart(fine), known.apart(beyond)];
        let fits = apart[0] < case.on_mesh && apart[1] < case.tolerance;
        assert!(fits, "{name}, {} s: {:.1e} m, {:.1e} m", known.time, apart[0], apart[1]);
    }
}

#[test]
fn a_rod_is_pulled_at_once() {
    check("pulled-at-once");
}

#[test]
fn a_soft_cantilever_falls() {
    check("soft-drop");
}

#[test]
fn a_steel_rod_springs_back() {
    check("released-steel");
}

#[test]
fn a_rod_that_is_thrown_flies_in_a_plane() {
    check("flying-rod-plane");
}

#[test]
fn a_rod_that_is_thrown_flies_through_space() {
    check("flying-rod-space");
    check("flying-rod-space-even");
}

#[test]
fn a_helix_spins_in_flight() {
    check("spinning-helix");
}

#[test]
fn a_robots_arm_is_spun_up() {
    check("spun-arm");
}

#[test]
fn what_is_thrown_has_the_momentum_of_its_pulse() {
    // 8 N for 2.5 s; 20 N at most for 5 s.
    for (name, impulse) in [("flying-rod-plane", 20.0), ("flying-rod-space", 50.0)] {
        let case = case(name);
        let settings = Settings { integrator: Integrator::Sdirk4, time_step: 0.05, ..Settings::default() };
        let mut simulation = case.begin(10, settings).unwrap();
        for _ in 0..120 {
            case.step(&mut simulation).unwrap();
        }
        let (momentum, _) = simulation.momentum();
        assert!((momentum - Vec3::X * impulse).norm() < 1e-10 * impulse, "{name}: {momentum:?}");
    }
}

#[test]
fn a_helix_in_flight_keeps_momentum_and_energy() {
    let case = case("spinning-helix");
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 5e-3,
        tolerance: 1e-12,
        ..Settings::default()
    };
    let mut simulation = case.begin(50, settings).unwrap();
    let (momentum, angular) = simulation.momentum();
    let began = simulation.energy().total();
    // Those of the curve itself.
    let [exact, turning] = [
        Vec3::new(0.12, 0.048, -0.072),
        Vec3::new(0.012_052_156_688_361, 0.002_089_670_049_520_59, 0.028_575_439_834_708_1),
    ];
    assert!(
        (momentum - exact).norm() < 1e-12 && (angular - turning).norm() < 2e-3 * turning.norm(),
        "{angular:?}"
    );
    assert!((began / 0.368_300_871_277_364 - 1.0).abs() < 2e-3, "{began}");
    for _ in 0..400 {
        case.step(&mut simulation).unwrap();
    }
    let (later, turned) = simulation.momentum();
    let lost = (later - momentum).norm() / momentum.norm();
    let lost_angular = (turned - angular).norm() / angular.norm();
    let drift = (simulation.energy().total() / began - 1.0).abs();
    assert!(lost < 1e-10 && lost_angular < 1e-10 && drift < 1e-6, "{lost:e} {lost_angular:e} {drift:e}");
}
