//! `strands solve`: reads a scene, solves it, says and writes what was found.

use std::path::Path;
use std::time::Instant;

use strands::math::Vec3;
use strands::statics::{FailureReason, Solution, Workspace, solve};
use strands_scene::{Model, Scene};

use crate::args::Solve;
use crate::{Failure, colour_out, overrides, say, source, summary};

/// A solved scene.
#[derive(Debug)]
pub struct Outcome {
    /// Its name.
    pub scene: String,
    /// Gravity, m/s², world axes.
    pub gravity: Vec3,
    /// Its rods, in the scene's order.
    pub rods: Vec<RodOutcome>,
}

/// A solved rod.
#[derive(Debug)]
pub struct RodOutcome {
    /// Its name.
    pub name: String,
    /// Order of its discretisation.
    pub order: usize,
    /// The equilibrium, or what came nearest to one.
    pub solution: Solution,
    /// Why it is none.
    pub failure: Option<FailureReason>,
    /// How long the solve took, s.
    pub seconds: f64,
}

/// The command.
///
/// # Errors
/// Bad arguments, scenes and files; and, once everything is said and written, a solve that found no equilibrium.
pub fn run(options: &Solve) -> Result<(), Failure> {
    for path in &options.output {
        known_ending(path)?;
    }
    let mut source = source::read(&options.scene)?;
    source.text = overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    let scene = source.parse()?;
    let outcome = solve_all(&scene.model);
    for path in &options.output {
        write(path, &scene, &outcome)?;
    }
    if options.json {
        say(&json(&scene, &outcome))?;
    } else {
        say(&summary::summary(&outcome, colour_out()))?;
    }
    if outcome.rods.iter().any(|rod| rod.failure.is_some()) { Err(Failure::Unsolved) } else { Ok(()) }
}

fn solve_all(model: &Model) -> Outcome {
    let mut workspace = Workspace::default();
    let rods = model.rods.iter().map(|rod| {
        let start = Instant::now();
        let solved = solve(&rod.problem, &model.settings, None, &mut workspace);
        let seconds = start.elapsed().as_secs_f64();
        let (solution, failure) = match solved {
            Ok(solution) => (solution, None),
            Err(failure) => (*failure.nearest, Some(failure.reason)),
        };
        let order = rod.problem.rod.order().as_number();
        RodOutcome { name: rod.name.clone(), order, solution, failure, seconds }
    });
    Outcome { scene: model.name.clone(), gravity: model.gravity, rods: rods.collect() }
}

fn known_ending(_path: &Path) -> Result<(), Failure> { Ok(()) }
fn write(_path: &Path, _scene: &Scene, _outcome: &Outcome) -> Result<(), Failure> { Ok(()) }
fn json(_scene: &Scene, _outcome: &Outcome) -> String { String::new() }
