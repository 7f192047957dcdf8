//! `strands solve --all` and `--path`: many equilibria of one rod.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use serde_json::Value as Json;
use strands::statics::{
    EventKind, MOST_ALIKE, Path, PathEnd, PathError, PathSettings, SearchSettings, Solution, Workspace,
    equilibria, follow_path,
};
use strands_scene::write::{PathAnswer, equilibria_json, path_json};
use strands_scene::{MeshChoice, Model};
use toml_edit::Value;

use crate::args::Solve;
use crate::solve::Format;
use crate::source::Source;
use crate::units::engineering;
use crate::{Failure, overrides, say, summary, tell};

/// Lists all equilibria of a rod.
///
/// # Errors
/// Bad scenes, files and names; and, once that is said, a search that found none.
pub fn all(options: &Solve, source: &Source, outputs: &[(&PathBuf, Format)]) -> Result<(), Failure> {
    let mut model = source.parse_alone()?.model;
    let name = rod_named(options.rod.as_deref(), &model, None)?;
    model.refine(&name).map_err(Failure::bad)?;
    if !(options.effort > 0.0 && options.effort <= 1e4) {
        return Err(Failure::bad("--effort: give a number greater than 0 and up to 10000"));
    }
    let times = |count: usize| (count as f64 * options.effort).ceil() as usize;
    let default = SearchSettings::default();
    let settings = SearchSettings {
        solver: model.settings,
        starts: times(default.starts),
        paths: times(default.paths),
        ..default
    };
    let start = Instant::now();
    let rod = model.rod(&name).unwrap_or_else(|| unreachable!("it has been looked up"));
    let found = equilibria(&rod.problem, &settings, &mut Workspace::default()).map_err(Failure::bad)?;
    let seconds = start.elapsed().as_secs_f64();
    let json = || equilibria_json(&model, &name, &found, Some(seconds));
    write_files(outputs, &model, &name, &found.iter().collect::<Vec<_>>(), &json)?;
    if options.json {
        say(&json())?;
    } else {
        say(list(&model, &name, &found, seconds).trim_end())?;
    }
    if found.is_empty() { Err(Failure::Unsolved) } else { Ok(()) }
}

fn list(model: &Model, name: &str, found: &[Solution], seconds: f64) -> String {
    let mut out = picture(model, found.iter().take(6));
    let stable = found.iter().filter(|solution| solution.report.morse_index == Some(0)).count();
    let took = engineering(seconds, "s");
    let _ = writeln!(
        out,
        "{}, {name}: {} equilibria found, {stable} of them stable, in {took}",
        model.name,
        found.len()
    );
    if found.is_empty() {
        out += "none; `strands solve` without --all says why\n";
        return out;
    }
    let _ = writeln!(out, "  {:>3}  {:>14}  {:<24} middle, m", "", "energy", "");
    let mut rows = 0;
    for (i, solution) in found.iter().enumerate() {
        let alike = |other: &&Solution| same_energy(other, solution);
        let before = found[..i].iter().rev().take_while(alike).count();
        let all = before + found[i..].iter().take_while(alike).count();
        // Of a circle the first.
        if all >= MOST_ALIKE && before > 0 {
            continue;
        }
        rows += 1;
        if rows > ROWS {
            let _ = writeln!(out, "  … and {} more, which --json and -o list", found.len() - i);
            break;
        }
        let circle = if all >= MOST_ALIKE { ", and turned about an axis at will" } else { "" };
        let middle = solution.poses[solution.poses.len() / 2].position;
        let _ = writeln!(
            out,
            "  {:>3}  {:>14}  {:<24} ({:.4}, {:.4}, {:.4}){circle}",
            i + 1,
            engineering(solution.energy.total(), "J"),
            stability(solution.report.morse_index),
            middle.x,
            middle.y,
            middle.z
        );
    }
    out
}

/// Whether two are one shape that lies otherwise, as far as energies tell.
fn same_energy(a: &Solution, b: &Solution) -> bool {
    let size = a.energy.elastic.abs() + a.energy.load.abs();
    (a.energy.total() - b.energy.total()).abs() <= 1e-7 * size
}

fn stability(index: Option<usize>) -> String {
    match index {
        Some(0) => "stable".into(),
        Some(index) => format!("unstable, Morse index {index}"),
        None => "stability not known".into(),
    }
}

