use super::*;
use crate::coupling::{Grip, VirtualCoupling};
use crate::load::{DistributedLoad, Frame, NodalLoads, PointLoad};
use crate::math::{Mat3, Pose, Quat, SimdLevel, Wrench};
use crate::rod::{
    Law, Material, Mesh, Order, Profile, RestShape, Rod, RodDescription, Section, Station, Stiffness,
};

mod batch;
mod continuation;
mod fit;
mod meshes;
mod multiple_shooting;
mod pulls;
mod schemes;
mod search;
mod stability;
mod supports;

fn description(kinematics: Kinematics, rest: RestShape) -> RodDescription {
    let stiffness = Stiffness { bending: [0.05, 0.08], torsion: 0.04, axial: 900.0, shear: [300.0, 320.0] };
    RodDescription {
        length: 0.8,
        kinematics,
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: 0.02,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.002; 2],
        },
        rest,
        base: Pose::from_parts(Vec3::new(0.1, -0.2, 0.3), Quat::from_wxyz([0.9, 0.1, -0.3, 0.2]).unwrap()),
    }
}

fn curved() -> RestShape {
    RestShape::samples(vec![(0.0, Vec3::new(1.0, -2.0, 3.0)), (0.8, Vec3::new(-1.5, 2.5, 1.0))]).unwrap()
}

fn rod(kinematics: Kinematics, rest: RestShape, elements: usize, order: Order) -> Rod {
    Rod::with_elements(description(kinematics, rest), elements, &[], order).unwrap()
}

/// A rod with rest curvature, clamped, a force and a moment at its tip.
fn loaded(kinematics: Kinematics, elements: usize, order: Order, frame: Frame) -> Problem {
    let rod = rod(kinematics, curved(), elements, order);
    let load = PointLoad {
        at: 0.8,
        wrench: Wrench::new(Vec3::new(0.05, -0.08, 0.06), Vec3::new(0.15, 0.1, -0.2)),
        frame,
    };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

fn tip(solution: &Solution) -> Pose {
    solution.poses[solution.poses.len() - 1]
}

fn solved(problem: &Problem, settings: &Settings) -> Solution {
    match solve(problem, settings, None, &mut Workspace::default()) {
        Ok(solution) => solution,
        Err(failure) => panic!("{failure}: {:?}", failure.nearest.report),
    }
}

fn slope_of(error: impl Fn(usize) -> f64, coarse: usize) -> f64 {
    (error(coarse) / error(2 * coarse)).log2()
}

#[test]
fn tip_error_falls_at_the_order_of_the_scheme() {
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for frame in [Frame::World, Frame::Body] {
            for (order, coarse) in [(Order::First, 1024), (Order::Second, 64), (Order::Fourth, 32)] {
                let fine = tip(&solved(&loaded(kinematics, 32 * coarse, order, frame), &settings));
                let error = |n| {
                    let tip = tip(&solved(&loaded(kinematics, n, order, frame), &settings));
                    fine.between(&tip).log().max_abs()
                };
                let slope = slope_of(error, coarse);
                let expected = order.as_number() as f64;
                assert!(
                    (slope - expected).abs() < 0.1,
                    "{kinematics:?} {frame:?} {order:?}: slope {slope:.3}"
                );
            }
        }
    }
}

#[test]
fn multistep_scheme_is_of_second_order() {
    let settings = Settings { tolerance: 1e-13, scheme: Scheme::Multistep, ..Settings::default() };
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for frame in [Frame::World, Frame::Body] {
            let fine = tip(&solved(&loaded(kinematics, 4096, Order::Second, frame), &settings));
            let error = |n| {
                let tip = tip(&solved(&loaded(kinematics, n, Order::Second, frame), &settings));
                fine.between(&tip).log().max_abs()
            };
            let slope = slope_of(error, 128);
            assert!((slope - 2.0).abs() < 0.1, "{kinematics:?} {frame:?}: slope {slope:.3}");
        }
    }
}

