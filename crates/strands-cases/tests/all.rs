//! Every equilibrium that is known of a problem with many, found by one search.

use strands::rod::Order;
use strands::statics::{SearchSettings, Workspace, equilibria};
use strands_cases::Case;

/// Which of a case's equilibria a search finds, and how many it finds in all.
fn found(case: &Case, elements: usize, times: usize) -> (Vec<bool>, usize) {
    let row = &case.rows[0];
    let problem = row.problem(elements, Order::Second).unwrap();
    let default = SearchSettings::default();
    let settings = SearchSettings { starts: default.starts * times, paths: default.paths * times, ..default };
    let all = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
    let is_among = |answer: &strands_cases::Answer| {
        all.iter().any(|solution| {
            // The places and orientations: on so few elements the wrenches of highly curved shapes are less exact.
            let shape = answer.expected.iter().filter(|expected| expected.place().is_some());
            solution.report.morse_index == answer.index
                && shape.clone().all(|expected| expected.compare(&problem, solution).error < 1e-2)
        })
    };
    (row.answers.iter().map(is_among).collect(), all.len())
}

fn posed() -> Vec<Case> {
    strands_cases::all().into_iter().filter(|case| case.name.starts_with("pose-")).collect()
}

#[test]
fn all_listed_equilibria_of_some_random_rods_are_found() {
    for name in ["pose-kirchhoff-17", "pose-cosserat-16"] {
        let case = strands_cases::find(name).unwrap();
        let (listed, _) = found(&case, 60, 1);
        assert!(listed.iter().all(|found| *found), "{name}: {listed:?}");
    }
}

/// Minutes in release. `STRANDS_EFFORT` says how hard to search.
#[test]
#[ignore = "takes minutes: cargo test --release -p strands-cases --test all -- --ignored --nocapture"]
fn all_listed_equilibria_of_every_random_rod_are_found() {
    let times = std::env::var("STRANDS_EFFORT").map_or(4, |times| times.parse().unwrap());
    let mut missed = Vec::new();
    let (mut listed, mut in_all) = (0, 0);
    for case in posed() {
        let (hits, all) = found(&case, 100, times);
        listed += hits.len();
        in_all += all;
        let not: Vec<usize> = (0..hits.len()).filter(|i| !hits[*i]).collect();
        println!(
            "{}: {} of {} listed, {all} in all; missed {not:?}",
            case.name,
            hits.len() - not.len(),
            hits.len()
        );
        missed.extend(not.into_iter().map(|i| format!("{} {i}", case.name)));
    }
    println!("{} of {listed} listed, {in_all} in all", listed - missed.len());
    assert!(missed.is_empty(), "{missed:?}");
}
