//! Surfaces of triangles from files: STL, OBJ, glTF.

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use std::io::Cursor;
use std::path::Path;

/// Corners, and the numbers of those of each triangle.
pub(super) type Triangles = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// Reads the corners and triangles of a mesh that lies beside the scene, in the file's own unit.
pub(super) fn read(
    document: &Document,
    folder: Option<&Path>,
    path: &KeyPath,
    name: &str,
) -> Result<Triangles, SceneError> {
    let Some(folder) = folder else {
        let error =
            document.error(path, format!("cannot read {name}: this scene has no folder to find it in"));
        return Err(error.mend("give the mesh in the scene itself, as `corners` and `triangles`"));
    };
    let file = folder.join(name);
    let bytes = std::fs::read(&file).map_err(|error| {
        let error = document.error(path, format!("cannot read {}: {error}", file.display()));
        error.mend("the path is relative to the folder of the scene")
    })?;
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let triangles = match ending.as_deref() {
        Some("stl") => stl(&bytes),
        Some("obj") => obj(&bytes),
        Some("gltf" | "glb") => gltf(&bytes),
        _ => {
            let error = document.error(path, format!("{} is no mesh", file.display()));
            return Err(error.mend("meshes are files that end in `.stl`, `.obj`, `.gltf` or `.glb`"));
        }
    };
    triangles.map_err(|what| {
        let error = document.error(path, format!("{}: {what}", file.display()));
        error.mend("the file has to be a surface of triangles; export it again")
    })
}

fn stl(bytes: &[u8]) -> Result<Triangles, String> {
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let corners = mesh.vertices.iter().map(|corner| [0, 1, 2].map(|k| f64::from(corner[k]))).collect();
    Ok((corners, mesh.faces.iter().map(|face| face.vertices).collect()))
}

fn obj(bytes: &[u8]) -> Result<Triangles, String> {
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    // Materials say nothing of the surface.
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials)
        .map_err(|error| error.to_string())?;
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for tobj::Model { mesh, .. } in &models {
        let first = corners.len();
        corners.extend(mesh.positions.chunks_exact(3).map(|at| [at[0], at[1], at[2]].map(f64::from)));
        let corner = |at: u32| first + at as usize;
        triangles.extend(mesh.indices.chunks_exact(3).map(|of| [of[0], of[1], of[2]].map(corner)));
    }
    Ok((corners, triangles))
}

/// Of all nodes of the scene, each put where it is; buffers have to be in the file.
fn gltf(bytes: &[u8]) -> Result<Triangles, String> {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes).map_err(|error| error.to_string())?;
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    let mut waiting: Vec<(gltf::Node, [[f64; 4]; 4])> = Vec::new();
    let scenes = document.default_scene().into_iter().chain(document.scenes()).take(1);
    waiting.extend(scenes.flat_map(|scene| scene.nodes().map(|node| (node, UNMOVED)).collect::<Vec<_>>()));
    while let Some((node, moved)) = waiting.pop() {
        let moved = after(&moved, &node.transform().matrix().map(|column| column.map(f64::from)));
        waiting.extend(node.children().map(|child| (child, moved)));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            if primitive.mode() != gltf::mesh::Mode::Triangles {
                return Err(format!("it has {:?}, which are no triangles", primitive.mode()));
            }
            let reader = primitive.reader(|buffer| match buffer.source() {
                gltf::buffer::Source::Bin => blob.as_deref(),
                gltf::buffer::Source::Uri(_) => None,
            });
            let places = reader.read_positions().ok_or("its buffer is in another file: save it as `.glb`")?;
            let first = corners.len();
            corners.extend(places.map(|at| put(&moved, at.map(f64::from))));
            let corner = |at: u32| first + at as usize;
            let numbers: Vec<usize> = match reader.read_indices() {
                Some(indices) => indices.into_u32().map(corner).collect(),
                None => (first..corners.len()).collect(),
            };
            triangles.extend(numbers.chunks_exact(3).map(|of| [of[0], of[1], of[2]]));
        }
    }
    Ok((corners, triangles))
}

const UNMOVED: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The product of two matrices by columns.
fn after(a: &[[f64; 4]; 4], b: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    b.map(|column| core::array::from_fn(|row| (0..4).map(|k| a[k][row] * column[k]).sum()))
}

fn put(moved: &[[f64; 4]; 4], at: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|row| (0..3).map(|k| moved[k][row] * at[k]).sum::<f64>() + moved[3][row])
}
