//! Instruction counts: this program runs itself under callgrind, which counts the same whatever else the machine does.

use std::process::{Command, Stdio};

use strands::statics::{Guess, Settings, Workspace};

use super::{BenchError, ELEMENTS, Figure, SWEEPS, again, figure, problems, solved, sweep_runs};

/// A search that is stopped before its first step, and after it: they differ by a sweep and a Jacobian.
const HELD: [&str; 2] = ["held.look", "held.step"];
/// How often a kernel is run for a count, and how often for the count that is taken off it.
const RUNS: [usize; 2] = [30, 10];

/// Counts the instructions that an element takes in each kernel.
pub fn count() -> Result<Vec<Figure>, BenchError> {
    let mut figures = Vec::new();
    for (name, ..) in SWEEPS {
        let name = format!("sweep.{name}");
        figures.push(figure(format!("{name}.instructions"), each(&name)?, "instructions an element"));
    }
    let [look, step] = [each(HELD[0])?, each(HELD[1])?];
    figures.push(figure("jacobian.instructions", step - 2.0 * look, "instructions an element"));
    Ok(figures)
}

/// Instructions of one run of a kernel, over its elements.
fn each(kernel: &str) -> Result<f64, BenchError> {
    let [more, fewer] = [collected(kernel, RUNS[0])?, collected(kernel, RUNS[1])?];
    Ok((more - fewer) / ((RUNS[0] - RUNS[1]) * ELEMENTS) as f64)
}

/// Instructions of the whole program when it runs a kernel so many times.
fn collected(kernel: &str, times: usize) -> Result<f64, BenchError> {
    let failed = |why: String| BenchError::Count(why);
    let program = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["bench", "--kernel", kernel, "--times", &times.to_string()])
        .stdin(Stdio::null())
        .output()
        .map_err(|error| {
            failed(format!("valgrind does not start ({error}); `apt install valgrind` brings it"))
        })?;
    let said = String::from_utf8_lossy(&output.stderr);
    let total = said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    total.ok_or_else(|| failed(format!("valgrind gives no count:\n{said}")))
}

/// Runs a kernel so many times.
pub fn run(kernel: &str, times: usize) -> Result<(), BenchError> {
    let sweep = SWEEPS.iter().position(|(name, ..)| kernel.strip_prefix("sweep.") == Some(name));
    let mut run = match (sweep, HELD.iter().position(|name| *name == kernel)) {
        (Some(sweep), _) => sweep_runs()?.swap_remove(sweep),
        (None, Some(steps)) => held(steps)?,
        (None, None) => return Err(BenchError::Count(format!("there is no kernel `{kernel}`"))),
    };
    (0..times).for_each(|_| run());
    Ok(())
}

/// A search for a moved end, stopped after so many steps.
fn held(steps: usize) -> Result<Box<dyn FnMut()>, BenchError> {
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    let mut problem = problems::held(ELEMENTS, problems::home())?;
    let found = solved(&problem, &settings, None, &mut Workspace::default())?.guess;
    problem.end.pose = problems::wander(1)[0];
    let settings = Settings { max_iterations: steps, ..settings };
    Ok(again(problem, settings, Guess::new(found.pose, found.wrench)))
}
