//! Random rods clamped at both ends: every equilibrium that a search found, most of them unstable.

use crate::table::{Record, Table};
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::math::Pose;
use strands::rod::{Kinematics, Law, Profile, RestShape, RodDescription, Stiffness};

pub(crate) fn cases() -> Vec<Case> {
    let kirchhoff = [
        include_str!("../data/pose_kirchhoff_problems.csv"),
        include_str!("../data/pose_kirchhoff_equilibria.csv"),
    ];
    let cosserat = [
        include_str!("../data/pose_cosserat_problems.csv"),
        include_str!("../data/pose_cosserat_equilibria.csv"),
    ];
    let mut cases = Vec::new();
    for (kinematics, [problems, equilibria]) in [("kirchhoff", kirchhoff), ("cosserat", cosserat)] {
        let equilibria = Table::read(equilibria);
        cases.extend(Table::read(problems).records().map(|record| random(kinematics, &record, &equilibria)));
    }
    cases
}

/// A random rod at the origin: its law, and rest curvature and twist that grow evenly along it.
pub(crate) fn description(record: &Record<'_>) -> RodDescription {
    let number = |column| record.number(column);
    let (from, growth) = (vector123(record, "a"), vector123(record, "b"));
    let length = number("length");
    RodDescription {
        length,
        kinematics: match record.text("kinematics") {
            "kirchhoff" => Kinematics::Kirchhoff,
            _ => Kinematics::Cosserat,
        },
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness {
                bending: [number("EI1"), number("EI2")],
                torsion: number("GJ"),
                axial: number("EA"),
                shear: [number("GA1"), number("GA2")],
            }),
            mass_per_length: 0.0,
            rotational_inertia_per_length: strands::math::Vec3::ZERO,
            half_extent: [0.005 * length; 2],
        },
        rest: RestShape::Samples(vec![(0.0, from), (length, from + growth)]),
        base: Pose::IDENTITY,
    }
}

fn vector123(record: &Record<'_>, prefix: &str) -> strands::math::Vec3 {
    let [x, y, z] = [1, 2, 3].map(|i| record.number(&format!("{prefix}{i}")));
    strands::math::Vec3::new(x, y, z)
}

fn random(kinematics: &str, record: &Record<'_>, equilibria: &Table) -> Case {
    let name = record.text("name");
    let tip = Pose::from_parts(record.vector("t"), record.quaternion("q"));
    let setup =
        Setup::cantilever(description(record)).with_weight(record.vector("w")).with_tip(Tip::Pose(tip));
    let length = setup.description.length;
    let answers = equilibria
        .records()
        .filter(|equilibrium| equilibrium.text("name") == name)
        .map(|equilibrium| answer(&equilibrium, &tip, length));
    Case {
        name: format!("pose-{kinematics}-{name}"),
        title: format!("A random {kinematics} rod clamped at both ends, number {name}"),
        source: "manufactured from a base wrench, all others by multistart shooting; stability by conjugate points (Bretl & McCarthy, \
                 IJRR 33:48–68, 2014) and by the Hessian",
        tolerance: 1e-6,
        elements: 800,
        rows: vec![Row {
            label: "all equilibria".into(),
            setup,
            start: Start::Cold,
            answers: answers.collect(),
        }],
        remark: Some("At most the twelve of least energy are listed; the search may have missed some."),
    }
}

fn answer(record: &Record<'_>, tip: &Pose, length: f64) -> Answer {
    let along = |part: f64, prefix| Expected::position(part * length, record.vector(prefix), length);
    let wrench = |quantity, prefix| Expected::vector(quantity, record.vector(prefix));
    // The load's energy passes through zero; its error counts beside the elastic energy.
    let energies = ["elastic_energy", "load_energy"].map(|column| record.number(column));
    let energy = |quantity, value: f64| {
        Expected::scalar(quantity, value).measured_by(energies[0].abs().max(energies[1].abs()))
    };
    let expected = vec![
        along(0.25, "q"),
        along(0.5, "h"),
        along(0.75, "t"),
        Expected::position(length, tip.position, length),
        Expected::orientation(length, tip.orientation()),
        wrench(Quantity::BaseForce, "n"),
        wrench(Quantity::BaseMoment, "m"),
        wrench(Quantity::TipForce, "N"),
        wrench(Quantity::TipMoment, "M"),
        energy(Quantity::ElasticEnergy, energies[0]),
        energy(Quantity::LoadEnergy, energies[1]),
    ];
    Answer { expected, index: record.count("index") }
}
