//! Rods that are arcs of a circle at rest: a ring pinched at its poles, by a quarter of it, and a deep arch pushed down at its crown.
//!
//! Each is so stiff across the plane of x and y that it stays in it.

use crate::planar::{kept_in_plane, moment, straight, turned};
use crate::table::Table;
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start};
use core::f64::consts::{FRAC_PI_2, PI};
use strands::math::{Pose, Vec3};
use strands::rod::{RestShape, RodDescription};
use strands::statics::Support;

pub(crate) fn cases() -> Vec<Case> {
    vec![pinched_ring(), deep_arch()]
}

/// A frame in the plane, its tangent at an angle to x.
fn at(x: f64, y: f64, angle: f64) -> Pose {
    Pose::from_parts(Vec3::new(x, y, 0.0), turned(angle))
}

/// An arc that stays in the plane.
pub(crate) fn arc(length: f64, bending: f64, curvature: f64, base: Pose) -> RodDescription {
    RodDescription {
        rest: RestShape::Constant(Vec3::Y * curvature),
        base,
        ..kept_in_plane(straight(length, bending, None))
    }
}

/// A quarter of a ring about the origin, from where it crosses x to its pole on y: both crossings stay across, and slide along their axes.
pub(crate) fn quarter_ring(radius: f64, bending: f64) -> Setup {
    let (side, pole) = (at(radius, 0.0, FRAC_PI_2), at(0.0, radius, PI));
    let length = radius * FRAC_PI_2;
    Setup::cantilever(arc(length, bending, 1.0 / radius, side))
        .held(0.0, Support::clamped(side).sliding_along(Vec3::X))
        .held(length, Support::clamped(pole).sliding_along(Vec3::Y))
}

fn pinched_ring() -> Case {
    const RADIUS: f64 = 0.12;
    const BENDING: f64 = 0.03;
    let length = RADIUS * FRAC_PI_2;
    let table = Table::read(include_str!("../data/pinched_ring.csv"));
    let rows = table.records().map(|record| {
        let load = record.number("force");
        let half = |column| 0.5 * record.number(column);
        let expected = vec![
            Expected::position(0.0, Vec3::X * half("width"), RADIUS),
            Expected::position(length, Vec3::Y * half("height"), RADIUS),
            moment(record.number("side_moment")),
            Expected::vector(Quantity::TipMoment, Vec3::Z * record.number("pole_moment")),
            Expected::scalar(Quantity::ElasticEnergy, 0.25 * record.number("energy")),
        ];
        Row {
            label: format!("F R²/EI = {}", record.number("ratio")),
            // Each half of the ring bears half of the force.
            setup: quarter_ring(RADIUS, BENDING).with_force(length, Vec3::Y * (-0.5 * load)),
            start: Start::Cold,
            answers: vec![Answer::stable(expected)],
        }
    });
    Case {
        name: "pinched-ring".into(),
        title: "A ring that two opposite forces press together or pull apart, by a quarter of it".into(),
        source: "Frisch-Fay, Flexible Bars, 1962; computed twice, collocation and shooting agree to 3e-13",
        tolerance: 1e-8,
        elements: 200,
        rows: rows.collect(),
        remark: Some("Beyond F R²/EI = 8 its poles have passed through each other."),
    }
}

fn deep_arch() -> Case {
    const RADIUS: f64 = 2.0;
    const BENDING: f64 = 5.0;
    let half_angle = 107.5_f64.to_radians();
    let length = 2.0 * RADIUS * half_angle;
    let (sin, cos) = half_angle.sin_cos();
    let left = at(-RADIUS * sin, RADIUS * cos, half_angle);
    let right = at(RADIUS * sin, RADIUS * cos, -half_angle);
    let table = Table::read(include_str!("../data/deep_arch.csv"));
    let rows = table.records().map(|record| {
        let drop = record.number("drop");
        let crown = at(0.0, RADIUS - drop, 0.0);
        let push = Vec3::Y * -record.number("force");
        let mut expected = vec![Expected::vector(Quantity::SupportForce { s: 0.5 * length }, push)];
        if let (Some(x), Some(bend)) = (record.figure("crown_x"), record.figure("clamp_bend")) {
            let place = Vec3::new(x, crown.position.y, 0.0);
            expected.push(Expected::position(0.5 * length, place, RADIUS));
            expected.push(moment(bend * BENDING / RADIUS).measured_by(BENDING / RADIUS));
        }
        Row {
            label: format!("drop/R = {:.4}, P R²/EI = {:.6}", drop / RADIUS, -push.y * RADIUS * RADIUS / BENDING),
            setup: Setup::cantilever(arc(length, BENDING, -1.0 / RADIUS, left))
                .held(0.5 * length, Support::pinned(crown).sliding_along(Vec3::X))
                .held(length, Support::pinned(right)),
            // Far down, it may also rest with its hinged half thrown over.
            start: if drop < 0.1 { Start::Cold } else { Start::PreviousRow },
            answers: vec![Answer::new(expected)],
        }
    });
    Case {
        name: "deep-arch".into(),
        title: "An arch of 215°, clamped at one end and hinged at the other, its crown pushed down".into(),
        source: "DaDeppo & Schmidt, J. Appl. Mech. 42:894–896, 1975; computed at two steps and closed by shooting to 1e-12",
        tolerance: 1e-6,
        elements: 200,
        rows: rows.collect(),
        remark: Some("Published limit load: 8.97 EI/R²; the row at a drop of 1.1373 R is at the limit."),
    }
}
