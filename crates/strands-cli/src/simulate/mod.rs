//! `strands simulate`: lets the rods of a scene move in time.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use strands::dynamics::{Damping, Integrator, Settings, Simulation, Start};
use strands_scene::write::{Frame, Moved, motion_csv, motion_json};
use strands_scene::{DynamicsFile, IntegratorName, MeshChoice, Model};

use crate::args::Simulate;
use crate::units::engineering;
use crate::{Failure, overrides, say, source};

/// What a scene leaves out.
const TIME_STEP: f64 = 1e-3;
const DURATION: f64 = 1.0;
const OUTPUT_RATE: f64 = 60.0;
/// Rows of the table.
const ROWS: usize = 24;

/// How a scene is simulated.
struct Plan {
    settings: Settings,
    steps: usize,
    /// Steps from frame to frame.
    every: f64,
    start: Start,
}

/// What came of it.
struct Run {
    frames: Vec<Frame>,
    steps: usize,
    failure: Option<String>,
    /// How long the steps took, s.
    seconds: f64,
}

/// The command.
///
/// # Errors
/// Bad arguments, scenes and files; and, once everything is said and written, a step that could not be made.
pub fn run(options: &Simulate) -> Result<(), Failure> {
    for path in &options.output {
        ending(path)?;
    }
    let mut source = source::read(&options.scene)?;
    source.text =
        overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    let model = source.parse()?.model;
    let plan = Plan::new(options, &model.dynamics)?;
    let run = simulated(&model, &plan)?;
    let time_step = plan.settings.time_step;
    let factor = run.steps as f64 * time_step / run.seconds;
    let json = || motion_json(&model, &run.frames, run.steps, factor, run.failure.as_deref());
    for path in &options.output {
        let text = if ending(path)? == "csv" { motion_csv(&model, &run.frames) } else { json() };
        std::fs::write(path, text).map_err(|error| Failure::file(path.display(), &error))?;
    }
    if options.json {
        say(&json())?;
    } else {
        say(summary(&model, &plan, &run, factor).trim_end())?;
    }
    if run.failure.is_some() { Err(Failure::Unsolved) } else { Ok(()) }
}

fn ending(path: &Path) -> Result<&str, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.filter(|ending| ["json", "csv"].contains(ending)).ok_or_else(|| {
        Failure::bad(format!(
            "{}: frames are written by the file's ending, one of .json .csv",
            path.display()
        ))
    })
}

impl Plan {
    fn new(options: &Simulate, dynamics: &DynamicsFile) -> Result<Self, Failure> {
        let integrator = match dynamics.integrator.unwrap_or(IntegratorName::Bdf2) {
            IntegratorName::Bdf2 => Integrator::Bdf2,
            IntegratorName::ImplicitEuler => Integrator::ImplicitEuler,
            IntegratorName::Sdirk4 => Integrator::Sdirk4,
            name @ (IntegratorName::GeneralizedAlpha | IntegratorName::Midpoint) => {
                return Err(Failure::bad(format!(
                    "dynamics.integrator: {name:?} is not there yet; use \"bdf2\", \"sdirk4\" or \"implicit_euler\""
                )));
            }
        };
        if dynamics.tolerance.is_some() {
            let message = "dynamics.tolerance: steps are not chosen by their error yet; give `time_step`";
            return Err(Failure::bad(message));
        }
        let start = match dynamics.start.as_deref().unwrap_or("equilibrium") {
            "equilibrium" => Start::Equilibrium,
            "rest" => Start::Rest,
            other => {
                return Err(Failure::bad(format!(
                    "dynamics.start: \"{other}\" is neither \"equilibrium\" nor \"rest\""
                )));
            }
        };
        let positive = |name: &str, value: f64| {
            let fits = value > 0.0 && value.is_finite();
            if fits { Ok(value) } else { Err(Failure::bad(format!("{name}: give a number greater than 0"))) }
        };
        let time_step = dynamics.time_step.unwrap_or(TIME_STEP);
        let seconds = options.seconds.or(dynamics.duration).unwrap_or(DURATION);
        let steps = (positive("--seconds", seconds)? / time_step).round().max(1.0);
        let every = options.every.unwrap_or(1.0 / dynamics.output_rate.unwrap_or(OUTPUT_RATE));
        let every = (positive("--every", every)? / time_step).max(1.0);
        let settings = Settings { integrator, time_step, ..Settings::default() };
        Ok(Self { settings, steps: steps as usize, every, start })
    }
}

