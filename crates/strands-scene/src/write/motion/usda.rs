//! Pixar's Universal Scene Description as text, for Blender, Houdini and usdview: a curve a rod.

use super::{Frame, MovedBody};
use crate::model::Model;
use crate::write::names::identifiers;
use std::fmt::Write;
use strands::math::Vec3;

/// A simulation as a `.usda` file: metres, +z up, a time code a frame where frames are evenly apart.
///
/// Each rod is a `BasisCurves`, a Catmull–Rom curve through its nodes, with `points`, `velocities` (m/s) and `extent` in time and `widths` (the larger extent of
/// the section). Each body is an `Xform` with its frame in time. Names that are no identifiers are changed; `customData.name` has them as they were.
pub fn motion_usda(model: &Model, frames: &[Frame]) -> String {
    let rate = time_codes_per_second(frames);
    let codes: Vec<f64> = frames.iter().map(|frame| frame.time * rate).collect();
    let (first, last) = (codes.first().unwrap_or(&0.0), codes.last().unwrap_or(&0.0));
    let mut out = format!(
        "#usda 1.0\n(\n    defaultPrim = \"scene\"\n    startTimeCode = {first:?}\n    endTimeCode = {last:?}\n    \
         timeCodesPerSecond = {rate:?}\n    framesPerSecond = {rate:?}\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n\
         def Xform \"scene\" (\n    {}\n)\n{{\n",
        custom_name(&model.name)
    );
    let bodies = frames.first().map_or(&[] as &[MovedBody], |frame| &frame.bodies);
    let names = model.rods.iter().map(|rod| rod.name.as_str());
    let mut identifiers = identifiers(names.chain(bodies.iter().map(|body| body.name.as_str()))).into_iter();
    for (i, identifier) in (0..model.rods.len()).zip(&mut identifiers) {
        rod(&mut out, model, frames, &codes, i, &identifier);
    }
    for (i, identifier) in identifiers.enumerate() {
        body(&mut out, frames, &codes, i, &identifier);
    }
    out + "}\n"
}

/// The whole number that is nearest to the mean of the frames a second.
fn time_codes_per_second(frames: &[Frame]) -> f64 {
    match frames {
        [first, .., last] if last.time > first.time => {
            ((frames.len() - 1) as f64 / (last.time - first.time)).round().max(1.0)
        }
        _ => 1.0,
    }
}

fn rod(out: &mut String, model: &Model, frames: &[Frame], codes: &[f64], i: usize, identifier: &str) {
    let (name, rod) = (&model.rods[i].name, &model.rods[i].problem.rod);
    let widths: Vec<f64> = rod.half_extent().iter().map(|half| 2.0 * half[0].max(half[1])).collect();
    let thickest = widths.iter().copied().fold(0.0, f64::max);
    let points =
        |frame: &Frame| -> Vec<Vec3> { frame.rods[i].poses.iter().map(|pose| pose.position).collect() };
    let velocities = |frame: &Frame| -> Vec<Vec3> {
        frame.rods[i].velocities.iter().map(|velocity| velocity.linear).collect()
    };
    let extent = |frame: &Frame| {
        let bound = |pick: fn(f64, f64) -> f64, margin: f64| {
            let points = points(frame).into_iter().map(Vec3::to_array);
            let bound = points.reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i]))).unwrap_or_default();
            Vec3::from(bound.map(|x| x + margin))
        };
        vec![bound(f64::min, -0.5 * thickest), bound(f64::max, 0.5 * thickest)]
    };
    let samples = |of: &dyn Fn(&Frame) -> Vec<Vec3>| in_time(frames, codes, |frame| list(of(frame), vector));
    let _ = write!(
        out,
        "    def BasisCurves \"{identifier}\" (\n        {}\n    )\n    {{\n        \
         uniform token type = \"cubic\"\n        uniform token basis = \"catmullRom\"\n        uniform token wrap = \"pinned\"\n        \
         int[] curveVertexCounts = [{}]\n        \
         float[] widths = {} (\n            interpolation = \"vertex\"\n        )\n        \
         point3f[] points.timeSamples = {}\n        vector3f[] velocities.timeSamples = {}\n        \
         float3[] extent.timeSamples = {}\n    }}\n",
        custom_name(name),
        widths.len(),
        list(widths.iter().copied(), number),
        samples(&points),
        samples(&velocities),
        samples(&extent)
    );
}

fn body(out: &mut String, frames: &[Frame], codes: &[f64], i: usize, identifier: &str) {
    let pose = |frame: &Frame| frame.bodies[i].pose;
    let turn = |frame: &Frame| {
        format!("({})", pose(frame).orientation().to_wxyz().map(|x| format!("{x:?}")).join(", "))
    };
    let place =
        |frame: &Frame| format!("({})", pose(frame).position.to_array().map(|x| format!("{x:?}")).join(", "));
    let _ = write!(
        out,
        "    def Xform \"{identifier}\" (\n        {}\n    )\n    {{\n        \
         double3 xformOp:translate.timeSamples = {}\n        quatd xformOp:orient.timeSamples = {}\n        \
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n    }}\n",
        custom_name(&frames[0].bodies[i].name),
        in_time(frames, codes, place),
        in_time(frames, codes, turn)
    );
}

fn custom_name(name: &str) -> String {
    let name = name.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
    format!("customData = {{ string name = \"{name}\" }}")
}

/// A value for each time code.
fn in_time(frames: &[Frame], codes: &[f64], value: impl Fn(&Frame) -> String) -> String {
    let mut out = String::from("{\n");
    for (frame, code) in frames.iter().zip(codes) {
        let _ = writeln!(out, "            {code:?}: {},", value(frame));
    }
    out + "        }"
}

fn list<T>(values: impl IntoIterator<Item = T>, written: fn(T) -> String) -> String {
    format!("[{}]", values.into_iter().map(written).collect::<Vec<_>>().join(", "))
}

fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// USD has points in single precision.
fn number(x: f64) -> String {
    format!("{:?}", x as f32)
}
