//! `strands check`: how hard a scene is, and what looks wrong with it, before it is used.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};
use serde_json::{Value, json};
use strands_scene::check::{Check, Level, Remark, RodCheck, Trial};

use crate::args::Check as Options;
use crate::units::{digits, engineering};
use crate::{Failure, colour_err, colour_out, overrides, say, source, tell};

/// The command.
///
/// # Errors
/// A scene that cannot be read, and bad arguments.
pub fn run(options: &Options) -> Result<(), Failure> {
    let mut source = source::read(&options.scene)?;
    source.text =
        overrides::apply(&source.text, source.is_json(), &options.overrides).map_err(Failure::bad)?;
    let scene = source.parse()?;
    let check = scene.check();
    if options.json { say(&json(&scene.model.name, &check)) } else { say(&text(&check, colour_out())) }
}

/// Says the first line of each warning on standard error, with its place.
pub fn warn(remarks: &[Remark]) {
    let (style, bold) = (AnsiColor::Yellow.on_default().bold(), Style::new().bold());
    for Remark { said, .. } in remarks.iter().filter(|remark| remark.level == Level::Warning) {
        let (place, message) = (format!("{}:{}: {}", said.file(), said.line(), said.key()), said.message());
        if colour_err() {
            tell(&format!("{style}warning{style:#}: {bold}{place}{bold:#}: {message}"));
        } else {
            tell(&format!("warning: {place}: {message}"));
        }
    }
}

/// What a person reads: the numbers of each rod, then the remarks, then how many.
fn text(check: &Check, colour: bool) -> String {
    let mut out = String::new();
    for rod in &check.rods {
        let bold = Style::new().bold();
        let _ =
            if colour { writeln!(out, "{bold}{}{bold:#}", rod.name) } else { writeln!(out, "{}", rod.name) };
        for (what, value) in rows(rod) {
            let _ = writeln!(out, "  {what:<9} {value}");
        }
        out.push('\n');
    }
    for remark in &check.remarks {
        let _ = writeln!(out, "{}\n", remark.render(colour));
    }
    let warnings = warnings(check);
    let notes = check.remarks.len() - warnings;
    let style = if warnings > 0 { AnsiColor::Yellow } else { AnsiColor::Green }.on_default().bold();
    let count = format!("{}, {}", counted(warnings, "warning"), counted(notes, "note"));
    out + &if colour { format!("{style}{count}{style:#}") } else { count }
}

fn counted(n: usize, what: &str) -> String {
    match n {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        _ => format!("{n} {what}s"),
    }
}

fn warnings(check: &Check) -> usize {
    check.remarks.iter().filter(|remark| remark.level == Level::Warning).count()
}

/// What a number of 64 bits holds.
const DIGITS: f64 = 16.0;

