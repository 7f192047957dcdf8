//! The obstacles of a scene, what touches and what rods pass through, as the page draws them.

use serde_json::{Value, json};
use strands::contact::{Contact, Passage, Shape};
use strands::math::{Pose, Vec3};
use strands_scene::Model;

/// The shapes of the obstacles, as JSON.
pub fn drawn(model: &Model) -> Value {
    model.obstacles.iter().map(|obstacle| shape(&obstacle.shape)).collect()
}

fn shape(shape: &Shape) -> Value {
    match shape {
        Shape::Plane { point, normal } => {
            json!({ "kind": "plane", "point": point.to_array(), "normal": normal.to_array() })
        }
        Shape::Capsule { ends, radius } => {
            json!({ "kind": "capsule", "ends": ends.map(|end| end.to_array()), "radius": radius })
        }
        Shape::Cylinder { ends, radius } => {
            json!({ "kind": "cylinder", "ends": ends.map(|end| end.to_array()), "radius": radius })
        }
        Shape::Ring { middle, axis, radius, wire_radius } => json!({
            "kind": "ring", "point": middle.to_array(), "axis": axis.to_array(), "radius": radius, "wire_radius": wire_radius
        }),
        Shape::Bore { point, axis, radius } => {
            json!({ "kind": "tube", "point": point.to_array(), "axis": axis.to_array(), "radius": radius })
        }
        Shape::Mesh(mesh) => {
            let corners: Vec<f64> = mesh.corners().iter().flat_map(|corner| corner.to_array()).collect();
            json!({ "kind": "mesh", "corners": corners, "triangles": mesh.indices().as_flattened() })
        }
    }
}

/// Contacts as plain numbers, nine each: the point, the normal, the force.
pub fn flat(contacts: &[Contact]) -> Vec<f64> {
    let parts = |contact: &Contact| [contact.point, contact.normal, contact.force].map(|v| v.to_array());
    contacts.iter().flat_map(parts).flatten().collect()
}

/// What a rod passes through as plain numbers, nine of them like a contact: where the rod is in it, the rod's direction there, the force on the rod. `along` tells
/// how far along the rod its `nodes` are, m.
pub fn ring(passage: &Passage, nodes: &[Pose], along: &[f64]) -> [f64; 9] {
    let element = along.partition_point(|along| *along <= passage.at).clamp(1, along.len() - 1) - 1;
    let [from, to] = [nodes[element].position, nodes[element + 1].position];
    let part = (passage.at - along[element]) / (along[element + 1] - along[element]);
    let direction = (to - from).normalized().unwrap_or(Vec3::Z);
    let parts = [from + (to - from) * part, direction, passage.force].map(|v| v.to_array());
    core::array::from_fn(|i| parts[i / 3][i % 3])
}