fn simulated(model: &Model, plan: &Plan) -> Result<Run, Failure> {
    let mut rods = Vec::with_capacity(model.rods.len());
    for rod in &model.rods {
        if matches!(rod.mesh, MeshChoice::Tolerance(_)) {
            eprintln!(
                "note: rod `{}` moves on 100 elements in place of those that `tolerance` asks for",
                rod.name
            );
        }
        let damping = Damping { viscous: rod.damping, mass: 0.0 };
        let settings = Settings { damping, ..plan.settings };
        let rod = Simulation::new(rod.problem.clone(), settings, plan.start.clone())
            .map_err(|error| Failure::bad(format!("rod `{}`: {error}", rod.name)))?;
        rods.push(rod);
    }
    let frame = |rods: &[Simulation], iterations, residual| Frame {
        time: rods[0].state().time,
        rods: rods.iter().map(|rod| Moved { state: rod.state().clone(), energy: rod.energy() }).collect(),
        iterations,
        residual,
    };
    let mut run = Run { frames: vec![frame(&rods, 0, 0.0)], steps: 0, failure: None, seconds: 0.0 };
    let (mut iterations, mut residual): (usize, f64) = (0, 0.0);
    while run.steps < plan.steps {
        let began = Instant::now();
        for (rod, of) in rods.iter_mut().zip(&model.rods) {
            match rod.step() {
                Ok(step) => {
                    iterations += step.iterations;
                    residual = residual.max(step.residual);
                }
                Err(failure) => {
                    run.failure =
                        Some(format!("rod `{}`: {failure}; a shorter time_step may be solved", of.name));
                    return Ok(run);
                }
            }
        }
        run.seconds += began.elapsed().as_secs_f64();
        run.steps += 1;
        // The frame that is nearest to its time.
        let due = (run.frames.len() as f64 * plan.every).round() as usize;
        if run.steps == due || run.steps == plan.steps {
            run.frames.push(frame(&rods, iterations, residual));
            (iterations, residual) = (0, 0.0);
        }
    }
    Ok(run)
}

fn summary(model: &Model, plan: &Plan, run: &Run, factor: f64) -> String {
    let mut out = format!("{}\n", model.name);
    let header = ["time", "kinetic", "elastic", "of loads", "dissipated"];
    let [time, kinetic, elastic, load, dissipated] = header;
    let _ = writeln!(
        out,
        "  {time:>10}  {kinetic:>11}  {elastic:>11}  {load:>11}  {dissipated:>11}  end of {}, m",
        model.rods[0].name
    );
    let each = run.frames.len().div_ceil(ROWS);
    for (i, frame) in run.frames.iter().enumerate() {
        if i % each != 0 && i + 1 != run.frames.len() {
            continue;
        }
        let energy = |of: fn(&Moved) -> f64| engineering(frame.rods.iter().map(of).sum(), "J");
        let poses = &frame.rods[0].state.poses;
        let end = poses[poses.len() - 1].position;
        let _ = writeln!(
            out,
            "  {:>8.4} s  {:>11}  {:>11}  {:>11}  {:>11}  ({:.4}, {:.4}, {:.4})",
            frame.time,
            energy(|rod| rod.energy.kinetic),
            energy(|rod| rod.energy.elastic),
            energy(|rod| rod.energy.load),
            energy(|rod| rod.energy.dissipated),
            end.x,
            end.y,
            end.z
        );
    }
    let _ = writeln!(
        out,
        "  {} steps of {} by {}, {} a step: {factor:.1} times as fast as real time",
        run.steps,
        engineering(plan.settings.time_step, "s"),
        plan.settings.integrator.name(),
        engineering(run.seconds / run.steps.max(1) as f64, "s")
    );
    let total = |frame: &Frame| frame.rods.iter().map(|rod| rod.energy.total()).sum::<f64>();
    let taken = total(&run.frames[0]) - total(&run.frames[run.frames.len() - 1]);
    let _ = writeln!(
        out,
        "  {} of energy {} by the integrator",
        engineering(taken.abs(), "J"),
        if taken < 0.0 { "added" } else { "taken" }
    );
    if let Some(failure) = &run.failure {
        let _ = writeln!(out, "  failed: {failure}");
    }
    out
}
