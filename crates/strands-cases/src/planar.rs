//! Rods that bend in the plane of x and y: elasticas under end loads and under their weight, and rods that stretch and shear.
//!
//! The base is at the origin with `d3 = x`, `d1 = y`, `d2 = z`, so that bending in the plane is about `d2` and counter-clockwise is
//! positive.

use crate::table::{Record, Table};
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::load::Frame;
use strands::math::{Mat3, Pose, Quat, Vec3, Wrench};
use strands::rod::{Kinematics, Law, Profile, RestShape, RodDescription, Stiffness};

/// How close converged solutions come to figures that are good to at least nine digits.
const TOLERANCE: f64 = 1e-6;

/// How many times as stiff across the plane a rod is that must not leave it.
const ACROSS: f64 = 30.0;

pub(crate) fn cases() -> Vec<Case> {
    vec![dead_load(), follower_load(), end_moment(), heavy_cantilever(), reissner(), timoshenko()]
}

/// The frame of a planar rod that points along x.
pub(crate) fn along_x() -> Pose {
    Pose { rotation: Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X), position: Vec3::ZERO }
}

/// A straight rod along x whose stiffnesses against bending and torsion are all `bending`, `[EA, GA]` where it stretches and shears.
pub(crate) fn straight(length: f64, bending: f64, stretch: Option<[f64; 2]>) -> RodDescription {
    let [axial, shear] = stretch.unwrap_or([1.0; 2]);
    let stiffness = Stiffness { bending: [bending; 2], torsion: bending, axial, shear: [shear; 2] };
    RodDescription {
        length,
        kinematics: if stretch.is_some() { Kinematics::Cosserat } else { Kinematics::Kirchhoff },
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: 0.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.005 * length; 2],
        },
        rest: RestShape::default(),
        base: along_x(),
    }
}

/// The same rod, so stiff against bending across the plane and against torsion that it stays in the plane.
pub(crate) fn kept_in_plane(mut description: RodDescription) -> RodDescription {
    if let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile {
        stiffness.bending[0] *= ACROSS;
        stiffness.torsion *= ACROSS;
    }
    description
}

pub(crate) fn force(x: f64, y: f64) -> Wrench {
    Wrench::new(Vec3::ZERO, Vec3::new(x, y, 0.0))
}

pub(crate) fn row(
    label: String,
    description: RodDescription,
    wrench: Wrench,
    expected: Vec<Expected>,
) -> Row {
    Row {
        label,
        setup: Setup::cantilever(description).with_tip(Tip::Wrench { wrench, frame: Frame::World }),
        start: Start::Cold,
        answers: vec![Answer::new(expected)],
    }
}

/// The tip's place and orientation.
pub(crate) fn tip(record: &Record<'_>, length: f64, angle: f64) -> [Expected; 2] {
    let at = Vec3::new(record.number("x"), record.number("y"), 0.0);
    [Expected::position(length, at, length), Expected::orientation(length, turned(angle))]
}

/// The orientation of a frame that is turned by an angle from the base's.
pub(crate) fn turned(angle: f64) -> Quat {
    Quat::from_matrix(Quat::from_rotation_vector(Vec3::Z * angle).to_matrix() * along_x().rotation)
}

pub(crate) fn moment(value: f64) -> Expected {
    Expected::vector(Quantity::BaseMoment, Vec3::Z * value)
}

pub(crate) fn energy(record: &Record<'_>) -> Expected {
    Expected::scalar(Quantity::ElasticEnergy, record.number("energy"))
}

fn dead_load() -> Case {
    let table = Table::read(include_str!("../data/cantilever_dead_load.csv"));
    let rows = table.records().map(|record| {
        let mut expected = tip(&record, 0.8, -record.number("tip_angle")).to_vec();
        expected.extend([moment(-record.number("base_moment")), energy(&record)]);
        let label = format!("P L²/EI = {}", record.number("alpha"));
        row(label, straight(0.8, 0.05, None), force(0.0, -record.number("force")), expected)
    });
    Case {
        name: "cantilever-dead-load".into(),
        title: "Cantilever with a dead force across its tip".into(),
        source: "Bisshopp & Drucker, Quart. Appl. Math. 3:272–275, 1945: elliptic integrals, 30 digits",
        tolerance: TOLERANCE,
        elements: 400,
        rows: rows.collect(),
        remark: None,
    }
}

fn follower_load() -> Case {
    let table = Table::read(include_str!("../data/cantilever_follower_load.csv"));
    let rows = table.records().map(|record| {
        let load = record.number("force");
        let mut expected = tip(&record, 0.8, record.number("tip_angle")).to_vec();
        // The moment passes through zero where the tip has turned back: the lever is the rod.
        expected.push(moment(record.number("base_moment")).measured_by(load * 0.8));
        expected.push(energy(&record));
        let label = format!("P L²/EI = {}", record.number("alpha"));
        let mut row = row(label, straight(0.8, 0.05, None), force(0.0, 0.0), expected);
        // The left normal of the tip is its d1.
        let wrench = Wrench::new(Vec3::ZERO, Vec3::X * load);
        row.setup = row.setup.with_tip(Tip::Wrench { wrench, frame: Frame::Body });
        row
    });
    Case {
        name: "cantilever-follower-load".into(),
        title: "Cantilever with a force that stays across its tip".into(),
        source: "closed form of the rectangular elastica; Argyris & Symeonidis, CMAME 26:75–123, 1981",
        tolerance: TOLERANCE,
        elements: 200,
        rows: rows.collect(),
        remark: None,
    }
}