#[test]
fn weight_keeps_the_order_for_any_number_of_elements() {
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    let problem = |n: usize, order: Order| {
        let rod = rod(Kinematics::Kirchhoff, curved(), n, order);
        let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(1.0, -3.0, -9.0));
        Problem { loads, ..Problem::cantilever(rod) }
    };
    for (order, coarse) in [(Order::Second, 64), (Order::Fourth, 32), (Order::Fourth, 33)] {
        let fine = tip(&solved(&problem(32 * coarse, order), &settings));
        let error = |n| fine.between(&tip(&solved(&problem(n, order), &settings))).log().max_abs();
        let slope = slope_of(error, coarse);
        let expected = order.as_number() as f64;
        assert!((slope - expected).abs() < 0.1, "{order:?} from {coarse}: slope {slope:.3}");
    }
}

#[test]
fn following_and_turning_distributed_loads_are_of_second_order() {
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    let problem = |n: usize| {
        let rod = rod(Kinematics::Cosserat, curved(), n, Order::Second);
        let along = |frame, moment, force| DistributedLoad {
            from: 0.0,
            to: 0.8,
            per_length: Wrench::new(moment, force),
            frame,
        };
        let loads = NodalLoads::none(&rod)
            .with_distributed(
                &rod,
                &along(Frame::Body, Vec3::new(0.01, 0.0, 0.02), Vec3::new(0.1, -0.1, 0.0)),
            )
            .and_then(|loads| {
                loads.with_distributed(&rod, &along(Frame::World, Vec3::new(0.0, 0.03, 0.0), Vec3::X * 0.1))
            })
            .unwrap();
        Problem { loads, ..Problem::cantilever(rod) }
    };
    let fine = tip(&solved(&problem(2048), &settings));
    let error = |n| fine.between(&tip(&solved(&problem(n), &settings))).log().max_abs();
    let slope = slope_of(error, 64);
    assert!((slope - 2.0).abs() < 0.1, "slope {slope:.3}");
}

#[test]
fn force_and_moment_balance_to_roundoff_at_any_number_of_elements() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            for elements in [5, 50, 500] {
                let mut problem = loaded(kinematics, elements, order, Frame::World);
                problem.loads = problem.loads.clone().with_gravity(&problem.rod, Vec3::new(0.0, 1.0, -9.81));
                let settings = Settings { tolerance: 1e-13, ..Settings::default() };
                let free = solved(&problem, &settings);
                let imbalance = free.imbalance(&problem);
                assert!(imbalance < 1e-12, "{kinematics:?} {order:?} {elements}: free end {imbalance:e}");
                problem.end = Support::clamped(tip(&free));
                let held = solve(&problem, &settings, Some(&free.guess), &mut Workspace::default()).unwrap();
                let imbalance = held.imbalance(&problem);
                assert!(imbalance < 1e-12, "{kinematics:?} {order:?} {elements}: held end {imbalance:e}");
            }
        }
    }
}

#[test]
fn solution_moves_with_the_problem() {
    let motion = Pose::from_parts(Vec3::new(-3.0, 2.0, 5.0), Quat::from_wxyz([0.3, -0.5, 0.7, 0.4]).unwrap());
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    for order in [Order::First, Order::Second, Order::Fourth] {
        let mut problem = loaded(Kinematics::Cosserat, 60, order, Frame::World);
        problem.loads = problem.loads.clone().with_gravity(&problem.rod, Vec3::new(0.0, 1.0, -9.81));
        let here = solved(&problem, &settings);
        let mut description = problem.rod.description().clone();
        description.base = motion.compose(&description.base);
        let mut there = Problem::cantilever(Rod::with_elements(description, 60, &[], order).unwrap());
        there.loads = problem.loads.clone();
        for load in &mut there.loads.world {
            *load = load.turned_by(&motion.rotation);
        }
        let there = solved(&there, &settings);
        for (a, b) in here.poses.iter().zip(&there.poses) {
            let gap = motion.compose(a).between(b).log().max_abs();
            assert!(gap < 1e-12, "{order:?}: {gap:e}");
        }
    }
}

