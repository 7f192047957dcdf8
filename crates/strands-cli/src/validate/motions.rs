//! The lines of the rods that move far.

use strands::math::Vec3;
use strands_cases::{Moment, MotionCase};

use super::Entry;
use super::line::Line;
use crate::units::digits;

/// An entry for each case of motions.
pub fn entries() -> Vec<Entry> {
    let entry = |case: MotionCase| Entry { name: case.name.into(), lines: Box::new(move || lines(&case)) };
    strands_cases::all_motions().into_iter().map(entry).collect()
}

/// Where the rod is at each time that is known, by two meshes.
fn lines(case: &MotionCase) -> Vec<Line> {
    match case.on_two_meshes() {
        Ok([_, found]) => {
            case.moments.iter().zip(&found).map(|(known, found)| compared(case, known, found)).collect()
        }
        Err(error) => {
            vec![Line { expected: "a motion".into(), got: error.to_string(), ..blank(case) }]
        }
    }
}

/// Both ends and the centre of mass; the end is what is printed.
fn compared(case: &MotionCase, known: &Moment, found: &Moment) -> Line {
    let [_, expected, _] = known.places.map(place);
    let [_, got, _] = found.places.map(place);
    Line {
        label: format!("{} s", digits(known.time, 5)),
        expected,
        got,
        error: known.apart(found),
        ..blank(case)
    }
}

fn place(place: Vec3) -> String {
    let [x, y, z] = place.to_array().map(|x| digits(x, 5));
    format!("({x}, {y}, {z}) m")
}

fn blank(case: &MotionCase) -> Line {
    Line { quantity: "place".into(), ..Line::blank(case.name, case.title, case.source, case.tolerance) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rod_elsewhere_and_one_that_is_not_cut_fail() {
        let case = strands_cases::all_motions().into_iter().find(|case| case.name == "soft-drop");
        let mut case = case.expect("a case of that name");
        assert!(lines(&case).iter().all(Line::ok));
        case.tolerance = 1e-18;
        let strict = lines(&case);
        assert!(strict.iter().any(|line| !line.ok()), "{strict:?}");
        case.elements = 0;
        let uncut = lines(&case);
        assert!(uncut.iter().all(|line| !line.ok()) && uncut[0].got.contains("element"), "{uncut:?}");
    }
}
