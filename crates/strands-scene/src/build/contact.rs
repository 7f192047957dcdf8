//! What touches.

use super::sizes::Sizes;
use super::{Context, mesh, passage};
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{ObstacleFile, ObstacleName, SceneFile};
use crate::model::Model;
use std::path::Path;
use std::sync::Arc;
use strands::contact::{Mesh, Obstacle, Shape, Surfaces};
use strands::math::{Mat3, Pose, Vec3};

/// How surfaces touch, where the scene has contact.
pub(super) fn surfaces(context: &Context) -> Result<Option<Surfaces>, SceneError> {
    let Context { document, file, .. } = *context;
    if file.contact.is_none() && !file.obstacles.is_empty() {
        let error = document.error(&KeyPath::of("obstacles"), "there are obstacles, and nothing touches");
        return Err(error.mend("add `[contact]`, with `friction = 0.3` or whatever it is"));
    }
    let Some(contact) = &file.contact else { return Ok(None) };
    let path = KeyPath::of("contact").key("friction");
    let friction = document.not_negative(&path, contact.friction.unwrap_or(0.0))?;
    Ok(Some(Surfaces { friction }))
}

/// The obstacles of a scene.
pub(super) fn obstacles(context: &Context) -> Result<Vec<Obstacle>, SceneError> {
    let path = KeyPath::of("obstacles");
    let written = context.file.obstacles.iter().enumerate();
    written.map(|(i, written)| obstacle(context, &path.index(i), written)).collect()
}

fn obstacle(context: &Context, path: &KeyPath, written: &ObstacleFile) -> Result<Obstacle, SceneError> {
    let document = context.document;
    let given = [
        ("normal", written.normal.is_some()),
        ("orientation", written.orientation.is_some()),
        ("radius", written.radius.is_some()),
        ("wire_radius", written.wire_radius.is_some()),
        ("length", written.length.is_some()),
        ("size", written.size.is_some()),
        ("file", written.file.is_some()),
        ("scale", written.scale.is_some()),
        ("corners", written.corners.is_some()),
        ("triangles", written.triangles.is_some()),
    ];
    let of: (_, &[&str]) = match written.shape {
        ObstacleName::Plane => ("a plane", &["position", "normal"]),
        ObstacleName::Sphere => ("a sphere", &["position", "radius"]),
        ObstacleName::Capsule => ("a capsule", &["position", "orientation", "radius", "length"]),
        ObstacleName::Cylinder => ("a cylinder", &["position", "orientation", "radius", "length"]),
        ObstacleName::Box => ("a box", &["position", "orientation", "size"]),
        ObstacleName::Ring => ("a ring", &["position", "orientation", "radius", "wire_radius"]),
        ObstacleName::Tube => ("a tube", &["position", "orientation", "radius"]),
        ObstacleName::Mesh => {
            ("a mesh", &["position", "orientation", "file", "scale", "corners", "triangles"])
        }
    };
    let sizes = Sizes::new(document, path, of, &given)?;
    let position = written.position.map_or(Vec3::ZERO, Vec3::from);
    let rotation = match written.orientation {
        Some(orientation) => document.quaternion(&path.key("orientation"), orientation)?.to_matrix(),
        None => Mat3::IDENTITY,
    };
    let radius = || sizes.positive("radius", written.radius);
    let ends = || {
        let half = rotation.cols[2] * (0.5 * sizes.positive("length", written.length)?);
        Ok([position - half, position + half])
    };
    let shape = match written.shape {
        ObstacleName::Plane => {
            let normal = written.normal.map_or(Vec3::Z, Vec3::from).normalized().ok_or_else(|| {
                let error = document.error(&path.key("normal"), "the normal points nowhere");
                error.mend("give it a direction, as `normal = [0.0, 0.0, 1.0]`")
            })?;
            Shape::Plane { point: position, normal }
        }
        ObstacleName::Sphere => Shape::Capsule { ends: [position; 2], radius: radius()? },
        ObstacleName::Capsule => Shape::Capsule { ends: ends()?, radius: radius()? },
        ObstacleName::Cylinder => Shape::Cylinder { ends: ends()?, radius: radius()? },
        ObstacleName::Ring => {
            let [radius, wire_radius] = sizes.ring(written.radius, written.wire_radius)?;
            Shape::Ring { middle: position, axis: rotation.cols[2], radius, wire_radius }
        }
        ObstacleName::Tube => Shape::Bore { point: position, axis: rotation.cols[2], radius: radius()? },
        ObstacleName::Box => {
            let size = written.size.ok_or_else(|| sizes.missing("size"))?;
            for (i, edge) in size.into_iter().enumerate() {
                document.positive(&path.key("size").index(i), edge)?;
            }
            Shape::block(position, size.map(|edge| 0.5 * edge), rotation.cols)
        }
        ObstacleName::Mesh => {
            Shape::Mesh(Arc::new(placed(context, path, written, &Pose { rotation, position })?))
        }
    };
    let friction = written
        .friction
        .map(|friction| document.not_negative(&path.key("friction"), friction))
        .transpose()?;
    let tissue = match &written.tissue {
        Some(_) if written.shape == ObstacleName::Tube => {
            let error =
                document.error(&path.key("tissue"), "rods are inside of a tube, and cannot pierce it");
            return Err(error.mend("remove it, or take a shape that rods are outside of"));
        }
        Some(_) if matches!(&shape, Shape::Mesh(mesh) if !mesh.is_closed()) => {
            let error = document.error(&path.key("tissue"), "the mesh is not closed, and has no inside");
            return Err(error.mend("close it, or give the sheet a thickness"));
        }
        written => written.as_ref().map(|written| passage::tissue(context, path, written)).transpose()?,
    };
    Ok(Obstacle { shape, friction, body: None, tissue })
}

