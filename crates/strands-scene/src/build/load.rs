//! Loads of a rod, at points and along stretches.

use super::Context;
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{FrameName, LoadFile, Place, RodFile};
use crate::model::Loads;
use strands::load::{DistributedLoad, DistributedPull, Frame, PointLoad, PointPull};
use strands::math::{Vec3, Wrench};

/// The loads of a rod of a length.
pub(super) fn loads(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    length: f64,
) -> Result<Loads, SceneError> {
    let mut loads = Loads {
        gravity: context.gravity,
        points: Vec::new(),
        stretches: Vec::new(),
        pulls: Vec::new(),
        pulled_stretches: Vec::new(),
    };
    for (i, written) in rod.loads.iter().enumerate() {
        let path = path.key("loads").index(i);
        if let Some(towards) = towards(context, &path, written)? {
            pull(context, &path, written, towards.into(), length, &mut loads)?;
            continue;
        }
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

/// The point that a load pulls towards, where it pulls.
fn towards(context: &Context, path: &KeyPath, written: &LoadFile) -> Result<Option<[f64; 3]>, SceneError> {
    let tensions = [
        ("tension", written.tension.is_some()),
        ("tension_per_length", written.tension_per_length.is_some()),
    ];
    let Some(towards) = written.towards else {
        let Some((key, _)) = tensions.into_iter().find(|(_, given)| *given) else { return Ok(None) };
        let error = context
            .document
            .error(&path.key(key), format!("`{key}` does not say towards which point it pulls"));
        return Err(error.mend("add `towards = [0.0, 0.0, 0.0]` in metres, or give a `force`"));
    };
    let others = [
        ("force", written.force.is_some()),
        ("moment", written.moment.is_some()),
        ("force_per_length", written.force_per_length.is_some()),
        ("moment_per_length", written.moment_per_length.is_some()),
        ("frame", written.frame.is_some()),
    ];
    if let Some((key, _)) = others.into_iter().find(|(_, given)| *given) {
        let error =
            context.document.error(&path.key(key), format!("`{key}` and `towards` do not go together"));
        return Err(error.mend("a pull towards a point has a `tension` in N; give two loads for both"));
    }
    Ok(Some(towards))
}

/// A pull towards a point, at a place or along a stretch.
fn pull(
    context: &Context,
    path: &KeyPath,
    written: &LoadFile,
    towards: Vec3,
    length: f64,
    loads: &mut Loads,
) -> Result<(), SceneError> {
    match (written.tension, written.tension_per_length) {
        (Some(tension), None) if written.from.is_none() && written.to.is_none() => {
            let at = load_place(context, path, written, length)?;
            loads.pulls.push(PointPull { at, towards, tension });
        }
        (None, Some(tension_per_length)) if written.at.is_none() => {
            let (from, to) = ends(context, path, written, length)?;
            loads.pulled_stretches.push(DistributedPull { from, to, towards, tension_per_length });
        }
        _ => {
            let error = context.document.error(
                &path.key("towards"),
                "a pull is at a point, with `at` and `tension`, or along a stretch, with `from`, `to` and `tension_per_length`",
            );
            return Err(error.mend("give `at = \"end\"` and `tension = 0.1` in N"));
        }
    }
    Ok(())
}

/// Where a load at a point acts, m from the start.
fn load_place(context: &Context, path: &KeyPath, written: &LoadFile, length: f64) -> Result<f64, SceneError> {
    let Some(at) = written.at else {
        let error = context.document.error(&path.key("at"), "the load does not say where it acts");
        return Err(error.mend("add `at = \"end\"`, or metres from the start, as `at = 0.1`"));
    };
    place(context, &path.key("at"), at, length)
}

/// From where to where a load along a stretch acts, m from the start.
fn ends(
    context: &Context,
    path: &KeyPath,
    written: &LoadFile,
    length: f64,
) -> Result<(f64, f64), SceneError> {
    let from = place(context, &path.key("from"), written.from.unwrap_or(Place::Start), length)?;
    let to = place(context, &path.key("to"), written.to.unwrap_or(Place::End), length)?;
    if to - from <= 1e-9 * length {
        let error = context
            .document
            .error(&path.key("to"), format!("the load ends at {to} m, where it starts ({from} m) or before"));
        return Err(error.mend("`to` must be greater than `from`; a load at one place has `at` and `force`"));
    }
    Ok((from, to))
}

fn point(
    context: &Context,
    path: &KeyPath,
    written: &LoadFile,
    length: f64,
) -> Result<PointLoad, SceneError> {
    let at = load_place(context, path, written, length)?;
    if written.force.is_none() && written.moment.is_none() {
        let error = context.document.error(path, "the load has neither `force` nor `moment`");
        return Err(error.mend("add `force = [0.0, 0.0, -0.1]` in N, or `moment` in N·m"));
    }
    Ok(PointLoad { at, wrench: wrench(written.moment, written.force), frame: frame(written) })
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
    let (from, to) = ends(context, path, written, length)?;
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
