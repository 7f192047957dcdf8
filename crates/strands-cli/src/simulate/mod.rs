//! `strands simulate`: lets the rods of a scene move in time.

mod output;
mod table;

use std::path::PathBuf;
use std::time::Instant;

use indicatif::ProgressBar;
use strands::dynamics::{Damping, Integrator, Settings, Simulation, Start};
use strands_scene::write::{End, Frame, FrameEnergy, MovedRod, Ran, motion_json};
use strands_scene::{DynamicsFile, IntegratorName, MeshChoice, Model};

use crate::args::Simulate;
use crate::{Failure, interrupt, overrides, progress, say, source};
use output::Format;

/// What a scene leaves out.
const TIME_STEP: f64 = 1e-3;
const DURATION: f64 = 1.0;
const OUTPUT_RATE: f64 = 60.0;

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
    end: End,
    /// How long the steps took, s.
    seconds: f64,
}

/// The command.
///
/// # Errors
/// Bad arguments, scenes and files; and, once everything is said and written, a step that could not be made, or Ctrl-C.
pub fn run(options: &Simulate) -> Result<(), Failure> {
    let outputs: Vec<(&PathBuf, Format)> =
        options.output.iter().map(|path| Ok((path, Format::of(path)?))).collect::<Result<_, Failure>>()?;
    let mut source = source::read(&options.scene)?;
    source.text =
        overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    let model = source.parse()?.model;
    let plan = Plan::new(options, &model.dynamics)?;
    let mut rods = started(&model, &plan)?;
    // Until here there is nothing to keep.
    interrupt::catch()?;
    let bar = if options.json { ProgressBar::hidden() } else { progress::bar(plan.steps) };
    let Run { frames, steps, end, seconds } = stepped(&model, &plan, &mut rods, &bar);
    bar.finish_and_clear();
    let simulated = steps as f64 * plan.settings.time_step;
    let real_time_factor = if steps == 0 { 0.0 } else { simulated / seconds };
    let ran = Ran { steps, real_time_factor, end };
    for (path, format) in outputs {
        format.write(path, &model, &frames, &ran)?;
    }
    if options.json {
        say(&motion_json(&model, &frames, &ran))?;
    } else {
        say(table::table(&model, &plan.settings, &frames, &ran).trim_end())?;
    }
    match ran.end {
        End::Failed(_) => Err(Failure::Unsolved),
        End::Interrupted => Err(Failure::Interrupted),
        End::Finished => Ok(()),
    }
}

impl Plan {
    fn new(options: &Simulate, dynamics: &DynamicsFile) -> Result<Self, Failure> {
        let integrator = match dynamics.integrator.unwrap_or(IntegratorName::Bdf2) {
            IntegratorName::Bdf2 => Integrator::Bdf2,
            IntegratorName::ImplicitEuler => Integrator::ImplicitEuler,
            IntegratorName::Sdirk4 => Integrator::Sdirk4,
            name @ (IntegratorName::GeneralizedAlpha | IntegratorName::Midpoint) => {
                return Err(Failure::bad(format!(
                    "dynamics.integrator: {} is not there yet; use \"bdf2\", \"sdirk4\" or \"implicit_euler\"",
                    serde_json::json!(name)
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

/// The rods where they start.
fn started(model: &Model, plan: &Plan) -> Result<Vec<Simulation>, Failure> {
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
    Ok(rods)
}

/// Steps until it is done, a step cannot be made, or someone ends it.
fn stepped(model: &Model, plan: &Plan, rods: &mut [Simulation], bar: &ProgressBar) -> Run {
    let mut run = Run { frames: vec![frame(rods, 0, 0.0)], steps: 0, end: End::Finished, seconds: 0.0 };
    let (mut iterations, mut residual): (usize, f64) = (0, 0.0);
    while run.steps < plan.steps && run.end == End::Finished {
        let began = Instant::now();
        for (rod, of) in rods.iter_mut().zip(&model.rods) {
            match rod.step() {
                Ok(step) => {
                    iterations += step.iterations;
                    residual = residual.max(step.residual);
                }
                Err(failure) => {
                    let why = format!("rod `{}`: {failure}; a shorter time_step may be solved", of.name);
                    run.end = End::Failed(why);
                    return run;
                }
            }
        }
        run.seconds += began.elapsed().as_secs_f64();
        run.steps += 1;
        bar.inc(1);
        if run.steps < plan.steps && interrupt::asked() {
            run.end = End::Interrupted;
        }
        // The frame that is nearest to its time, and the last.
        let due = (run.frames.len() as f64 * plan.every).round() as usize;
        if run.steps == due || run.steps == plan.steps || run.end == End::Interrupted {
            run.frames.push(frame(rods, iterations, residual));
            (iterations, residual) = (0, 0.0);
        }
    }
    run
}

/// How the rods move now.
fn frame(rods: &[Simulation], iterations: usize, residual: f64) -> Frame {
    let mut energy = FrameEnergy::default();
    for budget in rods.iter().map(Simulation::energy) {
        energy.kinetic += budget.kinetic;
        energy.elastic += budget.elastic;
        energy.load += budget.load;
        energy.dissipated += budget.dissipated;
    }
    let moved = |rod: &Simulation| {
        let state = rod.state();
        MovedRod::new(&rod.problem().rod, &state.poses, &state.velocities, &state.wrenches)
    };
    Frame {
        time: rods[0].state().time,
        rods: rods.iter().map(moved).collect(),
        bodies: Vec::new(),
        energy,
        iterations,
        residual,
    }
}
