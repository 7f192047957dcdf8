//! Supports between the ends, collars and hinges.

use super::*;

/// A rod under its own weight and a load at its tip, held at its start.
fn hanging(kinematics: Kinematics, order: Order) -> Problem {
    let rod = rod(kinematics, curved(), 60, order);
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 1.0, -9.81));
    Problem { loads, ..Problem::cantilever(rod) }
}

#[test]
fn a_support_where_the_rod_is_anyway_bears_nothing_and_changes_nothing() {
    let settings = Settings { tolerance: 1e-11, ..Settings::default() };
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for order in [Order::First, Order::Second, Order::Fourth] {
            let mut problem = hanging(kinematics, order);
            let free = solved(&problem, &settings);
            for node in [15, 40] {
                problem.between.push((node, Support::clamped(free.poses[node])));
            }
            let held = solved(&problem, &settings);
            let weight = problem.loads.world.iter().map(|load| load.linear.norm()).sum::<f64>();
            for reaction in &held.reactions[1..] {
                assert!(reaction.force.norm() < 1e-6 * weight, "{kinematics:?} {order:?}: {reaction:?}");
            }
            for (a, b) in free.poses.iter().zip(&held.poses) {
                assert!((a.position - b.position).norm() < 1e-9, "{kinematics:?} {order:?}");
            }
        }
    }
}

#[test]
fn a_beam_on_three_supports_bears_five_eighths_of_its_weight_in_the_middle() {
    // Small deflections: R = 5/8 w L at the middle, 3/16 w L at each end (Timoshenko, Strength of Materials I, 1955, art. 44).
    let description = RodDescription {
        base: Pose::from_parts(
            Vec3::ZERO,
            Quat::from_rotation_vector(Vec3::new(0.0, 0.5 * std::f64::consts::PI, 0.0)),
        ),
        ..description(Kinematics::Kirchhoff, RestShape::default())
    };
    let rod = Rod::with_elements(description, 80, &[0.4], Order::Fourth).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.0, -1e-3));
    let weight = 0.02 * 0.8 * 1e-3;
    let poses = rod.rest_poses();
    let (f, t) = (false, true);
    let mut problem = Problem { loads, ..Problem::cantilever(rod) };
    problem.start = Support::of([f, f, t, t, t, t], poses[0]);
    problem.between = vec![(40, Support::of([f, f, f, f, t, t], poses[40]))];
    problem.end = Support::of([f, f, f, f, t, t], poses[80]);
    let solution = solved(&problem, &Settings::default());
    assert_eq!(solution.report.morse_index, Some(0));
    let parts = [3.0 / 16.0, 5.0 / 8.0, 3.0 / 16.0];
    for (reaction, part) in solution.reactions.iter().zip(parts) {
        assert!((reaction.force.z / weight - part).abs() < 1e-5, "{} of {part}", reaction.force.z / weight);
    }
}

#[test]
fn a_collar_slides_and_a_hinge_turns_without_resistance() {
    let settings = Settings { tolerance: 1e-11, ..Settings::default() };
    let axes = [Vec3::new(0.3, -0.5, 0.8), Vec3::new(-1.0, 0.2, 0.1)];
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for node in [25, 60] {
            let mut problem = hanging(kinematics, Order::Second);
            let free = solved(&problem, &settings).poses[node];
            let aside = Pose::exp(Vec6::new(Vec3::new(0.2, -0.1, 0.15), Vec3::new(0.02, -0.03, -0.02)));
            let target = free.compose(&aside);
            let support = Support::clamped(target).sliding_along(axes[0]).turning_about(axes[1]);
            match problem.support_mut(node) {
                Some(end) => *end = support,
                None => problem.between.push((node, support)),
            }
            let solution = solved(&problem, &settings);
            let reaction = solution.reactions[1];
            let (slide, hinge) = (axes[0] * (1.0 / axes[0].norm()), axes[1] * (1.0 / axes[1].norm()));
            assert!(reaction.force.dot(slide).abs() < 1e-10 * reaction.force.norm(), "{kinematics:?} {node}");
            assert!(
                reaction.moment.dot(hinge).abs() < 1e-9 * reaction.moment.norm(),
                "{kinematics:?} {node}"
            );
            assert!(reaction.force.norm() > 1e-3 && reaction.moment.norm() > 1e-4);
            let reached = solution.poses[node];
            let shift = reached.position - target.position;
            let turn = target.rotation * target.rotation.turn_to(&reached.rotation);
            assert!(
                shift.cross(slide).norm() < 1e-10 && shift.norm() > 1e-4,
                "{kinematics:?} {node}: {shift:?}"
            );
            assert!(
                turn.cross(hinge).norm() < 1e-10 && turn.norm() > 1e-3,
                "{kinematics:?} {node}: {turn:?}"
            );
            assert!(solution.imbalance(&problem) < 1e-11, "{:e}", solution.imbalance(&problem));
            assert_eq!(solution.report.morse_index, Some(0));
        }
    }
}

