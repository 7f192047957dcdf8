//! Beams and ribbons on edge that tip over to the side: lateral–torsional buckling, after an exact deflection in their plane.
//!
//! The beam lies along x, and its load pulls along −z.

use crate::Setup;
use crate::columns::{branch, known};
use crate::critical::{Branch, CriticalCase};
use crate::planar::{along_x, straight};
use crate::table::Table;
use strands::math::{Pose, Vec3};
use strands::rod::{Law, Profile, RodDescription};
use strands::statics::Support;

pub(crate) fn cases() -> Vec<CriticalCase> {
    vec![cantilever(), fork(), ribbon()]
}

/// A beam of length one: its stiffnesses against bending in its plane, to the side, and against torsion.
fn beam(in_plane: f64, lateral: f64, torsion: f64) -> RodDescription {
    let mut description = straight(1.0, 1.0, None);
    if let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile {
        (stiffness.bending, stiffness.torsion) = ([in_plane, lateral], torsion);
    }
    description
}

fn cantilever() -> CriticalCase {
    let table = Table::read(include_str!("../data/lateral_torsional.csv"));
    let branches = table.records().map(|record| {
        let (load, lateral, ratio) = (record.text("load"), record.number("EI2"), record.number("GJ_ratio"));
        let torsion = ratio * lateral;
        let unit = (lateral * torsion).sqrt();
        let description = beam(1.0, lateral, torsion);
        let label = format!("{load}, EI2/EI1 = {lateral}, GJ/EI2 = {ratio}");
        let critical = known(&record, &["first"]);
        let family = move |part: f64| {
            let (setup, load_size) = (Setup::cantilever(description.clone()), Vec3::Z * (-part * unit));
            if load == "tip" { setup.with_force(1.0, load_size) } else { setup.with_weight(load_size) }
        };
        let branch = branch(label, critical, (1.0, Vec3::Y), family);
        let up_to = if branch.critical.is_empty() { 3.0 * record.number("thin") } else { branch.up_to };
        Branch { up_to, ..branch }
    });
    CriticalCase {
        name: "lateral-torsional".into(),
        title: "The load under which a cantilever tips over to the side".into(),
        source: "Prandtl 1899; Michell 1899; Hodges & Peters, Int. J. Solids Struct. 11:1269, 1975; thin limits by zeros of Bessel functions",
        tolerance: 1e-6,
        elements: 100,
        branches: branches.collect(),
        remark: Some("Beams nearly as stiff to the side as in their plane do not tip over."),
    }
}

fn fork() -> CriticalCase {
    // Thin, so that it hardly deflects before; the figures are a textbook's, to their last digit.
    const LATERAL: f64 = 1e-4;
    let branches = [("a force in its middle", true, 16.94), ("its weight", false, 28.3)].map(
        |(what, in_middle, load)| {
            let description = beam(1.0, LATERAL, LATERAL);
            branch(format!("between forks, {what}"), vec![load], (0.4, Vec3::Y), move |part| {
                let far = Pose { position: Vec3::X, ..along_x() };
                let fork = [false, false, true, true, true, true];
                let setup = Setup::cantilever(description.clone())
                    .held(0.0, Support::of(fork, along_x()))
                    .held(1.0, Support::of(fork, far).sliding_along(Vec3::X));
                let load = Vec3::Z * (-part * LATERAL);
                if in_middle { setup.with_force(0.5, load) } else { setup.with_weight(load) }
            })
        },
    );
    CriticalCase {
        name: "lateral-torsional-fork".into(),
        title: "The load under which a beam between two forks tips over to the side".into(),
        source: "Timoshenko & Gere, Theory of Elastic Stability, 1961, ch. 6",
        tolerance: 2e-3,
        elements: 100,
        branches: branches.to_vec(),
        remark: Some("The textbook gives three or four digits."),
    }
}

fn ribbon() -> CriticalCase {
    // So stiff on edge that it does not deflect.
    const IN_PLANE: f64 = 1e4;
    let table = Table::read(include_str!("../data/ribbon.csv"));
    let branches = table.records().map(|record| {
        let ratio = record.number("poisson_ratio");
        let description = beam(IN_PLANE, 1.0, 2.0 / (1.0 + ratio));
        branch(format!("ν = {ratio}"), known(&record, &["first"]), (1.0, Vec3::Y), move |weight| {
            Setup::cantilever(description.clone()).with_weight(Vec3::Z * -weight)
        })
    });
    CriticalCase {
        name: "ribbon".into(),
        title: "The weight under which a ribbon on edge tips over to the side".into(),
        source: "the lateral buckling test of Romero et al., ACM TOG 40(4):66, 2021, for a narrow ribbon; Michell 1899, Prandtl 1899",
        tolerance: 1e-3,
        elements: 100,
        branches: branches.collect(),
        remark: Some(
            "Romero et al. measure within a percent, and ribbons that are not narrow differ by more.",
        ),
    }
}
