//! Helical springs: an axial force and torque take a helix to another helix, in closed form.
//!
//! The helix winds about the world's z. Its frames are Frenet's: `d1` the normal, towards the axis, `d3` the tangent. With radius `R`
//! and pitch angle `a` the curvature is `cos²a/R` and the twist `sin a cos a/R`. The force acts along the axis, so at the tip its moment
//! is that of an arm to the axis.
//!
//! Long springs have many other equilibria under the same load (pushed ones buckle), and a search from rest may end at any of them or at
//! none. So each row starts at the tip of a helix that is stretched a little less; what is compared is the row's own helix, which is an
//! equilibrium whether or not it is stable.

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
    let length = number("length");
    let torsion = BENDING / (1.0 + number("poisson_ratio"));
    let rest = Helix { radius: number("rest_radius"), pitch_angle: number("rest_pitch_angle").to_radians() };
    let loaded = Helix { radius: number("radius"), pitch_angle: number("pitch_angle").to_radians() };
    let description = RodDescription {
        length,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness { bending: [BENDING; 2], torsion, axial: 1.0, shear: [1.0; 2] }),
            mass_per_length: 0.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.1 * rest.radius; 2],
        },
        rest: RestShape::Constant(rest.curvature()),
        base: loaded.frame(0.0),
    };
    let end = loaded.frame(length);
    let (pull, torque) = (Vec3::Z * number("force"), number("torque"));
    let wrench = about(end.position, pull, torque);
    // Springs that hardly move carry hardly any torque: the force times the radius is what the torque compares with.
    let lever = pull.norm() * loaded.radius;
    let expected = vec![
        Expected::position(0.5 * length, loaded.frame(0.5 * length).position, length),
        Expected::position(length, end.position, length),
        Expected::orientation(length, end.orientation()),
        Expected::vector(Quantity::BaseForce, pull),
        Expected::vector(Quantity::BaseMoment, about(loaded.frame(0.0).position, pull, torque).angular)
            .measured_by(lever),
        Expected::scalar(Quantity::ElasticEnergy, number("energy")),
    ];
    let kept_from_turning = record.text("mode") == "no_axial_rotation";
    // What is wrong at the tip is exp(L/ℓ) times as wrong at the base, ℓ² = EI/F where the spring is pulled: so near must the start be.
    let short = 0.01 * (-length * (number("force").max(0.0) / BENDING).sqrt()).exp();
    let tip = if given == "wrench" { Tip::Wrench { wrench, frame: Frame::World } } else { Tip::Pose(end) };
    Row {
        label: format!(
            "{} turns at {}°, stretched by {}, {}",
            number("turns"),
            number("rest_pitch_angle"),
            number("stretch"),
            record.text("mode").replace('_', " ")
        ),
        setup: Setup::cantilever(description).with_tip(tip),
        start: rest.stretched(length, (1.0 - short) * number("stretch"), torsion, kept_from_turning),
        answers: vec![Answer::new(expected)],
    }
}

/// A wrench along the axis, as it acts at a place: its moment is about that place.
fn about(place: Vec3, pull: Vec3, torque: f64) -> Wrench {
    Wrench::new(Vec3::Z * torque + (Vec3::Z * place.z - place).cross(pull), pull)
}

/// A helix about the world's z that begins on the x axis.
#[derive(Clone, Copy)]
struct Helix {
    radius: f64,
    pitch_angle: f64,
}

impl Helix {
    /// `(0, κ, τ)`.
    fn curvature(&self) -> Vec3 {
        let (sin, cos) = self.pitch_angle.sin_cos();
        Vec3::new(0.0, cos * cos / self.radius, sin * cos / self.radius)
    }

    /// Its frame at `s`.
    fn frame(&self, s: f64) -> Pose {
        let (rise, run) = self.pitch_angle.sin_cos();
        let (sin, cos) = (s * run / self.radius).sin_cos();
        let normal = Vec3::new(-cos, -sin, 0.0);
        let tangent = Vec3::new(-run * sin, run * cos, rise);
        Pose {
            rotation: Mat3::from_cols(normal, tangent.cross(normal), tangent),
            position: Vec3::new(self.radius * cos, self.radius * sin, rise * s),
        }
    }

    /// The tip of a spring of this rest shape, stretched by a part of its height, its tip kept from turning about the axis or free to.
    fn stretched(&self, length: f64, stretch: f64, torsion: f64, kept_from_turning: bool) -> Start {
        let rest = self.curvature();
        let pitch_angle = ((1.0 + stretch) * self.pitch_angle.sin()).asin();
        let (sin, cos) = pitch_angle.sin_cos();
        let radius = if kept_from_turning {
            self.radius * cos / self.pitch_angle.cos()
        } else {
            // No torque about the axis.
            cos * (BENDING * cos * cos + torsion * sin * sin)
                / (BENDING * cos * rest.y + torsion * sin * rest.z)
        };
        let helix = Self { radius, pitch_angle };
        let bent = helix.curvature() - rest;
        let (bend, twist) = (BENDING * bent.y, torsion * bent.z);
        let pull = Vec3::Z * ((cos * twist - sin * bend) / radius);
        let tip = helix.frame(length);
        let wrench = about(tip.position, pull, sin * twist + cos * bend);
        let turned = |v| tip.rotation.transpose_mul(v);
        Start::Near { pose: tip, wrench: Wrench::new(turned(wrench.angular), turned(wrench.linear)) }
    }
}
