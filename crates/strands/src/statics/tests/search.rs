//! All equilibria of problems of which all are known.

use super::*;
use core::f64::consts::PI;

/// A clamped rod, pressed down at its end by so many times its first critical load about `d2`.
fn pressed(rod: Rod, times: f64) -> Problem {
    let down = rod.description().base.rotation.cols[2] * (-times * 0.25 * PI * PI * 0.05 / 0.64);
    let load = PointLoad { at: 0.8, wrench: Wrench::new(Vec3::ZERO, down), frame: Frame::World };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

#[test]
fn a_column_beyond_two_critical_loads_has_five_equilibria() {
    // Under 6.4 times the first critical load, about d1, which is 4 times that about d2 and less than the next (9 times): straight, and buckled
    // either way about either axis.
    let rod = rod(Kinematics::Kirchhoff, RestShape::default(), 60, Order::Second);
    let base = rod.description().base;
    let problem = pressed(rod, 6.4);
    let settings = SearchSettings { starts: 200, paths: 20, ..SearchSettings::default() };
    let found = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
    let indices: Vec<_> = found.iter().map(|solution| solution.report.morse_index).collect();
    assert_eq!(indices, [0, 0, 1, 1, 2].map(Some));
    for pair in [[0, 1], [2, 3]] {
        let energy = pair.map(|i| found[i].energy.elastic + found[i].energy.load);
        assert!((energy[0] - energy[1]).abs() < 1e-9 * energy[0].abs(), "{energy:?}");
        // Mirror images.
        let middle = pair.map(|i| base.rotation.transpose_mul(found[i].poses[30].position - base.position));
        let across = (middle[0] + middle[1]) - Vec3::Z * (middle[0].z + middle[1].z);
        assert!(across.norm() < 1e-6, "{middle:?}");
    }
    for solution in &found {
        assert!(solution.imbalance(&problem) < 1e-9);
    }
    // The same seed gives the same.
    let again = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
    assert!(found.iter().zip(&again).all(|(a, b)| a.poses == b.poses));
}

#[test]
fn a_round_column_that_buckles_whichever_way_is_listed_a_few_times() {
    let mut description = description(Kinematics::Kirchhoff, RestShape::default());
    if let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile {
        stiffness.bending = [0.05; 2];
    }
    let problem = pressed(Rod::with_elements(description, 40, &[], Order::Second).unwrap(), 4.0);
    let settings = SearchSettings { starts: 500, paths: 5, ..SearchSettings::default() };
    let found = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
    let indices: Vec<_> = found.iter().filter_map(|solution| solution.report.morse_index).collect();
    // Straight, it falls two ways.
    assert_eq!(indices, [[0; MOST_ALIKE].as_slice(), &[2]].concat());
}

#[test]
fn twisting_a_straight_rod_once_round_leads_to_other_twist_classes() {
    // Held at both ends, 0.9 of its length apart, it buckles, and into loops, which differ by whole turns of twist.
    let rod = rod(Kinematics::Cosserat, RestShape::default(), 50, Order::Second);
    let base = rod.description().base;
    let end = base.compose(&Pose { rotation: crate::math::Mat3::IDENTITY, position: Vec3::Z * 0.72 });
    let problem = Problem { end: Support::clamped(end), ..Problem::cantilever(rod) };
    let settings = SearchSettings { starts: 200, paths: 20, ..SearchSettings::default() };
    let found = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
    let stable: Vec<f64> = found
        .iter()
        .filter(|solution| solution.report.morse_index == Some(0))
        .map(|solution| solution.stress[25].angular.z / 0.04 * 0.8 / (2.0 * PI))
        .collect();
    // Twist of about none (the two buckled shapes), and of one turn either way (loops).
    assert!(stable.iter().filter(|twist| twist.abs() < 1e-6).count() >= 2, "{stable:?}");
    assert!(
        stable.iter().any(|twist| *twist > 0.2) && stable.iter().any(|twist| *twist < -0.2),
        "{stable:?}"
    );
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let problem = loaded(Kinematics::Kirchhoff, 20, Order::First, Frame::World);
    let refused = equilibria(&problem, &SearchSettings::default(), &mut Workspace::default());
    assert_eq!(refused.unwrap_err(), FailureReason::NoEnergy);
}
