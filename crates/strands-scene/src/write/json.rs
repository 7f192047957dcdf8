//! The answer of a solve, as scripts read it.

use super::Solved;
use crate::model::Model;
use serde::Serialize;
use serde_json::{Map, Value, json as value};
use std::fmt::Display;
use strands::math::Vec3;
use strands::statics::{Event, EventKind, Method, PathEnd, Reaction, Solution, SolveReport};

#[derive(Serialize)]
struct RodAnswer<'a> {
    s: &'a [f64],
    position: Vec<[f64; 3]>,
    orientation: Vec<[f64; 4]>,
    strain: Vec<[f64; 6]>,
    stress: Vec<[f64; 6]>,
    reactions: Vec<ReactionAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unstable_mode: Option<ModeAnswer>,
}

#[derive(Serialize)]
struct ModeAnswer {
    curvature: f64,
    rotation: Vec<[f64; 3]>,
    displacement: Vec<[f64; 3]>,
}

#[derive(Serialize)]
pub(super) struct ReactionAnswer {
    s: f64,
    force: [f64; 3],
    moment: [f64; 3],
}

impl From<&Reaction> for ReactionAnswer {
    fn from(reaction: &Reaction) -> Self {
        let Reaction { s, force, moment } = *reaction;
        Self { s, force: force.to_array(), moment: moment.to_array() }
    }
}

/// The answer of a solve that converged, one JSON object.
///
/// `iterations`, `energy` (elastic and of the loads, J) and `morse_index` are sums over the rods, `residual` is the largest;
/// `morse_index` and `stable` are null where the loads have no potential or the elements are too long to tell. `method` is null where rods were
/// solved in different ways. Reactions are those of the places that are held. `solve_seconds` is left out where it is not known. A rod in an
/// unstable equilibrium has its `unstable_mode`: at the nodes the `rotation` (rotation vectors, rad) and `displacement` (m), world axes, in which
/// it falls, the larger of turn and shift over length at most one, and the `curvature` of the energy along them (J, negative).
pub fn json(model: &Model, solutions: &[(&str, &Solution)], solve_seconds: Option<f64>) -> String {
    let solved = Solved::all(model, solutions);
    let reports = || solved.iter().map(|solved| &solved.solution.report);
    let morse_index = reports().map(|report| report.morse_index).sum::<Option<usize>>();
    let mut answer = head(model, "converged", common_method(reports()));
    answer.insert("stable".into(), value!(morse_index.map(|index| index == 0)));
    answer.insert("morse_index".into(), value!(morse_index));
    answer.insert("iterations".into(), value!(reports().map(|report| report.iterations).sum::<usize>()));
    answer.insert("residual".into(), value!(reports().map(|report| report.residual).fold(0.0, f64::max)));
    let energy: f64 = solved.iter().map(|solved| solved.solution.energy.total()).sum();
    answer.insert("energy".into(), value!(energy));
    if let Some(seconds) = solve_seconds {
        answer.insert("solve_seconds".into(), value!(seconds));
    }
    answer.insert("rods".into(), rods(&solved));
    Value::Object(answer).to_string()
}

/// The answer of a solve that failed, one JSON object: the rod, why, and how far it got, and in `rods` those that were solved before it. Of
/// the failed rod no shape is given, since none is right.
pub fn failure_json(
    model: &Model,
    rod: &str,
    reason: &dyn Display,
    report: &SolveReport,
    solutions: &[(&str, &Solution)],
    solve_seconds: Option<f64>,
) -> String {
    let mut answer = head(model, "failed", Some(report.method));
    answer.insert("rod".into(), value!(rod));
    answer.insert("reason".into(), value!(reason.to_string()));
    answer.insert("iterations".into(), value!(report.iterations));
    answer.insert("residual".into(), value!(report.residual));
    answer.insert("residual_history".into(), value!(report.residual_history));
    if let Some(seconds) = solve_seconds {
        answer.insert("solve_seconds".into(), value!(seconds));
    }
    answer.insert("rods".into(), rods(&Solved::all(model, solutions)));
    Value::Object(answer).to_string()
}

fn head(model: &Model, status: &str, method: Option<Method>) -> Map<String, Value> {
    let head = [
        ("scene", value!(model.name)),
        ("method", value!(method.map(Method::name))),
        ("status", value!(status)),
    ];
    head.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

fn common_method<'a>(mut reports: impl Iterator<Item = &'a SolveReport>) -> Option<Method> {
    let first = reports.next()?.method;
    reports.all(|report| report.method == first).then_some(first)
}

fn rods(solved: &[Solved]) -> Value {
    Value::Object(solved.iter().map(|solved| (solved.rod.name.clone(), value!(rod(solved)))).collect())
}

