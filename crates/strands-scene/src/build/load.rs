//! Loads of a rod, at points and along stretches.

use super::Context;
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{FrameName, LoadFile, Place, RodFile};
use crate::model::Loads;
use strands::load::{DistributedLoad, Frame, PointLoad};
use strands::math::Wrench;

/// The loads of a rod of a length.
pub(super) fn loads(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    length: f64,
) -> Result<Loads, SceneError> {
    let mut loads = Loads { gravity: context.gravity, points: Vec::new(), stretches: Vec::new() };
    for (i, written) in rod.loads.iter().enumerate() {
        let path = path.key("loads").index(i);
        let along = [
            ("from", written.from.is_some()),
            ("to", written.to.is_some()),
            ("force_per_length", written.force_per_length.is_some()),
            ("moment_per_length", written.moment_per_length.is_some()),
        ];
        let at_point = [
            ("at", written.at.is_some()),
            ("force", written.force.is_some()),
            ("moment", written.moment.is_some()),
        ];
        let first =
            |keys: &[(&'static str, bool)]| keys.iter().find(|(_, given)| *given).map(|(key, _)| *key);
        match (first(&at_point), first(&along)) {
            (Some(_), None) => loads.points.push(point(context, &path, written, length)?),
            (None, Some(_)) => loads.stretches.push(stretch(context, &path, written, length)?),
            (Some(one), Some(other)) => {
                let error = context
                    .document
                    .error(&path.key(other), format!("`{one}` and `{other}` do not go together"));
                return Err(error.mend(
                    "a load at a point has `at` with `force` or `moment`; one along a stretch has `from` and `to` with \
                     `force_per_length` or `moment_per_length`. Give two loads for both",
                ));
            }
            (None, None) => {
                let error = context.document.error(&path, "the load is empty");
                return Err(error.mend("give `at = \"end\"` and `force = [0.0, 0.0, -0.1]` in N"));
            }
        }
    }
    Ok(loads)
}

fn point(
    context: &Context,
    path: &KeyPath,
    written: &LoadFile,
    length: f64,
) -> Result<PointLoad, SceneError> {
    let Some(at) = written.at else {
        let error = context.document.error(&path.key("at"), "the load does not say where it acts");
        return Err(error.mend("add `at = \"end\"`, or metres from the start, as `at = 0.1`"));
    };
    if written.force.is_none() && written.moment.is_none() {
        let error = context.document.error(path, "the load has neither `force` nor `moment`");
        return Err(error.mend("add `force = [0.0, 0.0, -0.1]` in N, or `moment` in N·m"));
    }
    Ok(PointLoad {
        at: place(context, &path.key("at"), at, length)?,
        wrench: wrench(written.moment, written.force),
        frame: frame(written),
    })
}

fn stretch(
    context: &Context,
    path: &KeyPath,
    written: &LoadFile,
    length: f64,
) -> Result<DistributedLoad, SceneError> {
    let document = context.document;
    if written.force_per_length.is_none() && written.moment_per_length.is_none() {
        let error = document.error(path, "the load has neither `force_per_length` nor `moment_per_length`");
        return Err(
            error.mend("add `force_per_length = [0.0, 0.0, -0.01]` in N/m, or `moment_per_length` in N")
        );
    }
    let from = place(context, &path.key("from"), written.from.unwrap_or(Place::Start), length)?;
    let to = place(context, &path.key("to"), written.to.unwrap_or(Place::End), length)?;
    if to - from <= 1e-9 * length {
        let error = document
            .error(&path.key("to"), format!("the load ends at {to} m, where it starts ({from} m) or before"));
        return Err(error.mend("`to` must be greater than `from`; a load at one place has `at` and `force`"));
    }
    Ok(DistributedLoad {
        from,
        to,
        per_length: wrench(written.moment_per_length, written.force_per_length),
        frame: frame(written),
    })
}

/// A place as metres from the start.
pub(super) fn place(context: &Context, path: &KeyPath, place: Place, length: f64) -> Result<f64, SceneError> {
    match place {
        Place::Start => Ok(0.0),
        Place::End => Ok(length),
        Place::At(s) if s >= 0.0 && s <= length * (1.0 + 1e-9) => Ok(s.min(length)),
        Place::At(s) => {
            let error =
                context.document.error(path, format!("{s} m lies outside the rod, which is {length} m long"));
            Err(error.mend(format!("use a number from 0 to {length}, \"start\" or \"end\"")))
        }
    }
}

fn wrench(moment: Option<[f64; 3]>, force: Option<[f64; 3]>) -> Wrench {
    Wrench::new(moment.unwrap_or_default().into(), force.unwrap_or_default().into())
}

fn frame(written: &LoadFile) -> Frame {
    match written.frame {
        Some(FrameName::Body) => Frame::Body,
        Some(FrameName::World) | None => Frame::World,
    }
}
