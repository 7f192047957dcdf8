//! What touches.

use super::Context;
use super::sizes::Sizes;
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{ObstacleFile, ObstacleName};
use strands::contact::{Obstacle, Shape, Surfaces};
use strands::math::{Mat3, Vec3};

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
    written.map(|(i, written)| obstacle(context.document, &path.index(i), written)).collect()
}

fn obstacle(document: &Document, path: &KeyPath, written: &ObstacleFile) -> Result<Obstacle, SceneError> {
    let given = [
        ("normal", written.normal.is_some()),
        ("orientation", written.orientation.is_some()),
        ("radius", written.radius.is_some()),
        ("length", written.length.is_some()),
    ];
    let of: (_, &[&str]) = match written.shape {
        ObstacleName::Plane => ("a plane", &["position", "normal"]),
        ObstacleName::Sphere => ("a sphere", &["position", "radius"]),
        ObstacleName::Capsule => ("a capsule", &["position", "orientation", "radius", "length"]),
    };
    let sizes = Sizes::new(document, path, of, &given)?;
    let position = written.position.map_or(Vec3::ZERO, Vec3::from);
    let shape = match written.shape {
        ObstacleName::Plane => {
            let normal = written.normal.map_or(Vec3::Z, Vec3::from).normalized().ok_or_else(|| {
                let error = document.error(&path.key("normal"), "the normal points nowhere");
                error.mend("give it a direction, as `normal = [0.0, 0.0, 1.0]`")
            })?;
            Shape::Plane { point: position, normal }
        }
        ObstacleName::Sphere => {
            Shape::Capsule { ends: [position; 2], radius: sizes.positive("radius", written.radius)? }
        }
        ObstacleName::Capsule => {
            let axes = match written.orientation {
                Some(orientation) => document.quaternion(&path.key("orientation"), orientation)?.to_matrix(),
                None => Mat3::IDENTITY,
            };
            let half = axes.cols[2] * (0.5 * sizes.positive("length", written.length)?);
            Shape::Capsule {
                ends: [position - half, position + half],
                radius: sizes.positive("radius", written.radius)?,
            }
        }
    };
    let friction = written
        .friction
        .map(|friction| document.not_negative(&path.key("friction"), friction))
        .transpose()?;
    Ok(Obstacle { shape, friction })
}
