//! Rods under their weight that hang between two places, stiff or hardly so, down to the catenary; and from one place.

use crate::planar::{along_x, energy, moment, row, straight, turned};
use crate::table::Table;
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::math::{Pose, Vec3, Wrench};
use strands::statics::Support;

pub(crate) fn cases() -> Vec<Case> {
    vec![romero(), clamped(), catenary_limit(), hanging(), catenary()]
}

fn romero() -> Case {
    let table = Table::read(include_str!("../data/romero_cantilever.csv"));
    let rows = table.records().map(|record| {
        let gamma = record.number("gamma");
        let at = Vec3::new(record.number("reach"), -record.number("drop"), 0.0);
        let expected = vec![
            Expected::position(1.0, at, 1.0),
            Expected::deflection(1.0, -Vec3::Y, record.number("drop")),
            Expected::deflection(1.0, Vec3::X, record.number("reach")),
            Expected::orientation(1.0, turned(record.number("tip_angle"))),
        ];
        let label = format!("Γ = {gamma}, H/W = {:.6}", record.number("aspect"));
        let mut row = row(label, straight(1.0, 1.0, None), Wrench::ZERO, expected);
        row.setup = row.setup.with_weight(Vec3::Y * -gamma);
        row
    });
    Case {
        name: "romero-cantilever".into(),
        title: "The cantilever test: drop over reach against the gravito-bending number".into(),
        source: "Romero et al., ACM TOG 40(4):66, 2021; computed twice, shooting and collocation agree to 1e-13",
        tolerance: 1e-6,
        elements: 400,
        rows: rows.collect(),
        remark: Some("Romero et al. accept a few percent of H/W from a measurement."),
    }
}

/// A rod that is stiffer than this, over `w L³`, needs few elements.
const STIFF: f64 = 9e-4;

fn clamped() -> Case {
    Case {
        name: "heavy-clamped".into(),
        title: "A heavy rod between two clamps, from hardly heavy on".into(),
        elements: 400,
        ..between_clamps(|stiffness| stiffness > STIFF)
    }
}

fn catenary_limit() -> Case {
    Case {
        name: "catenary-limit".into(),
        title: "A heavy wire between two clamps that is nearly a catenary".into(),
        elements: 2400,
        ..between_clamps(|stiffness| stiffness < STIFF)
    }
}

/// The rows of which the stiffness over `w L³` is kept.
fn between_clamps(keep: impl Fn(f64) -> bool) -> Case {
    const LENGTH: f64 = 1.5;
    const WEIGHT: f64 = 0.9;
    let table = Table::read(include_str!("../data/heavy_clamped.csv"));
    let rows = table.records().filter(|record| keep(record.number("beta"))).map(|record| {
        let span = record.number("span");
        let far = Pose { position: Vec3::X * span, ..along_x() };
        let weight = WEIGHT * LENGTH;
        let bending = record.number("bending");
        // Over this length the rod turns to its clamps.
        let layer = (bending / record.number("pull").abs().max(0.1 * weight)).sqrt();
        // A wire stores next to nothing beside what it has fallen by: the two energies count together.
        let energies = ["elastic_energy", "load_energy"].map(|column| record.number(column));
        let energy = |quantity, value| {
            Expected::scalar(quantity, value).measured_by(energies[0].abs().max(energies[1].abs()))
        };
        let expected = vec![
            Expected::position(0.5 * LENGTH, Vec3::new(0.5 * span, -record.number("sag"), 0.0), LENGTH),
            Expected::vector(Quantity::BaseForce, Vec3::new(record.number("pull"), -0.5 * weight, 0.0)),
            moment(record.number("base_moment")),
            energy(Quantity::ElasticEnergy, energies[0]),
            energy(Quantity::LoadEnergy, energies[1]),
        ];
        Row {
            label: format!("D/L = {:.2}, EI/w L³ = {}", span / LENGTH, record.number("beta")),
            setup: Setup::cantilever(straight(LENGTH, bending, None))
                .with_weight(Vec3::Y * -WEIGHT)
                .fine_at_ends((10.0 * layer).min(0.2 * LENGTH))
                .with_tip(Tip::Pose(far)),
            start: Start::Cold,
            answers: vec![Answer::stable(expected)],
        }
    });
    Case {
        name: String::new(),
        title: String::new(),
        source: "Wolfe 1993; computed by collocation to 1e-13, and again by another to 1e-8",
        tolerance: 1e-7,
        elements: 0,
        rows: rows.collect(),
        remark: None,
    }
}

fn hanging() -> Case {
    let table = Table::read(include_str!("../data/hanging.csv"));
    let rows = table.records().map(|record| {
        let [axial, weight, length, pull] =
            ["EA", "weight", "length", "force"].map(|column| record.number(column));
        let expected = vec![
            Expected::position(length, Vec3::X * record.number("stretched_length"), length),
            energy(&record),
        ];
        let label = format!("EA = {axial}, w = {weight}, L = {length}, P = {pull}");
        let wrench = Wrench::new(Vec3::ZERO, Vec3::X * pull);
        let mut row = row(label, straight(length, 1.0, Some([axial; 2])), wrench, expected);
        row.setup = row.setup.with_weight(Vec3::X * weight);
        row.answers[0].index = Some(0);
        row
    });
    Case {
        name: "hanging-rod".into(),
        title: "A rod that hangs from its base and stretches".into(),
        source: "closed form; Irvine, Cable Structures, 1981, sec. 2.3",
        tolerance: 1e-6,
        elements: 1000,
        rows: rows.collect(),
        remark: None,
    }
}

/// The bending stiffness of what should have none, over `w L³`. Between pins the shape is off by as much.
const HARDLY_STIFF: f64 = 5e-8;

fn catenary() -> Case {
    let table = Table::read(include_str!("../data/elastic_catenary.csv"));
    let rows = table.records().map(|record| {
        let [length, weight, axial, span, drop] =
            ["length", "weight", "EA", "span", "drop"].map(|column| record.number(column));
        let pull = Vec3::new(record.number("pull"), -record.number("pull_down"), 0.0);
        let middle = Vec3::new(record.number("mid_x"), -record.number("mid_depth"), 0.0);
        let expected = vec![
            Expected::position(0.5 * length, middle, length),
            Expected::vector(Quantity::BaseForce, pull),
            Expected::vector(Quantity::TipForce, pull + Vec3::Y * (weight * length)),
        ];
        let bending = HARDLY_STIFF * weight * length * length * length;
        let mut start = Support::pinned(along_x());
        start.fixed[2] = true;
        let far = Pose { position: Vec3::new(span, -drop, 0.0), ..along_x() };
        Row {
            label: format!("EA = {axial}, D = {span}, h = {drop}"),
            setup: Setup::cantilever(straight(length, bending, Some([axial; 2])))
                .with_weight(Vec3::Y * -weight)
                .held(0.0, start)
                .held(length, Support::pinned(far)),
            start: Start::Cold,
            answers: vec![Answer::new(expected)],
        }
    });
    Case {
        name: "elastic-catenary".into(),
        title: "A wire that stretches and hardly resists bending, hung between two pins".into(),
        source: "Irvine, Cable Structures, 1981, sec. 2.3: closed form without bending stiffness",
        tolerance: 1e-6,
        elements: 3000,
        rows: rows.collect(),
        remark: None,
    }
}
