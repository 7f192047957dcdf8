//! The obstacles of a scene and what touches, as the page draws them.

use serde_json::{Value, json};
use strands::contact::{Contact, Shape};
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
