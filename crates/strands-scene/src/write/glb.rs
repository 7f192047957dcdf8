//! A solution as glTF: one mesh a rod, coloured by curvature.

use super::colour::{linear, viridis};
use super::gltf::{Buffer, UPRIGHT, asset, container};
use super::tube::Tube;
use super::{Shape, Solved};
use crate::model::Model;
use serde_json::{Value, json};
use strands::statics::Solution;

/// The solutions as a `.glb` file: metres, glTF's +y up (the world's +z), colour from no bending (dark) to the scene's sharpest (bright).
pub fn glb(model: &Model, solutions: &[(&str, &Solution)]) -> Vec<u8> {
    let shapes: Vec<Shape> = Solved::all(model, solutions).iter().map(Solved::shape).collect();
    let curvatures: Vec<Vec<f64>> = shapes.iter().map(Shape::curvature_at_nodes).collect();
    let sharpest = curvatures.iter().flatten().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mut buffer = Buffer::default();
    let mut meshes = Vec::new();
    for (shape, curvature) in shapes.iter().zip(&curvatures) {
        let tube = Tube::of(shape);
        let colours: Vec<[f32; 3]> =
            tube.nodes.iter().map(|node| linear(viridis(curvature[*node] / sharpest))).collect();
        let attributes = json!({
            "POSITION": buffer.positions(&tube.positions),
            "NORMAL": buffer.normals(&tube.normals),
            "COLOR_0": buffer.vertices(&colours),
        });
        let primitive =
            json!({ "attributes": attributes, "indices": buffer.indices(&tube.triangles), "material": 0 });
        meshes.push(json!({ "name": shape.rod.name, "primitives": [primitive] }));
    }
    let rods: Vec<Value> =
        shapes.iter().enumerate().map(|(i, shape)| json!({ "name": shape.rod.name, "mesh": i })).collect();
    let root = json!({
        "name": model.name,
        "rotation": UPRIGHT,
        "children": (0..rods.len()).collect::<Vec<_>>(),
    });
    let document = json!({
        "asset": asset(),
        "scene": 0,
        "scenes": [{ "name": model.name, "nodes": [rods.len()] }],
        "nodes": rods.into_iter().chain([root]).collect::<Vec<_>>(),
        "meshes": meshes,
        "materials": [{ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.5 } }],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    container(&document.to_string(), buffer.bytes)
}
