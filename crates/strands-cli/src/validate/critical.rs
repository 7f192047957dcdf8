//! The lines of the families with reference critical loads.

use strands::rod::Order;
use strands_cases::{Branch, CaseError, CriticalCase, CriticalLoad};

use super::Entry;
use super::line::Line;
use crate::units::digits;

/// An entry for each case of critical loads.
pub fn entries() -> Vec<Entry> {
    let entry = |case: CriticalCase| Entry { name: case.name.clone(), lines: Box::new(move || lines(&case)) };
    strands_cases::all_critical().into_iter().map(entry).collect()
}

fn lines(case: &CriticalCase) -> Vec<Line> {
    let branches = case.branches.iter();
    branches
        .flat_map(|branch| compared(case, branch, branch.critical_loads(case.elements, Order::Fourth)))
        .collect()
}

/// The loads of a branch beside the known ones, in their order; one more or less than is known is a failure.
fn compared(case: &CriticalCase, branch: &Branch, found: Result<Vec<CriticalLoad>, CaseError>) -> Vec<Line> {
    let found = match found {
        Ok(found) => found,
        Err(error) => {
            let got = error.to_string();
            return vec![Line { expected: "the branch".into(), got, ..blank(case, branch) }];
        }
    };
    let known = &branch.critical;
    if known.is_empty() && found.is_empty() {
        let none = || format!("none up to {}", digits(branch.up_to, 5));
        return vec![Line { expected: none(), got: none(), error: 0.0, ..blank(case, branch) }];
    }
    (0..known.len().max(found.len()))
        .flat_map(|k| at_load(case, branch, k, known.get(k).copied(), found.get(k).copied()))
        .collect()
}

/// One critical load, and how many ways to fall there are below and above it where that is known.
fn at_load(
    case: &CriticalCase,
    branch: &Branch,
    k: usize,
    known: Option<f64>,
    found: Option<CriticalLoad>,
) -> Vec<Line> {
    let written = |load: Option<f64>| load.map_or_else(|| "none".into(), |load| digits(load, 5));
    let got = found.map(|found| found.load);
    let error = known.zip(got).map_or(f64::INFINITY, |(known, got)| (got / known - 1.0).abs());
    let label = match branch.critical.len() {
        0 | 1 => branch.label.clone(),
        _ => format!("{}, load {}", branch.label, k + 1),
    };
    let load = Line {
        label: label.clone(),
        expected: written(known),
        got: written(got),
        error,
        ..blank(case, branch)
    };
    let index =
        known.and(found).and_then(|found| found.index).into_iter().flat_map(|index| {
            [("below", index[0], k * branch.ways), ("above", index[1], (k + 1) * branch.ways)]
        });
    let index = index.map(|(side, got, expected)| Line {
        label: label.clone(),
        quantity: format!("Morse index {side}"),
        expected: expected.to_string(),
        got: got.to_string(),
        error: got.abs_diff(expected) as f64,
        tolerance: 0.0,
        ..blank(case, branch)
    });
    std::iter::once(load).chain(index).collect()
}

/// A line of a branch before anything is known.
fn blank(case: &CriticalCase, branch: &Branch) -> Line {
    Line {
        label: branch.label.clone(),
        quantity: "critical load".into(),
        ..Line::blank(&case.name, &case.title, case.source, case.tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_too_many_too_few_or_off_and_a_wrong_index_fail() {
        let case = strands_cases::all_critical().into_iter().find(|case| case.name == "euler-loads");
        let case = case.expect("a case of that name");
        let branch = &case.branches[0];
        let load = |k: usize| CriticalLoad { load: branch.critical[k], index: Some([k, k + 1]) };
        let failed = |found| compared(&case, branch, Ok(found)).iter().filter(|line| !line.ok()).count();
        let all = || (0..branch.critical.len()).map(load).collect::<Vec<_>>();
        assert_eq!(failed(all()), 0);
        assert_eq!(failed(all()[..2].to_vec()), 1);
        assert_eq!(failed([all(), vec![load(0)]].concat()), 1);
        assert_eq!(failed([vec![CriticalLoad { load: 1.0, ..load(0) }], all()[1..].to_vec()].concat()), 1);
        assert_eq!(
            failed([vec![CriticalLoad { index: Some([0, 2]), ..load(0) }], all()[1..].to_vec()].concat()),
            1
        );
    }
}
