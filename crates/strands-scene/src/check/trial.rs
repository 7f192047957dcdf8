//! A trial: the rod is solved on its mesh and on one of elements half as long. Their difference tells the error of the first, as for
//! [`refine`](strands::statics::refine): of order `p` it is `2^p/(2^p − 1)` of it.

use super::mesh::element_lengths;
use super::numbers::{Numbers, bend, radius};
use super::reach::MUCH_STRAIN;
use super::{Remarks, View, metres, short};
use crate::model::{MAX_ELEMENTS, MeshError, Model, ModelRod};
use strands::math::Pose;
use strands::rod::{Mesh, Rod};
use strands::statics::{FailureReason, Problem, RefineError, Settings, Solution, Workspace, solve};

/// What a trial found.
#[derive(Clone, Debug, PartialEq)]
pub enum Trial {
    /// There is an equilibrium.
    Solved {
        /// The estimated error of the nodes' frames: turns in rad, shifts over the rod's length, the largest of all. `None` where the finer
        /// mesh could not be solved.
        estimated_error: Option<f64>,
        /// The largest tension, N.
        tension: f64,
        /// The largest strain of the material, by bending and stretching, and where, m; `None` where there is no section.
        strain: Option<[f64; 2]>,
    },
    /// None was found.
    Failed {
        /// Why.
        reason: String,
        /// What is at fault, as far as it is known.
        fault: Fault,
    },
    /// There was none: joints tie the rod to others, or surfaces touch, and it does not come to rest alone.
    Tied,
}

/// What a failed trial is the fault of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The supports, which are out of the rod's reach.
    Supports,
    /// The mesh, too coarse for the tension or its tolerance.
    Mesh,
    /// Not known.
    Unknown,
}

/// Tries a rod, on the mesh for its tolerance where it gives one: the rod on that mesh, what it was solved with, and what was found.
pub(super) fn trial(model: &Model, rod: &ModelRod) -> (ModelRod, Settings, Trial) {
    if rod.is_tied() || model.surfaces.is_some() {
        return (rod.clone(), model.settings, Trial::Tied);
    }
    let mut model = model.clone();
    match model.refine(&rod.name) {
        // Without an equilibrium on one of the meshes there is none to be expected on the first one either, and its failure says why.
        Ok(()) | Err(MeshError { reason: RefineError::Solve(_), .. }) => {}
        Err(MeshError { reason, .. }) => {
            let failed = Trial::Failed { reason: reason.to_string(), fault: Fault::Mesh };
            return (rod.clone(), model.settings, failed);
        }
    }
    let settings = model.settings;
    let rod = model.rod(&rod.name).unwrap_or(rod).clone();
    let mut workspace = Workspace::default();
    let trial = match solve(&rod.problem, &settings, None, &mut workspace) {
        Err(failure) => Trial::Failed {
            reason: failure.reason.to_string(),
            fault: match failure.reason {
                FailureReason::OutOfReach { .. } => Fault::Supports,
                FailureReason::TooCoarse { .. } => Fault::Mesh,
                _ => Fault::Unknown,
            },
        },
        Ok(solution) => Trial::Solved {
            estimated_error: estimate(&rod, &solution, &settings, &mut workspace),
            tension: solution.stress.iter().fold(0.0, |most, stress| most.max(stress.linear.z)),
            strain: strain(&rod.problem, &solution),
        },
    };
    (rod, settings, trial)
}