#[test]
fn imposed_pose_and_imposed_wrench_agree() {
    let settings = Settings { tolerance: 1e-11, ..Settings::default() };
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            // A place that the tip can be pulled and turned to: where a known wrench has it.
            let pulled = loaded(kinematics, 100, order, Frame::World);
            let target = tip(&solved(&pulled, &settings));
            let rod = pulled.rod;
            let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.5, -2.0));
            let mut posed = Problem { loads, ..Problem::cantilever(rod) };
            posed.end = Support::clamped(target);
            let posed_solution = solved(&posed, &settings);
            let reaction = posed_solution.end_reaction();
            let load = PointLoad {
                at: posed.rod.length(),
                wrench: Wrench::new(reaction.moment, reaction.force),
                frame: Frame::World,
            };
            let mut loaded = posed.clone();
            loaded.end = Support::free(target);
            loaded.loads = loaded.loads.with_point(&loaded.rod, &load).unwrap();
            let back =
                solve(&loaded, &settings, Some(&posed_solution.guess), &mut Workspace::default()).unwrap();
            assert_eq!(back.report.method, Method::Sweep);
            let gap = target.between(&tip(&back)).log().max_abs();
            assert!(gap < 1e-9 * posed.rod.length(), "{kinematics:?} {order:?}: {gap:e}");
        }
    }
}

/// A tip held in every way that differs in kind, near a loaded shape.
fn held_in_many_ways() -> Vec<(&'static str, [bool; 6])> {
    let (f, t) = (false, true);
    vec![
        ("whole pose", [t; 6]),
        ("position", [f, f, f, t, t, t]),
        ("position and tangent", [t, t, f, t, t, t]),
        ("orientation", [t, t, t, f, f, f]),
        ("position and twist", [f, f, t, t, t, t]),
        ("height", [f, f, f, f, f, t]),
        ("plane and tangent", [t, t, f, t, f, f]),
    ]
}

#[test]
fn any_mix_of_the_six_can_be_held_and_what_is_free_bears_no_load() {
    let settings = Settings { tolerance: 1e-11, ..Settings::default() };
    for (name, fixed) in held_in_many_ways() {
        let rod = rod(Kinematics::Kirchhoff, curved(), 80, Order::Second);
        let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 1.0, -9.81));
        let mut problem = Problem { loads, ..Problem::cantilever(rod) };
        let hanging = tip(&solved(&problem, &settings));
        let target =
            hanging.compose(&Pose::exp(Vec6::new(Vec3::new(0.2, -0.3, 0.25), Vec3::new(0.03, -0.04, -0.05))));
        problem.end = Support::of(fixed, target);
        let solution = solved(&problem, &settings);
        let reached = tip(&solution);
        let turn = target.between(&reached).log().angular;
        let shift = reached.position - target.position;
        let reaction = solution.end_reaction();
        for i in 0..3 {
            if fixed[3 + i] {
                assert!(shift[i].abs() < 1e-10, "{name}: position {i} is off by {:e}", shift[i]);
            } else {
                assert!(reaction.force[i].abs() < 1e-12, "{name}: force {i} is {:e}", reaction.force[i]);
            }
            if fixed[i] {
                assert!(turn[i].abs() < 1e-10, "{name}: turn {i} is off by {:e}", turn[i]);
            }
        }
        if fixed[..3] == [false; 3] {
            assert!(reaction.moment.max_abs() < 1e-12, "{name}");
        }
        if name == "position and tangent" {
            let about_tangent = reaction.moment.dot(reached.rotation.cols[2]);
            assert!(about_tangent.abs() < 1e-12, "{name}: moment about the tangent {about_tangent:e}");
        }
        assert!(solution.imbalance(&problem) < 1e-11, "{name}: {:e}", solution.imbalance(&problem));
    }
}

