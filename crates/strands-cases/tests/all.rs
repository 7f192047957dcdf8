//! Every equilibrium that is known of a problem with many, found by one search.

use strands::rod::Order;
use strands::statics::{SearchSettings, Workspace, equilibria};
use strands_cases::Case;

/// Which of a case's equilibria searches find that are each so many times as hard as by default, one after the other with its own seed, until all are
/// found or the seeds are spent. Gives how many equilibria each search found in all, too.
fn found(case: &Case, (elements, order): (usize, Order), effort: f64, seeds: u64) -> (Vec<bool>, Vec<usize>) {
    let row = &case.rows[0];
    let problem = row.problem(elements, order).unwrap();
    let default = SearchSettings::default();
    let times = |count: usize| (count as f64 * effort).ceil() as usize;
    let (mut hits, mut counts) = (vec![false; row.answers.len()], Vec::new());
    for seed in 0..seeds {
        let settings =
            SearchSettings { starts: times(default.starts), paths: times(default.paths), seed, ..default };
        let all = equilibria(&problem, &settings, &mut Workspace::default()).unwrap();
        for (hit, answer) in hits.iter_mut().zip(&row.answers) {
            *hit |= all.iter().any(|solution| {
                // The places and orientations: on so few elements the wrenches of highly curved shapes are less exact.
                let mut shape = answer.expected.iter().filter(|expected| expected.place().is_some());
                solution.report.morse_index == answer.index
                    && shape.all(|expected| expected.compare(&problem, solution).error < 1e-2)
            });
        }
        counts.push(all.len());
        if hits.iter().all(|hit| *hit) {
            break;
        }
    }
    (hits, counts)
}

/// The mesh on which a case is searched. One of the equilibria of pose-cosserat-01, no. 4, is so near to a fold that elements of order 2 have it from
/// about 300 on only, and those of order 4 from 60.
fn mesh(case: &Case) -> (usize, Order) {
    if case.name == "pose-cosserat-01" { (60, Order::Fourth) } else { (100, Order::Second) }
}

fn posed() -> Vec<Case> {
    let wanted = std::env::var("STRANDS_CASE").unwrap_or_default();
    let is_posed = |case: &Case| case.name.starts_with("pose-") && case.name.contains(&wanted);
    strands_cases::all().into_iter().filter(is_posed).collect()
}

/// So many searches are made at most for what is listed of a rod: there may be hundreds of equilibria, and which a search misses is chance.
const SEEDS: u64 = 8;

#[test]
fn all_listed_equilibria_of_some_random_rods_are_found() {
    for name in ["pose-kirchhoff-02", "pose-cosserat-16"] {
        let case = strands_cases::find(name).unwrap();
        let (listed, _) = found(&case, (60, Order::Second), 0.1, 1);
        assert!(listed.iter().all(|found| *found), "{name}: {listed:?}");
    }
}

/// Minutes in release. `STRANDS_EFFORT` says how hard to search, `STRANDS_SEEDS` how often at most, `STRANDS_CASE` is a part of the names of the
/// cases that are searched.
#[test]
#[ignore = "takes minutes: cargo test --release -p strands-cases --test all -- --ignored --nocapture"]
fn all_listed_equilibria_of_every_random_rod_are_found() {
    let effort = std::env::var("STRANDS_EFFORT").map_or(1.0, |effort| effort.parse().unwrap());
    let seeds = std::env::var("STRANDS_SEEDS").map_or(SEEDS, |seeds| seeds.parse().unwrap());
    let mut missed = Vec::new();
    let mut listed = 0;
    for case in posed() {
        let began = std::time::Instant::now();
        let (hits, all) = found(&case, mesh(&case), effort, seeds);
        listed += hits.len();
        let not: Vec<usize> = (0..hits.len()).filter(|i| !hits[*i]).collect();
        println!(
            "{}: {} of {} listed, {all:?} in all, {:.0} s; missed {not:?}",
            case.name,
            hits.len() - not.len(),
            hits.len(),
            began.elapsed().as_secs_f64()
        );
        missed.extend(not.into_iter().map(|i| format!("{} {i}", case.name)));
    }
    println!("{} of {listed} listed", listed - missed.len());
    assert!(missed.is_empty(), "{missed:?}");
}
