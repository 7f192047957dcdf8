//! Rods side by side against each of them alone.

use super::super::batch::{Batch, BatchError};
use super::super::*;
use crate::load::{Frame, NodalLoads, PointLoad, PointPull};
use crate::math::{Mat3, Pose, SimdLevel, Vec3, Vec6, Wrench};
use crate::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};

/// Rods that differ in all that they may.
fn rod(number: usize, elements: usize) -> Rod {
    let x = number as f64;
    let material = Material::new(1e9 * (1.0 + x), 0.4e9 * (1.0 + x), 1000.0).unwrap();
    let description = RodDescription {
        length: 0.3 + 0.02 * x,
        kinematics: if number.is_multiple_of(3) { Kinematics::Kirchhoff } else { Kinematics::Cosserat },
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 1e-3 + 1e-4 * x },
            material,
        }]),
        rest: RestShape::default(),
        base: Pose {
            rotation: Pose::exp(Vec6::new(Vec3::new(0.1 * x, 0.0, 0.3), Vec3::ZERO)).rotation,
            position: Vec3::new(x, 0.0, 0.1),
        },
    };
    Rod::with_elements(description, elements, &[], Order::Second).unwrap()
}

/// A rod under its weight, its end held by a turn and a shift from where it rests.
fn held(number: usize, elements: usize, end: Pose) -> Problem {
    let mut problem = Problem::cantilever(rod(number, elements));
    problem.loads = NodalLoads::none(&problem.rod).with_gravity(&problem.rod, Vec3::new(0.0, 0.0, -9.81));
    let length = problem.rod.length();
    let end = Pose { position: end.position * length, ..end };
    problem.end = Support::clamped(problem.rod.description().base.compose(&end));
    problem
}

fn place(step: f64) -> Pose {
    let turn = Vec3::new(0.3 * step, 0.5 - 0.2 * step, 0.1 * step);
    let rotation = Pose::exp(Vec6::new(turn, Vec3::ZERO)).rotation;
    Pose { rotation, position: Vec3::new(0.2 + 0.1 * step, 0.05 * step, 0.85 - 0.05 * step) }
}

fn settings() -> Settings {
    Settings { method: Method::Equilibrium, tolerance: 1e-10, ..Settings::default() }
}

/// The largest distance between two solutions: turns in rad, shifts over the length.
fn apart(a: &Solution, b: &Solution, length: f64) -> f64 {
    let of = |(a, b): (&Pose, &Pose)| {
        (a.rotation - b.rotation).max_abs() + (a.position - b.position).max_abs() / length
    };
    a.poses.iter().zip(&b.poses).map(of).fold(0.0, f64::max)
}

#[test]
fn rods_side_by_side_find_what_each_finds_alone() {
    for level in [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512] {
        let problems: Vec<_> = (0..11).map(|number| held(number, 24, place(0.0))).collect();
        let mut batch = Batch::at_level(problems.clone(), &settings(), level).unwrap();
        let mut workspace = Workspace::default();
        let mut alone: Vec<_> =
            problems.iter().map(|p| solve(p, &settings(), None, &mut workspace).unwrap()).collect();
        for step in 1..6 {
            for rod in 0..problems.len() {
                let moved = held(rod, 24, place(0.05 * step as f64 + 0.01 * rod as f64));
                *batch.end_mut(rod) = moved.end.pose;
            }
            assert!(batch.follow(&settings()));
            for rod in 0..problems.len() {
                let problem = batch.problem(rod).clone();
                let guess = alone[rod].guess;
                alone[rod] = solve(&problem, &settings(), Some(&guess), &mut workspace).unwrap();
                let beside = batch.solution(rod);
                let apart = apart(&alone[rod], &beside, problem.rod.length());
                assert!(apart < 1e-10, "{level:?}, step {step}, rod {rod}: {apart:e}");
                assert!(beside.imbalance(&problem) < 1e-10, "{:e}", beside.imbalance(&problem));
                assert_eq!(beside.report.morse_index, Some(0));
                assert!(beside.report.iterations > 0 && beside.report.residual <= 1e-10);
                let (a, b) = (alone[rod].end_reaction(), beside.end_reaction());
                let force = problem.rod.scale().force;
                assert!((a.force - b.force).max_abs() < 1e-7 * force, "{:?} {:?}", a.force, b.force);
            }
        }
    }
}