fn estimate(
    rod: &ModelRod,
    solution: &Solution,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Option<f64> {
    let coarse = &rod.problem.rod;
    if 2 * coarse.elements() > MAX_ELEMENTS {
        return None;
    }
    let nodes = coarse.mesh().nodes();
    let halved: Vec<(f64, usize)> =
        coarse.mesh().spans().iter().map(|span| (nodes[span.end], 2 * span.len())).collect();
    let mesh = Mesh::from_pieces(&halved).ok()?;
    let fine = Rod::new(coarse.description().clone(), mesh, coarse.order()).ok()?;
    let problem = rod.loads.problem(fine, &rod.supports, rod.initial.as_ref()).ok()?;
    let fine = solve(&problem, settings, Some(&solution.guess), workspace).ok()?;
    let apart = |(i, pose): (usize, &Pose)| {
        let by = pose.between(&fine.poses[2 * i]).log();
        by.angular.max_abs().max(by.linear.max_abs() / coarse.length())
    };
    let gained = 2.0_f64.powi(coarse.order().as_number() as i32);
    Some(solution.poses.iter().enumerate().map(apart).fold(0.0, f64::max) * gained / (gained - 1.0))
}

/// The largest strain in the material: half the thickness times the change of curvature, and the stretch.
fn strain(problem: &Problem, solution: &Solution) -> Option<[f64; 2]> {
    let rod = &problem.rod;
    radius(rod)?;
    let nodes = rod.mesh().nodes();
    let of = |e: usize| {
        let points = rod.points(e);
        let rest = points.iter().fold(strands::math::Strain::ZERO, |sum, point| sum + point.rest)
            * (1.0 / points.len() as f64);
        let change = solution.strain[e] - rest;
        let half = [0, 1].map(|axis| rod.half_extent()[e][axis].min(rod.half_extent()[e + 1][axis]));
        // Bending about d1 strains along d2.
        let bent = strands::math::Vec3::new(change.angular.x * half[1], change.angular.y * half[0], 0.0);
        [bend(bent) + change.linear.z.abs(), 0.5 * (nodes[e] + nodes[e + 1])]
    };
    (0..rod.elements()).map(of).reduce(|most, here| if here[0] > most[0] { here } else { most })
}

/// More error than this asks for a finer mesh; the advice is for a tenth of it.
const MUCH_ERROR: f64 = 1e-2;

/// Looks at what the trial found.
pub(super) fn look(remarks: &mut Remarks<'_>, view: &View<'_>, numbers: &Numbers, trial: &Trial) {
    let rod = &view.rod.problem.rod;
    let (error, strain) = match trial {
        Trial::Solved { estimated_error, strain, .. } => (*estimated_error, *strain),
        Trial::Tied => return,
        // The supports have been told of.
        Trial::Failed { fault: Fault::Supports, .. } => return,
        Trial::Failed { reason, fault } => {
            let key = if *fault == Fault::Mesh { view.mesh_key() } else { view.path.clone() };
            let (what, mend) = reason.split_once("; ").unwrap_or((reason, "use more elements, or less load"));
            return remarks.warn(&key, format!("a trial failed: {what}"), mend);
        }
    };
    let [_, longest] = element_lengths(rod);
    let bends_over = numbers.bending_length();
    let order = rod.order().as_number() as f64;
    if longest > bends_over {
        remarks.warn(
            &view.mesh_key(),
            format!(
                "elements are up to {} long, and under its tension of {} N the rod bends over {}",
                metres(longest),
                short(numbers.tension.value),
                metres(bends_over)
            ),
            format!("use {} elements or more", (2.0 * rod.length() / bends_over).ceil()),
        );
    } else if let Some(error) = error.filter(|error| *error > MUCH_ERROR) {
        let needed = rod.elements() as f64 * (10.0 * error / MUCH_ERROR).powf(1.0 / order);
        remarks.warn(
            &view.mesh_key(),
            format!(
                "{} elements of order {order} are too few: the estimated error is {:.1} % of the length, or {} rad",
                rod.elements(),
                100.0 * error,
                short(error)
            ),
            format!("about {} elements would leave 0.1 %, or fewer of order 4", (needed / 10.0).ceil() * 10.0),
        );
    }
    if let Some([strain, s]) = strain.filter(|[strain, _]| *strain > MUCH_STRAIN) {
        remarks.warn(
            &view.path,
            format!("the material is strained by {:.0} % at s = {}", 100.0 * strain, metres(s)),
            "its law, stress in proportion to strain, holds for some percent: a real rod would yield or break there, or stiffen",
        );
    }
}
