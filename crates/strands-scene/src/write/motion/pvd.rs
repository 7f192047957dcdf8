//! ParaView's collection: a VTK file a frame and rod, with their times.

use super::Frame;
use crate::model::Model;
use crate::write::names::{escaped, identifiers};
use crate::write::vtp::{array, poly_data};
use std::fmt::Write;

/// A simulation as a `.pvd` file, and the `.vtp` files that it names, each with its own name: they belong in a folder beside it whose name is
/// `folder`. A file has one rod at one time, as [`vtp`](fn@crate::write::vtp) writes it, and its `velocity` (m/s) at the nodes.
pub fn motion_pvd<'a>(
    model: &'a Model,
    frames: &'a [Frame],
    folder: &str,
) -> (String, impl Iterator<Item = (String, String)> + 'a) {
    let words = identifiers(model.rods.iter().map(|rod| rod.name.as_str()));
    let digits = frames.len().saturating_sub(1).to_string().len();
    let file = move |rod: usize, frame: usize| format!("{}_{frame:0digits$}.vtp", words[rod]);
    let mut collection = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (i, frame) in frames.iter().enumerate() {
        for (number, rod) in model.rods.iter().enumerate() {
            let _ = writeln!(
                collection,
                "<DataSet timestep=\"{:?}\" part=\"{number}\" name=\"{}\" file=\"{}/{}\"/>",
                frame.time,
                escaped(&rod.name),
                escaped(folder),
                file(number, i)
            );
        }
    }
    collection.push_str("</Collection>\n</VTKFile>\n");
    let parts = frames.iter().enumerate().flat_map(move |(i, frame)| {
        let parts = frame.shapes(model).enumerate().map(|(number, (shape, moved))| {
            let velocities = moved.velocities.iter().flat_map(|velocity| velocity.linear.to_array());
            let velocity = array("Float64", "velocity", 3, velocities);
            (file(number, i), poly_data(&[(number, shape)], &[velocity]))
        });
        parts.collect::<Vec<_>>()
    });
    (collection, parts)
}