#[test]
fn a_small_motion_takes_few_factorisations() {
    let problems: Vec<_> = (0..8).map(|number| held(number, 40, place(0.0))).collect();
    let mut batch = Batch::new(problems, &settings()).unwrap();
    for step in 1..4 {
        for rod in 0..8 {
            *batch.end_mut(rod) = held(rod, 40, place(0.01 * step as f64)).end.pose;
        }
        assert!(batch.follow(&settings()));
        assert!(batch.report(0).factorisations <= 5, "{}", batch.report(0).factorisations);
    }
}

#[test]
fn supports_between_follower_loads_and_partly_held_ends_run_side_by_side() {
    let build = |number: usize, step: f64| {
        let mut problem = held(number, 20, place(0.1));
        let base = problem.rod.description().base;
        let length = problem.rod.length();
        problem.end =
            Support::pinned(base.compose(&Pose {
                rotation: Mat3::IDENTITY,
                position: Vec3::new(0.1 + step, 0.0, 0.9) * length,
            }));
        let load = PointLoad {
            at: 0.5 * length,
            wrench: Wrench::new(Vec3::ZERO, Vec3::new(0.0, 0.02, 0.0) * problem.rod.scale().force),
            frame: Frame::Body,
        };
        problem.loads = problem.loads.clone().with_point(&problem.rod, &load).unwrap();
        let clip =
            base.compose(&Pose { rotation: Mat3::IDENTITY, position: Vec3::new(0.05, 0.02, 0.24) * length });
        problem.between.push((5, Support::pinned(clip).sliding_along(Vec3::Z)));
        problem
    };
    let problems: Vec<_> = (0..5).map(|number| build(number, 0.0)).collect();
    let mut batch = Batch::new(problems, &settings()).unwrap();
    let mut workspace = Workspace::default();
    for step in 1..4 {
        for rod in 0..batch.len() {
            *batch.end_mut(rod) = build(rod, 0.02 * step as f64).end.pose;
            batch.support_mut(rod, 5).unwrap().pose.position += Vec3::new(1e-3, 0.0, 0.0);
        }
        assert!(batch.follow(&settings()));
        for rod in 0..batch.len() {
            let beside = batch.solution(rod);
            let problem = batch.problem(rod).clone();
            recall(&problem, &beside, &mut workspace);
            let alone = solve(&problem, &settings(), Some(&beside.guess), &mut workspace).unwrap();
            let apart = apart(&alone, &beside, problem.rod.length());
            assert!(apart < 1e-9, "step {step}, rod {rod}: {apart:e}");
            // No potential, no index.
            assert_eq!(beside.report.morse_index, None);
        }
    }
}

#[test]
fn a_rod_that_snaps_is_followed_alone_and_the_others_go_on() {
    // Rod 1 is pushed past where an arch snaps through.
    let arch = |across: f64| {
        let mut problem = held(1, 20, place(0.0));
        let base = problem.rod.description().base;
        problem.loads = NodalLoads::none(&problem.rod);
        let end =
            Pose { rotation: Mat3::IDENTITY, position: Vec3::new(0.0, 0.0, 0.8) * problem.rod.length() };
        problem.end = Support::clamped(base.compose(&end));
        let push = PointLoad {
            at: 0.5 * problem.rod.length(),
            wrench: Wrench::new(Vec3::ZERO, base.rotation * Vec3::X * (across * problem.rod.scale().force)),
            frame: Frame::World,
        };
        problem.loads = problem.loads.clone().with_point(&problem.rod, &push).unwrap();
        problem
    };
    let middle = |batch: &Batch| {
        let mut poses = Vec::new();
        batch.read_poses(1, &mut poses);
        let base = batch.problem(1).rod.description().base;
        base.rotation.transpose_mul(poses[10].position - base.position).x
    };
    let problems = vec![held(0, 20, place(0.0)), arch(30.0), held(2, 20, place(0.0))];
    let mut batch = Batch::new(problems, &settings()).unwrap();
    assert!(middle(&batch) > 0.0);
    for push in [0.0, -50.0, -100.0, -200.0, -400.0] {
        batch.set_loads(1, arch(push).loads);
        assert!(batch.follow(&settings()), "{push}");
    }
    assert!(middle(&batch) < 0.0);
    assert!((0..3).all(|rod| batch.solution(rod).imbalance(&batch.problem(rod).clone()) < 1e-9));
    assert_eq!(batch.report(1).morse_index, Some(0));
}

