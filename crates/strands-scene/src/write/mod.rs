//! Solutions and simulations as text and bytes, one format a module. No file is touched here.
//!
//! Every writer takes the model, and the solutions of its rods by name, in any order, or the frames of a simulation.
//!
//! # Panics
//! Every writer, where a solution's name is not a rod of the model, or its mesh is not that rod's; where frames are not of the model's rods.

mod colour;
mod csv;
mod glb;
mod gltf;
mod json;
mod motion;
mod names;
mod svg;
mod tube;
mod view;
mod vtp;

pub use csv::csv;
pub use glb::glb;
pub use json::{PathAnswer, equilibria_json, failure_json, json, path_json};
pub use motion::{
    End, Frame, FrameEnergy, MovedBody, MovedRod, Ran, TooManyNodes, motion_csv, motion_glb, motion_json,
    motion_npz, motion_pvd, motion_usda,
};
pub use svg::svg;
pub use vtp::vtp;

use crate::model::{Model, ModelRod};
use strands::math::{Pose, Strain, Stress};
use strands::statics::{Solution, UnstableMode, Workspace, unstable_mode};

/// A solved rod.
#[derive(Clone, Copy)]
struct Solved<'a> {
    rod: &'a ModelRod,
    solution: &'a Solution,
}

impl<'a> Solved<'a> {
    /// The rods that were solved, in the order of the solutions.
    fn all(model: &'a Model, solutions: &[(&str, &'a Solution)]) -> Vec<Self> {
        let solved = |&(name, solution): &(&str, &'a Solution)| {
            let rod = model.rod(name).unwrap_or_else(|| panic!("`{name}` is not a rod of the model"));
            assert_eq!(
                solution.poses.len(),
                rod.problem.rod.mesh().nodes().len(),
                "the mesh of `{name}` is another"
            );
            Self { rod, solution }
        };
        solutions.iter().map(solved).collect()
    }

    fn shape(&self) -> Shape<'a> {
        let Solution { poses, strain, stress, .. } = self.solution;
        Shape { rod: self.rod, poses, strain, stress }
    }

    /// The mode in which it falls, where it is unstable.
    fn unstable_mode(&self) -> Option<UnstableMode> {
        unstable_mode(&self.rod.problem, self.solution, &mut Workspace::default())
    }
}

/// A rod in some shape, at rest or in motion.
#[derive(Clone, Copy)]
struct Shape<'a> {
    rod: &'a ModelRod,
    /// Of the nodes.
    poses: &'a [Pose],
    /// Of the elements, body frame.
    strain: &'a [Strain],
    stress: &'a [Stress],
}

impl<'a> Shape<'a> {
    /// The nodes' places, m.
    fn s(&self) -> &'a [f64] {
        self.rod.problem.rod.mesh().nodes()
    }

    /// The bending curvature `√(κ1² + κ2²)` at the nodes, 1/m, each the mean of its two elements.
    fn curvature_at_nodes(&self) -> Vec<f64> {
        let of_element: Vec<f64> =
            self.strain.iter().map(|strain| strain.angular.x.hypot(strain.angular.y)).collect();
        let last = of_element.len() - 1;
        (0..=of_element.len())
            .map(|i| 0.5 * (of_element[i.saturating_sub(1)] + of_element[i.min(last)]))
            .collect()
    }
}
