//! Rods that bend out of a plane and twist: the 45° bend, the helix roll-up, MacNeal and Harder's beams.

use crate::planar::straight;
use crate::table::Table;
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use core::f64::consts::{FRAC_PI_2, PI};
use strands::load::Frame;
use strands::math::{Mat3, Pose, Quat, Vec3, Wrench};
use strands::rod::{Kinematics, Law, Profile, RestShape, RodDescription, Stiffness};

pub(crate) fn cases() -> Vec<Case> {
    vec![bend_45(), helix_roll_up("cosserat"), helix_roll_up("kirchhoff"), twisted_beam(), curved_beam()]
}

fn given(stiffness: Stiffness) -> Profile {
    Profile::Given {
        law: Law::Diagonal(stiffness),
        mass_per_length: 0.0,
        rotational_inertia_per_length: Vec3::ZERO,
        half_extent: [0.5; 2],
    }
}

fn dead(moment: Vec3, force: Vec3) -> Tip {
    Tip::Wrench { wrench: Wrench::new(moment, force), frame: Frame::World }
}

fn bend_45() -> Case {
    const RADIUS: f64 = 100.0;
    let length = RADIUS * PI / 4.0;
    let bending = 1e7 / 12.0;
    let table = Table::read(include_str!("../data/bend_45.csv"));
    let rows = table.records().map(|record| {
        let variant = record.text("variant");
        let stiffness = Stiffness {
            bending: [bending; 2],
            torsion: if variant == "C" { 0.140_577 * 5e6 } else { bending },
            axial: 1e7,
            shear: [if variant == "A" { 5e6 } else { 5e6 * 5.0 / 6.0 }; 2],
        };
        let description = RodDescription {
            length,
            kinematics: if variant == "D" { Kinematics::Kirchhoff } else { Kinematics::Cosserat },
            profile: given(stiffness),
            rest: RestShape::Constant(Vec3::new(0.0, 1.0 / RADIUS, 0.0)),
            base: Pose { rotation: Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y), position: Vec3::ZERO },
        };
        let force = Vec3::Z * record.number("force");
        let expected = vec![
            Expected::position(length, record.vector(""), length),
            Expected::orientation(length, record.quaternion("q")),
            Expected::vector(Quantity::BaseForce, force),
            Expected::vector(Quantity::BaseMoment, record.vector("m")),
            Expected::scalar(Quantity::ElasticEnergy, record.number("energy")),
        ];
        Row {
            label: format!("variant {variant}, F = {}", force.z),
            setup: Setup::cantilever(description).with_tip(dead(Vec3::ZERO, force)),
            start: Start::Cold,
            answers: vec![Answer::new(expected)],
        }
    });
    Case {
        name: "bend-45".into(),
        title: "The 45° bend with a dead force out of its plane".into(),
        source: "Bathe & Bolourchi, IJNME 14:961–986, 1979; Simo & Vu-Quoc, CMAME 58:79–116, 1986; converged values, shooting and \
                 collocation agree to 1e-12",
        tolerance: 1e-6,
        elements: 100,
        rows: rows.collect(),
        remark: Some(
            "Published tips, coarse meshes, x y z. F = 300: Bathe & Bolourchi 22.5 59.2 39.5; Simo & Vu-Quoc 22.33 58.84 40.08; \
             Cardona & Géradin (1988) 22.14 58.64 40.35. F = 450: Simo & Vu-Quoc 18.62 52.32 48.39; Cardona & Géradin 18.38 52.11 \
             48.59. F = 600: Bathe & Bolourchi 15.9 47.2 53.4; Simo & Vu-Quoc 15.79 47.23 53.37; Cardona & Géradin 15.55 47.04 53.5.",
        ),
    }
}

fn helix_roll_up(kinematics: &'static str) -> Case {
    const LENGTH: f64 = 10.0;
    let table = Table::read(include_str!("../data/helix_roll_up.csv"));
    let rows = table.records().filter(|record| record.text("kinematics") == kinematics).map(|record| {
        let lambda = record.number("lambda");
        let stretch = (kinematics == "cosserat").then_some([1e4; 2]);
        let expected = vec![
            Expected::position(LENGTH, record.vector(""), LENGTH),
            Expected::orientation(LENGTH, record.quaternion("q")),
            Expected::scalar(Quantity::ElasticEnergy, record.number("energy")),
        ];
        Row {
            label: format!("λ = {lambda}"),
            setup: Setup::cantilever(straight(LENGTH, 100.0, stretch))
                .with_tip(dead(Vec3::Z * (200.0 * PI * lambda), Vec3::Z * (50.0 * lambda))),
            start: Start::PreviousRow,
            answers: vec![Answer::new(expected)],
        }
    });
    Case {
        name: format!("helix-roll-up-{kinematics}"),
        title: format!("Cantilever rolled up to ten turns and pulled out of plane ({kinematics})"),
        source: "Ibrahimbegovic, CMAME 149:49–71, 1997; states on the load path, shooting and collocation agree to 1e-12",
        tolerance: 1e-6,
        elements: 400,
        rows: rows.collect(),
        remark: None,
    }
}