#[test]
fn a_rod_that_is_lost_for_a_frame_goes_on_from_where_it_was() {
    let keep = Settings { restart_from_rest: false, ..settings() };
    let mut batch = Batch::new((0..3).map(|number| held(number, 20, place(0.0))).collect(), &keep).unwrap();
    let (mut before, mut after) = (Vec::new(), Vec::new());
    batch.read_poses(1, &mut before);
    let there = *batch.end_mut(1);
    batch.end_mut(1).position.x = f64::NAN;
    *batch.end_mut(2) = held(2, 20, place(0.02)).end.pose;
    assert!(!batch.follow(&keep));
    assert_eq!((0..3).map(|rod| batch.is_solved(rod)).collect::<Vec<_>>(), [true, false, true]);
    batch.read_poses(1, &mut after);
    assert!(before.iter().zip(&after).all(|(a, b)| (a.position - b.position).norm() < 1e-14));
    *batch.end_mut(1) = there;
    assert!(batch.follow(&keep));
    assert!(batch.solution(1).imbalance(&batch.problem(1).clone()) < 1e-10);
}

#[test]
fn loads_of_another_rod_are_not_solved_and_nothing_panics() {
    let of = |elements: usize| held(1, elements, place(0.0)).loads;
    for elements in [4, 300] {
        let refused =
            Batch::new(vec![Problem { loads: of(elements), ..held(1, 20, place(0.0)) }], &settings());
        assert!(matches!(refused, Err(BatchError::Unsolved { rod: 0, .. })));
        let mut batch =
            Batch::new(vec![held(0, 20, place(0.0)), held(1, 20, place(0.0))], &settings()).unwrap();
        batch.set_loads(1, of(elements));
        assert!(!batch.follow(&settings()));
        assert!(batch.is_solved(0) && !batch.is_solved(1));
        assert!(batch.solution(1).is_finite());
        batch.set_loads(1, of(20));
        assert!(batch.follow(&settings()));
    }
}

#[test]
fn a_rod_that_is_carried_far_away_keeps_its_digits() {
    let mut batch =
        Batch::new((0..2).map(|number| held(number, 20, place(0.0))).collect(), &settings()).unwrap();
    let far = Vec3::new(2e3, -1e3, 5e2);
    batch.support_mut(1, 0).unwrap().pose.position += far;
    batch.end_mut(1).position += far;
    assert!(batch.follow(&settings()));
    assert_eq!(batch.report(1).morse_index, Some(0));
    let moved = batch.solution(1);
    let mut here = Workspace::default();
    let alone = solve(&batch.problem(1).clone(), &settings(), None, &mut here).unwrap();
    assert!(apart(&alone, &moved, 0.3) < 1e-8, "{:e}", apart(&alone, &moved, 0.3));
}

#[test]
fn what_cannot_run_side_by_side_is_refused_with_its_number() {
    let good = || held(0, 10, place(0.0));
    let refused = |problem: Problem| Batch::new(vec![good(), problem], &settings()).unwrap_err().to_string();
    assert!(matches!(Batch::new(Vec::new(), &settings()), Err(BatchError::Empty)));
    let longer = refused(held(1, 11, place(0.0)));
    assert!(longer.contains("rod 1 has 11 elements"), "{longer}");
    let mut pulled = good();
    let pull = PointPull { at: pulled.rod.length(), towards: Vec3::X, tension: 1e-3 };
    pulled.loads = pulled.loads.clone().with_pull(&pulled.rod, &pull).unwrap();
    let pulled = refused(pulled);
    assert!(pulled.contains("rod 1 cannot run beside others: it is pulled towards a point"), "{pulled}");
    let description = rod(1, 10).description().clone();
    let first = Problem::cantilever(Rod::with_elements(description, 10, &[], Order::First).unwrap());
    assert!(refused(first).contains("order 2"));
}
