//! A simulation as glTF: one skinned mesh a rod, a joint at each node, and an animation that moves the joints.

use super::Frame;
use crate::model::Model;
use crate::write::colour::linear;
use crate::write::gltf::{Buffer, UPRIGHT, asset, container};
use crate::write::tube::Tube;
use serde_json::{Value, json};
use strands::math::{Mat3, Pose, Quat, Vec3};
use thiserror::Error;

/// The colour of rods, sRGB.
const BLUE: [f64; 3] = [0.0, 0.447, 0.698];

/// A rod that a skin has not joints enough for.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("rod `{rod}` has {nodes} nodes, and glTF moves no more than 65536 in a mesh; use fewer elements")]
pub struct TooManyNodes {
    /// The rod.
    pub rod: String,
    /// How many nodes it has.
    pub nodes: usize,
}

/// A simulation as an animated `.glb` file: metres, seconds from the first frame on, glTF's +y up (the world's +z).
///
/// A rod is the surface of its true section in the first frame. Each of its sections moves with the joint at its node as the rod's node does, from frame to
/// frame along straight lines and by the shorter turn. A body is a node without a mesh that moves in the same way.
///
/// # Errors
/// Where a rod has more nodes than a skin can have joints.
pub fn motion_glb(model: &Model, frames: &[Frame]) -> Result<Vec<u8>, TooManyNodes> {
    let mut buffer = Buffer::default();
    let times: Vec<[f32; 1]> = frames.iter().map(|frame| [(frame.time - frames[0].time) as f32]).collect();
    let mut moving = Moving { times: buffer.times(&times), ..Moving::default() };
    let (mut meshes, mut skins) = (Vec::new(), Vec::new());
    for (i, (shape, _)) in frames[0].shapes(model).enumerate() {
        let (name, nodes) = (&shape.rod.name, shape.poses.len());
        let tube = Tube::of(&shape);
        let joint = |node: &usize| u16::try_from(*node);
        let joints: Result<Vec<u16>, _> = tube.nodes.iter().map(joint).collect();
        let joints = joints.map_err(|_| TooManyNodes { rod: name.clone(), nodes })?;
        let upright =
            |vectors: &[Vec3]| vectors.iter().map(|v| Vec3::new(v.x, v.z, -v.y)).collect::<Vec<_>>();
        let attributes = json!({
            "POSITION": buffer.positions(&upright(&tube.positions)),
            "NORMAL": buffer.normals(&upright(&tube.normals)),
            "JOINTS_0": buffer.joints(&joints),
            "WEIGHTS_0": buffer.vertices(&vec![[1.0, 0.0, 0.0, 0.0]; joints.len()]),
        });
        let primitive =
            json!({ "attributes": attributes, "indices": buffer.indices(&tube.triangles), "material": 0 });
        meshes.push(json!({ "name": name, "primitives": [primitive] }));
        let unbound: Vec<[f32; 16]> = shape.poses.iter().map(unbound).collect();
        let first = moving.nodes.len();
        for node in 0..nodes {
            let poses = frames.iter().map(|frame| &frame.rods[i].poses[node]);
            moving.add(&mut buffer, format!("{name} {node}"), poses);
        }
        let joints: Vec<usize> = (first..first + nodes).collect();
        skins.push(json!({ "inverseBindMatrices": buffer.numbers(&unbound), "joints": joints }));
    }
    for (i, body) in frames[0].bodies.iter().enumerate() {
        moving.add(&mut buffer, body.name.clone(), frames.iter().map(|frame| &frame.bodies[i].pose));
    }
    let Moving { mut nodes, channels, samplers, .. } = moving;
    let root = nodes.len();
    nodes.push(json!({
        "name": model.name,
        "rotation": UPRIGHT,
        "children": (0..root).collect::<Vec<_>>(),
    }));
    // A mesh that joints move stays where it is itself, so it hangs from nothing.
    let skinned = model.rods.iter().enumerate();
    nodes.extend(skinned.map(|(i, rod)| json!({ "name": rod.name, "mesh": i, "skin": i })));
    let [r, g, b] = linear(BLUE);
    let colour = json!({ "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.5 });
    let document = json!({
        "asset": asset(),
        "scene": 0,
        "scenes": [{ "name": model.name, "nodes": (root..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "skins": skins,
        "animations": [{ "name": model.name, "channels": channels, "samplers": samplers }],
        "materials": [{ "pbrMetallicRoughness": colour }],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    Ok(container(&document.to_string(), buffer.bytes))
}

/// The nodes that move, and how.
#[derive(Default)]
struct Moving {
    /// The accessor of the frames' times.
    times: usize,
    nodes: Vec<Value>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

impl Moving {
    /// Adds a node with its frames in time.
    fn add<'a>(&mut self, buffer: &mut Buffer, name: String, poses: impl Iterator<Item = &'a Pose>) {
        let (mut places, mut turns) = (Vec::new(), Vec::<[f32; 4]>::new());
        for pose in poses {
            places.push(pose.position.to_array().map(|x| x as f32));
            let turn = quaternion(pose.orientation());
            // Of the two quaternions of a turn the one that is nearer to the last.
            let apart = turns.last().is_some_and(|last| (0..4).map(|i| last[i] * turn[i]).sum::<f32>() < 0.0);
            turns.push(turn.map(|x| if apart { -x } else { x }));
        }
        let node = self.nodes.len();
        self.nodes.push(json!({ "name": name, "translation": places[0], "rotation": turns[0] }));
        for (path, output) in [("translation", buffer.numbers(&places)), ("rotation", buffer.numbers(&turns))]
        {
            let target = json!({ "node": node, "path": path });
            self.channels.push(json!({ "sampler": self.samplers.len(), "target": target }));
            self.samplers.push(json!({ "input": self.times, "output": output, "interpolation": "LINEAR" }));
        }
    }
}

/// As glTF has it, w last.
fn quaternion(q: Quat) -> [f32; 4] {
    let [w, x, y, z] = q.to_wxyz();
    [x, y, z, w].map(|x| x as f32)
}

/// The matrix, column by column, that takes a place in glTF's world to where it is as seen from a node.
fn unbound(pose: &Pose) -> [f32; 16] {
    let upright = Pose { rotation: Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y), position: Vec3::ZERO };
    let Pose { rotation, position } = upright.compose(pose).inverse();
    let [a, b, c] = rotation.cols.map(Vec3::to_array);
    let d = position.to_array();
    [a[0], a[1], a[2], 0.0, b[0], b[1], b[2], 0.0, c[0], c[1], c[2], 0.0, d[0], d[1], d[2], 1.0]
        .map(|x| x as f32)
}