/// Checks that rods that begin within a ring fit through it.
pub(super) fn check_rings(document: &Document, model: &Model) -> Result<(), SceneError> {
    for (i, obstacle) in model.obstacles.iter().enumerate() {
        let Shape::Ring { middle, axis, radius, wire_radius } = &obstacle.shape else { continue };
        let hole = radius - wire_radius;
        let is_through = |pair: &[Pose]| {
            let [from, to] = [pair[0].position - *middle, pair[1].position - *middle];
            let [before, after] = [from.dot(*axis), to.dot(*axis)];
            let crossing = from + (to - from) * (before / (before - after));
            (before < 0.0) != (after < 0.0) && crossing.norm() < *radius
        };
        for rod in &model.rods {
            let thickest = rod.problem.rod.half_extent().iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
            if thickest < hole || !rod.starts().windows(2).any(is_through) {
                continue;
            }
            let message = format!(
                "rod `{}`, which has a radius of {thickest} m, goes through a hole of {hole:.3e} m",
                rod.name
            );
            let error = document.error(&KeyPath::of("obstacles").index(i).key("radius"), message);
            let least = thickest + wire_radius;
            return Err(error.mend(format!("the radius of the hole is `radius` less `wire_radius`: give a `radius` of more than {least:.3e}")));
        }
    }
    Ok(())
}

/// A mesh from its file or as it is written, put where it is.
fn placed(
    context: &Context,
    path: &KeyPath,
    written: &ObstacleFile,
    pose: &Pose,
) -> Result<Mesh, SceneError> {
    let ((corners, triangles), of) = triangles(context.document, context.folder, path, written)?;
    let corners = corners.into_iter().map(|corner| pose.position + pose.rotation * Vec3::from(corner));
    Mesh::new(corners.collect(), triangles).map_err(|error| {
        let error = context.document.error(&path.key(of), error.to_string());
        error.mend("give triangles by their corners, counted from 0")
    })
}

/// The corners, m, and the triangles of a mesh, and the key that they are from.
fn triangles(
    document: &Document,
    folder: Option<&Path>,
    path: &KeyPath,
    written: &ObstacleFile,
) -> Result<(mesh::Triangles, &'static str), SceneError> {
    let stray = |key: &str, beside: &str| {
        let error = document.error(&path.key(key), format!("both `{beside}` and `{key}` are given"));
        Err(error.mend("keep `file`, or `corners` with `triangles`"))
    };
    match (&written.file, &written.corners, &written.triangles) {
        (Some(_), Some(_), _) => stray("corners", "file"),
        (Some(_), None, Some(_)) => stray("triangles", "file"),
        (None, Some(_), _) if written.scale.is_some() => {
            let error = document.error(&path.key("scale"), "`scale` goes with `file` only");
            Err(error.mend("remove it: corners are in metres"))
        }
        (Some(file), None, None) => {
            let scale = document.positive(&path.key("scale"), written.scale.unwrap_or(1.0))?;
            let (corners, triangles) = mesh::read(document, folder, &path.key("file"), file)?;
            let corners = corners.into_iter().map(|corner| corner.map(|x| x * scale)).collect();
            Ok(((corners, triangles), "file"))
        }
        (None, Some(corners), Some(triangles)) => Ok(((corners.clone(), triangles.clone()), "triangles")),
        (None, corners, _) => {
            let missing = if corners.is_some() { "triangles" } else { "file" };
            let error = document.error(&path.key(missing), format!("`{missing}` is missing"));
            Err(error.mend("give the mesh by `file = \"vessel.stl\"`, or by `corners` and `triangles`"))
        }
    }
}

/// Puts the meshes that a scene names into it, in place of their names.
pub(super) fn write_in(
    document: &Document,
    file: &mut SceneFile,
    folder: Option<&Path>,
) -> Result<(), SceneError> {
    let path = KeyPath::of("obstacles");
    for (i, written) in file.obstacles.iter_mut().enumerate().filter(|(_, written)| written.file.is_some()) {
        let ((corners, triangles), _) = triangles(document, folder, &path.index(i), written)?;
        (written.file, written.scale) = (None, None);
        (written.corners, written.triangles) = (Some(corners), Some(triangles));
    }
    Ok(())
}
