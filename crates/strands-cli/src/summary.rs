//! What a person reads after a solve.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};
use strands::math::Vec3;

use crate::drawing::draw;
use crate::solve::{Outcome, RodOutcome};
use crate::units::{digits, engineering};

/// The summary of a solved scene: a picture, then for each rod what it does and how that was found.
pub fn summary(outcome: &Outcome, colour: bool) -> String {
    let paint = |style: Style, text: &str| if colour { format!("{style}{text}{style:#}") } else { text.to_owned() };
    let bold = Style::new().bold();
    let mut out = String::new();
    let lines: Vec<Vec<Vec3>> =
        outcome.rods.iter().map(|rod| rod.solution.poses.iter().map(|pose| pose.position).collect()).collect();
    if lines.iter().flatten().all(|p| p.is_finite()) {
        let up = outcome.gravity.normalized().map_or(Vec3::Z, |down| -down);
        let picture = draw(&lines, up);
        for line in &picture.lines {
            out += format!("  {}", paint(AnsiColor::Cyan.on_default(), line)).trim_end();
            out.push('\n');
        }
        out += &format!("  {} across\n\n", engineering(picture.width, "m"));
    }
    out += &paint(bold, &outcome.scene);
    out.push('\n');
    for rod in &outcome.rods {
        if outcome.rods.len() > 1 {
            out += &format!("\n{}\n", paint(bold, &rod.name));
        }
        for (what, value) in rows(rod) {
            let _ = writeln!(out, "  {what:<11} {value}");
        }
        let (style, verdict) = verdict(rod);
        let _ = writeln!(out, "  {:<11} {}", "result", paint(style, &verdict));
    }
    out.trim_end().to_owned()
}

fn rows(rod: &RodOutcome) -> Vec<(&'static str, String)> {
    let solution = &rod.solution;
    let report = &solution.report;
    let mut rows = Vec::new();
    if let Some(tip) = solution.poses.last() {
        let wxyz = tip.orientation().to_wxyz().map(|x| format!("{x:.4}")).join(", ");
        rows.push(("end", triple(tip.position, "m")));
        rows.push(("", format!("orientation [{wxyz}]")));
    }
    for reaction in &solution.reactions {
        let (force, moment) = (reaction.force, reaction.moment);
        if force == Vec3::ZERO && moment == Vec3::ZERO {
            continue;
        }
        rows.push((
            "reaction",
            format!("at s = {}: {}  {}", engineering(reaction.s, "m"), sized(force, "N"), triple(force, "N")),
        ));
        rows.push(("", format!("{}  {}", sized(moment, "N·m"), triple(moment, "N·m"))));
    }
    rows.push((
        "energy",
        format!("{} elastic, {} of the loads", engineering(solution.energy.elastic, "J"), engineering(solution.energy.load, "J")),
    ));
    rows.push((
        "solver",
        format!(
            "{}, {} elements, order {}, {} iterations, residual {:.1e}, {}",
            report.method.name(),
            solution.strain.len(),
            rod.order,
            report.iterations,
            report.residual,
            engineering(rod.seconds, "s"),
        ),
    ));
    rows
}

fn verdict(rod: &RodOutcome) -> (Style, String) {
    let good = AnsiColor::Green.on_default().bold();
    let doubtful = AnsiColor::Yellow.on_default().bold();
    if let Some(reason) = &rod.failure {
        return (AnsiColor::Red.on_default().bold(), format!("failed: {reason}"));
    }
    match rod.solution.report.morse_index {
        Some(0) => (good, "stable equilibrium (Morse index 0)".to_owned()),
        Some(index) => (doubtful, format!("UNSTABLE equilibrium (Morse index {index})")),
        None => (good, "equilibrium; its loads have no potential, so stability is not known".to_owned()),
    }
}

/// A vector with one prefix for all its parts, four digits of the largest.
fn triple(v: Vec3, unit: &str) -> String {
    let largest = v.max_abs();
    if largest == 0.0 || !largest.is_finite() {
        return format!("({}, {}, {}) {unit}", v.x, v.y, v.z);
    }
    let written = engineering(largest, unit);
    let (number, unit) = written.split_once(' ').unwrap_or((&written, unit));
    let scale = number.parse::<f64>().map_or(1.0, |number| number / largest);
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    // Rounding to a power of ten: the number's own rounding is not the scale's.
    let scale = 10_f64.powf(scale.log10().round());
    let part = |x: f64| {
        let text = format!("{:.decimals$}", x * scale);
        if text.trim_start_matches('-').bytes().all(|c| c == b'0' || c == b'.') { text.trim_start_matches('-').to_owned() } else { text }
    };
    format!("({}, {}, {}) {unit}", part(v.x), part(v.y), part(v.z))
}

fn sized(v: Vec3, unit: &str) -> String {
    let norm = v.norm();
    if norm.is_finite() { engineering(norm, unit) } else { format!("{} {unit}", digits(norm, 4)) }
}
