//! Solutions as text and bytes, one format a module. No file is touched here.
//!
//! Every writer takes the model that was solved and the solutions of its rods by name, in any order.
//!
//! # Panics
//! Every writer, where a solution's name is not a rod of the model, or its mesh is not that rod's.

mod colour;
mod csv;
mod glb;
mod json;
mod motion;
mod svg;
mod tube;
mod view;
mod vtp;

pub use csv::csv;
pub use glb::glb;
pub use json::{PathAnswer, equilibria_json, failure_json, json, path_json};
pub use motion::{Frame, Moved, motion_csv, motion_json};
pub use svg::svg;
pub use vtp::vtp;

use crate::model::{Model, ModelRod};
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

    /// The nodes' places, m.
    fn s(&self) -> &'a [f64] {
        self.rod.problem.rod.mesh().nodes()
    }

    /// The mode in which it falls, where it is unstable.
    fn unstable_mode(&self) -> Option<UnstableMode> {
        unstable_mode(&self.rod.problem, self.solution, &mut Workspace::default())
    }

    /// The bending curvature `√(κ1² + κ2²)` at the nodes, 1/m, each the mean of its two elements.
    fn curvature_at_nodes(&self) -> Vec<f64> {
        let of_element: Vec<f64> =
            self.solution.strain.iter().map(|strain| strain.angular.x.hypot(strain.angular.y)).collect();
        let last = of_element.len() - 1;
        (0..=of_element.len())
            .map(|i| 0.5 * (of_element[i.saturating_sub(1)] + of_element[i.min(last)]))
            .collect()
    }
}
