//! Frames as a table.

use super::Frame;
use crate::model::Model;
use crate::write::csv::{AT_NODE, OF_ELEMENT, at_node, number, of_element, table};

/// A simulation as CSV, one row a node and frame: `t`, then the columns of [`csv`](fn@crate::write::csv), with the velocities `vx` to `vz` (world axes) and `wx`
/// to `wz` (the node's own axes) before those of the element that begins at the node.
pub fn motion_csv(model: &Model, frames: &[Frame]) -> String {
    let velocities = ["vx", "vy", "vz", "wx", "wy", "wz"];
    let columns: Vec<&str> =
        ["t", "rod"].into_iter().chain(AT_NODE).chain(velocities).chain(OF_ELEMENT).collect();
    let mut rows = Vec::new();
    for frame in frames {
        for (shape, moved) in frame.shapes(model) {
            for (node, velocity) in moved.velocities.iter().enumerate() {
                let [linear, angular] = [velocity.linear, velocity.angular].map(|v| v.to_array());
                let head = [number(frame.time), shape.rod.name.clone()].into_iter();
                let moving = linear.into_iter().chain(angular).map(number);
                rows.push(
                    head.chain(at_node(&shape, node)).chain(moving).chain(of_element(&shape, node)).collect(),
                );
            }
        }
    }
    table(&columns, rows)
}
