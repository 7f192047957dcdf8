//! The lines of the rods that vibrate.

use strands_cases::{VibrationCase, VibrationRow};

use super::Entry;
use super::line::Line;
use crate::units::digits;

/// An entry for each case of vibrations.
pub fn entries() -> Vec<Entry> {
    let entry = |case: VibrationCase| Entry { name: case.name.into(), lines: Box::new(move || lines(&case)) };
    strands_cases::all_vibrations().into_iter().map(entry).collect()
}

fn lines(case: &VibrationCase) -> Vec<Line> {
    case.rows.iter().flat_map(|row| compared(case, row)).collect()
}

/// The frequencies of a row by two meshes, beside the known ones.
fn compared(case: &VibrationCase, row: &VibrationRow) -> Vec<Line> {
    let found = match row.on_two_meshes(case.elements) {
        Ok([_, found]) => found,
        Err(error) => {
            let got = error.to_string();
            return vec![Line { expected: "its modes".into(), got, ..blank(case, row) }];
        }
    };
    let modes = row.frequencies.iter().zip(found).enumerate();
    modes
        .map(|(k, (expected, got))| Line {
            quantity: format!("frequency {}", k + 1),
            expected: digits(*expected, 5),
            got: digits(got, 5),
            error: (got / expected - 1.0).abs(),
            ..blank(case, row)
        })
        .collect()
}

/// A line of a row before anything is known.
fn blank(case: &VibrationCase, row: &VibrationRow) -> Line {
    Line {
        label: row.label.clone(),
        quantity: "frequencies".into(),
        ..Line::blank(case.name, case.title, case.source, case.tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frequency_out_of_its_tolerance_and_a_rod_that_is_not_cut_fail() {
        let case = strands_cases::all_vibrations().into_iter().find(|case| case.name == "waves-with-a-body");
        let case = case.expect("a case of that name");
        assert!(lines(&case).iter().all(Line::ok));
        let strict = lines(&VibrationCase { tolerance: 1e-18, ..case.clone() });
        assert!(strict.iter().any(|line| !line.ok()), "{strict:?}");
        let uncut = lines(&VibrationCase { elements: 0, ..case });
        assert!(uncut.iter().all(|line| !line.ok()) && uncut[0].got.contains("element"), "{uncut:?}");
    }
}
