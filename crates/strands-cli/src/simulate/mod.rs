//! `strands simulate`: lets the rods of a scene move in time.

mod output;
mod table;

use std::path::PathBuf;
use std::time::Instant;

use indicatif::ProgressBar;
use strands::assembly::{Assembly, Member, Strand};
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::statics::Reaction;
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
    /// How long, and from frame to frame, s.
    seconds: f64,
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
    let mut simulation = started(&model, &plan)?;
    // Until here there is nothing to keep.
    interrupt::catch()?;
    let bar = if options.json { ProgressBar::hidden() } else { progress::bar() };
    let Run { frames, steps, end, seconds } = stepped(&plan, &mut simulation, &bar);
    bar.finish_and_clear();
    let simulated = simulation.state().time;
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
        let seconds = positive("--seconds", seconds)?.max(0.5 * time_step);
        let every = options.every.unwrap_or(1.0 / dynamics.output_rate.unwrap_or(OUTPUT_RATE));
        let every = positive("--every", every)?.max(time_step);
        let settings = Settings { integrator, time_step, ..Settings::default() };
        Ok(Self { settings, seconds, every, start })
    }
}

/// All where it starts.
fn started(model: &Model, plan: &Plan) -> Result<Simulation, Failure> {
    for rod in &model.rods {
        if matches!(rod.mesh, MeshChoice::Tolerance(_)) {
            eprintln!(
                "note: rod `{}` moves on 100 elements in place of those that `tolerance` asks for",
                rod.name
            );
        }
    }
    let strands =
        model.rods.iter().map(|rod| Strand { viscosity: rod.damping, ..rod.problem.clone().into() });
    let assembly = Assembly { strands: strands.collect(), ..Assembly::default() };
    Simulation::new(assembly, plan.settings, plan.start.clone())
        .map_err(|error| Failure::bad(error.to_string()))
}

/// Steps until it is done, a step cannot be made, or someone ends it.
fn stepped(plan: &Plan, simulation: &mut Simulation, bar: &ProgressBar) -> Run {
    let mut run = Run { frames: vec![frame(simulation, 0, 0.0)], steps: 0, end: End::Finished, seconds: 0.0 };
    // Nearer to a time than this, it has come.
    let near = if plan.settings.local_error.is_some() { 1e-6 } else { 0.5 } * plan.settings.time_step;
    let (mut iterations, mut residual): (usize, f64) = (0, 0.0);
    let has_come = |simulation: &Simulation, time: f64| simulation.state().time > time - near;
    while !has_come(simulation, plan.seconds) && run.end == End::Finished {
        let due = (run.frames.len() as f64 * plan.every).min(plan.seconds);
        let began = Instant::now();
        let step = match simulation.step_towards(due) {
            Ok(step) => step,
            Err(failure) => {
                run.end = End::Failed(format!("{failure}; a shorter time_step may be solved"));
                return run;
            }
        };
        run.seconds += began.elapsed().as_secs_f64();
        run.steps += 1;
        iterations += step.iterations;
        residual = residual.max(step.residual);
        bar.set_position((step.time / plan.seconds * progress::WHOLE as f64) as u64);
        if interrupt::asked() && !has_come(simulation, plan.seconds) {
            run.end = End::Interrupted;
        }
        // The frame that is nearest to its time, and the last.
        if has_come(simulation, due) || run.end == End::Interrupted {
            run.frames.push(frame(simulation, iterations, residual));
            (iterations, residual) = (0, 0.0);
        }
    }
    run
}

/// How all moves now.
fn frame(simulation: &Simulation, iterations: usize, residual: f64) -> Frame {
    let (assembly, state) = (simulation.assembly(), simulation.state());
    let moved = |(number, strand): (usize, &Strand)| {
        let (nodes, elements) = (assembly.nodes(number), assembly.elements(number));
        let problem = &strand.problem;
        let mut rod = MovedRod::new(
            &problem.rod,
            &state.poses[nodes.clone()],
            &state.velocities[nodes],
            &state.wrenches[elements],
        );
        let held = problem.supports().filter(|(_, support)| support.holds_anything());
        rod.reactions = held
            .map(|(node, _)| {
                let reaction = simulation.reaction(Member::Node { rod: number, node });
                let s = problem.rod.mesh().nodes()[node];
                Reaction { s, force: reaction.linear, moment: reaction.angular }
            })
            .collect();
        rod
    };
    let budget = simulation.energy();
    let energy = FrameEnergy {
        kinetic: budget.kinetic,
        elastic: budget.elastic,
        load: budget.load,
        dissipated: budget.dissipated,
        work: Some(budget.worked),
    };
    Frame {
        time: state.time,
        rods: assembly.strands.iter().enumerate().map(moved).collect(),
        bodies: Vec::new(),
        energy,
        iterations,
        residual,
    }
}
