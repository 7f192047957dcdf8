//! Binary glTF 2.0 (Khronos Group 2021), for Blender and every viewer: one mesh a rod, coloured by curvature.

use super::Solved;
use super::colour::{linear, viridis};
use super::tube::Tube;
use crate::model::Model;
use serde_json::{Value, json};
use strands::statics::Solution;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The solutions as a `.glb` file: metres, glTF's +y up (the world's +z), colour from no bending (dark) to the scene's sharpest (bright).
pub fn glb(model: &Model, solutions: &[(&str, &Solution)]) -> Vec<u8> {
    let solved = Solved::all(model, solutions);
    let curvatures: Vec<Vec<f64>> = solved.iter().map(Solved::curvature_at_nodes).collect();
    let sharpest = curvatures.iter().flatten().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mut buffer = Buffer::default();
    let mut meshes = Vec::new();
    for (rod, curvature) in solved.iter().zip(&curvatures) {
        let tube = Tube::of(rod);
        let vectors = |vectors: &[strands::math::Vec3]| {
            vectors.iter().map(|v| v.to_array().map(|x| x as f32)).collect::<Vec<_>>()
        };
        let colours: Vec<[f32; 3]> =
            tube.nodes.iter().map(|node| linear(viridis(curvature[*node] / sharpest))).collect();
        let attributes = json!({
            "POSITION": buffer.vectors(&vectors(&tube.positions), true),
            "NORMAL": buffer.vectors(&vectors(&tube.normals), false),
            "COLOR_0": buffer.vectors(&colours, false),
        });
        let primitive =
            json!({ "attributes": attributes, "indices": buffer.indices(&tube.triangles), "material": 0 });
        meshes.push(json!({ "name": rod.rod.name, "primitives": [primitive] }));
    }
    let rods: Vec<Value> =
        solved.iter().enumerate().map(|(i, rod)| json!({ "name": rod.rod.name, "mesh": i })).collect();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let root = json!({
        "name": model.name,
        "rotation": [-half, 0.0, 0.0, half],
        "children": (0..rods.len()).collect::<Vec<_>>(),
    });
    let document = json!({
        "asset": { "version": "2.0", "generator": concat!("Strands ", env!("CARGO_PKG_VERSION")) },
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

/// The bytes of all arrays, and what they are.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an array of vectors; gives its accessor. Positions must say their bounds.
    fn vectors(&mut self, vectors: &[[f32; 3]], bounds: bool) -> usize {
        let view = self.view(vectors.iter().flatten().flat_map(|x| x.to_le_bytes()), ARRAY_BUFFER);
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": vectors.len(), "type": "VEC3" });
        if bounds {
            let bound = |pick: fn(f32, f32) -> f32, from: f32| {
                vectors.iter().fold([from; 3], |bound, v| std::array::from_fn(|i| pick(bound[i], v[i])))
            };
            accessor["min"] = json!(bound(f32::min, f32::INFINITY));
            accessor["max"] = json!(bound(f32::max, f32::NEG_INFINITY));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds the corners of triangles; gives their accessor.
    fn indices(&mut self, triangles: &[[usize; 3]]) -> usize {
        let view = self
            .view(triangles.iter().flatten().flat_map(|i| (*i as u32).to_le_bytes()), ELEMENT_ARRAY_BUFFER);
        let count = 3 * triangles.len();
        self.accessors.push(
            json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" }),
        );
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: u32) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target }));
        self.views.len() - 1
    }
}

/// Header, JSON chunk, binary chunk; each chunk a multiple of four bytes long.
fn container(document: &str, mut binary: Vec<u8>) -> Vec<u8> {
    let mut text = document.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let mut out = Vec::with_capacity(total);
    let word = |out: &mut Vec<u8>, word: usize| out.extend((word as u32).to_le_bytes());
    out.extend(b"glTF");
    word(&mut out, 2);
    word(&mut out, total);
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        word(&mut out, chunk.len());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}