fn rows(rod: &RodCheck) -> Vec<(&'static str, String)> {
    let numbers = &rod.numbers;
    let mut size = engineering(numbers.length, "m") + " long";
    if let Some(radius) = numbers.radius {
        size += &format!(
            ", up to {} across: length/radius {}",
            engineering(2.0 * radius, "m"),
            digits(numbers.length / radius, 3)
        );
    }
    if let Some(gyration) = numbers.gyration {
        size += &format!("; length/radius of gyration {}", digits(numbers.length / gyration, 3));
    }
    let parameters = [
        ("w L³/EI", numbers.weight_parameter()),
        ("P L²/EI", numbers.force_parameter()),
        ("M L/EI", numbers.moment_parameter()),
    ];
    let parameters: Vec<String> = (parameters.iter())
        .filter(|(_, value)| *value > 0.0)
        .map(|(name, value)| format!("{name} = {}", digits(*value, 3)))
        .collect();
    let loads = if parameters.is_empty() { "none".to_owned() } else { parameters.join(", ") };
    let mut rows =
        vec![("size", size), ("loads", format!("{loads}; EI = {}", engineering(numbers.bending, "N·m²")))];
    if numbers.tension.value > 0.0 {
        let how = if numbers.tension.found { "up to" } else { "expected: at most" };
        let mut tension = format!(
            "{how} {}: bends over ℓ = √(EI/T) = {}, L/ℓ = {}",
            engineering(numbers.tension.value, "N"),
            engineering(numbers.bending_length(), "m"),
            digits(numbers.bending_lengths(), 3)
        );
        // exp(L/ℓ) as a power of ten, which is a number of digits.
        let lost = numbers.bending_lengths() / std::f64::consts::LN_10;
        if lost >= DIGITS {
            tension += "; shooting loses all its digits";
        } else if lost >= 1.0 {
            tension += &format!("; shooting loses {lost:.0} of {DIGITS} digits");
        }
        rows.push(("tension", tension));
    }
    rows.push(("solver", format!("{}: {}", rod.plan.method.name(), rod.plan.why)));
    let [shortest, longest] = rod.element_lengths.map(|length| engineering(length, "m"));
    let lengths = if shortest == longest { longest } else { format!("{shortest} to {longest}") };
    rows.push((
        "mesh",
        format!("{} elements of order {}, {lengths} long", rod.elements, rod.order.as_number()),
    ));
    match &rod.trial {
        Trial::Solved { estimated_error: Some(error), .. } => {
            let error = if *error < 1e-12 { "below 1e-12".to_owned() } else { format!("{error:.0e}") };
            rows.push((
                "error",
                format!("{error} of the length, or rad: estimated, from a mesh twice as fine"),
            ));
        }
        Trial::Solved { .. } => {
            rows.push(("error", "not estimated: a mesh twice as fine was not solved".into()))
        }
        Trial::Failed { .. } => rows.push(("error", "not estimated: a trial failed".into())),
        Trial::Tied => rows.push((
            "error",
            "not estimated: joints tie the rod to others, nothing holds it, or surfaces touch".into(),
        )),
    }
    rows
}

/// The check as one JSON object. What is not known or beyond all numbers is null.
fn json(scene: &str, check: &Check) -> String {
    let rods: serde_json::Map<String, Value> =
        check.rods.iter().map(|rod| (rod.name.clone(), rod_json(rod))).collect();
    let remarks: Vec<Value> = (check.remarks.iter())
        .map(|Remark { level, said }| {
            json!({
                "level": level.name(), "key": said.key(), "line": said.line(), "column": said.column(),
                "message": said.message(), "mends": said.mends(),
            })
        })
        .collect();
    json!({ "scene": scene, "rods": rods, "warnings": warnings(check), "remarks": remarks }).to_string()
}

fn rod_json(rod: &RodCheck) -> Value {
    let numbers = &rod.numbers;
    let (error, strain, reason) = match &rod.trial {
        Trial::Solved { estimated_error, strain, .. } => {
            (*estimated_error, strain.map(|[strain, _]| strain), None)
        }
        Trial::Failed { reason, .. } => (None, None, Some(reason.as_str())),
        Trial::Tied => (None, None, Some("joints tie the rod to others, or nothing holds it")),
    };
    let known = |x: f64| x.is_finite().then_some(x);
    json!({
        "length": numbers.length,
        "radius": numbers.radius,
        "radius_of_gyration": numbers.gyration,
        "bending_stiffness": numbers.bending,
        "weight_parameter": numbers.weight_parameter(),
        "force_parameter": numbers.force_parameter(),
        "moment_parameter": numbers.moment_parameter(),
        "tension": numbers.tension.value,
        "tension_found": numbers.tension.found,
        "bending_length": known(numbers.bending_length()),
        "shooting_loses": known(numbers.shooting_loses()),
        "method": rod.plan.method.name(),
        "why": rod.plan.why,
        "elements": rod.elements,
        "order": rod.order.as_number(),
        "element_lengths": rod.element_lengths,
        "estimated_error": error,
        "largest_strain": strain,
        "reason": reason,
    })
}
