//! `strands solve`: reads a scene, solves it, says and writes what was found.

use std::path::{Path, PathBuf};
use std::time::Instant;

use strands::statics::{RefineError, Solution, Workspace, solve};
use strands_scene::{MeshError, Model, write};

use crate::args::Solve;
use crate::ending::format_of;
use crate::{Failure, check, colour_out, many, overrides, say, source, summary, tell};

/// A solved scene.
#[derive(Debug)]
pub struct Outcome {
    /// The scene, each rod on the mesh that it was solved on.
    pub model: Model,
    /// The rods that were solved, in the scene's order. The first failure ends it.
    pub solved: Vec<SolvedRod>,
    /// The rod for which no equilibrium was found, or none within its tolerance.
    pub failed: Option<FailedRod>,
    /// How long all of it took, s.
    pub seconds: f64,
}

/// A rod and its equilibrium.
#[derive(Debug)]
pub struct SolvedRod {
    /// The rod's name.
    pub name: String,
    /// The equilibrium.
    pub solution: Solution,
    /// How long the solve took, s.
    pub seconds: f64,
}

/// A rod without an equilibrium.
#[derive(Debug)]
pub struct FailedRod {
    /// The rod's name.
    pub name: String,
    /// Why there is none, or none within the tolerance.
    pub reason: String,
    /// What came nearest.
    pub nearest: Solution,
}

/// The command.
///
/// # Errors
/// Bad arguments, scenes and files; and, once everything is said and written, a solve that found no equilibrium.
pub fn run(options: &Solve) -> Result<(), Failure> {
    let outputs: Vec<(&PathBuf, Format)> =
        options.output.iter().map(|path| Ok((path, Format::of(path)?))).collect::<Result<_, Failure>>()?;
    let mut source = source::read(&options.scene)?;
    source.text =
        overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    if options.all {
        return many::all(options, &source, &outputs);
    }
    if let Some(path) = &options.path {
        return many::path(options, &source, path, &outputs);
    }
    let scene = source.parse_alone()?;
    check::warn(&scene.remarks());
    let outcome = solve_all(scene.model)?;
    for (path, format) in outputs {
        match format.bytes(&outcome) {
            Some(bytes) => {
                std::fs::write(path, bytes).map_err(|error| Failure::file(path.display(), &error))?
            }
            None => tell(&format!("note: {} is not written: there is no solution to show", path.display())),
        }
    }
    if options.json {
        say(&json(&outcome))?;
    } else {
        say(&summary::summary(&outcome, colour_out()))?;
    }
    if outcome.failed.is_some() { Err(Failure::Unsolved) } else { Ok(()) }
}

fn solve_all(mut model: Model) -> Result<Outcome, Failure> {
    let start = Instant::now();
    let mut workspace = Workspace::default();
    let names: Vec<String> = model.rods.iter().map(|rod| rod.name.clone()).collect();
    let (mut solved, mut failed) = (Vec::with_capacity(names.len()), None);
    for name in names {
        match solve_rod(&mut model, name, &mut workspace)? {
            Ok(rod) => solved.push(rod),
            Err(rod) => {
                failed = Some(rod);
                break;
            }
        }
    }
    Ok(Outcome { model, solved, failed, seconds: start.elapsed().as_secs_f64() })
}

/// Chooses a rod's mesh, if it is to be chosen, and solves the rod. What fails is the outer error where the scene is at fault.
fn solve_rod(
    model: &mut Model,
    name: String,
    workspace: &mut Workspace,
) -> Result<Result<SolvedRod, FailedRod>, Failure> {
    match model.refine(&name) {
        Ok(()) => {}
        // No equilibrium on one of the meshes that were tried: there is none to be expected on the first one either, and its answer says why.
        Err(MeshError { reason: RefineError::Solve(_), .. }) => {}
        Err(MeshError { reason, .. }) => {
            let said = reason.to_string();
            let RefineError::TooFine { nearest, .. } = reason else {
                return Err(Failure::bad(format!("no mesh for rod `{name}`: {said}")));
            };
            return Ok(Err(FailedRod { name, reason: said, nearest: nearest.solution }));
        }
    }
    let Some(rod) = model.rod(&name) else { unreachable!("the names are the model's") };
    let start = Instant::now();
    let solution = solve(&rod.problem, &model.settings, None, workspace);
    let seconds = start.elapsed().as_secs_f64();
    Ok(match solution {
        Ok(solution) => Ok(SolvedRod { name, solution, seconds }),
        Err(failure) => {
            Err(FailedRod { name, reason: failure.reason.to_string(), nearest: *failure.nearest })
        }
    })
}

/// The answer as one JSON object.
fn json(outcome: &Outcome) -> String {
    let Outcome { model, failed, seconds, .. } = outcome;
    match failed {
        Some(FailedRod { name, reason, nearest }) => {
            let solved = solutions(outcome);
            write::failure_json(model, name, reason, &nearest.report, &solved, Some(*seconds))
        }
        None => write::json(model, &solutions(outcome), Some(*seconds)),
    }
}

fn solutions(outcome: &Outcome) -> Vec<(&str, &Solution)> {
    outcome.solved.iter().map(|rod| (rod.name.as_str(), &rod.solution)).collect()
}

/// What a result can be written as.
#[derive(Clone, Copy, Debug)]
pub enum Format {
    Json,
    Csv,
    Vtp,
    Glb,
    Svg,
}

impl Format {
    const ALL: [(&str, Self); 5] = [
        ("json", Self::Json),
        ("csv", Self::Csv),
        ("vtp", Self::Vtp),
        ("glb", Self::Glb),
        ("svg", Self::Svg),
    ];

    /// The format that a file's ending asks for.
    fn of(path: &Path) -> Result<Self, Failure> {
        format_of(path, "a result is written", &Self::ALL)
    }

    /// Several solutions of rods of a model, in all formats but JSON.
    pub fn shapes(self, model: &Model, solutions: &[(&str, &Solution)]) -> Option<Vec<u8>> {
        Some(match self {
            Self::Json => return None,
            Self::Csv => write::csv(model, solutions).into_bytes(),
            Self::Vtp => write::vtp(model, solutions).into_bytes(),
            Self::Glb => write::glb(model, solutions),
            Self::Svg => write::svg(model, solutions).into_bytes(),
        })
    }

    /// The file's bytes. `None` where there is nothing to show, since the solve failed; only JSON can say so.
    fn bytes(self, outcome: &Outcome) -> Option<Vec<u8>> {
        if outcome.failed.is_some() && !matches!(self, Self::Json) {
            return None;
        }
        self.shapes(&outcome.model, &solutions(outcome)).or_else(|| Some(json(outcome).into_bytes()))
    }
}
