//! The lines of the cases with reference solutions.

use strands::math::Quat;
use strands::rod::Order;
use strands::statics::{Settings, SolveFailure};
use strands_cases::{Case, CaseError, Comparison, Outcome, Row, Value};

use super::Entry;
use super::line::Line;
use crate::units::digits;

/// The residual to which a row is solved, and those for what cannot be: a long spring multiplies round-off, and stops at more than others.
const TOLERANCE: f64 = 1e-12;
const LOOSER: [f64; 2] = [1e-10, 1e-8];

/// An entry for each case.
pub fn entries() -> Vec<Entry> {
    let entry = |case: Case| Entry { name: case.name.clone(), lines: Box::new(move || lines(&case)) };
    strands_cases::all().into_iter().map(entry).collect()
}

fn lines(case: &Case) -> Vec<Line> {
    // A row that starts near its answer must be found from there: nothing found from rest instead.
    let settings = Settings { tolerance: TOLERANCE, restart_from_rest: false, ..Settings::default() };
    let outcomes = case.solve_or_looser(case.elements, Order::Fourth, &settings, &LOOSER);
    let rows = case.rows.iter().zip(outcomes);
    rows.flat_map(|(row, outcome)| match outcome {
        Ok(outcome) => compared(case, row, &outcome),
        Err(error) => vec![unsolved(case, row, &error)],
    })
    .collect()
}

fn compared(case: &Case, row: &Row, outcome: &Outcome) -> Vec<Line> {
    let mut lines: Vec<Line> = (outcome.comparisons.iter())
        .map(|comparison| Line {
            quantity: without_zeros(&comparison.expected.quantity.to_string()),
            expected: written(&comparison.expected.value, comparison.expected.scale),
            got: written(&alike(comparison), comparison.expected.scale),
            error: comparison.error,
            ..blank(case, row)
        })
        .collect();
    if let Some(known) = row.answers[outcome.answer].index {
        let got = outcome.solution.report.morse_index;
        lines.push(Line {
            quantity: "ways to fall (Morse index)".into(),
            expected: known.to_string(),
            got: got.map_or_else(|| "not known".into(), |got| got.to_string()),
            error: got.map_or(f64::INFINITY, |got| got.abs_diff(known) as f64),
            tolerance: 0.0,
            ..blank(case, row)
        });
    }
    lines
}

fn unsolved(case: &Case, row: &Row, error: &CaseError) -> Line {
    let why = match error {
        CaseError::Solve(SolveFailure { reason, .. }) => reason.to_string(),
        CaseError::Rod(error) => error.to_string(),
    };
    Line { quantity: "a solution".into(), expected: "one".into(), got: why, ..blank(case, row) }
}

/// A line of a row before anything is known.
fn blank(case: &Case, row: &Row) -> Line {
    Line { label: row.label.clone(), ..Line::blank(&case.name, &case.title, case.source, case.tolerance) }
}

/// What was found; of the two quaternions of an orientation, the one next to the reference.
fn alike(comparison: &Comparison) -> Value {
    let (Value::Orientation(expected), Value::Orientation(got)) = (comparison.expected.value, comparison.got)
    else {
        return comparison.got;
    };
    let ([a, b], mut got) = ([expected.to_wxyz(), got.to_wxyz()], got);
    if a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
        got = Quat { w: -got.w, x: -got.x, y: -got.y, z: -got.z };
    }
    Value::Orientation(got)
}

/// A value to five digits; of a vector, to four. What is round-off of what its error is measured by is zero.
fn written(value: &Value, scale: f64) -> String {
    let among = |parts: &[f64]| {
        let size = parts.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let least = (1e-5 * size).max(1e-12 * scale);
        let part = |x: &f64| if x.abs() < least { "0".to_owned() } else { digits(*x, 4) };
        parts.iter().map(part).collect::<Vec<_>>().join(", ")
    };
    match value {
        Value::Scalar(x) => digits(*x, 5),
        Value::Vector(v) => format!("({})", among(&[v.x, v.y, v.z])),
        Value::Orientation(q) => format!("[{}]", among(&q.to_wxyz())),
    }
}

/// `position at s = 0.800000` as `position at s = 0.8`.
fn without_zeros(quantity: &str) -> String {
    let number = quantity.rsplit_once("= ").and_then(|(what, s)| Some((what, s.parse::<f64>().ok()?)));
    match number {
        Some((what, s)) => format!("{what}= {}", (s * 1e4).round() / 1e4),
        None => quantity.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_out_of_its_tolerance_and_a_row_without_a_solution_fail() {
        let case = strands_cases::find("steel-tip-wrench").expect("a case of that name");
        assert!(lines(&case).iter().all(Line::ok));
        let strict = lines(&Case { tolerance: 1e-18, ..case.clone() });
        assert!(strict.iter().any(|line| !line.ok()), "{strict:?}");
        let uncut = lines(&Case { elements: 0, ..case });
        assert!(uncut.len() == 1 && !uncut[0].ok() && uncut[0].got.contains("element"), "{uncut:?}");
    }
}
