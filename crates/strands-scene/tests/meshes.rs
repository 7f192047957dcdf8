//! Meshes that lie beside a scene.

use std::path::{Path, PathBuf};
use strands::contact::Shape;
use strands_scene::{Scene, SceneFile};

/// A floor of two triangles, 2 m wide, in centimetres.
const OBJ: &str = "v -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n";
const STL: &str = "solid floor
facet normal 0 0 1
outer loop
vertex -100 -100 0
vertex 100 -100 0
vertex 100 100 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -100 -100 0
vertex 100 100 0
vertex -100 100 0
endloop
endfacet
endsolid floor
";

/// The same in metres, in a node that is 2 m further up.
fn glb() -> Vec<u8> {
    let mut buffer = Vec::new();
    for corner in [[-1.0_f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]] {
        corner.iter().for_each(|x| buffer.extend(x.to_le_bytes()));
    }
    for at in [0_u16, 1, 2, 0, 2, 3] {
        buffer.extend(at.to_le_bytes());
    }
    let mut json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":60}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]}"#
        .to_owned()
        .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = Vec::new();
    file.extend(b"glTF");
    for part in [2, (12 + 8 + json.len() + 8 + buffer.len()) as u32, json.len() as u32] {
        file.extend(part.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(&json);
    file.extend((buffer.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(&buffer);
    file
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meshes");
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("floor.obj"), OBJ).expect("a mesh");
    std::fs::write(folder.join("floor.stl"), STL).expect("a mesh");
    std::fs::write(folder.join("floor.glb"), glb()).expect("a mesh");
    std::fs::write(folder.join("broken.obj"), "v 0 0\nf 1 2 9\n").expect("a mesh");
    std::fs::write(folder.join("floor.ply"), "ply").expect("a mesh");
    folder
}

fn scene(obstacle: &str) -> String {
    format!(
        r#"
format = 1
name = "meshes"
[rods.wire]
length = 0.2
stiffness = {{ bending = [1e-4, 1e-4], torsion = 1e-4, axial = 1e3, shear = [1e3, 1e3] }}
supports = [{{ at = "start", fix = ["position", "orientation"] }}]
[contact]
[[obstacles]]
shape = "mesh"
{obstacle}
"#
    )
}

fn corners(scene: &Scene) -> (Vec<[f64; 3]>, usize) {
    let Shape::Mesh(mesh) = &scene.model.obstacles[0].shape else { panic!("a mesh") };
    let mut corners: Vec<[f64; 3]> = mesh.triangles().flatten().map(|corner| corner.to_array()).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    corners.dedup();
    (corners, mesh.indices().len())
}

#[test]
fn a_mesh_is_read_from_any_kind_of_file_and_put_where_it_is() {
    let folder = folder();
    let square = |z: f64| vec![[-1.0, -1.0, z], [-1.0, 1.0, z], [1.0, -1.0, z], [1.0, 1.0, z]];
    for (obstacle, z) in [
        ("file = \"floor.obj\"\nscale = 1e-2", 0.0),
        ("file = \"floor.stl\"\nscale = 1e-2\nposition = [0.0, 0.0, -0.5]", -0.5),
        ("file = \"floor.glb\"", 2.0),
        (
            "corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\ntriangles = [[0, 1, 2], [0, 2, 3]]",
            0.0,
        ),
    ] {
        let text = scene(obstacle);
        let meant = Scene::parse(&text, "meshes.toml", Some(&folder)).expect("a scene");
        let (found, triangles) = corners(&meant);
        let near = found.iter().flatten().zip(square(z).iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near && found.len() == 4 && triangles == 2, "{obstacle}: {found:?}");
        // Written into the scene, it needs no folder.
        let whole = SceneFile::parse_with_tables(&text, "meshes.toml", Some(&folder)).expect("a scene");
        let opened =
            Scene::parse(&whole.to_toml(), "meshes.toml", None).expect("a scene that needs no folder");
        assert_eq!(corners(&opened).0.len(), 4, "{obstacle}");
    }
}

#[test]
fn what_is_no_mesh_is_said_to_be_none() {
    let folder = folder();
    for (obstacle, key) in [
        ("", "obstacles[0].file"),
        ("file = \"nowhere.stl\"", "obstacles[0].file"),
        ("file = \"broken.obj\"", "obstacles[0].file"),
        ("file = \"floor.ply\"", "obstacles[0].file"),
        ("file = \"floor.obj\"\nscale = 0.0", "obstacles[0].scale"),
        ("file = \"floor.obj\"\ncorners = [[0, 0, 0]]", "obstacles[0].corners"),
        ("corners = [[0, 0, 0]]", "obstacles[0].triangles"),
        ("corners = [[0, 0, 0], [1, 0, 0]]\ntriangles = [[0, 1, 2]]", "obstacles[0].triangles"),
        ("corners = [[0, 0, 0], [1, 0, 0]]\ntriangles = [[0, 1, 1]]", "obstacles[0].triangles"),
        ("file = \"floor.obj\"\nradius = 1.0", "obstacles[0].radius"),
    ] {
        let error = Scene::parse(&scene(obstacle), "meshes.toml", Some(&folder)).expect_err(obstacle);
        assert_eq!(error.key(), key, "{obstacle}: {error}");
    }
}
