//! Columns beyond their buckling load: Euler's elastica.
//!
//! Each is so stiff across the plane of x and y that it stays in it; there it may go to either side. The load, or where it pushes the end to, is
//! given: by both the same shapes are found.
//!
//! Just beyond its buckling load how far a rod goes depends on the last digits of the load: where the load is given, moment and energy are measured
//! by the load and the length.

use crate::planar::{along_x, force, kept_in_plane, straight, turned};
use crate::table::{Record, Table};
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::load::Frame;
use strands::math::{Pose, Vec3, Wrench};
use strands::statics::Support;

const LENGTH: f64 = 0.8;
const BENDING: f64 = 0.05;
const TOLERANCE: f64 = 1e-6;

pub(crate) fn cases() -> Vec<Case> {
    let mut cases = vec![column()];
    for ends in [Ends::Pinned, Ends::Clamped] {
        cases.extend([between(ends, Given::Distance), between(ends, Given::Load)]);
    }
    cases
}

/// The shape and its mirror image.
fn both_sides(side: impl Fn(f64) -> Vec<Expected>) -> Vec<Answer> {
    [1.0, -1.0].map(|sign| Answer::stable(side(sign))).to_vec()
}

fn column() -> Case {
    let table = Table::read(include_str!("../data/column_buckled.csv"));
    let rows = table.records().map(|record| {
        let [x, y, angle] = ["x", "y", "tip_angle"].map(|column| record.number(column));
        let load = record.number("force");
        let answers = both_sides(|side| {
            vec![
                Expected::position(LENGTH, Vec3::new(x, side * y, 0.0), LENGTH),
                Expected::orientation(LENGTH, turned(side * angle.to_radians())),
                Expected::vector(Quantity::BaseMoment, Vec3::Z * (side * load * y))
                    .measured_by(load * LENGTH),
                Expected::scalar(Quantity::ElasticEnergy, record.number("energy")).measured_by(load * LENGTH),
            ]
        });
        let description = kept_in_plane(straight(LENGTH, BENDING, None));
        let tip = Tip::Wrench { wrench: force(-load, 0.0), frame: Frame::World };
        Row {
            label: format!("P/P_E = {}, tip at {angle}°", record.number("ratio")),
            setup: Setup::cantilever(description).with_tip(tip),
            start: Start::Cold,
            answers,
        }
    });
    Case {
        name: "buckled-column".into(),
        title: "A column that a dead load on its top has buckled".into(),
        source: "Timoshenko & Gere, Theory of Elastic Stability, 1961, sec. 2.7: Euler's elastica in closed form",
        tolerance: TOLERANCE,
        elements: 400,
        rows: rows.collect(),
        remark: None,
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Ends {
    Pinned,
    Clamped,
}

#[derive(Clone, Copy, PartialEq)]
enum Given {
    Distance,
    Load,
}

fn between(ends: Ends, given: Given) -> Case {
    let table = Table::read(include_str!("../data/end_shortening.csv"));
    let (held, how) = match ends {
        Ends::Pinned => ("pinned", "between pins"),
        Ends::Clamped => ("clamped", "between clamps"),
    };
    let (name, what) = match given {
        Given::Distance => ("distance", "its ends at a distance"),
        Given::Load => ("load", "pressed by a dead load"),
    };
    Case {
        name: format!("buckled-{held}-{name}"),
        title: format!("A buckled rod {how}, {what}"),
        source: "Love, Mathematical Theory of Elasticity, 1927; Timoshenko & Gere 1961: Euler's elastica in closed form",
        tolerance: TOLERANCE,
        elements: 400,
        rows: table.records().map(|record| shortened(&record, held, ends, given)).collect(),
        remark: None,
    }
}

fn shortened(record: &Record<'_>, held: &str, ends: Ends, given: Given) -> Row {
    let distance = LENGTH - record.number("shortening");
    let load = Vec3::X * -record.number(&format!("{held}_force"));
    let far = Pose { position: Vec3::X * distance, ..along_x() };
    let support = |pose| match ends {
        Ends::Pinned => Support::pinned(pose),
        Ends::Clamped => Support::clamped(pose),
    };
    let mut start = support(along_x());
    // The rod as a whole must not turn about its axis.
    start.fixed[2] = true;
    let setup = Setup::cantilever(kept_in_plane(straight(LENGTH, BENDING, None))).held(0.0, start);
    let setup = match given {
        Given::Distance => setup.held(LENGTH, support(far)),
        Given::Load => setup.held(LENGTH, support(far).sliding_along(Vec3::X)).with_force(LENGTH, load),
    };
    let mut answers = both_sides(|side| {
        let energy = Expected::scalar(Quantity::ElasticEnergy, record.number(&format!("{held}_energy")));
        let middle = Vec3::new(0.5 * distance, side * record.number("deflection"), 0.0);
        vec![
            Expected::position(0.5 * LENGTH, middle, LENGTH),
            Expected::position(LENGTH, far.position, LENGTH),
            Expected::vector(Quantity::BaseForce, load),
            match given {
                Given::Distance => energy,
                Given::Load => energy.measured_by(load.norm() * LENGTH),
            },
        ]
    });
    let angle = record.number("angle");
    // Where the ends have passed each other there are shapes that need less energy, and pinned ones may turn about to them; this one is on the
    // path from those before.
    let start = if angle < 130.0 { Start::Cold } else { beside(record, ends, far, load) };
    if angle > 130.0 {
        answers.iter_mut().for_each(|answer| answer.index = None);
    }
    Row { label: format!("{angle}°"), setup, start, answers }
}

/// The end of the shape itself, in closed form.
fn beside(record: &Record<'_>, ends: Ends, far: Pose, load: Vec3) -> Start {
    let (turn, moment) = match ends {
        Ends::Pinned => (-record.number("angle").to_radians(), 0.0),
        // Of the two inflections each is half way aside.
        Ends::Clamped => (0.0, -0.5 * load.x * record.number("deflection")),
    };
    let pose = Pose::from_parts(far.position, turned(turn));
    let in_frame = |v| pose.rotation.transpose_mul(v);
    Start::Near { pose, wrench: Wrench::new(in_frame(Vec3::Z * moment), in_frame(load)) }
}
