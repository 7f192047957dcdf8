//! A table for spreadsheets and plots.

use super::{Shape, Solved};
use crate::model::Model;
use strands::statics::Solution;

/// The columns of a node: its place (m), position (m) and orientation quaternion.
pub(super) const AT_NODE: [&str; 8] = ["s", "x", "y", "z", "qw", "qx", "qy", "qz"];
/// The columns of the element that begins at a node: strain (1/m, and dimensionless) and stress (N·m, N), in body axes.
pub(super) const OF_ELEMENT: [&str; 12] =
    ["kappa1", "kappa2", "tau", "v1", "v2", "v3", "m1", "m2", "m3", "n1", "n2", "n3"];

/// The solutions as CSV, one row a node, with the columns `rod`, `s`, `x` to `z`, `qw` to `qz`, and those of the element that begins at
/// the node: strain `kappa1`, `kappa2`, `tau`, `v1` to `v3` and stress `m1` to `m3`, `n1` to `n3`, empty at the last node.
pub fn csv(model: &Model, solutions: &[(&str, &Solution)]) -> String {
    let columns: Vec<&str> = ["rod"].into_iter().chain(AT_NODE).chain(OF_ELEMENT).collect();
    let mut rows = Vec::new();
    for shape in Solved::all(model, solutions).iter().map(Solved::shape) {
        for node in 0..shape.poses.len() {
            let name = [shape.rod.name.clone()].into_iter();
            rows.push(name.chain(at_node(&shape, node)).chain(of_element(&shape, node)).collect());
        }
    }
    table(&columns, rows)
}

/// A node's place, position and orientation.
pub(super) fn at_node(shape: &Shape<'_>, node: usize) -> impl Iterator<Item = String> {
    let pose = &shape.poses[node];
    let position = pose.position.to_array();
    [shape.s()[node]].into_iter().chain(position).chain(pose.orientation().to_wxyz()).map(number)
}

/// Strain and stress of the element that begins at a node; nothing at the last.
pub(super) fn of_element(shape: &Shape<'_>, node: usize) -> Vec<String> {
    match (shape.strain.get(node), shape.stress.get(node)) {
        (Some(strain), Some(stress)) => {
            strain.to_array().into_iter().chain(stress.to_array()).map(number).collect()
        }
        _ => vec![String::new(); OF_ELEMENT.len()],
    }
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
pub(super) fn number(x: f64) -> String {
    format!("{x:?}")
}