/// Follows a path.
///
/// # Errors
/// Bad scenes, keys and files; and, once that is said, a path that has no start or is stuck.
pub fn path(
    options: &Solve,
    source: &Source,
    path: &str,
    outputs: &[(&PathBuf, Format)],
) -> Result<(), Failure> {
    let way = Way::parse(path)?;
    let at_value = |at: f64| -> Result<Model, Failure> {
        let value = way.value(at);
        let text = overrides::set(&source.text, source.is_json(), &way.key, value).map_err(Failure::bad)?;
        Ok(source.with_text(text).parse_alone()?.model)
    };
    let first = at_value(0.0)?;
    at_value(1.0)?;
    let name = rod_named(options.rod.as_deref(), &first, Some(&way.key))?;
    if first.rod(&name).is_some_and(|rod| matches!(rod.mesh, MeshChoice::Tolerance(_))) {
        tell("note: a path keeps its mesh: 100 elements in place of those that `tolerance` asks for");
    }
    let problem = |at: f64| {
        let model = at_value(at).map_err(|failure| match failure {
            Failure::Bad(message) => message.lines().next().unwrap_or_default().to_owned(),
            Failure::Unsolved | Failure::Interrupted => String::new(),
        })?;
        model.rod(&name).map(|rod| rod.problem.clone()).ok_or_else(|| "the rod is gone".to_owned())
    };
    let settings = PathSettings {
        solver: first.settings,
        switch_at: options.switch.map(|number| number as usize - 1),
        ..PathSettings::default()
    };
    let found = match follow_path(problem, &settings, &mut Workspace::default()) {
        Ok(found) => found,
        Err(PathError::Problem(error)) => return Err(Failure::bad(error)),
        Err(PathError::Start(failure)) => {
            return Err(Failure::bad(format!("no equilibrium at the path's start: {failure}")));
        }
    };
    let points = found
        .points
        .iter()
        .map(|point| {
            let value = overrides::json_value(&way.value(point.at));
            Ok(PathAnswer { value, model: at_value(point.at)?, solution: &point.solution })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let events: Vec<_> =
        found.events.iter().map(|event| (overrides::json_value(&way.value(event.at)), *event)).collect();
    let json = || path_json(&first, &name, &way.written, &points, &events, &found.end);
    let solutions: Vec<&Solution> = found.points.iter().map(|point| &point.solution).collect();
    write_files(outputs, &first, &name, &solutions, &json)?;
    if options.json {
        say(&json())?;
    } else {
        say(table(&first, &way, &found, &points).trim_end())?;
    }
    let bifurcations = found.events.iter().filter(|event| event.kind == EventKind::Bifurcation).count();
    if let Some(number) = options.switch.filter(|number| *number as usize > bifurcations) {
        return Err(Failure::bad(format!("--switch {number}: the path has {bifurcations} bifurcations")));
    }
    if matches!(found.end, PathEnd::Reached | PathEnd::Returned) { Ok(()) } else { Err(Failure::Unsolved) }
}

/// Rows of a table; of a path beside its events.
const ROWS: usize = 24;

fn table(model: &Model, way: &Way, found: &Path, points: &[PathAnswer<'_>]) -> String {
    let shapes = 5.min(found.points.len());
    let shown =
        (0..shapes).map(|i| &found.points[i * (found.points.len() - 1) / (shapes - 1).max(1)].solution);
    let mut out = picture(model, shown);
    let _ = writeln!(out, "{}: {} along {} points", model.name, way.written, points.len());
    let _ = writeln!(out, "  {:<30} {:>14}  {:<24} end, m", "value", "energy", "");
    let each = found.points.len().div_ceil(ROWS);
    for (i, point) in points.iter().enumerate() {
        for event in found.events.iter().filter(|event| event.after_points == i) {
            let what = match event.kind {
                EventKind::Fold => "fold",
                EventKind::Bifurcation => "bifurcation",
            };
            let _ = writeln!(out, "  {:<30} {what}", short(&overrides::json_value(&way.value(event.at))));
        }
        if i % each != 0 && i + 1 != points.len() {
            continue;
        }
        let solution = point.solution;
        let end = solution.poses[solution.poses.len() - 1].position;
        let _ = writeln!(
            out,
            "  {:<30} {:>14}  {:<24} ({:.4}, {:.4}, {:.4})",
            short(&point.value),
            engineering(solution.energy.total(), "J"),
            stability(solution.report.morse_index),
            end.x,
            end.y,
            end.z
        );
    }
    let _ = match &found.end {
        PathEnd::Reached => writeln!(out, "  the path reaches its end"),
        PathEnd::Returned => writeln!(out, "  the path turns back and returns to its first value"),
        PathEnd::MostPoints => writeln!(out, "  the path goes on; it was left after {} points", points.len()),
        PathEnd::Stuck { why } => writeln!(out, "  failed: no further point was found: {why}"),
    };
    out
}

/// A value as a person reads it.
fn short(value: &Json) -> String {
    match value {
        Json::Array(list) => format!("[{}]", list.iter().map(short).collect::<Vec<_>>().join(", ")),
        Json::Number(number) => {
            let rounded = number.as_f64().map_or_else(|| number.to_string(), |x| format!("{x:.6}"));
            rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        other => other.to_string(),
    }
}

fn picture<'a>(model: &Model, shapes: impl Iterator<Item = &'a Solution>) -> String {
    let lines: Vec<Vec<_>> =
        shapes.map(|solution| solution.poses.iter().map(|pose| pose.position).collect()).collect();
    if lines.is_empty() {
        return String::new();
    }
    summary::sketch(&lines, model, str::to_owned).0 + "\n"
}

fn write_files(
    outputs: &[(&PathBuf, Format)],
    model: &Model,
    name: &str,
    solutions: &[&Solution],
    json: &dyn Fn() -> String,
) -> Result<(), Failure> {
    let named: Vec<(&str, &Solution)> = solutions.iter().map(|solution| (name, *solution)).collect();
    for (path, format) in outputs {
        let bytes = format.shapes(model, &named).unwrap_or_else(|| json().into_bytes());
        std::fs::write(path, bytes).map_err(|error| Failure::file(path.display(), &error))?;
    }
    Ok(())
}

/// The rod that is meant: the one named, the one in whose table the key is, or the only one.
fn rod_named(named: Option<&str>, model: &Model, key: Option<&[String]>) -> Result<String, Failure> {
    let in_key = key.filter(|key| key.len() > 1 && key[0] == "rods").map(|key| key[1].as_str());
    let names: Vec<&str> = model.rods.iter().map(|rod| rod.name.as_str()).collect();
    match (named.or(in_key), names.as_slice()) {
        (Some(name), _) if names.contains(&name) => Ok(name.to_owned()),
        (Some(name), _) => Err(Failure::bad(format!(
            "--rod {name}: there is no such rod; the scene has {}",
            names.join(", ")
        ))),
        (None, [only]) => Ok((*only).to_owned()),
        (None, _) => Err(Failure::bad(format!(
            "the scene has several rods, so say which: --rod {}",
            names.join(" | ")
        ))),
    }
}

/// A key, and the values that it goes through.
struct Way {
    key: Vec<String>,
    /// The key as it was written.
    written: String,
    /// Numbers or lists of numbers, all of one length.
    values: Vec<Vec<f64>>,
    is_list: bool,
}

impl Way {
    fn parse(written: &str) -> Result<Self, Failure> {
        let bad = |what: &str| {
            Failure::bad(format!(
                "--path {written}: {what}; write KEY=FROM..TO, such as rods.thread.length=0.2..0.4 or \
                 'rods.thread.supports[1].position=[0,0,0.3]..[0,0,0.1]'; values between are possible, A..B..C"
            ))
        };
        let (key, text) =
            overrides::key_and_value(written).ok_or_else(|| bad("there is no `=` after a key"))?;
        let numbers = |text: &str| -> Option<(Vec<f64>, bool)> {
            let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|x| x as f64));
            let value: Value = text.trim().parse().ok()?;
            match value.as_array() {
                Some(list) => Some((list.iter().map(number).collect::<Option<_>>()?, true)),
                None => Some((vec![number(&value)?], false)),
            }
        };
        let read: Vec<_> = text
            .split("..")
            .map(numbers)
            .collect::<Option<_>>()
            .ok_or_else(|| bad("a value is neither a number nor a list of numbers"))?;
        let is_list = read[0].1;
        let values: Vec<Vec<f64>> = read.into_iter().map(|(value, _)| value).collect();
        if values.len() < 2 {
            return Err(bad("there is no value to go to"));
        }
        if values.iter().any(|value| value.len() != values[0].len() || value.iter().any(|x| !x.is_finite())) {
            return Err(bad("the values are not of one kind"));
        }
        let name = written[..written.len() - text.len() - 1].trim().to_owned();
        Ok(Self { key, written: name, values, is_list })
    }

    /// The value at a part of the way, a little beyond its ends too.
    fn value(&self, at: f64) -> Value {
        let legs = self.values.len() - 1;
        let leg = ((at * legs as f64).floor().max(0.0) as usize).min(legs - 1);
        let part = at * legs as f64 - leg as f64;
        let (from, to) = (&self.values[leg], &self.values[leg + 1]);
        let mut value: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + (b - a) * part).collect();
        // A quaternion stays one.
        if self.key.last().is_some_and(|key| key == "orientation") {
            let norm = value.iter().map(|x| x * x).sum::<f64>().sqrt();
            value.iter_mut().for_each(|x| *x /= norm);
        }
        if self.is_list { Value::Array(value.into_iter().collect()) } else { Value::from(value[0]) }
    }
}
