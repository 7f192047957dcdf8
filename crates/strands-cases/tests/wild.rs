//! Whatever is asked, there is an equilibrium or a reason: no panic, and no number that is none.
//!
//! `STRANDS_INPUTS` says how many questions are asked, `STRANDS_FIRST` from which number on.

use core::convert::Infallible;
use std::panic::{AssertUnwindSafe, catch_unwind};
use strands::statics::{
    FailureReason, PathError, Problem, Settings, Solution, SolveFailure, SolveReport, Workspace, equilibria,
    follow, follow_path, nearest, rest_from, solve, unstable_mode,
};
use strands_cases::wild::{self, Change, More, Question};

type Checked = Result<(), String>;

/// How far the places of supports may be missed, over the length; and forces and moments over the largest.
const MISSED: f64 = 1e-6;

/// What is wrong with a solution.
fn solved(problem: &Problem, settings: &Settings, solution: &Solution, workspace: &mut Workspace) -> Checked {
    let (residual, imbalance) = (solution.report.residual, solution.imbalance(problem));
    if !solution.is_finite() {
        return Err("a solution with a number that is none".into());
    }
    if residual.is_nan() || residual > settings.tolerance {
        return Err(format!("a solution with the residual {residual:e}"));
    }
    if imbalance.is_nan() || imbalance > MISSED {
        return Err(format!("a solution out of balance by {imbalance:e}"));
    }
    for (node, support) in problem.supports() {
        let away = support.shift_axes.transpose_mul(solution.poses[node].position - support.pose.position);
        let held = [away.x, away.y, away.z].into_iter().zip(&support.fixed[3..]);
        let missed = held.filter(|(_, fixed)| **fixed).map(|(away, _)| away.abs()).fold(0.0, f64::max);
        let size = problem.rod.length() + support.pose.position.norm();
        if missed > MISSED * size {
            return Err(format!("a solution whose support at node {node} is {missed:e} m away"));
        }
    }
    let Some(mode) = unstable_mode(problem, solution, workspace) else { return Ok(()) };
    let finite = mode.rotation.iter().chain(&mode.displacement).all(|part| part.is_finite());
    if !finite || mode.curvature.is_nan() || mode.curvature >= 0.0 {
        return Err(format!("an unstable mode that is none, of curvature {:e}", mode.curvature));
    }
    Ok(())
}

/// What is wrong with a failure.
fn failed(failure: &SolveFailure) -> Checked {
    let SolveFailure { reason, nearest } = failure;
    if !nearest.is_finite() {
        return Err(format!("a failure ({reason}) with a number that is none"));
    }
    reasonable(reason)
}

fn reasonable(reason: &FailureReason) -> Checked {
    let said = reason.to_string();
    if said.contains("NaN") { Err(format!("a reason that is none: {said}")) } else { Ok(()) }
}

/// What is wrong with an answer, of either kind.
fn answered(
    problem: &Problem,
    settings: &Settings,
    answer: &Result<Solution, SolveFailure>,
    workspace: &mut Workspace,
) -> Checked {
    match answer {
        Ok(solution) => solved(problem, settings, solution, workspace),
        Err(failure) => failed(failure),
    }
}

/// Asks, and gives whether there was a solution, or what is wrong.
fn ask(question: &Question, workspace: &mut Workspace) -> Result<bool, String> {
    let Question { problem, settings, more } = question;
    let answer = match more {
        More::Path(change, how) => {
            let family = |at| Ok::<_, Infallible>(change.made(problem, at));
            let path = match follow_path(family, how, workspace) {
                Ok(path) => path,
                Err(PathError::Start(failure)) => return failed(&failure).map(|()| false),
                Err(PathError::Problem(none)) => match none {},
            };
            for point in &path.points {
                solved(&change.made(problem, point.at), settings, &point.solution, workspace)
                    .map_err(|what| format!("on a path at {}: {what}", point.at))?;
            }
            return Ok(true);
        }
        More::All(how) => {
            return match equilibria(problem, how, workspace) {
                Err(reason) => reasonable(&reason).map(|()| false),
                Ok(all) => {
                    for solution in &all {
                        solved(problem, settings, solution, workspace)
                            .map_err(|what| format!("of all equilibria: {what}"))?;
                    }
                    Ok(!all.is_empty())
                }
            };
        }
        More::Follow(_) | More::Nothing => solve(problem, settings, None, workspace),
    };
    answered(problem, settings, &answer, workspace)?;
    if let (Ok(solution), More::Follow(change)) = (&answer, more) {
        go_on(problem, settings, solution, change, workspace)?;
    }
    Ok(answer.is_ok())
}

