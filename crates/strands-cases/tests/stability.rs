//! The Morse index against what is known of it.

use strands::math::{Pose, Vec3, Wrench};
use strands::rod::Order;
use strands::statics::{Guess, Settings, Workspace, solve};
use strands_cases::workloads;
use strands_cases::{Answer, Quantity, Value, all, find};

fn vector(answer: &Answer, quantity: Quantity) -> Vec3 {
    let found = answer.expected.iter().find(|expected| expected.quantity == quantity);
    match found.map(|expected| &expected.value) {
        Some(Value::Vector(vector)) => *vector,
        _ => panic!("no {quantity}"),
    }
}

/// The frame and wrench that an equilibrium has at the held tip.
fn guess(answer: &Answer, tip: Pose) -> Guess {
    let turned = |v: Vec3| tip.rotation.transpose() * v;
    let (force, moment) = (vector(answer, Quantity::TipForce), vector(answer, Quantity::TipMoment));
    Guess::new(tip, Wrench::new(turned(moment), turned(force)))
}

#[test]
fn every_known_equilibrium_has_its_known_index() {
    let settings = Settings { restart_from_rest: false, max_halvings: 0, ..Settings::default() };
    let mut workspace = Workspace::default();
    let (mut checked, mut by_index) = (0, [0; 8]);
    for case in all().iter().filter(|case| case.name.starts_with("pose-")) {
        let row = &case.rows[0];
        let problem = row.problem(400, Order::Fourth).expect("a rod");
        let tip = problem.end.pose;
        for (k, answer) in row.answers.iter().enumerate() {
            let Some(index) = answer.index else { continue };
            let solution = solve(&problem, &settings, Some(&guess(answer, tip)), &mut workspace)
                .unwrap_or_else(|failure| panic!("{}, {k}: {failure}", case.name));
            let (found, comparisons) = row.compare(&problem, &solution);
            assert_eq!(found, k, "{}: another equilibrium than {k}", case.name);
            assert!(comparisons.iter().all(|comparison| comparison.error < 1e-4), "{}, {k}", case.name);
            assert_eq!(solution.report.morse_index, Some(index), "{}, {k}", case.name);
            checked += 1;
            by_index[index.min(7)] += 1;
        }
    }
    assert!(checked > 300 && by_index[..4].iter().all(|count| *count > 10), "{by_index:?}");
}

#[test]
fn a_hand_that_keeps_to_the_stable_branch_is_never_called_unstable() {
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    for (order, elements) in [(Order::Second, 50), (Order::Second, 100), (Order::Fourth, 20)] {
        for workload in workloads::all() {
            let frames = workload.run(elements, order, &settings).expect("a run");
            for frame in frames {
                let index = frame.solution.report.morse_index;
                assert_eq!(
                    index.unwrap_or(0),
                    0,
                    "{}, {elements} elements, frame {}",
                    workload.name,
                    frame.frame
                );
            }
        }
    }
}

#[test]
fn a_wire_of_hardly_any_bending_stiffness_is_never_called_unstable() {
    let case = find("elastic-catenary").expect("the case");
    for (order, elements) in [(Order::Second, 200), (Order::Second, 1000), (Order::Fourth, 3000)] {
        for (row, outcome) in case.rows.iter().zip(case.solve(elements, order, &Settings::default())) {
            let index =
                outcome.unwrap_or_else(|error| panic!("{}: {error}", row.label)).solution.report.morse_index;
            // Elements of order 4 longer than what the wire bends over may buckle by themselves: nothing is known there.
            let known = index == Some(0) || index.is_none() && order == Order::Fourth;
            assert!(known, "{}, {order:?}, {elements}: {index:?}", row.label);
        }
    }
}