fn end_moment() -> Case {
    let table = Table::read(include_str!("../data/cantilever_end_moment.csv"));
    let rows = table.records().map(|record| {
        let bend = record.number("moment");
        let mut expected = tip(&record, 0.8, record.number("tip_angle")).to_vec();
        expected.extend([moment(bend), energy(&record)]);
        let label = format!("{} turns", record.number("turns"));
        row(label, straight(0.8, 0.05, None), Wrench::new(Vec3::Z * bend, Vec3::ZERO), expected)
    });
    Case {
        name: "cantilever-end-moment".into(),
        title: "Cantilever bent to circles by a moment at its tip".into(),
        source: "Euler; Simo & Vu-Quoc, CMAME 58:79–116, 1986, pure bending",
        tolerance: TOLERANCE,
        elements: 100,
        rows: rows.collect(),
        remark: None,
    }
}

fn heavy_cantilever() -> Case {
    let table = Table::read(include_str!("../data/heavy_cantilever.csv"));
    let rows = table.records().map(|record| {
        let weight = record.number("weight");
        let mut expected = tip(&record, 0.6, record.number("tip_angle")).to_vec();
        expected.extend([
            Expected::vector(Quantity::BaseForce, Vec3::Y * (-weight * 0.6)),
            moment(record.number("base_moment")),
            Expected::scalar(Quantity::ElasticEnergy, record.number("elastic_energy")),
            Expected::scalar(Quantity::LoadEnergy, record.number("load_energy")),
        ]);
        let label = format!("w L³/EI = {}", record.number("gamma"));
        let mut row = row(label, straight(0.6, 0.02, None), force(0.0, 0.0), expected);
        row.setup.force_per_length = Vec3::Y * -weight;
        row
    });
    Case {
        name: "heavy-cantilever".into(),
        title: "Cantilever under its own weight".into(),
        source: "Bickley, Phil. Mag. 17:603–622, 1934; Rohde, Quart. Appl. Math. 11:337–338, 1953; Romero et al., ACM TOG \
                 40(4):66, 2021; computed twice, shooting and collocation agree to 1e-13",
        tolerance: TOLERANCE,
        elements: 400,
        rows: rows.collect(),
        remark: None,
    }
}

fn reissner() -> Case {
    let table = Table::read(include_str!("../data/reissner_cantilever.csv"));
    let rows = table.records().map(|record| {
        let [axial, shear] = ["EA", "GA"].map(|column| record.number(column));
        let [fx, fy, bend] = ["fx", "fy", "moment"].map(|column| record.number(column));
        let mut expected = tip(&record, 0.9, record.number("tip_angle")).to_vec();
        expected.extend([moment(record.number("base_moment")), energy(&record)]);
        let label = format!("EA = {axial}, GA = {shear}, F = ({fx}, {fy}), M = {bend}");
        let wrench = Wrench::new(Vec3::Z * bend, Vec3::new(fx, fy, 0.0));
        row(label, straight(0.9, 0.6, Some([axial, shear])), wrench, expected)
    });
    Case {
        name: "reissner-cantilever".into(),
        title: "Cantilever that stretches and shears".into(),
        source: "Reissner, ZAMP 23:795–804, 1972; computed twice, shooting and collocation agree to 1e-13",
        tolerance: TOLERANCE,
        elements: 200,
        rows: rows.collect(),
        remark: None,
    }
}

fn timoshenko() -> Case {
    let table = Table::read(include_str!("../data/timoshenko_cantilever.csv"));
    let rows = table.records().flat_map(|record| {
        let [axial, shear, bending, length] =
            ["EA", "GA", "EI", "length"].map(|column| record.number(column));
        let small = |load: &str, tip_force: Wrench, force_per_length: Vec3| {
            let [deflection, rotation] =
                ["deflection", "rotation"].map(|what| record.number(&format!("{load}_{what}")));
            let expected = vec![
                Expected::deflection(length, Vec3::Y, deflection),
                Expected::orientation(length, turned(rotation)).measured_by(rotation),
            ];
            let label = format!("GA = {shear}, EI = {bending}, L = {length}, {load}");
            let mut row = row(label, straight(length, bending, Some([axial, shear])), tip_force, expected);
            row.setup.force_per_length = force_per_length;
            row
        };
        [
            small("force", force(0.0, record.number("force")), Vec3::ZERO),
            small("weight", force(0.0, 0.0), Vec3::Y * record.number("weight")),
        ]
    });
    Case {
        name: "timoshenko-cantilever".into(),
        title: "Cantilever that shears, deflection and rotation of its tip under a small force or weight"
            .into(),
        source: "Timoshenko, Phil. Mag. 41:744–746, 1921; Gazzola et al., R. Soc. Open Sci. 5:171628, 2018",
        tolerance: TOLERANCE,
        elements: 100,
        rows: rows.collect(),
        remark: None,
    }
}
