//! Rigid bodies.

use super::sizes::Sizes;
use super::{Context, hold, passage};
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{BodyFile, BodyShapeFile, BodyShapeName};
use crate::model::{BodyShape, ModelBody};
use strands::assembly::Body;
use strands::math::{Mat3, Pose, Vec3};
use strands::rod::NodeInertia;

/// How much more than the sum of the other two a moment of inertia may be: what written digits leave.
const INERTIA_SLACK: f64 = 1e-3;

/// The bodies of a scene.
pub(super) fn bodies(context: &Context) -> Result<Vec<ModelBody>, SceneError> {
    let mut all: Vec<ModelBody> = Vec::with_capacity(context.file.bodies.len());
    for (i, written) in context.file.bodies.iter().enumerate() {
        let path = KeyPath::of("bodies").index(i);
        if all.iter().any(|body| body.name == written.name) {
            let message = format!("there is a body `{}` already", written.name);
            let error = context.document.error(&path.key("name"), message);
            return Err(error.mend("joints know bodies by their names: give it another one"));
        }
        all.push(body(context, &path, written)?);
    }
    Ok(all)
}

fn body(context: &Context, path: &KeyPath, written: &BodyFile) -> Result<ModelBody, SceneError> {
    let document = context.document;
    let (shape, inertia) = inertia(document, path, written)?;
    let rotation = match written.orientation {
        Some(orientation) => document.quaternion(&path.key("orientation"), orientation)?.to_matrix(),
        None => Mat3::IDENTITY,
    };
    let pose = Pose { rotation, position: written.position.unwrap_or_default().into() };
    let mut body = Body::new(inertia, pose).with_gravity(context.gravity);
    let support = written.support.as_ref();
    let held = support.map(|support| hold::body(document, &path.key("support"), support)).transpose()?;
    let tissue = match &written.tissue {
        Some(_) if shape.is_none() => {
            let error =
                document.error(&path.key("tissue"), "a body without a shape has no surface to pierce");
            return Err(error.mend("give it a `shape` with a `density`, or remove `tissue`"));
        }
        Some(_) if context.file.contact.is_none() => {
            let error = document.error(&path.key("tissue"), "there is tissue, and nothing touches");
            return Err(error.mend("add `[contact]`, with `friction = 0.3` or whatever it is"));
        }
        written => written.as_ref().map(|written| passage::tissue(context, path, written)).transpose()?,
    };
    body.support = held.as_ref().map(|held| held.support(pose));
    Ok(ModelBody {
        name: written.name.clone(),
        body,
        shape,
        tissue,
        velocity: written.velocity.unwrap_or_default().into(),
        angular_velocity: written.angular_velocity.unwrap_or_default().into(),
        held,
    })
}

/// The shape of a body, if it has one, and its inertia.
fn inertia(
    document: &Document,
    path: &KeyPath,
    written: &BodyFile,
) -> Result<(Option<BodyShape>, NodeInertia), SceneError> {
    let given = [
        ("density", written.density.is_some(), true),
        ("mass", written.mass.is_some(), false),
        ("inertia", written.inertia.is_some(), false),
    ];
    let has_shape = written.shape.is_some();
    let stray = given.into_iter().find(|(_, given, of_shape)| *given && *of_shape != has_shape);
    match (&written.shape, stray) {
        (Some(_), Some((key, ..))) => {
            let error = document.error(&path.key(key), format!("both `shape` and `{key}` are given"));
            Err(error.mend("keep `shape` with `density`, or `mass` with `inertia`"))
        }
        (None, Some((key, ..))) if written.mass.is_some() || written.inertia.is_some() => {
            let error = document.error(&path.key(key), format!("`{key}` goes with `shape` only"));
            Err(error.mend("remove it: `mass` and `inertia` say it all"))
        }
        (Some(shape), None) => {
            let density = written.density.ok_or_else(|| {
                let error = document.error(&path.key("density"), "the body has a shape, but no `density`");
                error.mend("give it in kg/m³, as `density = 7850.0`")
            })?;
            solid(document, path, shape, density).map(|(shape, inertia)| (Some(shape), inertia))
        }
        (None, None) if written.mass.is_some() || written.inertia.is_some() => {
            Ok((None, given_inertia(document, path, written)?))
        }
        (None, _) => {
            let error = document.error(path, "the body has neither `shape` nor `mass`");
            Err(error.mend(
                "give `shape = { shape = \"ball\", radius = 5e-3 }` with a `density`, or `mass` and `inertia`",
            ))
        }
    }
}

