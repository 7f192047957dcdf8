//! `strands validate`: the named problems of `strands-cases`, solved and set beside what is known of them.

mod cases;
mod convergence;
mod critical;
mod line;
mod motions;
mod plot;
mod report;
mod table;
mod vibrations;

use std::io::{IsTerminal, Write, stderr};
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread::available_parallelism;
use std::time::Instant;

use crate::args::Validate;
use crate::{Failure, colour_out, say};
use line::Line;

/// Something that can be validated: a name, and what finds its lines.
struct Entry {
    name: String,
    lines: Box<dyn FnOnce() -> Vec<Line> + Send>,
}

/// All that can be validated, in the order in which it is printed. Problems of another kind are one more list of entries here.
fn catalogue() -> Vec<Entry> {
    [cases::entries(), critical::entries(), vibrations::entries(), motions::entries()]
        .into_iter()
        .flatten()
        .collect()
}

/// What a run found.
struct Findings {
    /// How many cases were run.
    cases: usize,
    /// Each comparison, those of a case together.
    lines: Vec<Line>,
    /// How long it took, s.
    seconds: f64,
}

/// The command.
///
/// # Errors
/// Names that there are not, a report that cannot be written; and, once everything is said, a comparison out of its tolerance.
pub fn run(options: &Validate) -> Result<(), Failure> {
    if let Some(path) = &options.output
        && !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html"))
    {
        return Err(Failure::bad(format!("{}: the report is HTML; name it .html", path.display())));
    }
    let start = Instant::now();
    let chosen = chosen(catalogue(), &options.names)?;
    let cases = chosen.len();
    let lines = lines_of(chosen);
    let findings = Findings { cases, lines, seconds: start.elapsed().as_secs_f64() };
    if let Some(path) = &options.output {
        write(path, &findings)?;
    }
    if options.json {
        say(&findings.json())?;
    } else {
        say(&table::table(&findings, options.rows, colour_out()))?;
    }
    if findings.failed() > 0 { Err(Failure::Unsolved) } else { Ok(()) }
}

/// The lines of all entries in their order, found by as many threads as there are cores. On a terminal it says meanwhile how far it is.
fn lines_of(entries: Vec<Entry>) -> Vec<Line> {
    let (count, told) = (entries.len(), stderr().is_terminal());
    // The progress is not worth a failure where it cannot be written.
    let tell = |text: &str| {
        if told {
            let _ = write!(stderr(), "\r\x1b[K{text}").and_then(|()| stderr().flush());
        }
    };
    let waiting = Mutex::new(entries.into_iter().enumerate());
    let take = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        let mut found = Vec::new();
        while let Some((place, entry)) = take() {
            tell(&format!("{} of {count}: {}", place + 1, entry.name));
            found.push((place, (entry.lines)()));
        }
        found
    };
    let threads = available_parallelism().map_or(1, |cores| cores.get().min(count));
    let mut found = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().flat_map(|worker| match worker.join() {
            Ok(found) => found,
            Err(panic) => resume_unwind(panic),
        });
        joined.collect::<Vec<_>>()
    });
    tell("");
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().flat_map(|(_, lines)| lines).collect()
}

/// The entries that the names mean: the one of that name, or else all whose names contain it. Without names, all.
fn chosen(catalogue: Vec<Entry>, names: &[String]) -> Result<Vec<Entry>, Failure> {
    let known: Vec<&str> = catalogue.iter().map(|entry| entry.name.as_str()).collect();
    let mut wanted = vec![names.is_empty(); known.len()];
    for name in names {
        let whole = known.contains(&name.as_str());
        let means = |other: &str| if whole { other == name } else { other.contains(name.as_str()) };
        if !known.iter().any(|other| means(other)) {
            return Err(unknown(name, &known));
        }
        wanted.iter_mut().zip(&known).for_each(|(wanted, other)| *wanted |= means(other));
    }
    Ok(catalogue.into_iter().zip(wanted).filter_map(|(entry, wanted)| wanted.then_some(entry)).collect())
}

/// How many near names are told.
const NEAREST: usize = 3;

fn unknown(name: &str, known: &[&str]) -> Failure {
    let mut near = known.to_vec();
    near.sort_by_key(|other| strsim::damerau_levenshtein(name, other));
    let near: Vec<String> = near.iter().take(NEAREST).map(|other| format!("`{other}`")).collect();
    Failure::bad(format!(
        "no case is named `{name}`, or has it in its name; the nearest are {}\nAll {}: {}",
        near.join(", "),
        known.len(),
        known.join(", ")
    ))
}

fn write(path: &Path, findings: &Findings) -> Result<(), Failure> {
    let curves = convergence::curves(&findings.names());
    std::fs::write(path, report::html(findings, &curves))
        .map_err(|error| Failure::file(path.display(), &error))
}

impl Findings {
    /// How many comparisons are out of their tolerance.
    fn failed(&self) -> usize {
        self.lines.iter().filter(|line| !line.ok()).count()
    }

    /// The lines of each case.
    fn by_case(&self) -> impl Iterator<Item = &[Line]> {
        self.lines.chunk_by(|a, b| a.case == b.case)
    }

    fn names(&self) -> Vec<&str> {
        self.by_case().map(|lines| lines[0].case.as_str()).collect()
    }

    /// The last line of the table.
    fn summary(&self) -> String {
        let Self { cases, lines, seconds } = self;
        format!("{cases} cases, {} comparisons, {} failed, {seconds:.1} s", lines.len(), self.failed())
    }

    /// The findings as one JSON object. An error without a number, where there is no solution, is null.
    fn json(&self) -> String {
        let lines: Vec<serde_json::Value> = self.lines.iter().map(Line::json).collect();
        serde_json::json!({
            "cases": self.cases,
            "comparisons": self.lines.len(),
            "failed": self.failed(),
            "seconds": self.seconds,
            "lines": lines,
        })
        .to_string()
    }
}