#[test]
fn a_start_that_is_only_pinned_bears_no_moment() {
    let rod = rod(Kinematics::Cosserat, RestShape::default(), 60, Order::Second);
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.5, -2.0));
    let base = rod.description().base;
    let far =
        base.compose(&Pose { rotation: crate::math::Mat3::IDENTITY, position: Vec3::new(0.1, 0.05, 0.7) });
    let (start, end) = (Support::pinned(base), Support::clamped(far));
    let problem = Problem { rod, loads, start, end, between: Vec::new() };
    let solution = solved(&problem, &Settings { tolerance: 1e-11, ..Settings::default() });
    assert!(solution.start_reaction().moment.max_abs() < 1e-11, "{:?}", solution.reactions[0]);
    assert!(solution.imbalance(&problem) < 1e-11);
}

#[test]
fn every_jacobian_is_the_derivative_and_gives_the_same_solution() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            let rod = rod(kinematics, curved(), 40, order);
            let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 1.0, -9.81));
            let mut problem = Problem { loads, ..Problem::cantilever(rod) };
            let free = solved(&problem, &Settings::default());
            let target = tip(&free)
                .compose(&Pose::exp(Vec6::new(Vec3::new(0.3, 0.1, 0.2), Vec3::new(0.02, 0.03, -0.05))));
            problem.end = Support::clamped(target);
            let all = [
                Jacobian::VariationalLanes,
                Jacobian::Variational,
                Jacobian::FiniteDifferences,
                Jacobian::FiniteDifferenceLanes,
            ];
            let solutions = all.map(|jacobian| {
                let settings = Settings { tolerance: 1e-12, jacobian, ..Settings::default() };
                solved(&problem, &settings)
            });
            for (jacobian, solution) in all.iter().zip(&solutions) {
                let gap = solution.guess.wrench - solutions[0].guess.wrench;
                assert!(gap.max_abs() < 1e-10, "{kinematics:?} {order:?} {jacobian:?}: {gap:?}");
            }
            // Fresh at each step, the exact Jacobian converges quadratically; a wrong one would not.
            let one = shooting::slopes(&problem, &solutions[0].guess);
            for (jacobian, slope) in &one[1..] {
                for i in 0..6 {
                    for k in 0..6 {
                        let exact = one[0].1[i][k];
                        let scale = one[0].1[i].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                        assert!(
                            (slope[i][k] - exact).abs() <= 3e-6 * scale,
                            "{kinematics:?} {order:?} {jacobian:?} ({i}, {k}): {} against {exact}",
                            slope[i][k]
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn every_simd_level_gives_the_same_bits() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            let problem = loaded(kinematics, 50, order, Frame::World);
            let at = |simd: SimdLevel| {
                let mut workspace = Workspace::default();
                workspace.simd = simd;
                solve(&problem, &Settings::default(), None, &mut workspace).unwrap()
            };
            let plain = at(SimdLevel::Baseline);
            for level in [SimdLevel::Avx2, SimdLevel::Avx512] {
                let wide = at(level);
                assert_eq!(plain.poses, wide.poses, "{kinematics:?} {order:?} {level:?}");
                assert_eq!(plain.report, wide.report, "{kinematics:?} {order:?} {level:?}");
            }
        }
    }
}

#[test]
fn a_full_law_that_is_diagonal_gives_what_the_diagonal_law_gives() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            let plain = loaded(kinematics, 60, order, Frame::World);
            let mut description = plain.rod.description().clone();
            let Profile::Given { law, .. } = &mut description.profile else { unreachable!() };
            let diagonal = law.tangent(Vec6::ZERO).to_rows();
            *law = Law::full(diagonal).unwrap();
            let rod = Rod::with_elements(description, 60, &[], order).unwrap();
            let full = Problem { rod, ..plain.clone() };
            let settings = Settings { tolerance: 1e-13, ..Settings::default() };
            let gap = tip(&solved(&plain, &settings)).between(&tip(&solved(&full, &settings))).log();
            assert!(gap.max_abs() < 1e-12, "{kinematics:?} {order:?}: {:e}", gap.max_abs());
        }
    }
}

