//! Random rods, clamped at the base, of which three points are held in place and free to turn; the tip is free, or clamped too.

use crate::pose::description;
use crate::table::{Record, Table};
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::math::{Pose, Quat};
use strands::statics::Support;

const POINTS: [&str; 3] = ["a", "b", "c"];

pub(crate) fn cases() -> Vec<Case> {
    let problems = Table::read(include_str!("../data/three_points_problems.csv"));
    let equilibria = Table::read(include_str!("../data/three_points_equilibria.csv"));
    problems.records().map(|record| random(&record, &equilibria)).collect()
}

fn random(record: &Record<'_>, equilibria: &Table) -> Case {
    let name = record.text("name");
    let mut setup = Setup::cantilever(description(record)).with_weight(record.vector("w"));
    let length = setup.description.length;
    if record.figure("qw").is_some() {
        setup = setup.with_tip(Tip::Pose(Pose::from_parts(record.vector("t"), record.quaternion("q"))));
    }
    let places = POINTS.map(|point| record.number(&format!("s{point}")));
    for (point, place) in POINTS.iter().zip(places) {
        let pose = Pose::from_parts(record.vector(point), Quat::IDENTITY);
        setup = setup.held(place, Support::pinned(pose));
    }
    let answers = equilibria
        .records()
        .filter(|equilibrium| equilibrium.text("name") == name)
        .map(|equilibrium| answer(&equilibrium, places, length));
    Case {
        name: format!("three-points-{name}"),
        title: format!("A random rod of which three points are held in place, number {name}"),
        source: "manufactured by dead forces at the points, all others by Newton's method from 250 random starts; checked by collocation",
        tolerance: 1e-6,
        elements: 400,
        rows: vec![Row {
            label: "all equilibria".into(),
            setup,
            start: Start::Cold,
            answers: answers.collect(),
        }],
        remark: Some("The search may have missed some."),
    }
}

fn answer(record: &Record<'_>, places: [f64; 3], length: f64) -> Answer {
    let forces = POINTS.iter().zip(places).map(|(point, s)| (s, record.vector(point)));
    // The supports push against each other: each force counts beside the largest.
    let largest = forces.clone().fold(0.0, |max: f64, (_, force)| max.max(force.norm()));
    let energies = ["elastic_energy", "load_energy"].map(|column| record.number(column));
    let energy = |quantity, value| Expected::scalar(quantity, value).measured_by(energies[0]);
    let mut expected = vec![
        Expected::position(length, record.vector("t"), length),
        Expected::orientation(length, record.quaternion("q")),
        Expected::vector(Quantity::BaseForce, record.vector("n")),
        Expected::vector(Quantity::BaseMoment, record.vector("m")),
        energy(Quantity::ElasticEnergy, energies[0]),
        energy(Quantity::LoadEnergy, energies[1]),
    ];
    expected.extend(
        forces.map(|(s, force)| Expected::vector(Quantity::SupportForce { s }, force).measured_by(largest)),
    );
    Answer { expected, index: record.count("index") }
}
