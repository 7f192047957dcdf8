//! The shape that a rod's motion starts from.

use super::rest::{Written, as_long, curve};
use super::{Context, table};
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{InitialFile, RodFile, SceneFile};
use crate::model::Initial;
use strands::math::{Pose, Strain, Vec3};
use strands::rod::{RestShape, Rod};

/// So many points of a helix stand for a radian of it.
const A_RADIAN: f64 = 64.0;
/// So many pieces stand for what is between two points.
const FINE: usize = 16;
/// No element can begin bent by more, rad.
const SHARPEST: f64 = 1.0;

/// The points that a rod's motion starts from, the key that they are from and how long they are, m.
pub(super) struct Points {
    key: &'static str,
    all: Vec<Vec3>,
    pub length: f64,
}

/// The points that a rod's motion starts from, if it has such.
pub(super) fn points(context: &Context, path: &KeyPath, rod: &RodFile) -> Result<Option<Points>, SceneError> {
    let Some(written) = &rod.initial else { return Ok(None) };
    let (document, path) = (context.document, path.key("initial"));
    let (key, all) = match (&written.points, &written.csv, &written.helix) {
        (Some(points), None, None) => ("points", points.iter().map(|point| Vec3::from(*point)).collect()),
        (None, Some(file), None) => match table::read(document, context.folder, &path.key("csv"), file)? {
            Written::Points(points) => ("csv", points),
            Written::Samples(_) => {
                let error = document.error(&path.key("csv"), format!("{file} has no points"));
                return Err(error.mend("its first line is `x,y,z`, and every other line a point in metres"));
            }
        },
        (None, None, Some(_)) => return Ok(None),
        (None, None, None) => {
            let error = document.error(&path, "the initial shape is empty");
            return Err(error.mend(
                "give `points`, `csv` or `helix`; a rod that starts in its rest shape needs no `initial`",
            ));
        }
        (points, csv, _) => {
            let [first, second] = match (points, csv) {
                (Some(_), Some(_)) => ["points", "csv"],
                (Some(_), None) => ["points", "helix"],
                (None, _) => ["csv", "helix"],
            };
            let error = document.error(&path.key(second), format!("both `{first}` and `{second}` are given"));
            return Err(error.mend("an initial shape is given in one way: keep one of them"));
        }
    };
    curve(context, &path.key(key), &all)?;
    let all = smooth(&all);
    let length = all.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    Ok(Some(Points { key, all, length }))
}

/// More points, on cubics from each point to the next whose directions at the points are those of the parabola through it and its neighbours.
fn smooth(points: &[Vec3]) -> Vec<Vec3> {
    let last = points.len() - 1;
    let side = |i: usize| points[i + 1] - points[i];
    let slope = |i: usize| side(i) * (1.0 / side(i).norm());
    let at = |i: usize| {
        let [before, after] = [side(i - 1).norm(), side(i).norm()];
        (slope(i - 1) * after + slope(i) * before) * (1.0 / (before + after))
    };
    let direction = |i: usize| match i {
        _ if last == 1 => slope(0),
        0 => slope(0) * 2.0 - at(1),
        _ if i == last => slope(last - 1) * 2.0 - at(last - 1),
        _ => at(i),
    };
    let cubic = |i: usize, k: usize| {
        let (x, length) = (k as f64 / FINE as f64, side(i).norm());
        let [ahead, back] = [(3.0 - 2.0 * x) * x * x, x - 1.0];
        points[i]
            + side(i) * ahead
            + (direction(i) * (x * back * back) + direction(i + 1) * (x * x * back)) * length
    };
    let inner = (0..last).flat_map(|i| (0..FINE).map(move |k| (i, k))).map(|(i, k)| cubic(i, k));
    inner.chain([points[last]]).collect()
}

/// The shape that a rod's motion starts from, if it has one of its own.
pub(super) fn initial(
    context: &Context,
    path: &KeyPath,
    file: &RodFile,
    points: Option<Points>,
    rod: &Rod,
) -> Result<Option<Initial>, SceneError> {
    let Some(written) = &file.initial else { return Ok(None) };
    let (base, place) = (rod.description().base, path.key("initial"));
    let (key, all) = match points {
        Some(Points { key, all, length }) => {
            let length_key = if file.length.is_some() { path.key("length") } else { place.key(key) };
            as_long(context, &length_key, rod.length(), "initial", length)?;
            (key, all)
        }
        None => ("helix", helix(context.document, &place, written, &base, rod.length())?),
    };
    let initial = Initial::new(all, base.rotation, written.twist.unwrap_or(0.0));
    let poses = initial.poses(rod);
    let bends = poses.windows(2).map(|pair| pair[0].rotation.cols[2].dot(pair[1].rotation.cols[2]).acos());
    let (element, bend) =
        bends.enumerate().fold((0, 0.0), |most, bend| if bend.1 > most.1 { bend } else { most });
    if bend > SHARPEST {
        let s = rod.mesh().nodes()[element];
        let message = format!("at s = {s:.4} an element of the rod would be bent by {bend:.1} rad");
        let error = context.document.error(&place.key(key), message);
        return Err(error.mend("give the rod more `elements`, or the shape points around its bends"));
    }
    Ok(Some(initial))
}

/// Points of a helix from a frame on.
fn helix(
    document: &Document,
    path: &KeyPath,
    written: &InitialFile,
    base: &Pose,
    length: f64,
) -> Result<Vec<Vec3>, SceneError> {
    let Some(helix) = &written.helix else { return Ok(Vec::new()) };
    let path = path.key("helix");
    document.not_negative(&path.key("radius"), helix.radius)?;
    let shape = RestShape::helix(helix.radius, helix.pitch).map_err(|error| {
        let error = document.error(&path.key("pitch"), error.to_string());
        error.mend("give radius and pitch in metres, as { radius = 6e-3, pitch = 6e-3 }")
    })?;
    let strain = Strain { angular: shape.curvature(0.0, 0.0), linear: Vec3::Z };
    let pieces = (length * strain.angular.norm() * A_RADIAN).ceil().max(1.0);
    let at = |k: usize| base.compose(&Pose::exp(strain * (length * k as f64 / pieces))).position;
    Ok((0..=pieces as usize).map(at).collect())
}

/// Checks that there is a shape to start from, where motion is to start from one.
pub(super) fn check_start(document: &Document, file: &SceneFile) -> Result<(), SceneError> {
    let start = file.dynamics.as_ref().and_then(|dynamics| dynamics.start.as_deref());
    if start != Some("initial") || file.rods.values().any(|rod| rod.initial.is_some()) {
        return Ok(());
    }
    let error =
        document.error(&KeyPath::of("dynamics").key("start"), "no rod has an initial shape to start from");
    Err(error.mend("give one `initial = { points = [[0, 0, 0], …] }`, or write `start = \"rest\"`"))
}
