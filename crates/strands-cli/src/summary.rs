//! What a person reads after a solve.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};
use strands::math::{Pose, Vec3};
use strands::rod::{Rod, Scale};
use strands::statics::{Problem, Solution, UnstableMode, Workspace, unstable_mode};
use strands_scene::Model;

use crate::drawing::{Drawing, draw};
use crate::solve::{FailedRod, Outcome, SolvedRod};
use crate::units::engineering;

/// What a number must exceed, as a part of the largest of its kind, to be more than round-off.
const ROUND_OFF: f64 = 1e-11;

/// The summary of a scene: a picture, then for each rod what was found and how.
pub fn summary(outcome: &Outcome, colour: bool) -> String {
    let paint = Paint(colour);
    let mut out = picture(outcome, paint);
    let _ = writeln!(out, "{}", paint.with(Style::new().bold(), &outcome.model.name));
    let several = outcome.model.rods.len() > 1;
    for rod in &outcome.solved {
        if several {
            let _ = writeln!(out, "\n{}", paint.with(Style::new().bold(), &rod.name));
        }
        let problem = outcome.model.rod(&rod.name).map(|rod| &rod.problem);
        for (what, value) in problem.map_or_else(Vec::new, |problem| rows(rod, problem)) {
            let _ = writeln!(out, "  {what:<9} {value}");
        }
        let (style, verdict) = verdict(&rod.solution);
        let _ = writeln!(out, "  {:<9} {}", "result", paint.with(style, verdict));
    }
    if let Some(rod) = &outcome.failed {
        if several {
            let _ = writeln!(out, "\n{}", paint.with(Style::new().bold(), &rod.name));
        }
        out += &failed(rod, paint);
    }
    out.trim_end().to_owned()
}

/// Colours, or none.
#[derive(Clone, Copy)]
struct Paint(bool);

impl Paint {
    fn with(self, style: Style, text: &str) -> String {
        if self.0 { format!("{style}{text}{style:#}") } else { text.to_owned() }
    }
}

fn picture(outcome: &Outcome, paint: Paint) -> String {
    let line = |poses: &[Pose]| poses.iter().map(|pose| pose.position).collect::<Vec<Vec3>>();
    let mut lines: Vec<Vec<Vec3>> = outcome.solved.iter().map(|rod| line(&rod.solution.poses)).collect();
    let mut of_what = "";
    if let Some(rod) = &outcome.failed {
        lines.push(line(&rod.nearest.poses));
        of_what = "; the nearest shape, no solution";
    }
    if !lines.iter().flatten().all(|p| p.is_finite()) {
        return String::new();
    }
    let (mut out, drawing) =
        sketch(&lines, &outcome.model, |line| paint.with(AnsiColor::Cyan.on_default(), line));
    let size = drawing.width.max(drawing.height);
    let side = |length: f64| engineering(settled(length, size), "m");
    let _ = writeln!(out, "  {} wide, {} high{of_what}\n", side(drawing.width), side(drawing.height));
    out
}

/// Lines in space as a person sees them, gravity pointing down, indented.
pub fn sketch(lines: &[Vec<Vec3>], model: &Model, paint: impl Fn(&str) -> String) -> (String, Drawing) {
    let up = model.gravity.normalized().map_or(Vec3::Z, |down| -down);
    let drawing = draw(lines, up);
    let mut out = String::new();
    for line in &drawing.lines {
        let _ = writeln!(out, "{}", format!("  {}", paint(line)).trim_end());
    }
    (out, drawing)
}

fn rows(rod: &SolvedRod, problem: &Problem) -> Vec<(&'static str, String)> {
    let (solution, of_model) = (&rod.solution, &problem.rod);
    let order = of_model.order().as_number();
    let report = &solution.report;
    let scale = magnitudes(solution, of_model);
    let mut rows = Vec::new();
    if let Some(tip) = solution.poses.last() {
        let wxyz = tip.orientation().to_wxyz().map(|x| without_minus_zero(format!("{x:.4}"))).join(", ");
        rows.push(("end", format!("at {}", triple(each_settled(tip.position, scale.length), "m"))));
        rows.push(("", format!("orientation [{wxyz}]")));
    }
    for (reaction, (_, support)) in solution.reactions.iter().zip(problem.supports()) {
        if !support.holds_anything() {
            continue;
        }
        rows.push(("support", format!("at s = {}", engineering(reaction.s, "m"))));
        rows.push(("", format!("force  {}", sized(each_settled(reaction.force, scale.force), "N"))));
        rows.push(("", format!("moment {}", sized(each_settled(reaction.moment, scale.moment), "N·m"))));
    }
    if let Some(mode) = unstable_mode(problem, solution, &mut Workspace::default()) {
        rows.push(("falls", fall(&mode, problem)));
    }
    // The elastic energy is of second order in the strain, and so is its round-off.
    let elastic = engineering(settled(solution.energy.elastic, scale.moment * ROUND_OFF), "J");
    let load = engineering(settled(solution.energy.load, scale.force * scale.length), "J");
    rows.push(("energy", format!("{elastic} elastic, {load} of the loads")));
    rows.push((
        "solver",
        format!(
            "{}, {} elements of order {order}, {} iterations, residual {:.1e}, {}",
            report.method.name(),
            solution.strain.len(),
            report.iterations,
            report.residual,
            engineering(rod.seconds, "s"),
        ),
    ));
    rows
}

