//! Binary glTF 2.0 (Khronos Group 2021), for Blender and every viewer: arrays, and the file about them.

use serde_json::{Value, json};
use std::f64::consts::FRAC_1_SQRT_2;
use strands::math::Vec3;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The turn, as glTF has quaternions (w last), that has the world's +z along glTF's +y.
pub(super) const UPRIGHT: [f64; 4] = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];

/// Who wrote it.
pub(super) fn asset() -> Value {
    json!({ "version": "2.0", "generator": concat!("Strands ", env!("CARGO_PKG_VERSION")) })
}

/// The bytes of all arrays, and what they are. What adds an array gives its accessor.
#[derive(Default)]
pub(super) struct Buffer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Buffer {
    /// Places of vertices, which must say their bounds.
    pub fn positions(&mut self, positions: &[Vec3]) -> usize {
        let positions: Vec<[f32; 3]> = positions.iter().map(single).collect();
        let accessor = self.vertices(&positions);
        self.bound(accessor, &positions);
        accessor
    }

    /// Directions at vertices.
    pub fn normals(&mut self, normals: &[Vec3]) -> usize {
        self.vertices(&normals.iter().map(single).collect::<Vec<_>>())
    }

    /// Numbers at vertices.
    pub fn vertices<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        self.floats(values, Some(ARRAY_BUFFER))
    }

    /// Numbers that are not at vertices.
    pub fn numbers<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        self.floats(values, None)
    }

    /// Times of an animation, which must say their bounds.
    pub fn times(&mut self, times: &[[f32; 1]]) -> usize {
        let accessor = self.numbers(times);
        self.bound(accessor, times);
        accessor
    }

    /// For each vertex the joint that moves it, alone.
    pub fn joints(&mut self, joints: &[u16]) -> usize {
        let bytes = joints.iter().flat_map(|joint| [*joint, 0, 0, 0]).flat_map(u16::to_le_bytes);
        let view = self.view(bytes, Some(ARRAY_BUFFER));
        self.accessor(view, UNSIGNED_SHORT, joints.len(), "VEC4")
    }

    /// The corners of triangles.
    pub fn indices(&mut self, triangles: &[[usize; 3]]) -> usize {
        let bytes = triangles.iter().flatten().flat_map(|i| (*i as u32).to_le_bytes());
        let view = self.view(bytes, Some(ELEMENT_ARRAY_BUFFER));
        self.accessor(view, UNSIGNED_INT, 3 * triangles.len(), "SCALAR")
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], target: Option<u32>) -> usize {
        let view = self.view(values.iter().flatten().flat_map(|x| x.to_le_bytes()), target);
        let shape = match N {
            1 => "SCALAR",
            3 => "VEC3",
            4 => "VEC4",
            16 => "MAT4",
            _ => unreachable!("glTF has no arrays of {N}"),
        };
        self.accessor(view, FLOAT, values.len(), shape)
    }

    fn bound<const N: usize>(&mut self, accessor: usize, values: &[[f32; N]]) {
        let bound = |pick: fn(f32, f32) -> f32, from: f32| {
            let bound =
                values.iter().fold([from; N], |bound, v| std::array::from_fn(|i| pick(bound[i], v[i])));
            json!(bound.as_slice())
        };
        self.accessors[accessor]["min"] = bound(f32::min, f32::INFINITY);
        self.accessors[accessor]["max"] = bound(f32::max, f32::NEG_INFINITY);
    }

    fn accessor(&mut self, view: usize, component: u32, count: usize, shape: &str) -> usize {
        self.accessors
            .push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
        self.accessors.len() - 1
    }

    /// Adds bytes, a multiple of four; gives their view.
    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }
}

fn single(v: &Vec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

/// Header, JSON chunk, binary chunk; each chunk a multiple of four bytes long.
pub(super) fn container(document: &str, mut binary: Vec<u8>) -> Vec<u8> {
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