/// A part of the published unit load, so small that the response is linear.
const PART: f64 = 2e-5;

/// A row of MacNeal and Harder's: the tip's displacement under a part of a unit force, measured by itself.
fn unit_load(description: &RodDescription, rest_tip: Vec3, force: Vec3, per_unit: Vec3) -> Row {
    let length = description.length;
    let tip = rest_tip + per_unit * PART;
    let expected = Expected::position(length, tip, per_unit.norm() * PART);
    Row {
        label: format!("force along ({}, {}, {})", force.x, force.y, force.z),
        setup: Setup::cantilever(description.clone()).with_tip(dead(Vec3::ZERO, force * PART)),
        start: Start::Cold,
        answers: vec![Answer::new(vec![expected])],
    }
}

const MACNEAL_HARDER: &str =
    "MacNeal & Harder, Finite Elem. Anal. Des. 1:3–20, 1985; compliance of the rod by central differences";

fn twisted_beam() -> Case {
    const LENGTH: f64 = 12.0;
    let description = RodDescription {
        length: LENGTH,
        kinematics: Kinematics::Cosserat,
        profile: given(Stiffness {
            bending: [29e6 * 1.1 * 0.32 * 0.32 * 0.32 / 12.0, 29e6 * 0.32 * 1.1 * 1.1 * 1.1 / 12.0],
            torsion: 116_619.736_964_24,
            axial: 29e6 * 1.1 * 0.32,
            shear: [3_486_338.797_814_21; 2],
        }),
        rest: RestShape::Constant(Vec3::Z * (FRAC_PI_2 / LENGTH)),
        base: Pose::IDENTITY,
    };
    let along_x = Vec3::new(0.001_749_623_338_853_01, -0.001_718_743_864_653_44, 0.0);
    let along_y = Vec3::new(-0.001_718_743_864_653_4, 0.005_429_321_478_370_17, 0.0);
    let tip = Vec3::Z * LENGTH;
    Case {
        name: "twisted-beam".into(),
        title: "A beam with a quarter turn of twist, linear compliance of its tip".into(),
        source: MACNEAL_HARDER,
        tolerance: 1e-5,
        elements: 100,
        rows: vec![
            unit_load(&description, tip, Vec3::X, along_x),
            unit_load(&description, tip, Vec3::Y, along_y),
        ],
        remark: Some("Published, along the load: 1.754e-3 and 5.424e-3."),
    }
}

fn curved_beam() -> Case {
    const RADIUS: f64 = 4.22;
    let length = RADIUS * FRAC_PI_2;
    let base = Quat::from_rotation_vector(Vec3::new(0.0, 1.0, 1.0) * (PI / 2.0_f64.sqrt())).to_matrix();
    let description = RodDescription {
        length,
        kinematics: Kinematics::Cosserat,
        profile: given(Stiffness {
            bending: [1e7 * 0.2 * 0.001 / 12.0, 1e7 * 0.1 * 0.008 / 12.0],
            torsion: 182.945_341_702_192,
            axial: 200_000.0,
            shear: [200_000.0 / 3.0; 2],
        }),
        rest: RestShape::Constant(Vec3::Y * (1.0 / RADIUS)),
        base: Pose { rotation: base, position: Vec3::ZERO },
    };
    let tip = Vec3::new(-RADIUS, RADIUS, 0.0);
    let row = |force, x, y, z| unit_load(&description, tip, force, Vec3::new(x, y, z));
    Case {
        name: "curved-beam".into(),
        title: "A quarter circle, linear compliance of its tip".into(),
        source: MACNEAL_HARDER,
        tolerance: 1e-5,
        elements: 100,
        rows: vec![
            row(Vec3::X, 0.040_219_085_265_236_2, 0.056_384_685_820_065_8, 0.0),
            row(Vec3::Y, 0.056_384_686_099_723_1, 0.088_602_001_205_877_2, 0.0),
            row(Vec3::Z, 0.0, 0.0, 0.500_562_118_975_844),
        ],
        remark: Some("Published, along the load: 0.08734 in the plane and 0.5022 out of it."),
    }
}
