//! What ran, how long it took, and whether it passed.

use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How many tests a step ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed.
    pub failed: usize,
}

/// A step that is one check.
pub const ONE: Count = Count { passed: 1, failed: 0 };

/// The steps so far.
#[derive(Default)]
pub struct Report {
    steps: Vec<Step>,
}

struct Step {
    name: &'static str,
    time: Duration,
    outcome: Outcome,
}

enum Outcome {
    Ran(Count),
    Failed(String),
    Skipped(String),
}

impl Report {
    /// Runs a step; gives whether it passed. A step that fails does not stop the ones after it.
    pub fn step(&mut self, name: &'static str, run: impl FnOnce() -> Result<Count, String>) -> bool {
        println!("\n── {name} ──");
        let start = Instant::now();
        let outcome = match run() {
            Ok(count) => Outcome::Ran(count),
            Err(message) => {
                eprintln!("error: {message}");
                Outcome::Failed(message)
            }
        };
        let passed = matches!(outcome, Outcome::Ran(Count { failed: 0, .. }));
        self.steps.push(Step { name, time: start.elapsed(), outcome });
        passed
    }

    /// Notes a step that cannot run here.
    pub fn skip(&mut self, name: &'static str, why: &str) {
        self.steps.push(Step { name, time: Duration::ZERO, outcome: Outcome::Skipped(why.to_owned()) });
    }

    /// Prints the table and, last, the line `N passed, N failed`.
    pub fn print(self) -> ExitCode {
        let mut total = Count::default();
        println!();
        for step in &self.steps {
            let (mark, note) = match &step.outcome {
                Outcome::Ran(count) => {
                    total.passed += count.passed;
                    total.failed += count.failed;
                    let note = if *count == ONE {
                        String::new()
                    } else {
                        format!("{} passed, {} failed", count.passed, count.failed)
                    };
                    (if count.failed == 0 { "pass" } else { "FAIL" }, note)
                }
                Outcome::Failed(message) => {
                    total.failed += 1;
                    ("FAIL", message.clone())
                }
                Outcome::Skipped(why) => ("skip", why.clone()),
            };
            let line = format!("  {mark}  {:<16} {:>7.1} s  {note}", step.name, step.time.as_secs_f64());
            println!("{}", line.trim_end());
        }
        println!("\n{} passed, {} failed", total.passed, total.failed);
        if total.failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}
