//! Rods that shooting from rest does not find: held at both ends and loaded, beyond their buckling load, pulled tight, or far too heavy for
//! their stiffness. Each against a closed form.

use core::f64::consts::{FRAC_PI_2, PI};
use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Pose, Vec3, Vec6, Wrench};
use strands::rod::{Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, Stiffness};
use strands::statics::{Problem, Settings, Solution, Support, Workspace, solve};

/// A round rod of length one and `EI = 1` along x, `EA = 1e6`.
fn rod(kinematics: Kinematics, elements: usize, mass_per_length: f64) -> Rod {
    let description = RodDescription {
        length: 1.0,
        kinematics,
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness { bending: [1.0; 2], torsion: 0.8, axial: 1e6, shear: [1e6; 2] }),
            mass_per_length,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.001; 2],
        },
        rest: RestShape::default(),
        base: along_x(0.0),
    };
    Rod::with_elements(description, elements, &[0.5, 0.77], Order::Second).expect("a rod")
}

/// A frame on the x axis with its tangent along it.
fn along_x(x: f64) -> Pose {
    Pose { position: Vec3::X * x, ..Pose::exp(Vec6::new(Vec3::Y * FRAC_PI_2, Vec3::ZERO)) }
}

fn stable(problem: &Problem) -> Solution {
    let solution = solve(problem, &Settings::default(), None, &mut Workspace::default())
        .unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(solution.report.morse_index, Some(0), "{:?}", solution.report.method);
    assert!(solution.imbalance(problem) < 1e-11, "{:e}", solution.imbalance(problem));
    solution
}

fn point(rod: &Rod, at: f64, force: Vec3) -> NodalLoads {
    let load = PointLoad { at, wrench: Wrench::new(Vec3::ZERO, force), frame: Frame::World };
    NodalLoads::none(rod).with_point(rod, &load).expect("a node")
}

#[test]
fn a_beam_clamped_at_both_ends_bears_a_force_in_its_middle() {
    for force in [0.01, 3.0, 30.0, 300.0] {
        let rod = rod(Kinematics::Cosserat, 100, 0.0);
        let loads = point(&rod, 0.5, Vec3::Z * force);
        let problem = Problem { loads, end: Support::clamped(along_x(1.0)), ..Problem::cantilever(rod) };
        let solution = stable(&problem);
        let sag = solution.poses[50].position.z;
        let small = force / 192.0;
        if force < 1.0 {
            assert!((sag / small - 1.0).abs() < 1e-3, "{force}: {sag}");
        } else {
            // As it stretches it stiffens.
            assert!(sag > 0.0 && sag < small, "{force}: {sag}");
        }
    }
}

#[test]
fn a_column_stands_up_to_eulers_load_and_buckles_beyond() {
    let euler = PI * PI / 4.0;
    for (part, buckles) in [(0.99, false), (1.01, true), (1.5, true), (4.0, true)] {
        let rod = rod(Kinematics::Kirchhoff, 100, 0.0);
        let loads = point(&rod, 1.0, Vec3::X * (-part * euler));
        let solution = stable(&Problem { loads, ..Problem::cantilever(rod) });
        let tip = solution.poses[100].position;
        let aside = tip.y.hypot(tip.z);
        assert_eq!(aside > 0.1, buckles, "{part}: {aside}");
    }
}

#[test]
fn a_start_may_be_held_less_than_an_end() {
    let held = |fixed: [bool; 6]| {
        let rod = rod(Kinematics::Kirchhoff, 60, 0.0);
        let far = Pose { position: Vec3::new(0.6, 0.0, 0.3), ..along_x(0.0) };
        let start = Support { fixed, ..Support::clamped(along_x(0.0)) };
        let problem = Problem { start, end: Support::clamped(far), ..Problem::cantilever(rod) };
        let solution = stable(&problem);
        for (i, free) in fixed.iter().map(|fixed| !fixed).enumerate().take(3) {
            let moment = solution.poses[0].rotation.transpose() * solution.start_reaction().moment;
            assert!(!free || moment[i].abs() < 1e-8, "{fixed:?}: {moment:?}");
        }
        solution.energy.elastic
    };
    let place = [true; 3];
    let clamped = held([true; 6]);
    for turns in [[false; 3], [true, true, false], [false, false, true]] {
        let fixed = core::array::from_fn(|i| if i < 3 { turns[i] } else { place[i - 3] });
        let energy = held(fixed);
        assert!(energy <= clamped * (1.0 + 1e-9), "{turns:?}: {energy} above {clamped}");
    }
}

