//! The times of [`strands_wasm::bench`] on this machine without a browser, in µs a sweep and a search, for `npm run bench`.

use std::time::Instant;

const ROUNDS: usize = 30;

fn main() -> Result<(), String> {
    let (sweeps, solves) = (1000, 200);
    let mut best = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        // Both build a rod and solve it once; the difference is what is asked for.
        let none = time(0, 0)?;
        best[0] = best[0].min((time(sweeps, 0)? - none) / sweeps as f64);
        best[1] = best[1].min((time(0, solves)? - none) / solves as f64);
    }
    println!("{{\"sweep\": {:.3}, \"search\": {:.3}}}", best[0] * 1e6, best[1] * 1e6);
    Ok(())
}

fn time(sweeps: usize, solves: usize) -> Result<f64, String> {
    let start = Instant::now();
    let converged = strands_wasm::bench(100, sweeps, solves)?;
    if converged != solves {
        return Err(format!("{converged} of {solves} searches converged"));
    }
    Ok(start.elapsed().as_secs_f64())
}