#[test]
fn an_end_that_has_gone_far_along_its_rail_comes_back_onto_it() {
    let mut problem = hanging(Kinematics::Cosserat, Order::Second);
    let rest = *problem.rod.rest_poses().last().unwrap();
    problem.end = Support::pinned(rest).sliding_along(Vec3::new(0.3, -0.5, 0.8));
    let state = EndState::from_guess(&problem, &Guess::new(rest, Wrench::ZERO));
    let [there, back] = [1e13, -1e13].map(|far| [0.0, 0.0, 0.0, 0.0, 0.0, far]);
    let place = state.stepped(&problem, &there).stepped(&problem, &back).pose.position;
    let away = problem.end.shift_axes.transpose_mul(place - problem.end.pose.position);
    assert!(away.x.abs().max(away.y.abs()) < 1e-15, "{away:?}");
}

#[test]
fn loads_of_which_the_squares_overflow_are_weighed_too() {
    let mut problem = hanging(Kinematics::Cosserat, Order::Second);
    let solution = solved(&problem, &Settings::default());
    // A clamp bears whatever acts on it.
    problem.loads.world[0].linear += Vec3::X * 1e250;
    let solution = solve(&problem, &Settings::default(), Some(&solution.guess), &mut Workspace::default());
    let imbalance = solution.unwrap().imbalance(&problem);
    assert!(imbalance < 1e-12, "{imbalance:e}");
}

#[test]
fn few_iterations_are_few_where_all_frames_move_at_once_too() {
    let mut problem = hanging(Kinematics::Kirchhoff, Order::Second);
    problem.end = Support::clamped(problem.rod.description().base);
    let settings = Settings { method: Method::Equilibrium, max_iterations: 1, ..Settings::default() };
    let failure = solve(&problem, &settings, None, &mut Workspace::default()).unwrap_err();
    assert!(failure.nearest.report.iterations <= 6 * 8, "{}", failure.nearest.report.iterations);
}

#[test]
fn shooting_and_nodes_that_are_none_are_refused() {
    let mut problem = hanging(Kinematics::Kirchhoff, Order::Second);
    let reason = |problem: &Problem, settings: &Settings| {
        solve(problem, settings, None, &mut Workspace::default()).unwrap_err().reason
    };
    for node in [0, 60, 61] {
        problem.between = vec![(node, Support::pinned(Pose::IDENTITY))];
        let refused = reason(&problem, &Settings::default());
        assert_eq!(refused, FailureReason::SupportAt { node, last: 60 });
    }
    problem.between = vec![(30, Support::pinned(problem.rod.rest_poses()[30]))];
    for method in [Method::Shooting, Method::Sweep] {
        let settings = Settings { method, ..Settings::default() };
        let refused = reason(&problem, &settings);
        assert!(
            matches!(refused, FailureReason::HeldBetween | FailureReason::NotStandard { .. }),
            "{refused}"
        );
    }
}
