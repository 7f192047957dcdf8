//! The rigid bodies of a scene in motion, as the page draws them.

use serde_json::{Value, json};
use std::f64::consts::PI;
use strands_scene::{BodyShape, Model, ModelBody};

/// The density of the ball that stands for a body without a shape, kg/m³.
const DENSITY: f64 = 2000.0;

/// Names and shapes of the bodies, as JSON.
pub fn drawn(model: &Model) -> Value {
    model.bodies.iter().map(|body| json!({ "name": body.name, "shape": shape(body) })).collect()
}

fn shape(body: &ModelBody) -> Value {
    let ball = || BodyShape::Ball { radius: (0.75 * body.body.inertia.mass / (PI * DENSITY)).cbrt() };
    match body.shape.unwrap_or_else(ball) {
        BodyShape::Ball { radius } => json!({ "kind": "ball", "radius": radius }),
        BodyShape::Capsule { radius, length } => {
            json!({ "kind": "capsule", "radius": radius, "length": length })
        }
        BodyShape::Cylinder { radius, length } => {
            json!({ "kind": "cylinder", "radius": radius, "length": length })
        }
        BodyShape::Ring { radius, wire_radius } => {
            json!({ "kind": "ring", "radius": radius, "wire_radius": wire_radius })
        }
        BodyShape::Block { size } => json!({ "kind": "block", "size": size }),
    }
}