#[test]
fn a_stiffening_rod_bends_less_and_keeps_its_balance() {
    let plain = loaded(Kinematics::Cosserat, 60, Order::Fourth, Frame::World);
    let mut description = plain.rod.description().clone();
    let Profile::Given { law: Law::Diagonal(stiffness), .. } = description.profile else { unreachable!() };
    let energy = crate::rod::StiffeningEnergy {
        stiffness,
        doubling_strain: Vec6::from([2.0, 2.0, 2.0, 0.1, 0.1, 0.1]),
    };
    use crate::rod::StoredEnergy;
    assert!(energy.check_derivatives(Vec6::from([1.0, -2.0, 0.5, 0.02, 0.01, -0.03])) < 1e-6);
    description.profile = Profile::Given {
        law: Law::Hyperelastic(std::sync::Arc::new(energy)),
        mass_per_length: 0.02,
        rotational_inertia_per_length: Vec3::ZERO,
        half_extent: [0.002; 2],
    };
    let stiffening =
        Problem { rod: Rod::with_elements(description, 60, &[], Order::Fourth).unwrap(), ..plain.clone() };
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let (soft, stiff) = (solved(&plain, &settings), solved(&stiffening, &settings));
    assert!(stiff.energy.elastic < soft.energy.elastic);
    assert!(stiff.imbalance(&stiffening) < 1e-12);
}

#[test]
fn a_tip_out_of_reach_fails_and_says_by_how_much() {
    let rod = rod(Kinematics::Kirchhoff, RestShape::default(), 50, Order::Second);
    let base = rod.description().base;
    let far =
        base.compose(&Pose { rotation: crate::math::Mat3::IDENTITY, position: Vec3::new(0.0, 0.3, 0.9) });
    let problem = Problem { end: Support::clamped(far), ..Problem::cantilever(rod) };
    let failure = solve(&problem, &Settings::default(), None, &mut Workspace::default()).unwrap_err();
    assert!(matches!(failure.reason, FailureReason::OutOfReach { .. }), "{failure}");
    assert!(failure.nearest.report.residual > 0.1);
    for pair in failure.nearest.poses.windows(2) {
        let chord = (pair[1].position - pair[0].position).norm();
        assert!(chord <= 0.8 / 50.0 * (1.0 + 1e-12), "an inextensible rod was stretched");
    }
}

#[test]
fn a_straight_rod_pushed_along_its_axis_buckles_to_a_stable_shape() {
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        let rod = rod(kinematics, RestShape::default(), 100, Order::Second);
        let base = rod.description().base;
        let near =
            base.compose(&Pose { rotation: crate::math::Mat3::IDENTITY, position: Vec3::new(0.0, 0.0, 0.6) });
        let problem = Problem { end: Support::clamped(near), ..Problem::cantilever(rod) };
        let solution = solved(&problem, &Settings::default());
        assert_eq!(solution.report.morse_index, Some(0), "{kinematics:?}");
        let middle = base.between(&solution.poses[50]).position;
        // EI1 < EI2: it bends about d1 and moves along d2.
        assert!(middle.y.abs() > 0.1 && middle.x.abs() < 1e-6, "{kinematics:?}: {middle:?}");
    }
}

