//! Every format of a simulation read back.

use serde_json::Value;
use std::collections::HashMap;
use std::io::{Cursor, Read};
use strands::contact::{Contact, Passage, Through, Toucher};
use strands::math::{Pose, Vec3, Vec6, Wrench};
use strands::statics::Reaction;
use strands_scene::write::{
    End, Frame, FrameEnergy, MovedBody, MovedRod, Ran, motion_csv, motion_glb, motion_json, motion_npz,
    motion_pvd, motion_usda,
};
use strands_scene::{Model, Scene};

/// Two rods: one whose section has a step and whose name is no word, one of three nodes.
const TWO_RODS: &str = r#"
format = 1
name = "two \"rods\" & more"

[materials.steel]
youngs_modulus = 200e9
poisson_ratio = 0.3
density = 7850.0

[rods."round, stepped"]
material = "steel"
length = 0.5
elements = 20
section = [
    { s = 0.0, shape = "circle", radius = 1e-3 },
    { s = 0.25, shape = "circle", radius = 1e-3 },
    { s = 0.25, shape = "rectangle", width = 1e-3, height = 3e-3 },
]
supports = [{ at = "start", fix = ["position", "orientation"] }]

[rods.given]
length = 0.4
elements = 2
stiffness = { bending = [1e-2, 2e-2], torsion = 8e-3, axial = 1e4, shear = [4e3, 4e3] }
mass_per_length = 1e-3
position = [0.0, 0.1, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]
"#;

/// Three frames, not quite evenly apart: all turns and drifts, the more along the rods, and the first rod bends too.
fn moved() -> (Model, Vec<Frame>) {
    let model = Scene::parse(TWO_RODS, "two.toml", None).unwrap().model;
    let frames = [0.0, 0.017, 0.033].map(|time| Frame {
        time,
        rods: model
            .rods
            .iter()
            .map(|rod| {
                let rod = &rod.problem.rod;
                let at = |(i, pose): (usize, &Pose)| {
                    let way = Vec6::new(Vec3::new(60.0, 0.3 * i as f64, -4.0), Vec3::new(0.1, 0.0, 2.0));
                    Pose::exp(way * time).compose(pose)
                };
                let poses: Vec<Pose> = rod.rest_poses().iter().enumerate().map(at).collect();
                let velocity = |i: usize| Vec6::new(Vec3::X * i as f64, Vec3::Z * (time + i as f64));
                let velocities: Vec<Vec6> = (0..poses.len()).map(velocity).collect();
                let wrenches = vec![Wrench::new(Vec3::Y * time, Vec3::Z * 1e-7); poses.len() - 1];
                MovedRod::new(rod, &poses, &velocities, &wrenches)
            })
            .collect(),
        bodies: vec![MovedBody {
            name: "needle".into(),
            pose: Pose { position: Vec3::new(0.1, 0.2, time), ..Pose::IDENTITY },
            velocity: Vec6::new(Vec3::ZERO, Vec3::Z),
        }],
        contacts: vec![Contact {
            between: [Toucher::Element { rod: 0, element: 3 }, Toucher::Obstacle { obstacle: 0, part: 0 }],
            point: Vec3::new(0.1, 0.2, 0.3),
            normal: Vec3::Z,
            gap: 1e-6,
            force: Vec3::new(0.0, 0.1, time),
        }],
        passages: vec![Passage {
            through: Through::Eyelet(0),
            rod: 0,
            at: 0.01,
            place: Vec3::new(0.0, 0.0, 0.3),
            body: Some(0),
            force: Vec3::new(0.0, 0.2, time),
        }],
        energy: FrameEnergy { kinetic: time, elastic: 2.0, load: -1.0, dissipated: 0.5, work: None },
        iterations: 7,
        residual: 1e-12,
    });
    (model, frames.to_vec())
}

fn ran(end: End) -> Ran {
    Ran { steps: 33, real_time_factor: 2.5, end }
}

/// serde_json reads numbers to one unit in the last place.
fn assert_same(read: &Value, written: &[f64]) {
    let read: Vec<f64> = read.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert_eq!(read.len(), written.len());
    for (read, written) in read.iter().zip(written) {
        assert!((read - written).abs() <= 4.0 * f64::EPSILON * written.abs(), "{read} {written}");
    }
}

