//! Whatever is asked, there is an equilibrium or a reason: no panic, and no number that is none.

use std::panic::{AssertUnwindSafe, catch_unwind};
use strands::statics::{Workspace, solve};
use strands_cases::wild;

/// What is wrong with the answer to a problem; `None` where nothing is. Counts the solved ones.
fn wrong(number: u64, workspace: &mut Workspace, solved: &mut u64) -> Option<String> {
    let (problem, settings) = wild::problem(number).ok()?;
    match catch_unwind(AssertUnwindSafe(|| solve(&problem, &settings, None, workspace))) {
        Err(_) => {
            *workspace = Workspace::default();
            Some("panic".into())
        }
        Ok(Ok(solution)) => {
            *solved += 1;
            let (residual, imbalance) = (solution.report.residual, solution.imbalance(&problem));
            if !solution.is_finite() {
                Some("a solution with a number that is none".into())
            } else if residual.is_nan() || residual > settings.tolerance {
                Some(format!("a solution with the residual {residual:e}"))
            } else if imbalance.is_nan() || imbalance > 1e-6 {
                Some(format!("a solution out of balance by {imbalance:e}"))
            } else {
                None
            }
        }
        Ok(Err(failure)) => (!failure.nearest.is_finite())
            .then(|| format!("a failure ({}) with a number that is none", failure.reason)),
    }
}

#[test]
fn whatever_is_asked_there_is_an_equilibrium_or_a_reason() {
    let inputs = std::env::var("STRANDS_INPUTS").map_or(1_000, |inputs| inputs.parse().unwrap());
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    std::panic::set_hook(Box::new(|_| {}));
    let share = |thread: u64| {
        move || {
            let (mut workspace, mut solved, mut all) = (Workspace::default(), 0, Vec::new());
            for number in (thread..inputs).step_by(threads as usize) {
                all.extend(
                    wrong(number, &mut workspace, &mut solved).map(|what| format!("{number}: {what}")),
                );
            }
            (solved, all)
        }
    };
    let running: Vec<_> = (0..threads).map(|thread| std::thread::spawn(share(thread))).collect();
    let shares: Vec<_> = running.into_iter().map(|thread| thread.join().unwrap()).collect();
    let _ = std::panic::take_hook();
    let solved: u64 = shares.iter().map(|(solved, _)| solved).sum();
    let wrong: Vec<String> = shares.into_iter().flat_map(|(_, wrong)| wrong).collect();
    println!("{solved} of {inputs} solved, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{}", wrong[..wrong.len().min(20)].join("\n"));
    assert!(solved > inputs / 4, "{solved} of {inputs}");
}