#[test]
fn a_straight_column_has_one_unstable_way_for_each_buckling_load_below_its_own() {
    let straight = |end: Support, force: f64, order: Order| {
        let rod = rod(Kinematics::Kirchhoff, RestShape::default(), 60, order);
        let base = rod.description().base;
        let tip = base.compose(&Pose { position: Vec3::Z * 0.8, ..Pose::IDENTITY });
        let push = Wrench::new(Vec3::ZERO, base.rotation * Vec3::Z * -force);
        let load = PointLoad { at: 0.8, wrench: push, frame: Frame::World };
        let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
        let problem = Problem { loads, end, ..Problem::cantilever(rod) };
        let guess = Guess::new(tip, Wrench::new(Vec3::ZERO, Vec3::Z * -force));
        let solution = solve(&problem, &Settings::default(), Some(&guess), &mut Workspace::default());
        solution.unwrap_or_else(|failure| panic!("{failure}")).report.morse_index.unwrap()
    };
    let tip = description(Kinematics::Kirchhoff, RestShape::default()).base;
    let tip = tip.compose(&Pose { position: Vec3::Z * 0.8, ..Pose::IDENTITY });
    let sprung = |stiffness: f64| {
        let coupling = VirtualCoupling {
            linear_stiffness: stiffness,
            angular_stiffness: 0.01 * stiffness,
            linear_damping: 0.0,
            angular_damping: 0.0,
            max_force: 100.0,
            max_torque: 100.0,
        };
        Support::gripped(Grip { coupling, hand: tip, last: None })
    };
    for force in [0.1, 0.25, 1.0, 2.0, 5.0, 9.0, 20.0] {
        // Euler: a free end buckles at ((k − ½) π)² EI/L², about either axis; a guided one, clamped at its place, at the roots of
        // 2 (1 − cos x) = x sin x: 2 π k, and between them.
        let passed = |roots: &[f64]| {
            let below =
                |stiffness: f64| roots.iter().filter(|x| **x * **x * stiffness / 0.64 < force).count();
            below(0.05) + below(0.08)
        };
        let half = std::f64::consts::FRAC_PI_2;
        let free: Vec<f64> = (0..12).map(|k| f64::from(2 * k + 1) * half).collect();
        let clamped = [4.0 * half, 8.986_818_916, 8.0 * half, 15.450_503_674, 12.0 * half];
        for order in [Order::Second, Order::Fourth] {
            let loose = straight(Support::free(tip), force, order);
            assert_eq!(loose, passed(&free), "free, {force} N, {order:?}");
            let held = straight(Support::clamped(tip), force, order);
            assert_eq!(held, passed(&clamped), "clamped, {force} N, {order:?}");
            let mut last = loose;
            for stiffness in [1e-6, 0.01, 0.3, 1.0, 10.0, 1e3, 1e6] {
                let sprung = straight(sprung(stiffness), force, order);
                assert!((held..=last).contains(&sprung), "a spring of {stiffness} N/m, {force} N: {sprung}");
                last = sprung;
            }
        }
    }
}

#[test]
fn a_hand_on_a_stiff_coupling_pulls_the_tip_to_itself_and_its_wrench_balances() {
    let rod = rod(Kinematics::Kirchhoff, curved(), 80, Order::Second);
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 1.0, -9.81));
    let mut problem = Problem { loads, ..Problem::cantilever(rod) };
    let hanging = tip(&solved(&problem, &Settings::default()));
    let hand =
        hanging.compose(&Pose::exp(Vec6::new(Vec3::new(0.3, -0.2, 0.4), Vec3::new(0.05, 0.02, -0.04))));
    let coupling = VirtualCoupling {
        linear_stiffness: 2000.0,
        angular_stiffness: 20.0,
        linear_damping: 0.0,
        angular_damping: 0.0,
        max_force: 10.0,
        max_torque: 1.0,
    };
    let grip = Grip { coupling, hand, last: None };
    problem.end = Support::gripped(grip);
    let settings = Settings { tolerance: 1e-11, ..Settings::default() };
    let solution = solved(&problem, &settings);
    let held = tip(&solution);
    let spring = grip.wrench(&held);
    assert!((spring.linear - solution.end_reaction().force).max_abs() < 1e-12);
    assert!((held.position - hand.position).norm() < 0.02);
    assert!(solution.imbalance(&problem) < 1e-10, "{:e}", solution.imbalance(&problem));
    // Far beyond its length, the force stays at the device's limit and the inextensible strand keeps its length.
    let away = Pose { position: hand.position + Vec3::new(3.0, 0.0, 0.0), ..hand };
    let limited = VirtualCoupling { max_force: 0.4, max_torque: 0.01, ..coupling };
    let grip = Grip { coupling: limited, hand: away, last: None };
    problem.end = Support::gripped(grip);
    let pulled = solve(&problem, &settings, Some(&solution.guess), &mut Workspace::default());
    let pulled = pulled.unwrap_or_else(|failure| panic!("{failure}"));
    assert!(grip.saturated(&tip(&pulled)));
    assert!((pulled.end_reaction().force.norm() - 0.4).abs() < 1e-12);
}

