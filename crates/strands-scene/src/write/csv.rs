//! A table for spreadsheets and plots.

use super::Solved;
use crate::model::Model;
use strands::statics::Solution;

/// The columns: the rod's name; the node's place (m), position (m) and orientation quaternion; then strain (1/m, and
/// dimensionless) and stress (N·m, N) of the element that begins at the node, in body axes.
const COLUMNS: [&str; 21] = [
    "rod", "s", "x", "y", "z", "qw", "qx", "qy", "qz", "kappa1", "kappa2", "tau", "v1", "v2", "v3", "m1",
    "m2", "m3", "n1", "n2", "n3",
];

/// The solutions as CSV, one row a node, with the columns `rod`, `s`, `x` to `z`, `qw` to `qz`, and those of the element that begins at
/// the node: strain `kappa1`, `kappa2`, `tau`, `v1` to `v3` and stress `m1` to `m3`, `n1` to `n3`, empty at the last node.
pub fn csv(model: &Model, solutions: &[(&str, &Solution)]) -> String {
    let mut rows = Vec::new();
    for Solved { rod, solution } in Solved::all(model, solutions) {
        for (node, (s, pose)) in rod.problem.rod.mesh().nodes().iter().zip(&solution.poses).enumerate() {
            let mut row = vec![rod.name.clone()];
            let at_node =
                [*s].into_iter().chain(pose.position.to_array()).chain(pose.orientation().to_wxyz());
            row.extend(at_node.map(number));
            match (solution.strain.get(node), solution.stress.get(node)) {
                (Some(strain), Some(stress)) => {
                    row.extend(strain.to_array().into_iter().chain(stress.to_array()).map(number));
                }
                _ => row.resize(COLUMNS.len(), String::new()),
            }
            rows.push(row);
        }
    }
    table(&COLUMNS, rows)
}

/// Rows under the names of their columns.
pub(super) fn table(columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = csv::Writer::from_writer(Vec::new());
    let header = columns.iter().map(|&name| name.to_owned()).collect();
    for row in core::iter::once(header).chain(rows) {
        table.write_record(row).unwrap_or_else(|error| unreachable!("in memory: {error}"));
    }
    let bytes = table.into_inner().unwrap_or_else(|error| unreachable!("in memory: {error}"));
    String::from_utf8(bytes).unwrap_or_else(|error| unreachable!("only text was written: {error}"))
}

/// The shortest text that reads back as the same number.
fn number(x: f64) -> String {
    format!("{x:?}")
}
