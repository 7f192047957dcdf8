//! Every format read back.

use quick_xml::Reader;
use quick_xml::events::Event;
use serde_json::Value;
use std::collections::HashMap;
use strands::statics::{Solution, Workspace, solve};
use strands_scene::{Model, Scene, bundled_scene, write};

/// Two rods: one of every thing that a writer distinguishes.
const TWO_RODS: &str = r#"
format = 1
name = "two <rods> & more"
gravity = [0.0, 0.0, -9.81]

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
orientation = [0.7071068, 0.0, 0.7071068, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]

[rods.given]
length = 0.4
elements = 10
stiffness = { bending = [1e-2, 2e-2], torsion = 8e-3, axial = 1e4, shear = [4e3, 4e3] }
mass_per_length = 1e-3
position = [0.0, 0.1, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]
loads = [{ at = "end", force = [0.1, 0.0, 0.0] }]
"#;

fn solved() -> (Model, Vec<Solution>) {
    let model = Scene::parse(TWO_RODS, "two.toml", None).unwrap().model;
    let mut workspace = Workspace::default();
    let solutions = model
        .rods
        .iter()
        .map(|rod| solve(&rod.problem, &model.settings, None, &mut workspace).unwrap())
        .collect();
    (model, solutions)
}

fn named<'a>(model: &'a Model, solutions: &'a [Solution]) -> Vec<(&'a str, &'a Solution)> {
    model.rods.iter().map(|rod| rod.name.as_str()).zip(solutions).collect()
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
fn json_has_the_answer_of_the_scene_format() {
    let (model, solutions) = solved();
    let answer: Value =
        serde_json::from_str(&write::json(&model, &named(&model, &solutions), Some(0.25))).unwrap();
    assert_eq!(answer["scene"], "two <rods> & more");
    assert_eq!(answer["status"], "converged");
    assert_eq!((&answer["stable"], &answer["morse_index"]), (&Value::Bool(true), &Value::from(0)));
    assert_eq!(answer["solve_seconds"], 0.25);
    let energy: f64 = solutions.iter().map(|solution| solution.energy.elastic + solution.energy.load).sum();
    assert!((answer["energy"].as_f64().unwrap() - energy).abs() < 1e-15);
    for (name, solution) in named(&model, &solutions) {
        let rod = &answer["rods"][name];
        let elements = solution.strain.len();
        for (key, length) in [("s", 1), ("position", 1), ("orientation", 1), ("strain", 0), ("stress", 0)] {
            assert_eq!(rod[key].as_array().unwrap().len(), elements + length, "{key}");
        }
        assert_same(&rod["position"][elements], &solution.poses[elements].position.to_array());
        assert_same(&rod["stress"][3], &solution.stress[3].to_array());
        assert_eq!(rod["reactions"].as_array().unwrap().len(), 1);
        assert_same(&rod["reactions"][0]["force"], &solution.start_reaction().force.to_array());
    }
}

#[test]
fn a_failed_solve_says_why_and_how_far_it_got() {
    let text = bundled_scene("suture").unwrap().text.replace("[0.17, 0.03, 0.06]", "[0.5, 0.0, 0.0]");
    let model = Scene::parse(&text, "suture.toml", None).unwrap().model;
    let failure =
        solve(&model.rods[0].problem, &model.settings, None, &mut Workspace::default()).unwrap_err();
    let report = &failure.nearest.report;
    let answer = write::failure_json(&model, "thread", &failure, report, &[], None);
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(answer["status"], "failed");
    assert_eq!(answer["rod"], "thread");
    assert!(answer["reason"].as_str().unwrap().starts_with("out of reach"));
    assert_eq!(answer["residual_history"].as_array().unwrap().len(), report.residual_history.len());
    assert_eq!(answer["rods"].as_object().unwrap().len(), 0);
}

#[test]
fn a_failed_solve_keeps_the_rods_that_were_solved() {
    let (model, solutions) = solved();
    let solved = named(&model, &solutions);
    let (failed, before) = (solved[1], &solved[..1]);
    let answer = write::failure_json(&model, failed.0, &"it broke", &failed.1.report, before, None);
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!((&answer["status"], &answer["rod"]), (&"failed".into(), &failed.0.into()));
    let whole: Value = serde_json::from_str(&write::json(&model, &solved, None)).unwrap();
    let rods = answer["rods"].as_object().unwrap();
    assert_eq!(rods.len(), 1);
    assert_eq!(rods[before[0].0], whole["rods"][before[0].0]);
}

#[test]
fn csv_has_a_row_a_node_that_reads_back_to_the_last_bit() {
    let (model, solutions) = solved();
    let text = write::csv(&model, &named(&model, &solutions));
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<HashMap<String, String>> = table.deserialize().map(Result::unwrap).collect();
    assert_eq!(header[..5], ["rod", "s", "x", "y", "z"]);
    assert_eq!(rows.len(), 21 + 11);
    let at = |row: usize, column: &str| rows[row][column].parse::<f64>().unwrap();
    assert_eq!(rows[0]["rod"], "round, stepped");
    assert_eq!(at(20, "z").to_bits(), solutions[0].poses[20].position.z.to_bits());
    assert_eq!(at(21 + 4, "m2").to_bits(), solutions[1].stress[4].angular.y.to_bits());
    assert_eq!(rows[20]["kappa1"], "");
}

