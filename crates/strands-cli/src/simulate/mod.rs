//! `strands simulate`: lets the rods of a scene move in time.

mod output;
mod table;

use std::path::{Path, PathBuf};
use std::time::Instant;

use indicatif::ProgressBar;
use strands::assembly::{Member, Strand};
use strands::dynamics::{Integrator, Settings, Simulation, SimulationError, Start, StepFailure};
use strands::statics::{Reaction, Support};
use strands_scene::write::{End, Frame, FrameEnergy, MovedBody, MovedRod, Ran, motion_json};
use strands_scene::{MeshChoice, Model, ModelBody, OUTPUT_RATE, read_state, state_json};

use crate::args::Simulate;
use crate::source::Source;
use crate::units::engineering;
use crate::{Failure, interrupt, overrides, progress, say, source, tell};
use output::Format;

/// What a scene leaves out.
const DURATION: f64 = 1.0;

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
    keep_apart(options)?;
    let mut source = source::read(&options.scene)?;
    source.text =
        overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    let model = source.parse()?.model;
    let plan = Plan::new(options, &source, &model)?;
    let mut simulation = started(&model, &plan)?;
    // Until here there is nothing to keep.
    interrupt::catch()?;
    let bar = if options.json { ProgressBar::hidden() } else { progress::bar() };
    let Run { frames, steps, end, seconds } = stepped(&model, &plan, &mut simulation, &bar);
    bar.finish_and_clear();
    if end == End::Finished {
        tell_the_end(&plan, &simulation, frames[0].time);
    }
    let simulated = simulation.state().time - frames[0].time;
    let real_time_factor = if steps == 0 { 0.0 } else { simulated / seconds };
    let ran = Ran { steps, real_time_factor, end };
    if let Some(path) = &options.save {
        let text = state_json(&model, simulation.state());
        std::fs::write(path, text).map_err(|error| Failure::file(path.display(), &error))?;
    }
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

/// Sees that no file is written over the scene, or twice.
fn keep_apart(options: &Simulate) -> Result<(), Failure> {
    let place = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut taken = vec![place(options.scene.as_ref())];
    for path in options.output.iter().chain(&options.save) {
        if taken.contains(&place(path)) {
            let path = path.display();
            return Err(Failure::bad(format!(
                "{path}: this would be written over the scene, or twice; give each its own name"
            )));
        }
        taken.push(place(path));
    }
    Ok(())
}

impl Plan {
    fn new(options: &Simulate, source: &Source, model: &Model) -> Result<Self, Failure> {
        let (settings, dynamics) = (model.motion(), &model.dynamics);
        if let Some(fault) = fault_of(settings.integrator, model) {
            tell(&format!("note: {fault}; tr_bdf2 and bdf2 do not"));
        }
        let start = match (model.start(), &dynamics.start) {
            (None, Some(file)) => saved(model, &source.beside(file))?,
            (start, _) => start.unwrap_or(Start::Equilibrium),
        };
        let positive = |name: &str, value: f64| {
            let fits = value > 0.0 && value.is_finite();
            if fits { Ok(value) } else { Err(Failure::bad(format!("{name}: give a number greater than 0"))) }
        };
        let seconds = options.seconds.or(dynamics.duration).unwrap_or(DURATION);
        let seconds = positive("--seconds", seconds)?;
        let of_seconds = if options.seconds.is_some() { "--seconds" } else { "dynamics.duration" };
        let asked = options.every.or(dynamics.output_rate.map(|rate| 1.0 / rate));
        let every = positive("--every", asked.unwrap_or(1.0 / OUTPUT_RATE))?;
        if settings.local_error.is_some() {
            return Ok(Self { settings, seconds, every, start });
        }
        let (step, shown) = (settings.time_step, |seconds: f64| engineering(seconds, "s"));
        if seconds < 0.5 * step {
            return Err(Failure::bad(format!(
                "{of_seconds}: {} are less than half a step of {}: nothing would move; give more, or a shorter `dynamics.time_step`",
                shown(seconds),
                shown(step)
            )));
        }
        if asked.is_some_and(|every| every < (1.0 - SAME_TIME) * step) {
            tell(&format!("note: frames are {} apart, a step, and not {}", shown(step), shown(every)));
        }
        Ok(Self { settings, seconds, every: every.max(step), start })
    }
}

/// What an integrator does wrong with the rods of a scene.
fn fault_of(integrator: Integrator, model: &Model) -> Option<String> {
    let rod = model.inextensible().filter(|_| integrator == Integrator::Sdirk4)?;
    Some(format!("sdirk4 gains energy where rods that do not stretch, as `{}`, turn", rod.name))
}

