//! Rods that are arcs of a circle at rest: a ring pinched at its poles, by a quarter of it, and a deep arch pushed down at its crown.
//!
//! Each is so stiff across the plane of x and y that it stays in it.

use crate::columns::branch;
use crate::critical::CriticalCase;
use crate::planar::{kept_in_plane, moment, straight, turned};
use crate::table::Table;
use crate::{Answer, Case, Expected, Quantity, Row, Setup, Start};
use core::f64::consts::{FRAC_PI_2, PI};
use strands::load::{Frame, PointLoad, PointPull};
use strands::math::{Pose, Vec3, Wrench};
use strands::rod::{RestShape, RodDescription};
use strands::statics::Support;

pub(crate) fn cases() -> Vec<Case> {
    vec![pinched_ring(), deep_arch(), symmetric_arch()]
}

pub(crate) fn critical_cases() -> Vec<CriticalCase> {
    vec![pressed_ring(), swaying_arch()]
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

/// A wedge of a ring about the origin, from x on through an angle: both its ends stay across their radii and slide along them.
fn wedge(radius: f64, bending: f64, angle: f64) -> Setup {
    let (side, pole) = (at(radius, 0.0, FRAC_PI_2), radial(angle) * radius);
    let pole = at(pole.x, pole.y, angle + FRAC_PI_2);
    let length = radius * angle;
    Setup::cantilever(arc(length, bending, 1.0 / radius, side))
        .held(0.0, Support::clamped(side).sliding_along(Vec3::X))
        .held(length, Support::clamped(pole).sliding_along(radial(angle)))
}

/// The direction at an angle to x.
fn radial(angle: f64) -> Vec3 {
    Vec3::new(angle.cos(), angle.sin(), 0.0)
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
            setup: wedge(RADIUS, BENDING, FRAC_PI_2).with_force(length, Vec3::Y * (-0.5 * load)),
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

/// The radius of the arch, its stiffness, and half of what it subtends.
const ARCH_RADIUS: f64 = 2.0;
const ARCH_BENDING: f64 = 5.0;
const ARCH_HALF: f64 = 107.5 * PI / 180.0;

/// The arch clamped at its left end.
fn arch() -> Setup {
    let left = radial(FRAC_PI_2 + ARCH_HALF) * ARCH_RADIUS;
    let base = at(left.x, left.y, ARCH_HALF);
    Setup::cantilever(arc(2.0 * ARCH_RADIUS * ARCH_HALF, ARCH_BENDING, -1.0 / ARCH_RADIUS, base))
}

/// A hinge at the arch's left or right end.
fn arch_hinge(side: f64) -> Support {
    let place = radial(FRAC_PI_2 - side * ARCH_HALF) * ARCH_RADIUS;
    Support::pinned(at(place.x, place.y, -side * ARCH_HALF)).turning_about(Vec3::Z)
}

fn deep_arch() -> Case {
    const RADIUS: f64 = ARCH_RADIUS;
    const BENDING: f64 = ARCH_BENDING;
    let length = arch().description.length;
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
            label: format!(
                "drop/R = {:.4}, P R²/EI = {:.6}",
                drop / RADIUS,
                -push.y * RADIUS * RADIUS / BENDING
            ),
            setup: arch()
                .held(0.5 * length, Support::pinned(crown).sliding_along(Vec3::X))
                .held(length, arch_hinge(1.0)),
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

const SYMMETRIC: &str = "DaDeppo & Schmidt, J. Appl. Mech. 42:894–896, 1975, both ends hinged; computed by a Runge–Kutta method at two steps";

/// Where the arch between hinges starts to sway: the load, over `EI/R²`, and how far its crown is down, over the radius. By shooting with its
/// variations, where their determinant vanishes on the symmetric path.
const SWAY: [f64; 2] = [3.276_282_140_909_28, 0.166_769_377_074_915];
/// The most it bears while it is kept symmetric, in the same way.
const SYMMETRIC_LIMIT: [f64; 2] = [9.463_108_888_547_64, 1.118_772_431_742_9];

fn symmetric_arch() -> Case {
    let length = 0.5 * arch().description.length;
    let rows = [("where it would sway", SWAY), ("the most it bears", SYMMETRIC_LIMIT)].map(
        |(label, [load, drop])| {
            let mut setup = arch().held(0.0, arch_hinge(-1.0));
            setup.description.length = length;
            let crown = at(0.0, ARCH_RADIUS * (1.0 - drop), 0.0);
            let push = -0.5 * load * ARCH_BENDING / (ARCH_RADIUS * ARCH_RADIUS);
            Row {
                label: label.into(),
                setup: setup.held(length, Support::clamped(crown)),
                start: Start::Cold,
                answers: vec![Answer::new(vec![
                    Expected::deflection(length, Vec3::Y, crown.position.y).measured_by(ARCH_RADIUS),
                    Expected::scalar(Quantity::TipForceAlong { along: Vec3::Y }, push),
                ])],
            }
        },
    );
    Case {
        name: "symmetric-arch".into(),
        title: "Half of an arch of 215° between hinges, its crown pushed straight down".into(),
        source: SYMMETRIC,
        tolerance: 1e-6,
        elements: 200,
        rows: rows.to_vec(),
        remark: None,
    }
}

fn swaying_arch() -> CriticalCase {
    let unit = ARCH_BENDING / (ARCH_RADIUS * ARCH_RADIUS);
    let length = arch().description.length;
    let family = move |load: f64| {
        arch()
            .held(0.0, arch_hinge(-1.0))
            .held(length, arch_hinge(1.0))
            .with_force(0.5 * length, Vec3::Y * (-load * unit))
    };
    CriticalCase {
        name: "swaying-arch".into(),
        title: "The load on its crown under which an arch of 215° between hinges sways".into(),
        source: SYMMETRIC,
        tolerance: 1e-6,
        elements: 200,
        branches: vec![branch("between hinges".into(), vec![SWAY[0]], (0.5 * length, Vec3::X), family)],
        remark: None,
    }
}

/// Stretches of a wedge whose pressure acts at the places between them.
const STRETCHES: usize = 60;

fn pressed_ring() -> CriticalCase {
    let table = Table::read(include_str!("../data/pressed_ring.csv"));
    let branches = table.records().flat_map(|record| {
        let n = record.number("n");
        let angle = PI / n;
        let pressed = |kind, press: fn(&mut Setup, f64, f64)| {
            // Nothing can be said of more than the first mode of a wedge, which is the ring's n-th.
            branch(
                format!("{kind}, n = {n}"),
                vec![record.number(kind)],
                (angle, radial(angle)),
                move |pressure| {
                    let mut setup = wedge(1.0, 1.0, angle);
                    for i in 0..=STRETCHES {
                        let at = angle * i as f64 / STRETCHES as f64;
                        let share = if i == 0 || i == STRETCHES { 0.5 } else { 1.0 };
                        press(&mut setup, at, share * pressure * angle / STRETCHES as f64);
                    }
                    setup
                },
            )
        };
        let across = |setup: &mut Setup, at, size| {
            // The normal to the inside is d1.
            let wrench = Wrench::new(Vec3::ZERO, Vec3::X * size);
            setup.loads.push(PointLoad { at, wrench, frame: Frame::Body });
        };
        let dead = |setup: &mut Setup, at, size: f64| {
            let wrench = Wrench::new(Vec3::ZERO, radial(at) * -size);
            setup.loads.push(PointLoad { at, wrench, frame: Frame::World });
        };
        let central = |setup: &mut Setup, at, tension| {
            setup.pulls.push(PointPull { at, towards: Vec3::ZERO, tension });
        };
        [pressed("hydrostatic", across), pressed("dead", dead), pressed("central", central)]
    });
    CriticalCase {
        name: "pressed-ring".into(),
        title: "The pressure under which a ring collapses in its plane, by a wedge of it".into(),
        source: "Lévy 1884; Bresse 1866; Boresi 1955; Singer & Babcock 1970; Timoshenko & Gere 1961, art. 7.3: a textbook's values",
        tolerance: 1e-3,
        elements: 120,
        branches: branches.collect(),
        remark: Some("Pressure that stays across the ring has no potential here, so no index is known."),
    }
}
