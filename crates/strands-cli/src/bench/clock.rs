//! How times are taken: in batches that last long enough for the clock, of all candidates in turn, and the median of each one's batches.
//!
//! Taking turns spreads what else the machine does over all candidates alike; the median leaves the worst of it out.

use std::time::{Duration, Instant};

/// How long a batch should last.
const BATCH: Duration = Duration::from_millis(3);
/// Batches of each candidate.
const ROUNDS: usize = 21;

/// Times each candidate: the median of its batches, s a run.
pub fn in_turn(candidates: &mut [Box<dyn FnMut() + '_>]) -> Vec<f64> {
    let runs: Vec<u32> = candidates.iter_mut().map(|run| runs_in_a_batch(run)).collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); candidates.len()];
    for _ in 0..ROUNDS {
        for (i, run) in candidates.iter_mut().enumerate() {
            times[i].push(batch(run, runs[i]).as_secs_f64() / f64::from(runs[i]));
        }
    }
    times.into_iter().map(|mut times| quantile(&mut times, 0.5)).collect()
}

/// The value below which the given part of the values lies.
pub fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values[((last as f64) * part).round() as usize]
}

fn runs_in_a_batch(run: &mut dyn FnMut()) -> u32 {
    let mut runs = 1;
    loop {
        let time = batch(run, runs);
        if time >= BATCH {
            return runs;
        }
        runs *= 2;
    }
}

fn batch(run: &mut dyn FnMut(), runs: u32) -> Duration {
    let start = Instant::now();
    for _ in 0..runs {
        run();
    }
    start.elapsed()
}