/// Asks for what comes after a solution when the problem changes, in each of the ways that there are.
fn go_on(
    problem: &Problem,
    settings: &Settings,
    last: &Solution,
    change: &Change,
    workspace: &mut Workspace,
) -> Checked {
    let (mut guess, mut report) = (last.guess, SolveReport::default());
    for part in [0.1, 0.2] {
        let moved = change.made(problem, part);
        if follow(&moved, settings, &mut guess, workspace, &mut report)
            && !workspace.poses().iter().all(|pose| pose.is_finite())
        {
            return Err("a frame of an interactive loop with a number that is none".into());
        }
    }
    let changed = change.made(problem, 1.0);
    let answer = solve(&changed, settings, Some(&last.guess), workspace);
    answered(&changed, settings, &answer, workspace).map_err(|what| format!("from a guess: {what}"))?;
    let answer = nearest(&changed, settings, Some(&guess), workspace);
    answered(&changed, settings, &answer, workspace).map_err(|what| format!("the nearest: {what}"))?;
    let answer = rest_from(&changed, settings, last, workspace);
    answered(&changed, settings, &answer, workspace).map_err(|what| format!("moved on: {what}"))
}

/// How questions were answered.
#[derive(Default)]
struct Tally {
    asked: u64,
    solved: u64,
    wrong: Vec<String>,
}

impl Tally {
    fn ask(&mut self, number: u64, workspace: &mut Workspace) {
        let Ok(question) = wild::question(number) else { return };
        self.asked += 1;
        match catch_unwind(AssertUnwindSafe(|| ask(&question, workspace))) {
            Err(_) => {
                *workspace = Workspace::default();
                self.wrong.push(format!("{number}: panic"));
            }
            Ok(Err(what)) => self.wrong.push(format!("{number}: {what}")),
            Ok(Ok(solved)) => self.solved += u64::from(solved),
        }
    }
}

#[test]
fn whatever_is_asked_there_is_an_equilibrium_or_a_reason() {
    let number = |name, default| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let (first, inputs) = (number("STRANDS_FIRST", 0), number("STRANDS_INPUTS", 1_000));
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    std::panic::set_hook(Box::new(|_| {}));
    let share = |thread: u64| {
        move || {
            let (mut workspace, mut tally) = (Workspace::default(), Tally::default());
            for number in (first + thread..first + inputs).step_by(threads as usize) {
                tally.ask(number, &mut workspace);
            }
            tally
        }
    };
    let running: Vec<_> = (0..threads).map(|thread| std::thread::spawn(share(thread))).collect();
    let tallies: Vec<_> = running.into_iter().map(|thread| thread.join().unwrap()).collect();
    let _ = std::panic::take_hook();
    let asked: u64 = tallies.iter().map(|tally| tally.asked).sum();
    let solved: u64 = tallies.iter().map(|tally| tally.solved).sum();
    let wrong: Vec<String> = tallies.into_iter().flat_map(|tally| tally.wrong).collect();
    println!("{inputs} from {first}: {asked} asked, {solved} solved, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{}", wrong[..wrong.len().min(20)].join("\n"));
    assert!(solved > inputs / 3, "{solved} of {inputs}");
}