#[test]
fn a_taut_thread_turns_to_its_ends_over_the_length_that_its_tension_gives() {
    // Held at right angles to the line between its ends: each turn takes 2 (1 − cos 45°) ℓ of the length, ℓ² = EI/T,
    // up to a part (ℓ/L)² of it.
    for spare in [0.03, 0.01] {
        let rod = rod(Kinematics::Kirchhoff, 1000, 0.0);
        let up = |x: f64| Pose { rotation: strands::math::Mat3::IDENTITY, position: Vec3::X * x };
        let (start, end) = (Support::clamped(up(0.0)), Support::clamped(up(1.0 - spare)));
        let problem = Problem { start, end, ..Problem::cantilever(rod) };
        let tension = stable(&problem).end_reaction().force.norm();
        let bending_length = spare / (4.0 * (1.0 - (PI / 4.0).cos()));
        let expected = 1.0 / (bending_length * bending_length);
        assert!((tension / expected - 1.0).abs() < 0.02, "{spare}: {tension} and {expected}");
    }
}

#[test]
fn a_rod_that_its_loads_keep_moving_is_found_by_multiple_shooting() {
    // A force that follows the end has no potential: moved on from rest the rod flutters.
    let rod = rod(Kinematics::Kirchhoff, 100, 0.0);
    let load = PointLoad {
        at: 1.0,
        wrench: Wrench::new(Vec3::ZERO, Vec3::new(85.7, -76.1, 137.1)),
        frame: Frame::Body,
    };
    let aside = PointLoad {
        at: 0.77,
        wrench: Wrench::new(Vec3::ZERO, along_x(0.0).rotation * Vec3::new(-4.74, 1.49, 3.58)),
        frame: Frame::World,
    };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap().with_point(&rod, &aside).unwrap();
    let problem = Problem { loads, ..Problem::cantilever(rod) };
    let solution = solve(&problem, &Settings::default(), None, &mut Workspace::default())
        .unwrap_or_else(|failure| panic!("{failure}"));
    assert!(solution.imbalance(&problem) < 1e-9, "{:e}", solution.imbalance(&problem));
}

#[test]
fn a_wire_far_heavier_than_stiff_hangs_in_a_catenary() {
    let (span, weight) = (0.6, 36_000.0);
    // 2 a sinh(span/2a) = 1 by bisection.
    let (mut low, mut high) = (0.05, 10.0);
    for _ in 0..100 {
        let a: f64 = 0.5 * (low + high);
        if 2.0 * a * (span / (2.0 * a)).sinh() > 1.0 {
            low = a;
        } else {
            high = a;
        }
    }
    let sag = low * ((span / (2.0 * low)).cosh() - 1.0);
    for elements in [200, 2000, 10_000] {
        let rod = rod(Kinematics::Kirchhoff, elements, weight);
        let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Z * -1.0);
        let (start, end) = (Support::pinned(along_x(0.0)), Support::pinned(along_x(span)));
        let solution = stable(&Problem { loads, start, end, ..Problem::cantilever(rod) });
        let lowest = -solution.poses.iter().fold(0.0, |min: f64, pose| min.min(pose.position.z));
        assert!((lowest / sag - 1.0).abs() < 0.01, "{elements}: {lowest} and {sag}");
        let horizontal = solution.end_reaction().force.x;
        assert!((horizontal / (weight * low) - 1.0).abs() < 0.02, "{horizontal} and {}", weight * low);
    }
}
