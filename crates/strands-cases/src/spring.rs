//! Helical springs: an axial force and torque take a helix to another helix, in closed form.
//!
//! The helix winds about the world's z. Its frames are Frenet's: `d1` the normal, towards the axis, `d3` the tangent. With radius `R`
//! and pitch angle `a` the curvature is `cos²a/R` and the twist `sin a cos a/R`. The force acts along the axis, so at the tip its moment
//! is that of an arm to the axis.

use crate::table::{Record, Table};
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start, Tip};
use strands::load::Frame;
use strands::math::{Mat3, Pose, Vec3, Wrench};
use strands::rod::{Kinematics, Law, Profile, RestShape, RodDescription, Stiffness};

/// `EI`, N·m².
const BENDING: f64 = 0.04;

pub(crate) fn cases() -> Vec<Case> {
    vec![springs("wrench", "pulled and turned along its axis"), springs("pose", "stretched to a height")]
}

fn springs(given: &str, title: &str) -> Case {
    let table = Table::read(include_str!("../data/helical_spring.csv"));
    Case {
        name: format!("helical-spring-{given}"),
        title: format!("A helical spring, {title}"),
        source: "Love, Mathematical Theory of Elasticity, 1927, arts. 270–272; Wahl, Mechanical Springs, 1963",
        tolerance: 1e-6,
        elements: 200,
        rows: table.records().map(|record| spring(&record, given)).collect(),
        remark: None,
    }
}

fn spring(record: &Record<'_>, given: &str) -> Row {
    let number = |column| record.number(column);
    let (length, force, torque) = (number("length"), number("force"), number("torque"));
    let description = RodDescription {
        length,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness {
                bending: [BENDING; 2],
                torsion: BENDING / (1.0 + number("poisson_ratio")),
                axial: 1.0,
                shear: [1.0; 2],
            }),
            mass_per_length: 0.0,
            half_extent: [0.1 * number("rest_radius"); 2],
        },
        rest: RestShape::Constant(curvature(number("rest_radius"), number("rest_pitch_angle").to_radians())),
        base: helix_frame(record, 0.0),
    };
    let end = helix_frame(record, length);
    let pull = Vec3::Z * force;
    let about = |place: Vec3| Vec3::Z * torque + (Vec3::Z * place.z - place).cross(pull);
    let base_moment = about(description.base.position);
    // Springs that hardly move carry hardly any torque: the force times the radius is what the torque compares with.
    let lever = force.abs() * number("radius");
    let expected = vec![
        Expected::position(0.5 * length, helix_frame(record, 0.5 * length).position, length),
        Expected::position(length, end.position, length),
        Expected::orientation(length, end.orientation()),
        Expected::vector(Quantity::BaseForce, pull),
        Expected::vector(Quantity::BaseMoment, base_moment).measured_by(lever),
        Expected::scalar(Quantity::ElasticEnergy, number("energy")),
    ];
    let wrench = Wrench::new(about(end.position), pull);
    Row {
        label: format!(
            "{} turns at {}°, stretched by {}, {}",
            number("turns"),
            number("rest_pitch_angle"),
            number("stretch"),
            record.text("mode").replace('_', " ")
        ),
        setup: Setup {
            description,
            force_per_length: Vec3::ZERO,
            tip: if given == "wrench" { Tip::Wrench { wrench, frame: Frame::World } } else { Tip::Pose(end) },
        },
        start: Start::Cold,
        answers: vec![Answer::new(expected)],
    }
}

/// `(0, κ, τ)` of a helix.
fn curvature(radius: f64, pitch_angle: f64) -> Vec3 {
    let (sin, cos) = pitch_angle.sin_cos();
    Vec3::new(0.0, cos * cos / radius, sin * cos / radius)
}

/// The frame of the loaded helix at `s`.
fn helix_frame(record: &Record<'_>, s: f64) -> Pose {
    let radius = record.number("radius");
    let (rise, run) = record.number("pitch_angle").to_radians().sin_cos();
    let (sin, cos) = (record.number("wrap_angle") * s / record.number("length")).sin_cos();
    let normal = Vec3::new(-cos, -sin, 0.0);
    let tangent = Vec3::new(-run * sin, run * cos, rise);
    Pose {
        rotation: Mat3::from_cols(normal, tangent.cross(normal), tangent),
        position: Vec3::new(radius * cos, radius * sin, rise * s),
    }
}