#[test]
fn a_tolerance_is_met_with_fewer_elements_than_an_even_mesh_needs() {
    // Soft over a short stretch: all of the bending is there.
    for order in [Order::Second, Order::Fourth] {
        let rest = RestShape::samples(vec![
            (0.0, Vec3::ZERO),
            (0.6, Vec3::ZERO),
            (0.7, Vec3::new(0.0, 40.0, 0.0)),
            (0.8, Vec3::new(0.0, 0.0, 30.0)),
        ])
        .unwrap();
        let description = description(Kinematics::Kirchhoff, rest);
        let posed = |rod: Rod| -> Result<Problem, crate::rod::RodError> {
            let load = PointLoad {
                at: 0.8,
                wrench: Wrench::new(Vec3::ZERO, Vec3::new(0.1, 0.2, 0.05)),
                frame: Frame::World,
            };
            let loads = NodalLoads::none(&rod).with_point(&rod, &load)?;
            Ok(Problem { loads, ..Problem::cantilever(rod) })
        };
        let settings = Settings { tolerance: 1e-12, ..Settings::default() };
        let on = |mesh: Mesh| {
            let rod = Rod::new(description.clone(), mesh, order).unwrap();
            tip(&solved(&posed(rod).unwrap(), &settings))
        };
        let exact = on(Mesh::even(0.8, 6400, &[0.6, 0.7]).unwrap());
        for tolerance in [1e-3, 1e-5, 1e-7] {
            if order == Order::Second && tolerance < 1e-6 {
                continue;
            }
            let refined =
                refine(&description, order, &[0.6, 0.7], tolerance, 100_000, &settings, posed).unwrap();
            let error = exact.between(&tip(&refined.solution)).log().max_abs();
            let n = refined.problem.rod.elements();
            let even = exact.between(&on(Mesh::even(0.8, n, &[0.6, 0.7]).unwrap())).log().max_abs();
            println!("{order:?} {tolerance:e}: {n} elements, error {error:.2e}, even {even:.2e}");
            assert!(error <= tolerance, "{order:?} {tolerance:e}: {error:e} with {n}");
            assert!(error <= even, "{order:?} {tolerance:e}: an even mesh does better, {even:e}");
        }
    }
}