fn given_inertia(document: &Document, path: &KeyPath, written: &BodyFile) -> Result<NodeInertia, SceneError> {
    let missing = |key: &str| document.missing(&path.key(key));
    let mass = document.positive(&path.key("mass"), written.mass.ok_or_else(|| missing("mass"))?)?;
    let rotational = written.inertia.ok_or_else(|| missing("inertia"))?;
    let place = path.key("inertia");
    for (i, moment) in rotational.into_iter().enumerate() {
        document.positive(&place.index(i), moment)?;
        let others = rotational[(i + 1) % 3] + rotational[(i + 2) % 3];
        if moment > others * (1.0 + INERTIA_SLACK) {
            let message = format!(
                "no body has these moments of inertia: {moment:e} is more than the other two together"
            );
            let error = document.error(&place.index(i), message);
            return Err(error.mend("give them in kg·m² about its three principal axes"));
        }
    }
    Ok(NodeInertia { mass, rotational: Vec3::from(rotational) })
}

fn solid(
    document: &Document,
    path: &KeyPath,
    written: &BodyShapeFile,
    density: f64,
) -> Result<(BodyShape, NodeInertia), SceneError> {
    let density = document.positive(&path.key("density"), density)?;
    let place = path.key("shape");
    let shape = shape(document, &place, written)?;
    let inertia = shape.inertia(density);
    let fits = |x: f64| x > 0.0 && x.is_finite();
    if !fits(inertia.mass) || !inertia.rotational.to_array().into_iter().all(fits) {
        let message = format!("with these sizes and this density the mass is {:e} kg", inertia.mass);
        return Err(document.error(&place, message).mend("check the units: lengths in m, density in kg/m³"));
    }
    Ok((shape, inertia))
}

fn shape(document: &Document, path: &KeyPath, written: &BodyShapeFile) -> Result<BodyShape, SceneError> {
    let sizes = [
        ("radius", written.radius.is_some()),
        ("wire_radius", written.wire_radius.is_some()),
        ("length", written.length.is_some()),
        ("size", written.size.is_some()),
    ];
    let of: (_, &[&str]) = match written.shape {
        BodyShapeName::Ball => ("a ball", &["radius"]),
        BodyShapeName::Capsule => ("a capsule", &["radius", "length"]),
        BodyShapeName::Cylinder => ("a cylinder", &["radius", "length"]),
        BodyShapeName::Block => ("a block", &["size"]),
        BodyShapeName::Ring => ("a ring", &["radius", "wire_radius"]),
    };
    let given = Sizes::new(document, path, of, &sizes)?;
    let (radius, length) =
        (|| given.positive("radius", written.radius), || given.positive("length", written.length));
    Ok(match written.shape {
        BodyShapeName::Ball => BodyShape::Ball { radius: radius()? },
        BodyShapeName::Capsule => BodyShape::Capsule { radius: radius()?, length: length()? },
        BodyShapeName::Cylinder => BodyShape::Cylinder { radius: radius()?, length: length()? },
        BodyShapeName::Ring => {
            let [radius, wire_radius] = given.ring(written.radius, written.wire_radius)?;
            BodyShape::Ring { radius, wire_radius }
        }
        BodyShapeName::Block => {
            let size = written.size.ok_or_else(|| given.missing("size"))?;
            for (i, edge) in size.into_iter().enumerate() {
                document.positive(&path.key("size").index(i), edge)?;
            }
            BodyShape::Block { size }
        }
    })
}
