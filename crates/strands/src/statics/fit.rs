//! What a problem and its settings must be before any way to a solution is tried.

use super::problem::Problem;
use super::solution::{FailureReason, Scheme, Settings};
use crate::rod::Order;

/// Why a problem cannot be posed as it is; `None` where it can.
pub(crate) fn unfit(problem: &Problem, settings: &Settings) -> Option<FailureReason> {
    // An element of order 4 has two points, and the multistep scheme takes one strain an element.
    if settings.scheme == Scheme::Multistep && problem.rod.order() == Order::Fourth {
        return Some(FailureReason::SchemeOfOrder { order: Order::Fourth.as_number() });
    }
    None
}