/// A mode that shifts no node by more than this part of what it turns one by, over the length, only turns.
const HARDLY_SHIFTS: f64 = 1e-3;

/// What a mode does, in words: where the rod moves most and which way, or, where it stays in place, where it turns most.
fn fall(mode: &UnstableMode, problem: &Problem) -> String {
    let places = problem.rod.mesh().nodes();
    let most = |vectors: &[Vec3]| {
        let largest = (0..vectors.len())
            .fold(0, |best, i| if vectors[i].norm() > vectors[best].norm() { i } else { best });
        (places[largest], vectors[largest])
    };
    let (shifts_at, shift) = most(&mode.displacement);
    let (turns_at, turn) = most(&mode.rotation);
    let length = problem.rod.length();
    let (how, at, along) = if shift.norm() > HARDLY_SHIFTS * length * turn.norm() {
        ("moves along", shifts_at, shift)
    } else {
        ("turns about", turns_at, turn)
    };
    let largest = along.to_array().into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let along = along * (1.0 / along.norm()).copysign(largest);
    let [x, y, z] = along.to_array().map(|x| without_minus_zero(format!("{x:.2}")));
    format!("{how} ±({x}, {y}, {z}), most at s = {}", engineering(at, "m"))
}

/// The largest lengths, moments and forces about a solved rod, its own stiffness among them.
fn magnitudes(solution: &Solution, rod: &Rod) -> Scale {
    let own = rod.scale();
    let length = solution.poses.iter().fold(own.length, |most, pose| most.max(pose.position.max_abs()));
    let force = solution.reactions.iter().fold(own.force, |most, reaction| most.max(reaction.force.norm()));
    let moment =
        solution.reactions.iter().fold(own.moment, |most, reaction| most.max(reaction.moment.norm()));
    Scale { length, force, moment: moment.max(force * own.length) }
}

/// A number, or zero where it is no more than round-off of that magnitude.
fn settled(x: f64, magnitude: f64) -> f64 {
    if x.abs() <= ROUND_OFF * magnitude { 0.0 } else { x }
}

fn each_settled(v: Vec3, magnitude: f64) -> Vec3 {
    Vec3::new(settled(v.x, magnitude), settled(v.y, magnitude), settled(v.z, magnitude))
}

fn verdict(solution: &Solution) -> (Style, &'static str) {
    match solution.report.morse_index {
        Some(0) => (AnsiColor::Green.on_default().bold(), "stable equilibrium"),
        Some(1) => {
            (AnsiColor::Yellow.on_default().bold(), "UNSTABLE equilibrium: one way to fall (Morse index 1)")
        }
        Some(_) => (
            AnsiColor::Yellow.on_default().bold(),
            "UNSTABLE equilibrium: several ways to fall (Morse index 2 or more)",
        ),
        None => (
            AnsiColor::Green.on_default().bold(),
            "equilibrium; its stability is not known: the loads have no potential, or the elements are too long to tell",
        ),
    }
}

fn failed(rod: &FailedRod, paint: Paint) -> String {
    let report = &rod.nearest.report;
    let last = report.residual_history.len().saturating_sub(8);
    let history: Vec<String> = report.residual_history[last..].iter().map(|x| format!("{x:.1e}")).collect();
    let mut out = String::new();
    let _ = writeln!(
        out,
        "  {:<9} {} iterations; the last residuals: {}",
        "solver",
        report.iterations,
        history.join(" ")
    );
    let reason = format!("failed: {}", rod.reason);
    let _ = writeln!(out, "  {:<9} {}", "result", paint.with(AnsiColor::Red.on_default().bold(), &reason));
    out
}

/// A vector's length, and the vector.
fn sized(v: Vec3, unit: &str) -> String {
    format!("{:<12} {}", engineering(v.norm(), unit), triple(v, unit))
}

/// A vector with one prefix for all its parts, and four digits of the largest.
fn triple(v: Vec3, unit: &str) -> String {
    let largest = v.max_abs();
    if largest == 0.0 || !largest.is_finite() {
        return format!("({}, {}, {}) {unit}", v.x, v.y, v.z);
    }
    let written = engineering(largest, unit);
    let (number, unit) = written.split_once(' ').unwrap_or((&written, unit));
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    // The prefix as a factor, which the rounding of the number must not touch.
    let factor = number.parse::<f64>().map_or(1.0, |number| 10_f64.powf((number / largest).log10().round()));
    let part = |x: f64| without_minus_zero(format!("{:.decimals$}", x * factor));
    format!("({}, {}, {}) {unit}", part(v.x), part(v.y), part(v.z))
}

fn without_minus_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(number) if number.bytes().all(|c| matches!(c, b'0' | b'.')) => number.to_owned(),
        _ => text,
    }
}