#[test]
fn json_has_frames_of_rods_and_bodies() {
    let (model, mut frames) = moved();
    frames[1].energy.work = Some(0.25);
    let held = Reaction { s: 0.0, force: Vec3::X, moment: Vec3::Y };
    frames[1].rods[0].reactions.push(held);
    let answer: Value = serde_json::from_str(&motion_json(&model, &frames, &ran(End::Finished))).unwrap();
    assert_eq!((&answer["scene"], &answer["status"]), (&model.name.as_str().into(), &"finished".into()));
    assert_eq!((&answer["steps"], &answer["real_time_factor"]), (&33.into(), &2.5.into()));
    let (read, frame) = (&answer["frames"][1], &frames[1]);
    assert_eq!((&read["t"], &read["newton_iterations"]), (&0.017.into(), &7.into()));
    assert_eq!((&read["energy"]["gravity"], &read["energy"]["work"]), (&(-1.0).into(), &0.25.into()));
    assert_eq!(answer["frames"][0]["energy"].get("work"), None);
    let (rod, moved) = (&read["rods"]["round, stepped"], &frame.rods[0]);
    let velocity = &moved.velocities[20];
    assert_same(&rod["position"][20], &moved.poses[20].position.to_array());
    assert_same(&rod["orientation"][20], &moved.poses[20].orientation().to_wxyz());
    assert_same(&rod["velocity"][20], &velocity.linear.to_array());
    assert_same(&rod["angular_velocity"][20], &velocity.angular.to_array());
    assert_same(&rod["strain"][19], &moved.strain[19].to_array());
    assert_same(&rod["stress"][19], &moved.stress[19].to_array());
    assert_same(&rod["reactions"][0]["moment"], &[0.0, 1.0, 0.0]);
    assert_eq!(read["rods"]["given"].get("reactions"), None);
    assert_same(&read["bodies"]["needle"]["position"], &[0.1, 0.2, 0.017]);
}

#[test]
fn json_says_why_a_simulation_ended() {
    let (model, frames) = moved();
    let answer = |end| -> Value { serde_json::from_str(&motion_json(&model, &frames, &ran(end))).unwrap() };
    assert_eq!(answer(End::Interrupted)["status"], "interrupted");
    let failed = answer(End::Failed("it broke".into()));
    assert_eq!((&failed["status"], &failed["reason"]), (&"failed".into(), &"it broke".into()));
}

#[test]
fn csv_reads_back_to_the_last_bit() {
    let (model, frames) = moved();
    let text = motion_csv(&model, &frames);
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<HashMap<String, String>> = table.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 3 * (21 + 3));
    let (row, moved) = (&rows[24 + 5], &frames[1].rods[0]);
    let at = |column: &str| row[column].parse::<f64>().unwrap().to_bits();
    assert_eq!(row["rod"], "round, stepped");
    assert_eq!(at("t"), 0.017_f64.to_bits());
    assert_eq!(at("z"), moved.poses[5].position.z.to_bits());
    assert_eq!(at("vz"), moved.velocities[5].linear.z.to_bits());
    assert_eq!(at("wx"), moved.velocities[5].angular.x.to_bits());
    assert_eq!(at("kappa1"), moved.strain[5].angular.x.to_bits());
    assert_eq!(at("n3"), moved.stress[5].linear.z.to_bits());
    assert_eq!(rows[20]["n3"], "");
}

/// The numbers of an array of an `.npz`, and its header.
fn array(archive: &[u8], name: &str) -> (String, Vec<f64>) {
    let mut archive = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let data = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((data % 64, bytes[data - 1]), (0, b'\n'));
    let numbers = bytes[data..].chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().unwrap()));
    (String::from_utf8(bytes[10..data].to_vec()).unwrap(), numbers.collect())
}

