//! The findings as a table for people.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};

use super::Findings;
use super::line::{Line, shortened};

/// The longest that a value gets, and words, where every comparison is printed.
const VALUE: usize = 36;
const WORDS: usize = 27;
/// The longest of case and quantity where a case is one line, which so fits in 100 columns.
const CASE: usize = 24;
const BRIEFLY: usize = 22;

/// The columns where every comparison is printed, and where a case is one line.
const WHOLE: [&str; 9] = ["case", "source", "quantity", "row", "expected", "got", "error", "tolerance", ""];
const BRIEF: [&str; 6] = ["case", "source", "quantity", "error", "tolerance", ""];

/// The table: the worst comparison of each case, or every comparison; then how many there are.
pub fn table(findings: &Findings, every: bool, colour: bool) -> String {
    let shown: Vec<&Line> = if every {
        findings.lines.iter().collect()
    } else {
        findings.by_case().filter_map(Line::worst).collect()
    };
    let (head, rows): (Vec<&str>, Vec<Vec<String>>) = if every {
        (WHOLE.to_vec(), shown.iter().map(|line| cells(line)).collect())
    } else {
        (BRIEF.to_vec(), shown.iter().map(|line| brief(line)).collect())
    };
    let wide: Vec<usize> = (0..head.len())
        .map(|i| rows.iter().map(|row| width(&row[i])).fold(width(head[i]), usize::max))
        .collect();
    let mut out = String::new();
    let mut put = |cells: &[String], style: Style| {
        let padded =
            cells.iter().zip(&wide).map(|(cell, wide)| format!("{cell}{:1$}", "", wide - width(cell)));
        let text = padded.collect::<Vec<_>>().join("  ");
        let _ = match colour {
            true => writeln!(out, "{style}{}{style:#}", text.trim_end()),
            false => writeln!(out, "{}", text.trim_end()),
        };
    };
    let head: Vec<String> = head.into_iter().map(str::to_owned).collect();
    put(&head, Style::new().bold());
    for (line, row) in shown.iter().zip(&rows) {
        put(row, if line.ok() { Style::new() } else { AnsiColor::Red.on_default() });
    }
    let verdict = if findings.failed() == 0 { AnsiColor::Green } else { AnsiColor::Red };
    let style = verdict.on_default().bold();
    let summary = findings.summary();
    out + &if colour { format!("{style}{summary}{style:#}") } else { summary }
}

fn cells(line: &Line) -> Vec<String> {
    vec![
        line.case.clone(),
        line.short_source(),
        shortened(&line.quantity, WORDS),
        shortened(&line.label, WORDS),
        shortened(&line.expected, VALUE),
        shortened(&line.got, VALUE),
        magnitude(line.error),
        magnitude(line.tolerance),
        verdict(line).to_owned(),
    ]
}

/// A case by its worst comparison.
fn brief(line: &Line) -> Vec<String> {
    vec![
        shortened(&line.case, CASE),
        line.short_source(),
        shortened(&line.quantity, BRIEFLY),
        magnitude(line.error),
        magnitude(line.tolerance),
        verdict(line).to_owned(),
    ]
}

/// Whether a line is within its tolerance, as it is printed.
pub fn verdict(line: &Line) -> &'static str {
    if line.ok() { "ok" } else { "FAILED" }
}

/// An error as it is printed; a dash for one without a number.
pub fn magnitude(error: f64) -> String {
    match error {
        0.0 => "0".into(),
        _ if error.is_finite() => format!("{error:.1e}"),
        _ => "–".into(),
    }
}

fn width(text: &str) -> usize {
    text.chars().count()
}