fn rod<'a>(solved: &Solved<'a>) -> RodAnswer<'a> {
    let Solution { poses, strain, stress, reactions, .. } = solved.solution;
    let problem = &solved.rod.problem;
    let held = problem.supports().map(|(_, support)| support.holds_anything());
    let reactions = reactions.iter().zip(held).filter(|(_, held)| *held).map(|(reaction, _)| reaction.into());
    let vectors = |vectors: Vec<Vec3>| vectors.into_iter().map(Vec3::to_array).collect();
    let unstable_mode = solved.unstable_mode().map(|mode| ModeAnswer {
        curvature: mode.curvature,
        rotation: vectors(mode.rotation),
        displacement: vectors(mode.displacement),
    });
    RodAnswer {
        s: solved.shape().s(),
        position: poses.iter().map(|pose| pose.position.to_array()).collect(),
        orientation: poses.iter().map(|pose| pose.orientation().to_wxyz()).collect(),
        strain: strain.iter().map(|strain| strain.to_array()).collect(),
        stress: stress.iter().map(|stress| stress.to_array()).collect(),
        reactions: reactions.collect(),
        unstable_mode,
    }
}

/// The answer of a search for all equilibria of a rod, one JSON object: under `equilibria`, by growing energy, for each `stable`, `morse_index`,
/// `energy` (J), `method`, `residual` and `rods` with this one rod as [`json`](fn@json) has it.
pub fn equilibria_json(
    model: &Model,
    rod: &str,
    equilibria: &[Solution],
    solve_seconds: Option<f64>,
) -> String {
    let status = if equilibria.is_empty() { "failed" } else { "converged" };
    let mut answer = head(model, status, None);
    answer.insert("rod".into(), value!(rod));
    if let Some(seconds) = solve_seconds {
        answer.insert("solve_seconds".into(), value!(seconds));
    }
    let all = equilibria.iter().map(|solution| value!(one_of_many(model, rod, solution)));
    answer.insert("equilibria".into(), all.collect());
    Value::Object(answer).to_string()
}

/// A point of a path, with the scene as it is there.
#[derive(Clone, Debug)]
pub struct PathAnswer<'a> {
    /// The value of the key.
    pub value: Value,
    /// The scene with that value.
    pub model: Model,
    /// The equilibrium.
    pub solution: &'a Solution,
}

/// The answer of a path, one JSON object: `key` and `end` (why it ends), under `points` for each the key's `value` and what
/// [`equilibria_json`] has of an equilibrium, and under `events` folds and bifurcations, each with the key's `value` there, how many
/// points are before it (`after_points`) and the Morse index before and after.
pub fn path_json(
    model: &Model,
    rod: &str,
    key: &str,
    points: &[PathAnswer<'_>],
    events: &[(Value, Event)],
    end: &PathEnd,
) -> String {
    let status = if matches!(end, PathEnd::Reached | PathEnd::Returned) { "converged" } else { "failed" };
    let mut answer = head(model, status, None);
    answer.insert("rod".into(), value!(rod));
    answer.insert("key".into(), value!(key));
    let (end, reason) = match end {
        PathEnd::Reached => ("reached", None),
        PathEnd::Returned => ("returned", None),
        PathEnd::MostPoints => ("most_points", None),
        PathEnd::Stuck { why } => ("stuck", Some(why)),
    };
    answer.insert("end".into(), value!(end));
    if let Some(why) = reason {
        answer.insert("reason".into(), value!(why));
    }
    let points = points.iter().map(|point| {
        let mut one = one_of_many(&point.model, rod, point.solution);
        one.insert("value".into(), point.value.clone());
        Value::Object(one)
    });
    answer.insert("points".into(), points.collect());
    let events = events.iter().map(|(at, event)| {
        value!({
            "kind": match event.kind { EventKind::Fold => "fold", EventKind::Bifurcation => "bifurcation" },
            "value": at,
            "after_points": event.after_points,
            "morse_index": event.morse_index,
        })
    });
    answer.insert("events".into(), events.collect());
    Value::Object(answer).to_string()
}

fn one_of_many(model: &Model, rod: &str, solution: &Solution) -> Map<String, Value> {
    let report = &solution.report;
    let pairs = [
        ("stable", value!(report.morse_index.map(|index| index == 0))),
        ("morse_index", value!(report.morse_index)),
        ("energy", value!(solution.energy.total())),
        ("method", value!(report.method.name())),
        ("iterations", value!(report.iterations)),
        ("residual", value!(report.residual)),
        ("rods", rods(&Solved::all(model, &[(rod, solution)]))),
    ];
    pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}