/// The state in a file.
fn saved(model: &Model, path: &Path) -> Result<Start, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::bad(format!(
            "dynamics.start: {} cannot be read ({error}): give \"equilibrium\", \"rest\", \"initial\" or the file of a saved state",
            path.display()
        ))
    })?;
    let state = read_state(model, &text)
        .map_err(|error| Failure::bad(format!("dynamics.start: {}: {error}", path.display())))?;
    Ok(Start::State(Box::new(state)))
}

/// All where it starts.
fn started(model: &Model, plan: &Plan) -> Result<Simulation, Failure> {
    for rod in &model.rods {
        if matches!(rod.mesh, MeshChoice::Tolerance(_)) {
            tell(&format!(
                "note: rod `{}` moves on 100 elements in place of those that `tolerance` asks for",
                rod.name
            ));
        }
    }
    model
        .simulation(plan.settings, plan.start.clone())
        .map_err(|error| Failure::bad(with_names(model, &error)))
}

/// That it does not end when it is asked to, where steps that are all alike end before or after.
fn tell_the_end(plan: &Plan, simulation: &Simulation, began: f64) {
    let seconds = simulation.state().time - began;
    if (seconds - plan.seconds).abs() > 1e-6 * plan.seconds {
        let (step, asked) = (engineering(plan.settings.time_step, "s"), engineering(plan.seconds, "s"));
        let seconds = engineering(seconds, "s");
        tell(&format!("note: whole steps of {step} make {seconds}, not {asked}"));
    }
}

/// An error with the rod's name in place of its number.
fn with_names(model: &Model, error: &SimulationError) -> String {
    let text = match (error, &model.dynamics.start) {
        (
            SimulationError::Unfit { .. } | SimulationError::NotFinite | SimulationError::Assembly(_),
            Some(file),
        ) if !matches!(file.as_str(), "rest" | "initial" | "equilibrium") => {
            format!("dynamics.start: {file}: {error}")
        }
        _ => error.to_string(),
    };
    // The greater number first: it may begin as the lesser one. A state may name rods that the scene has not.
    let mut rods = error.rods();
    rods.sort_unstable_by(|a, b| b.cmp(a));
    rods.dedup();
    rods.into_iter().fold(text, |text, rod| match model.rods.get(rod) {
        Some(named) => text.replace(&format!("rod {rod}"), &format!("rod `{}`", named.name)),
        None => text,
    })
}

/// Steps until it is done, a step cannot be made, or someone ends it.
fn stepped(model: &Model, plan: &Plan, simulation: &mut Simulation, bar: &ProgressBar) -> Run {
    let mut run =
        Run { frames: vec![frame(model, simulation, 0, 0.0)], steps: 0, end: End::Finished, seconds: 0.0 };
    let (mut iterations, mut residual): (usize, f64) = (0, 0.0);
    let start = simulation.state().time;
    let end = start + plan.seconds;
    // A run that goes on has its frames at the same times, to the bit, as one that was not ended.
    let before = start / plan.every;
    let before = if (before - before.round()).abs() < SAME_TIME { before.round() } else { before };
    let last = (before + (plan.seconds / plan.every).round()) * plan.every;
    let end = if (last - end).abs() < SAME_TIME * plan.every { last } else { end };
    while !simulation.has_come_to(end) && run.end == End::Finished {
        let due = ((before + run.frames.len() as f64) * plan.every).min(end);
        let began = Instant::now();
        let step = match simulation.step_towards(due) {
            Ok(step) => step,
            Err(failure) => {
                run.end = End::Failed(format!("{failure}; {}", mend(model, simulation, &failure)));
                if simulation.state().time > run.frames[run.frames.len() - 1].time {
                    let mut last = frame(model, simulation, iterations, residual);
                    // What was solved last is the step that failed.
                    last.rods.iter_mut().for_each(|rod| rod.reactions.clear());
                    run.frames.push(last);
                }
                return run;
            }
        };
        run.seconds += began.elapsed().as_secs_f64();
        run.steps += 1;
        iterations += step.iterations;
        residual = residual.max(step.residual);
        bar.set_position(((step.time - start) / plan.seconds * progress::WHOLE as f64) as u64);
        if interrupt::asked() && !simulation.has_come_to(end) {
            run.end = End::Interrupted;
        }
        // The frame that is nearest to its time, and the last.
        if simulation.has_come_to(due) || simulation.has_come_to(end) || run.end == End::Interrupted {
            run.frames.push(frame(model, simulation, iterations, residual));
            (iterations, residual) = (0, 0.0);
        }
    }
    run
}

