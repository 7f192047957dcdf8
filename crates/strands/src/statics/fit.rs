//! What a problem and its settings must be before any way to a solution is tried.

use super::problem::Problem;
use super::solution::{FailureReason, Method, Scheme, Settings};
use crate::load::NodalLoads;
use crate::rod::Order;
use std::borrow::Cow;

/// Why a problem cannot be posed as it is; `None` where it can.
pub(crate) fn unfit(problem: &Problem, settings: &Settings) -> Option<FailureReason> {
    let nodes = problem.rod.elements() + 1;
    let pulled = problem.loads.pulls().last().map_or(nodes, |pull| nodes.max(pull.node + 1));
    for loads in [problem.loads.world.len(), problem.loads.body.len(), pulled] {
        if loads != nodes {
            return Some(FailureReason::LoadsOfAnotherRod { loads, nodes });
        }
    }
    if problem.start.grip.is_some() {
        return Some(FailureReason::GripAtStart);
    }
    let growing = problem.between.windows(2).all(|pair| pair[0].0 < pair[1].0);
    let mut between = problem.between.iter().map(|(node, _)| *node);
    if let Some(node) = between.find(|node| *node == 0 || *node + 1 >= nodes || !growing) {
        return Some(FailureReason::SupportAt { node, last: nodes - 1 });
    }
    let shoots = settings.method == Method::Shooting || settings.scheme == Scheme::Multistep;
    if shoots && !problem.between.is_empty() {
        return Some(FailureReason::HeldBetween);
    }
    if (shoots || settings.method == Method::MultipleShooting) && !problem.loads.pulls().is_empty() {
        return Some(FailureReason::PulledToAPoint);
    }
    if settings.scheme == Scheme::Multistep && settings.method == Method::MultipleShooting {
        return Some(FailureReason::SchemeOfSegments);
    }
    // An element of order 4 has two points, and the multistep scheme takes one strain an element.
    if settings.scheme == Scheme::Multistep && problem.rod.order() == Order::Fourth {
        return Some(FailureReason::SchemeOfOrder { order: Order::Fourth.as_number() });
    }
    None
}

/// A problem to look at where it cannot be posed: without loads that are not the rod's, and without what is at nodes that it has not.
pub(crate) fn fitted(problem: &Problem) -> Cow<'_, Problem> {
    let nodes = problem.rod.elements() + 1;
    if problem.loads.world.len() == nodes && problem.loads.body.len() == nodes && problem.can_be_shot() {
        return Cow::Borrowed(problem);
    }
    let loads = NodalLoads::none(&problem.rod);
    Cow::Owned(Problem { loads, between: Vec::new(), ..problem.clone() })
}