#[test]
fn npz_has_arrays_of_their_shapes_to_the_last_bit() {
    let (model, mut frames) = moved();
    let archive = motion_npz(&model, &frames);
    let (header, time) = array(&archive, "time");
    let begins = "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }";
    assert!(header.starts_with(begins), "{header}");
    assert_eq!(time, [0.0, 0.017, 0.033]);
    for (name, shape) in [
        ("round, stepped.s", "(21,)"),
        ("round, stepped.position", "(3, 21, 3)"),
        ("round, stepped.orientation", "(3, 21, 4)"),
        ("round, stepped.velocity", "(3, 21, 3)"),
        ("round, stepped.angular_velocity", "(3, 21, 3)"),
        ("round, stepped.strain", "(3, 20, 6)"),
        ("round, stepped.stress", "(3, 20, 6)"),
        ("given.position", "(3, 3, 3)"),
        ("needle.position", "(3, 1, 3)"),
        ("energy.kinetic", "(3,)"),
    ] {
        let (header, numbers) = array(&archive, name);
        assert!(header.contains(&format!("'shape': {shape}")), "{name}: {header}");
        let sizes = shape.trim_matches(['(', ')']).split(',').filter(|n| !n.is_empty());
        let size: usize = sizes.map(|n| n.trim().parse::<usize>().unwrap()).product();
        assert_eq!(numbers.len(), size, "{name}");
    }
    let (_, positions) = array(&archive, "round, stepped.position");
    assert_eq!(positions[3 * (2 * 21 + 7)..][..3], frames[2].rods[0].poses[7].position.to_array());
    let (_, stress) = array(&archive, "given.stress");
    assert_eq!(stress[6 * (2 + 1)..][..6], frames[1].rods[1].stress[1].to_array());
    for frame in &mut frames {
        frame.energy.work = Some(0.25);
    }
    assert_eq!(array(&motion_npz(&model, &frames), "energy.work").1, [0.25; 3]);
}

