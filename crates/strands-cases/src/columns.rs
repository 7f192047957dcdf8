//! Straight columns under thrust, weight and torque: the loads at which they leave the straight.
//!
//! Columns of which the modes are all wanted are so stiff across the plane of x and y that they leave the straight in it.

use crate::Setup;
use crate::critical::{Branch, CriticalCase};
use crate::planar::{along_x, kept_in_plane, straight};
use crate::table::{Record, Table};
use core::f64::consts::{PI, TAU};
use std::sync::Arc;
use strands::load::{Frame, PointLoad};
use strands::math::{Pose, Quat, Vec3, Wrench};
use strands::rod::{Law, Profile, RodDescription};
use strands::statics::{Guess, Support};

pub(crate) fn cases() -> Vec<CriticalCase> {
    vec![euler(), shearing(), greenhill(), torque_and_thrust(), twisted_ring()]
}

/// The columns of critical loads, where a table has three.
const THREE: [&str; 3] = ["first", "second", "third"];

/// The critical loads of a record that are known.
pub(crate) fn known(record: &Record<'_>, columns: &[&str]) -> Vec<f64> {
    columns.iter().filter_map(|column| record.figure(column)).collect()
}

/// A branch that lies in a straight line or a plane until a small force across it would push it out.
pub(crate) fn branch(
    label: String,
    critical: Vec<f64>,
    disturbed: (f64, Vec3),
    family: impl Fn(f64) -> Setup + Send + Sync + 'static,
) -> Branch {
    let up_to = 1.05 * critical.last().copied().unwrap_or(0.0);
    Branch {
        label,
        family: Arc::new(family),
        end: None,
        disturbed: Some(disturbed),
        critical,
        ways: 1,
        up_to,
    }
}

/// A column along x, held at its ends as their name says, that a dead load presses.
fn pressed(description: &RodDescription, ends: &str, thrust: f64) -> Setup {
    let length = description.length;
    let (base, far) = (along_x(), Pose { position: Vec3::X * length, ..along_x() });
    // A pinned column as a whole must not turn about its axis.
    let hinged = Support::of([false, false, true, true, true, true], base);
    let (start, end) = match ends {
        "clamped_free" => (Support::clamped(base), Support::free(far)),
        "pinned_pinned" => (hinged, Support::pinned(far).sliding_along(Vec3::X)),
        "clamped_pinned" => (Support::clamped(base), Support::pinned(far).sliding_along(Vec3::X)),
        "clamped_clamped" => (Support::clamped(base), Support::clamped(far).sliding_along(Vec3::X)),
        "clamped_guided_sway" => {
            (Support::clamped(base), Support::of([true, true, true, false, false, false], far))
        }
        _ => unreachable!("a table names no other ends"),
    };
    let setup = Setup::cantilever(description.clone()).held(0.0, start).held(length, end);
    setup.with_force(length, Vec3::X * -thrust)
}

fn euler() -> CriticalCase {
    const LENGTH: f64 = 0.8;
    let table = Table::read(include_str!("../data/euler_loads.csv"));
    let branches = table.records().map(|record| {
        let ends = record.text("ends");
        let description = kept_in_plane(straight(LENGTH, 0.05, None));
        let disturbed = (0.2 * LENGTH, Vec3::Y);
        branch(ends.replace('_', " "), known(&record, &THREE), disturbed, move |thrust| {
            pressed(&description, ends, thrust)
        })
    });
    CriticalCase {
        name: "euler-loads".into(),
        title: "The first three buckling loads of a column, its ends held in five ways".into(),
        source: "Euler 1744; Timoshenko & Gere, Theory of Elastic Stability, 1961, ch. 2",
        tolerance: 1e-8,
        elements: 640,
        branches: branches.collect(),
        remark: None,
    }
}

fn shearing() -> CriticalCase {
    const LENGTH: f64 = 0.5;
    let table = Table::read(include_str!("../data/shearing_columns.csv"));
    let branches = table.records().map(|record| {
        let ends = record.text("ends");
        let [axial, shear] = ["EA", "GA"].map(|column| record.number(column));
        let description = kept_in_plane(straight(LENGTH, record.number("bending"), Some([axial, shear])));
        let label = format!("{}, EA = {axial}, GA = {shear}", ends.replace('_', " "));
        let disturbed = (0.4 * LENGTH, Vec3::Y);
        branch(label, known(&record, &["first"]), disturbed, move |thrust| {
            pressed(&description, ends, thrust)
        })
    });
    CriticalCase {
        name: "shearing-columns".into(),
        title: "The buckling load of a column that stretches and shears".into(),
        source: "Haringx 1942; Reissner, ZAMP 23:795–804, 1972; Magnusson et al., Int. J. Solids Struct. 38:8441, 2001",
        tolerance: 1e-8,
        elements: 320,
        branches: branches.collect(),
        remark: None,
    }
}

