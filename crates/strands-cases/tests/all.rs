//! Every equilibrium that is known of a problem with many, found by one search.

use strands::rod::Order;
use strands::statics::{SearchSettings, Workspace, equilibria};
use strands_cases::Case;

/// Which of a case's equilibria a search finds that is so many times as hard as by default, and how many it finds in all.
fn found(case: &Case, elements: usize, effort: f64) -> (Vec<bool>, usize) {
    let row = &case.rows[0];
    let problem = row.problem(elements, Order::Second).unwrap();
    let default = SearchSettings::default();
    let times = |count: usize| (count as f64 * effort).ceil() as usize;
    let settings = SearchSettings { starts: times(default.starts), paths: times(default.paths), ..default };
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

/// So many of the 339 listed equilibria the search may miss, by chance. One of them, pose-cosserat-01 4, is so near to a fold that elements of order 2
/// have it from about 400 on only.
const FEW: usize = 8;

#[test]
fn all_listed_equilibria_of_some_random_rods_are_found() {
    for name in ["pose-kirchhoff-02", "pose-cosserat-16"] {
        let case = strands_cases::find(name).unwrap();
        let (listed, _) = found(&case, 60, 0.1);
        assert!(listed.iter().all(|found| *found), "{name}: {listed:?}");
    }
}

/// Minutes in release. `STRANDS_EFFORT` says how hard to search.
#[test]
#[ignore = "takes minutes: cargo test --release -p strands-cases --test all -- --ignored --nocapture"]
fn nearly_all_listed_equilibria_of_every_random_rod_are_found() {
    let effort = std::env::var("STRANDS_EFFORT").map_or(1.0, |effort| effort.parse().unwrap());
    let mut missed = Vec::new();
    let (mut listed, mut in_all) = (0, 0);
    for case in posed() {
        let (hits, all) = found(&case, 100, effort);
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
    assert!(missed.len() <= FEW, "{missed:?}");
}
