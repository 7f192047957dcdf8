//! The rest shape of a rod, and its length.

use super::{Context, table};
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{RestFile, RodFile};
use strands::math::{Pose, Vec3};
use strands::rod::{RestCurve, RestShape, RodError};

/// How far a given length may be from that of the rest shape's points, as a part of it.
const LENGTH_SLACK: f64 = 1e-3;

/// The unloaded rod: its shape, its length, and where it lies if its shape says so.
pub(super) struct Unloaded {
    pub shape: RestShape,
    pub length: f64,
    pub start: Option<Pose>,
}

/// What a rest shape is given by.
pub(super) enum Written {
    Points(Vec<Vec3>),
    Samples(Vec<(f64, Vec3)>),
}

/// The unloaded rod as its file describes it.
///
/// `initial` is how long the points are that motion starts from, if it starts from points, m.
pub(super) fn unloaded(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    initial: Option<f64>,
) -> Result<Unloaded, SceneError> {
    let document = context.document;
    let length = rod.length.map(|length| document.positive(&path.key("length"), length)).transpose()?;
    let written_length = length;
    let length = length.or(initial);
    let rest = path.key("rest");
    let with_length = |shape: RestShape| match length {
        Some(length) => Ok(Unloaded { shape, length, start: None }),
        None => Err(document.missing(&path.key("length"))),
    };
    let Some(written) = &rod.rest else { return with_length(RestShape::default()) };
    only_one(context, &rest, written)?;
    if let Some(curvature) = written.curvature {
        return with_length(RestShape::Constant(curvature.into()));
    }
    if let Some(helix) = &written.helix {
        let place = rest.key("helix");
        document.not_negative(&place.key("radius"), helix.radius)?;
        let shape = RestShape::helix(helix.radius, helix.pitch).map_err(|error| {
            document
                .error(&place.key("pitch"), error.to_string())
                .mend("give radius and pitch in metres, as { radius = 6e-3, pitch = 6e-3 }")
        })?;
        return with_length(shape);
    }
    let (place, written) = if let Some(samples) = &written.samples {
        let samples = samples.iter().map(|sample| (sample.s, sample.curvature.into())).collect();
        (rest.key("samples"), Written::Samples(samples))
    } else if let Some(points) = &written.points {
        (rest.key("points"), Written::Points(points.iter().map(|point| Vec3::from(*point)).collect()))
    } else {
        let file = written.csv.as_deref().unwrap_or_default();
        (rest.key("csv"), table::read(document, context.folder, &rest.key("csv"), file)?)
    };
    match written {
        Written::Points(points) => along_points(context, path, &place, &points, written_length),
        Written::Samples(samples) => {
            let unloaded = with_length(RestShape::default())?;
            let shape = sampled(context, &place, samples, unloaded.length)?;
            Ok(Unloaded { shape, ..unloaded })
        }
    }
}

/// Checks that the shape is given in one way.
fn only_one(context: &Context, rest: &KeyPath, written: &RestFile) -> Result<(), SceneError> {
    let given = [
        ("curvature", written.curvature.is_some()),
        ("samples", written.samples.is_some()),
        ("helix", written.helix.is_some()),
        ("points", written.points.is_some()),
        ("csv", written.csv.is_some()),
    ];
    let mut given = given.iter().filter(|(_, given)| *given).map(|(key, _)| key);
    match (given.next(), given.next()) {
        (Some(_), None) => Ok(()),
        (Some(first), Some(second)) => {
            let error =
                context.document.error(&rest.key(second), format!("both `{first}` and `{second}` are given"));
            Err(error.mend("a rest shape is given in one way: keep one of them"))
        }
        (None, _) => {
            let error = context.document.error(rest, "the rest shape is empty");
            Err(error.mend(
                "give `curvature`, `samples`, `helix`, `points` or `csv`; a straight rod needs no `rest`",
            ))
        }
    }
}

fn along_points(
    context: &Context,
    path: &KeyPath,
    place: &KeyPath,
    points: &[Vec3],
    length: Option<f64>,
) -> Result<Unloaded, SceneError> {
    let curve = curve(context, place, points)?;
    if let Some(length) = length {
        as_long(context, &path.key("length"), length, "rest", curve.length)?;
    }
    Ok(Unloaded { shape: curve.shape, length: curve.length, start: Some(curve.start) })
}

/// The line through points.
pub(super) fn curve(context: &Context, place: &KeyPath, points: &[Vec3]) -> Result<RestCurve, SceneError> {
    RestShape::polyline(points).map_err(|error| {
        let place = match &error {
            RodError::PointsCoincide { index } | RodError::FoldsBack { index } | RodError::NotFinite { index, .. } => place.index(*index),
            _ => place.clone(),
        };
        let error = context.document.error(&place, error.to_string());
        error.mend("give points in metres, each ahead of the one before, as [[0, 0, 0], [0, 0, 0.1], [0, 0.05, 0.2]]")
    })
}

/// Checks that the rod is as long as the points of a shape of it.
pub(super) fn as_long(
    context: &Context,
    place: &KeyPath,
    length: f64,
    shape: &str,
    points: f64,
) -> Result<(), SceneError> {
    if (length - points).abs() <= LENGTH_SLACK * points {
        return Ok(());
    }
    let message = format!("the length is {length}, but the {shape} shape's points are {points} m long");
    let error = context.document.error(place, message);
    Err(error.mend(
        "leave `length` out: it follows from the points, which are as long in each shape that has them",
    ))
}

fn sampled(
    context: &Context,
    place: &KeyPath,
    samples: Vec<(f64, Vec3)>,
    length: f64,
) -> Result<RestShape, SceneError> {
    let document = context.document;
    for (i, (s, _)) in samples.iter().enumerate() {
        let sample = place.index(i).key("s");
        document.not_negative(&sample, *s)?;
        if *s > length * (1.0 + 1e-9) {
            let error = document.error(
                &sample,
                format!("the sample at s = {s} lies beyond the rod, which is {length} m long"),
            );
            return Err(error.mend(format!("use an s from 0 to {length}")));
        }
        if i > 0 && *s < samples[i - 1].0 {
            let error = document.error(&sample, format!("s falls from {} to {s}", samples[i - 1].0));
            return Err(error.mend("order the samples by growing s"));
        }
    }
    RestShape::samples(samples).map_err(|error| {
        document
            .error(place, error.to_string())
            .mend("give at least one, as [{ s = 0.0, curvature = [0.0, 8.0, 0.0] }]")
    })
}