/// Times that are nearer than this part of the time from frame to frame are the same.
const SAME_TIME: f64 = 1e-6;

/// An element that is bent by more than this, rad, stands for too much of its rod.
const SHARP: f64 = 1.0;

/// What may help where a step cannot be made.
fn mend(model: &Model, simulation: &Simulation, failure: &StepFailure) -> String {
    let (assembly, state) = (simulation.assembly(), simulation.state());
    let [longer, shorter] = match model.dynamics.tolerance {
        Some(_) => ["a larger tolerance", "a smaller tolerance"],
        None => ["a longer time_step", "a shorter time_step"],
    };
    match failure {
        StepFailure::TooShort { .. } => return format!("take {longer}"),
        StepFailure::Blocked { .. } => {
            return "move them less far, or where nothing is in their way".to_owned();
        }
        StepFailure::NotConverged { .. } | StepFailure::Singular { .. } => {}
    }
    let bend = |rod: usize| {
        let pairs = state.poses[assembly.nodes(rod)].windows(2);
        pairs.map(|pair| pair[0].rotation.turn_to(&pair[1].rotation).norm()).fold(0.0, f64::max)
    };
    let bends = model.rods.iter().enumerate().map(|(rod, of)| (of, bend(rod)));
    let sharpest = bends.max_by(|(_, a), (_, b)| a.total_cmp(b)).filter(|(_, bend)| *bend > SHARP);
    if let Some((rod, bend)) = sharpest {
        return format!(
            "an element of rod `{}` is bent by {bend:.1} rad: give it more `elements`, or more `damping` to its material",
            rod.name
        );
    }
    if let Some(supports) = mend_of_supports(model, simulation, shorter) {
        return supports;
    }
    if let Some(iterations) = model.dynamics.newton_iterations {
        return format!("newton_iterations = {iterations} may be too few, or {shorter} may be solved");
    }
    if let Some(fault) = fault_of(simulation.settings().integrator, model) {
        return format!("{fault}: take tr_bdf2 or bdf2");
    }
    match model.inextensible() {
        Some(rod) => {
            format!("{longer} may be solved, or kinematics = \"cosserat\" for rod `{}`", rod.name)
        }
        None => format!("{shorter} may be solved"),
    }
}

/// The same where supports move further than a rod is long, or by more than an element in a step.
fn mend_of_supports(model: &Model, simulation: &Simulation, shorter: &str) -> Option<String> {
    let (assembly, state) = (simulation.assembly(), simulation.state());
    for (number, (rod, strand)) in model.rods.iter().zip(&assembly.strands).enumerate() {
        if let Some(stretch) = strand.problem.out_of_reach() {
            let [apart, length] =
                [stretch.chord.norm(), stretch.length].map(|metres| engineering(metres, "m"));
            return Some(format!(
                "supports of rod `{}` are then {apart} apart, and the rod between them is {length} long and does not stretch: move them less far, or take kinematics = \"cosserat\"",
                rod.name
            ));
        }
        let first = assembly.nodes(number).start;
        let moved = |(node, support): (usize, &Support)| {
            let apart = support.pose.position - state.poses[first + node].position;
            let along =
                (0..3).filter(|k| support.fixed[3 + k]).map(|k| support.shift_axes.cols[k].dot(apart).abs());
            along.fold(0.0, f64::max)
        };
        let far = strand.problem.supports().map(moved).fold(0.0, f64::max);
        let elements = (0..strand.problem.rod.elements()).map(|e| strand.problem.rod.element_length(e));
        let element = elements.fold(f64::INFINITY, f64::min);
        if far > element {
            let [far, element] = [far, element].map(|metres| engineering(metres, "m"));
            return Some(format!(
                "a support of rod `{}` moves by {far} in that step, and an element is {element} long: take {shorter}",
                rod.name
            ));
        }
    }
    None
}

/// How all moves now.
fn frame(model: &Model, simulation: &Simulation, iterations: usize, residual: f64) -> Frame {
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
    let body = |(body, frame): (&ModelBody, usize)| MovedBody {
        name: body.name.clone(),
        pose: state.poses[frame],
        velocity: state.velocities[frame],
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
        bodies: model.bodies.iter().zip(assembly.first_body()..).map(body).collect(),
        contacts: state.contacts.clone(),
        passages: state.passages.clone(),
        energy,
        iterations,
        residual,
    }
}