#[test]
fn pvd_names_a_file_a_frame_and_rod_with_its_time() {
    let (model, frames) = moved();
    let (collection, parts) = motion_pvd(&model, &frames, "a & \"b\"");
    let parts: Vec<(String, String)> = parts.collect();
    let mut reader = quick_xml::Reader::from_str(&collection);
    let mut read = Vec::new();
    loop {
        match reader.read_event().unwrap() {
            quick_xml::events::Event::Empty(tag) => {
                let attribute = |key: &str| {
                    let found = tag.try_get_attribute(key).unwrap().unwrap();
                    found.unescape_value().unwrap().into_owned()
                };
                read.push((attribute("timestep"), attribute("name"), attribute("file")));
            }
            quick_xml::events::Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!((read.len(), parts.len()), (6, 6));
    for ((_, _, file), (part, _)) in read.iter().zip(&parts) {
        assert_eq!(*file, format!("a & \"b\"/{part}"));
    }
    let last = ("0.033".into(), "given".into(), "a & \"b\"/given_2.vtp".into());
    assert_eq!((&read[1].1, &read[5]), (&"given".into(), &last));
    assert_eq!((parts[0].0.as_str(), parts[2].0.as_str()), ("round__stepped_0.vtp", "round__stepped_1.vtp"));
    let numbers = |name: &str| -> Vec<f64> {
        let after = parts[5].1.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
        let text = after.split_once('>').unwrap().1.split_once('<').unwrap().0;
        text.split_whitespace().map(|x| x.parse().unwrap()).collect()
    };
    let rod = &frames[2].rods[1];
    let velocities: Vec<f64> = rod.velocities.iter().flat_map(|v| v.linear.to_array()).collect();
    assert_eq!(numbers("velocity"), velocities);
    assert_eq!(numbers("position")[3..6], rod.poses[1].position.to_array());
    assert_eq!(numbers("connectivity"), [0.0, 1.0, 1.0, 2.0]);
    assert_eq!(numbers("rod"), [1.0, 1.0]);
}

#[test]
fn usda_has_a_curve_a_rod_with_points_in_time() {
    let (model, frames) = moved();
    let text = motion_usda(&model, &frames);
    assert!(text.starts_with("#usda 1.0\n"));
    let values = |after: &str, key: &str| -> String {
        let text = text.split(after).nth(1).unwrap_or_else(|| panic!("no {after}"));
        text.split(&format!("{key} = ")).nth(1).unwrap_or_else(|| panic!("no {key}")).to_owned()
    };
    for (key, value) in [
        ("metersPerUnit", "1\n"),
        ("upAxis", "\"Z\"\n"),
        // Three frames in 33 ms.
        ("timeCodesPerSecond", "61.0\n"),
        ("endTimeCode", "2.013\n"),
    ] {
        assert!(values("#usda", key).starts_with(value), "{key}: {:.20}", values("#usda", key));
    }
    assert!(text.contains(r#"customData = { string name = "two \"rods\" & more" }"#));
    let rod = "def BasisCurves \"round__stepped\"";
    assert!(values(rod, "int[] curveVertexCounts").starts_with("[21]"));
    // The larger extent of the section: a diameter of 2 mm, then a height of 3 mm.
    assert!(values(rod, "float[] widths").starts_with("[0.002, 0.002,"));
    assert!(values(rod, "float[] widths").split(']').next().unwrap().ends_with("0.003"));
    for (key, of) in [
        ("points", (|rod, i| rod.poses[i].position) as fn(&MovedRod, usize) -> Vec3),
        ("velocities", |rod, i| rod.velocities[i].linear),
    ] {
        let samples = values(rod, &format!("{key}.timeSamples"));
        let samples: Vec<&str> = samples.split('}').next().unwrap().lines().skip(1).collect();
        for (frame, sample) in frames.iter().zip(samples) {
            let (code, vectors) = sample.trim().split_once(": ").unwrap();
            assert_eq!(code.parse::<f64>().unwrap(), frame.time * 61.0);
            let numbers = vectors.split(['[', ']', '(', ')', ',', ' ']).filter(|word| !word.is_empty());
            let numbers: Vec<f32> = numbers.map(|word| word.parse().unwrap()).collect();
            let written: Vec<f32> =
                (0..21).flat_map(|i| of(&frame.rods[0], i).to_array()).map(|x| x as f32).collect();
            assert_eq!(numbers, written, "{key} at {code}");
        }
    }
    let needle = values("def Xform \"needle\"", "double3 xformOp:translate.timeSamples");
    assert!(needle.contains(": (0.1, 0.2, 0.017),"), "{needle}");
    assert_eq!(text.matches(['{', '[', '(']).count(), text.matches(['}', ']', ')']).count());
}

/// A `.glb`, taken apart.
struct Gltf {
    document: Value,
    binary: Vec<u8>,
}

impl Gltf {
    fn read(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let json = 20 + word(12);
        let document = serde_json::from_slice(&bytes[20..json]).unwrap();
        assert_eq!(
            (&bytes[..4], word(8), word(json)),
            (b"glTF".as_slice(), bytes.len(), bytes.len() - json - 8)
        );
        Self { document, binary: bytes[json + 8..].to_vec() }
    }

    /// The bytes of an array, and how many vectors there are.
    fn bytes(&self, accessor: &Value) -> (&[u8], usize) {
        let accessor = &self.document["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let [start, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        assert_eq!(start % 4, 0);
        (&self.binary[start..start + length], accessor["count"].as_u64().unwrap() as usize)
    }

    fn floats<const N: usize>(&self, accessor: &Value) -> Vec<[f64; N]> {
        let (bytes, count) = self.bytes(accessor);
        assert_eq!(bytes.len(), 4 * N * count);
        let floats: Vec<f64> =
            bytes.chunks_exact(4).map(|x| f32::from_le_bytes(x.try_into().unwrap()).into()).collect();
        floats.chunks_exact(N).map(|chunk| chunk.try_into().unwrap()).collect()
    }

    /// The values of a node's channel.
    fn channel<const N: usize>(&self, node: &Value, path: &str) -> Vec<[f64; N]> {
        let animation = &self.document["animations"][0];
        let target = serde_json::json!({ "node": node, "path": path });
        let channels = animation["channels"].as_array().unwrap();
        let channel = channels.iter().find(|channel| channel["target"] == target).unwrap();
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        let times = self.floats::<1>(&sampler["input"]);
        assert_eq!(times.iter().map(|[t]| (t * 1e6).round()).collect::<Vec<_>>(), [0.0, 17e3, 33e3]);
        self.floats(&sampler["output"])
    }
}

/// The frame of a node of glTF, which has w last.
fn pose([x, y, z]: [f64; 3], [qx, qy, qz, qw]: [f64; 4]) -> Pose {
    Pose::from_parts(Vec3::new(x, y, z), strands::math::Quat::from_wxyz([qw, qx, qy, qz]).unwrap())
}

#[test]
fn glb_moves_every_section_with_its_node() {
    let (model, frames) = moved();
    let gltf = Gltf::read(&motion_glb(&model, &frames).unwrap());
    let nodes = gltf.document["nodes"].as_array().unwrap();
    let scene = gltf.document["scenes"][0]["nodes"].as_array().unwrap();
    let at = |index: &Value| &nodes[index.as_u64().unwrap() as usize];
    let root = at(&scene[0]);
    let rotation: Vec<f64> =
        root["rotation"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let upright = pose([0.0; 3], rotation.try_into().unwrap());
    // The world's +z is glTF's +y.
    assert!((upright.rotation * Vec3::Z - Vec3::Y).max_abs() < 1e-12);
    for (i, rod) in model.rods.iter().enumerate() {
        let (mesh, skin) = (&gltf.document["meshes"][i], &gltf.document["skins"][i]);
        let instance = at(&scene[1 + i]);
        assert_eq!((&instance["name"], &instance["mesh"]), (&rod.name.as_str().into(), &i.into()));
        assert_eq!(instance["skin"], i);
        let joints = skin["joints"].as_array().unwrap();
        assert_eq!(joints.len(), rod.problem.rod.elements() + 1);
        assert!(joints.iter().all(|joint| root["children"].as_array().unwrap().contains(joint)));
        let unbound = gltf.floats::<16>(&skin["inverseBindMatrices"]);
        let attributes = &mesh["primitives"][0]["attributes"];
        let positions = gltf.floats::<3>(&attributes["POSITION"]);
        let weights = gltf.floats::<4>(&attributes["WEIGHTS_0"]);
        assert!(weights.iter().all(|weights| *weights == [1.0, 0.0, 0.0, 0.0]));
        let (bytes, count) = gltf.bytes(&attributes["JOINTS_0"]);
        assert_eq!(
            (bytes.len(), count, weights.len()),
            (8 * positions.len(), positions.len(), positions.len())
        );
        let joint_of: Vec<usize> =
            bytes.chunks_exact(8).map(|four| usize::from(u16::from_le_bytes([four[0], four[1]]))).collect();
        let half = rod.problem.rod.half_extent();
        for (joint, node) in joints.iter().enumerate() {
            let translation = gltf.channel::<3>(node, "translation");
            let rotation = gltf.channel::<4>(node, "rotation");
            for f in 0..frames.len() {
                let moved = pose(translation[f], rotation[f]);
                let expected = &frames[f].rods[i].poses[joint];
                assert!((moved.position - expected.position).max_abs() < 1e-6);
                assert!((moved.rotation * Vec3::X - expected.rotation * Vec3::X).max_abs() < 1e-6);
                let near = |pair: &[[f64; 4]]| (0..4).map(|i| pair[0][i] * pair[1][i]).sum::<f64>() > 0.0;
                assert!(rotation.windows(2).all(near), "a node turns the long way");
                let m = &unbound[joint];
                for (vertex, _) in joint_of.iter().enumerate().filter(|(_, of)| **of == joint) {
                    let [x, y, z] = positions[vertex];
                    let place = |row: usize| m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row];
                    let in_section = Vec3::new(place(0), place(1), place(2));
                    let drawn = upright.compose(&frames[0].rods[i].poses[joint]);
                    let drawn = drawn.position + drawn.rotation * in_section;
                    assert!((drawn - Vec3::new(x, y, z)).max_abs() < 1e-6, "it jumps when it is played");
                    let Vec3 { x, y, z } = in_section;
                    assert!(z.abs() < 1e-6, "{z}");
                    let most = half[joint][0].max(half[joint][1]);
                    assert!(x.abs() < most + 1e-6 && y.abs() < most + 1e-6 && x.hypot(y) > 0.49e-3);
                }
            }
        }
    }
    let needle = nodes.iter().position(|node| node["name"] == "needle").unwrap();
    assert!((gltf.channel::<3>(&needle.into(), "translation")[1][2] - 0.017).abs() < 1e-6);
}
