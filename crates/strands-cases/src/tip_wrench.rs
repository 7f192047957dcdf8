//! The standard boundary value problem: random rods, clamped, with a dead wrench at the tip and a dead force all along; a steel rod and a
//! suture as in the workloads.

use crate::pose::description;
use crate::table::{Record, Table};
use crate::workloads::steel;
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::load::Frame;
use strands::math::{Vec3, Wrench};

pub(crate) fn cases() -> Vec<Case> {
    let problems = Table::read(include_str!("../data/tip_wrench_problems.csv"));
    let equilibria = Table::read(include_str!("../data/tip_wrench_equilibria.csv"));
    let mut cases: Vec<Case> = problems.records().map(|record| random(&record, &equilibria)).collect();
    cases.extend([steel_tip_wrench()]);
    cases
}

fn random(record: &Record<'_>, equilibria: &Table) -> Case {
    let name = record.text("name");
    let wrench = Wrench::new(record.vector("m"), record.vector("f"));
    let setup = Setup::cantilever(description(record))
        .with_weight(record.vector("w"))
        .with_tip(Tip::Wrench { wrench, frame: Frame::World });
    let length = setup.description.length;
    let answers =
        equilibria.records().filter(|equilibrium| equilibrium.text("name") == name).map(|record| Answer {
            expected: vec![
                Expected::position(length, record.vector("t"), length),
                Expected::orientation(length, record.quaternion("q")),
                Expected::vector(Quantity::BaseForce, record.vector("n")),
                Expected::vector(Quantity::BaseMoment, record.vector("m")),
                Expected::scalar(Quantity::ElasticEnergy, record.number("elastic_energy")),
                Expected::scalar(Quantity::LoadEnergy, record.number("load_energy")),
            ],
            index: record.count("index"),
        });
    Case {
        name: format!("tip-wrench-{name}"),
        title: format!("A random rod with a tip wrench and a weight, number {name}"),
        source: "the problem of Pai, Computer Graphics Forum 21:347–352, 2002; shooting and collocation agree to 1e-13",
        tolerance: 1e-6,
        elements: 200,
        rows: vec![Row {
            label: "all equilibria".into(),
            setup,
            start: Start::Cold,
            answers: answers.collect(),
        }],
        remark: None,
    }
}

const TILL: &str =
    "computed with the Runge–Kutta shooting of ContinuumRobotExamples (J. Till, 2022) on 1601 nodes";

fn steel_tip_wrench() -> Case {
    let rod = steel();
    let length = rod.description.length;
    let wrench = Wrench::new(Vec3::new(0.1, -0.05, 0.08), Vec3::new(1.0, -0.5, -0.3));
    let tip = Vec3::new(0.217_102_720_241, -0.157_120_280_521, 0.402_280_434_480);
    let moment = Vec3::new(0.348_276_301_396, 0.444_408_587_943, 0.136_106_955_734);
    Case {
        name: "steel-tip-wrench".into(),
        title: "A steel rod with a wrench at its tip, and its weight".into(),
        source: TILL,
        tolerance: 1e-6,
        elements: 100,
        rows: vec![Row {
            label: "F = (1, −0.5, −0.3) N, M = (0.1, −0.05, 0.08) N·m".into(),
            setup: rod.with_tip(Tip::Wrench { wrench, frame: Frame::World }),
            start: Start::Cold,
            answers: vec![Answer::new(vec![
                Expected::position(length, tip, length),
                Expected::vector(Quantity::BaseMoment, moment),
            ])],
        }],
        remark: None,
    }
}