/// A rod that moves and is not in balance and has slack, seen as it is and turned as a whole with all that acts on it: what the slopes of the former, kept, give for
/// the latter is what new ones do.
#[test]
fn slopes_that_are_kept_turn_with_the_rod() {
    let problem = Problem::cantilever(rod(Kinematics::Cosserat, curved(), 40, Order::Second));
    let points = problem.rod.diagonal_points().unwrap();
    let loads = NodalLoads::none(&problem.rod).with_gravity(&problem.rod, Vec3::new(8.0, -20.0, 5.0));
    let mut workspace = Workspace::default();
    solve(&Problem { loads, ..problem.clone() }, &Settings::default(), None, &mut workspace).unwrap();
    let mut state = workspace.record;
    state.wrenches.iter_mut().for_each(|wrench| *wrench += *wrench * 0.01);
    let turn = Quat::from_rotation_vector(Vec3::new(0.4, -0.7, 0.2)).to_matrix();
    let turned = Record {
        poses: state
            .poses
            .iter()
            .map(|pose| Pose { rotation: turn * pose.rotation, position: turn * pose.position })
            .collect(),
        ..state.clone()
    };
    let inertial = |turn: Mat3| -> Vec<Inertial> {
        let of = |i: usize| Inertial {
            exerts: Wrench::new(Vec3::new(0.1, 0.02 * i as f64, -0.3), Vec3::new(-0.2, 0.4, 0.01 * i as f64))
                .turned_by(&turn),
            by_turn: turn * Mat3::diagonal(Vec3::new(-2.0, -1.0, -3.0)) * turn.transpose(),
            by_shift: Mat3::diagonal(Vec3::new(-500.0, -500.0, -500.0)),
        };
        (0..state.poses.len()).map(of).collect()
    };
    let level = SimdLevel::detect();
    let look = |nodal: &mut Nodal, slopes: Slopes, turn: Mat3, state: &Record| {
        let inertial = inertial(turn);
        let motion = Motion { points, inertial: &inertial, coupled: &[] };
        nodal.linearise_moving(&problem, level, (1e-4, slopes), &motion, state)
    };
    let mut kept = Nodal::default();
    look(&mut kept, Slopes::Anew, Mat3::IDENTITY, &state);
    kept.solve(level, 0.0).unwrap();
    let before = look(&mut kept, Slopes::Kept, turn, &turned);
    kept.solve_again(level, &turned);
    let mut anew = Nodal::default();
    let same = look(&mut anew, Slopes::Anew, turn, &turned);
    anew.solve(level, 0.0).unwrap();
    assert_eq!(before.residual(), same.residual());
    let after = |nodal: &Nodal| {
        let mut state = turned.clone();
        nodal.take(&problem, level, 1.0, &mut state);
        state
    };
    let (kept, anew) = (after(&kept), after(&anew));
    let moved = turned.poses.iter().zip(&anew.poses).map(|(from, to)| from.between(to).log().max_abs());
    let moved = moved.fold(0.0, f64::max);
    assert!(moved > 1e-3, "{moved:e}");
    for (kept, anew) in kept.poses.iter().zip(&anew.poses) {
        assert!(kept.between(anew).log().max_abs() < 1e-11 * moved, "{kept:?} {anew:?}");
    }
    for (kept, anew) in kept.wrenches.iter().zip(&anew.wrenches) {
        assert!((*kept - *anew).max_abs() < 1e-9 * anew.max_abs(), "{kept:?} {anew:?}");
    }
}

#[test]
fn a_state_with_one_number_that_is_none_has_no_residual() {
    for order in [Order::Second, Order::Fourth] {
        let rod = rod(Kinematics::Cosserat, curved(), 40, order);
        let problem = Problem::cantilever(rod);
        let mut workspace = Workspace::default();
        solve(&problem, &Settings::default(), None, &mut workspace).unwrap();
        let Workspace { record, nodal, simd, .. } = &mut workspace;
        for node in [3, 20, 39] {
            for part in 0..6 {
                let mut state = record.clone();
                let mut wrench = state.wrenches[node].to_array();
                wrench[part] = f64::NAN;
                state.wrenches[node] = wrench.into();
                let distance = nodal.linearise(&problem, *simd, 1e-3, &mut state);
                assert!(
                    distance.is_none_or(|distance| distance.residual().is_nan()),
                    "{order:?}, {node}, {part}"
                );
            }
            let mut state = record.clone();
            state.poses[node].position.y = f64::NAN;
            let distance = nodal.linearise(&problem, *simd, 1e-3, &mut state);
            assert!(distance.is_none_or(|distance| distance.residual().is_nan()), "{order:?}, {node}");
        }
    }
}
