//! The answer of a solve, as scripts read it.

use super::Solved;
use crate::model::Model;
use serde::Serialize;
use serde_json::{Map, Value, json as value};
use std::fmt::Display;
use strands::statics::{Method, Solution, SolveReport};

#[derive(Serialize)]
struct RodAnswer<'a> {
    s: &'a [f64],
    position: Vec<[f64; 3]>,
    orientation: Vec<[f64; 4]>,
    strain: Vec<[f64; 6]>,
    stress: Vec<[f64; 6]>,
    reactions: Vec<ReactionAnswer>,
}

#[derive(Serialize)]
struct ReactionAnswer {
    s: f64,
    force: [f64; 3],
    moment: [f64; 3],
}

/// The answer of a solve that converged, one JSON object.
///
/// `iterations`, `energy` (elastic and of dead loads, J) and `morse_index` are sums over the rods, `residual` is the largest;
/// `morse_index` and `stable` are null where the loads have no potential. `method` is null where rods were solved in different ways. Reactions are those
/// of the places that are held. `solve_seconds` is left out where it is not known.
pub fn json(model: &Model, solutions: &[(&str, &Solution)], solve_seconds: Option<f64>) -> String {
    let solved = Solved::all(model, solutions);
    let reports = || solved.iter().map(|solved| &solved.solution.report);
    let morse_index = reports().map(|report| report.morse_index).sum::<Option<usize>>();
    let mut answer = head(model, "converged", common_method(reports()));
    answer.insert("stable".into(), value!(morse_index.map(|index| index == 0)));
    answer.insert("morse_index".into(), value!(morse_index));
    answer.insert("iterations".into(), value!(reports().map(|report| report.iterations).sum::<usize>()));
    answer.insert("residual".into(), value!(reports().map(|report| report.residual).fold(0.0, f64::max)));
    let energy: f64 =
        solved.iter().map(|solved| solved.solution.energy.elastic + solved.solution.energy.load).sum();
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
    let reactions = reactions.iter().zip(held).filter(|(_, held)| *held).map(|(reaction, _)| {
        ReactionAnswer { s: reaction.s, force: reaction.force.to_array(), moment: reaction.moment.to_array() }
    });
    RodAnswer {
        s: solved.s(),
        position: poses.iter().map(|pose| pose.position.to_array()).collect(),
        orientation: poses.iter().map(|pose| pose.orientation().to_wxyz()).collect(),
        strain: strain.iter().map(|strain| strain.to_array()).collect(),
        stress: stress.iter().map(|stress| stress.to_array()).collect(),
        reactions: reactions.collect(),
    }
}