#[test]
fn vtp_has_arrays_of_the_size_that_it_says() {
    let (model, solutions) = solved();
    let text = write::vtp(&model, &named(&model, &solutions));
    let mut reader = Reader::from_str(&text);
    let (mut arrays, mut name, mut components) = (HashMap::new(), String::new(), 0);
    loop {
        match reader.read_event().unwrap() {
            Event::Start(tag) => {
                let attribute = |key: &str| {
                    let found = tag.try_get_attribute(key).unwrap();
                    found.map(|found| found.unescape_value().unwrap().into_owned())
                };
                if tag.name().as_ref() == b"Piece" {
                    assert_eq!(attribute("NumberOfPoints").unwrap(), "32");
                    assert_eq!(attribute("NumberOfLines").unwrap(), "30");
                }
                if tag.name().as_ref() == b"DataArray" {
                    name = attribute("Name").unwrap();
                    components = attribute("NumberOfComponents").unwrap().parse().unwrap();
                }
            }
            Event::Text(text) if !name.is_empty() => {
                let text = text.decode().unwrap();
                let values: Vec<f64> = text.split_whitespace().map(|x| x.parse().unwrap()).collect();
                if !values.is_empty() {
                    assert_eq!(values.len() % components, 0_usize, "{name}");
                    arrays.insert(name.clone(), values);
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(arrays["position"].len(), 3 * 32);
    assert_eq!(arrays["connectivity"].len(), 2 * 30);
    assert_eq!(arrays["connectivity"][2 * 20], 21.0);
    assert_eq!(arrays["offsets"][29], 60.0);
    assert_eq!(arrays["d3"].len(), 3 * 32);
    assert_eq!(arrays["radius"].len(), 32);
    assert_eq!(arrays["rod"].iter().filter(|rod| **rod == 1.0).count(), 10);
    assert_eq!(arrays["force"][3 * 20 + 2], solutions[1].stress[0].linear.z);
}

#[test]
fn glb_has_a_closed_surface_of_the_rods_volume() {
    let (model, solutions) = solved();
    let bytes = write::glb(&model, &named(&model, &solutions));
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[..4], b"glTF");
    assert_eq!((word(4), word(8)), (2, bytes.len()));
    let json_length = word(12);
    assert_eq!(&bytes[16..20], b"JSON");
    let document: Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
    let binary_at = 20 + json_length;
    assert_eq!(&bytes[binary_at + 4..binary_at + 8], b"BIN\0");
    let binary = &bytes[binary_at + 8..];
    assert_eq!(word(binary_at), binary.len());

    let view = |accessor: &Value| {
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        &binary[start..start + view["byteLength"].as_u64().unwrap() as usize]
    };
    let accessor = |index: &Value| &document["accessors"][index.as_u64().unwrap() as usize];
    let vectors = |index: &Value| -> Vec<[f64; 3]> {
        let float = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().unwrap()));
        let vectors: Vec<[f64; 3]> = view(accessor(index))
            .chunks_exact(12)
            .map(|v| [float(&v[..4]), float(&v[4..8]), float(&v[8..])])
            .collect();
        assert_eq!(vectors.len() as u64, accessor(index)["count"].as_u64().unwrap());
        vectors
    };
    assert_eq!(document["meshes"].as_array().unwrap().len(), 2);
    let volumes =
        [0.25 * (std::f64::consts::PI * 1e-6 + 3e-6), 0.4 * std::f64::consts::PI * 4e-6 * 2.0_f64.sqrt()];
    for (mesh, expected) in document["meshes"].as_array().unwrap().iter().zip(volumes) {
        let primitive = &mesh["primitives"][0];
        let positions = vectors(&primitive["attributes"]["POSITION"]);
        let normals = vectors(&primitive["attributes"]["NORMAL"]);
        let colours = vectors(&primitive["attributes"]["COLOR_0"]);
        assert_eq!((positions.len(), normals.len()), (colours.len(), colours.len()));
        let corners: Vec<usize> = view(accessor(&primitive["indices"]))
            .chunks_exact(4)
            .map(|i| u32::from_le_bytes(i.try_into().unwrap()) as usize)
            .collect();
        let mut volume = 0.0;
        for triangle in corners.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| positions[triangle[i]]);
            let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let cross = |p: [f64; 3], q: [f64; 3]| {
                [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
            };
            let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
            let face = cross(minus(b, a), minus(c, a));
            assert!(dot(face, normals[triangle[0]]) > 0.0, "a face looks inwards");
            volume += dot(a, cross(b, c)) / 6.0;
        }
        assert!((volume / expected - 1.0).abs() < 0.02, "{volume} {expected}");
    }
}

#[test]
fn svg_is_well_formed_and_names_every_rod() {
    let (model, solutions) = solved();
    let text = write::svg(&model, &named(&model, &solutions));
    let mut reader = Reader::from_str(&text);
    let mut paths = 0;
    loop {
        match reader.read_event().unwrap() {
            Event::Empty(tag) if tag.name().as_ref() == b"path" => paths += 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(paths, 2 + 1);
    assert!(text.contains("two &lt;rods&gt; &amp; more") && text.contains(">round, stepped<"));
    assert!(!text.contains("NaN") && !text.contains("inf"));
}