fn greenhill() -> CriticalCase {
    const LENGTH: f64 = 0.6;
    let table = Table::read(include_str!("../data/greenhill.csv"));
    let branches = table.records().map(|record| {
        let top = record.number("top_force");
        let description = kept_in_plane(straight(LENGTH, 0.02, None));
        branch(
            format!("{top} N on its top"),
            known(&record, &THREE),
            (0.4 * LENGTH, Vec3::Y),
            move |weight| pressed(&description, "clamped_free", top).with_weight(Vec3::X * -weight),
        )
    });
    CriticalCase {
        name: "greenhill-columns".into(),
        title: "The weight under which an upright column buckles".into(),
        source: "Greenhill, Proc. Camb. Phil. Soc. 4:65–73, 1881: zeros of a Bessel function",
        // With nearly Euler's load on its top the column bears a 37th of that in weight, which has as many times the error.
        tolerance: 5e-8,
        elements: 500,
        branches: branches.collect(),
        remark: None,
    }
}

/// The same rod with another torsional stiffness.
fn with_torsion(mut description: RodDescription, torsion: f64) -> RodDescription {
    if let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile {
        stiffness.torsion = torsion;
    }
    description
}

/// A frame along x at a place on it, turned about it.
fn turned_about_x(x: f64, angle: f64) -> Pose {
    let turn = Quat::from_rotation_vector(Vec3::Z * angle).to_matrix();
    Pose { rotation: along_x().rotation * turn, position: Vec3::X * x }
}

fn torque_and_thrust() -> CriticalCase {
    const TORSION: f64 = 0.8;
    let table = Table::read(include_str!("../data/torque_and_thrust.csv"));
    let branches = table.records().map(|record| {
        let (ends, thrust) = (record.text("ends"), record.number("thrust"));
        let description = with_torsion(straight(1.0, 1.0, None), TORSION);
        let label =
            format!("ends {}, P = {thrust}", if ends == "clamped" { "clamped" } else { "on the axis" });
        let family = move |torque: f64| {
            let setup = Setup::cantilever(description.clone()).with_force(1.0, Vec3::X * -thrust);
            if ends == "clamped" {
                // The torque is that of the turns given.
                let far = turned_about_x(1.0, torque / TORSION);
                return setup.held(1.0, Support::clamped(far).sliding_along(Vec3::X));
            }
            let far = Support::pinned(turned_about_x(1.0, 0.0)).sliding_along(Vec3::X);
            // What keeps the rod as a whole from turning bears nothing in its middle.
            let middle = Support::of([false, false, true, false, false, false], turned_about_x(0.5, 0.0));
            let mut setup = setup.held(0.0, Support::pinned(along_x())).held(0.5, middle).held(1.0, far);
            for (at, torque) in [(0.0, -torque), (1.0, torque)] {
                let wrench = Wrench::new(Vec3::X * torque, Vec3::ZERO);
                setup.loads.push(PointLoad { at, wrench, frame: Frame::World });
            }
            setup
        };
        Branch { ways: 2, ..branch(label, known(&record, &["first"]), (0.4, Vec3::Y), family) }
    });
    CriticalCase {
        name: "torque-and-thrust".into(),
        title: "The torque at which a straight rod under thrust or pull coils up".into(),
        source: "Greenhill, Proc. IMechE 1883; Love 1927, art. 272; van der Heijden et al., Int. J. Mech. Sci. 45:161–196, 2003",
        tolerance: 1e-6,
        elements: 320,
        branches: branches.collect(),
        remark: Some(
            "On the axis the ends may turn, and a dead torque on what may turn has no potential: no index is known there.",
        ),
    }
}

/// The twisted ring stretches and shears a little, `EA R²/EI`: the index of an inextensible rod is counted with some compliance lent to it, by which
/// the sides of its section are no longer alike.
const HARDLY_STRETCHES: f64 = 1e6;

fn twisted_ring() -> CriticalCase {
    let table = Table::read(include_str!("../data/twisted_ring.csv"));
    let branches = table.records().map(|record| {
        let torsion = record.number("GJ");
        let description = with_torsion(straight(TAU, 1.0, Some([HARDLY_STRETCHES; 2])), torsion);
        // Held in the plane where it is farthest from its clamp it cannot swing about that; nothing acts there.
        let in_plane = Support::of([false, false, false, false, false, true], turned_about_x(0.0, 0.0));
        let family = move |turns: f64| {
            let far = Support::clamped(turned_about_x(0.0, turns));
            Setup::cantilever(description.clone()).held(PI, in_plane.clone()).held(TAU, far)
        };
        let ring = branch(format!("GJ/EI = {torsion:.4}"), known(&record, &THREE), (1.0, Vec3::Z), family);
        let end = move |turns: f64| {
            let pose = turned_about_x(0.0, turns);
            // Along the ring the twisting moment turns, and a force across the plane turns it.
            let twisting = torsion * turns / TAU;
            let (moment, force) = (Vec3::Z + Vec3::X * twisting, Vec3::Z * twisting);
            let in_frame = |v| pose.rotation.transpose_mul(v);
            Guess::new(pose, Wrench::new(in_frame(moment), in_frame(force)))
        };
        Branch { ways: 2, end: Some(Arc::new(end)), ..ring }
    });
    CriticalCase {
        name: "twisted-ring".into(),
        title: "The turns of twist at which a straight rod closed to a ring leaves the plane".into(),
        source: "Michell 1889; Zajac, J. Appl. Mech. 29:136–142, 1962; Goriely, J. Elasticity 84:281, 2006",
        tolerance: 1e-4,
        elements: 100,
        branches: branches.collect(),
        remark: None,
    }
}
