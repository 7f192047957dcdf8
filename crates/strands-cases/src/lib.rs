//! Named problems with reference answers, each once: used by tests, benches and the command line.
//!
//! A [`Case`] is a problem as it was published, with its source, its tolerance and its rows; each [`Row`] builds the
//! [`Problem`](strands::statics::Problem) at any number of elements and order, and compares a solution with what is known of it:
//!
//! ```
//! use strands::rod::Order;
//! use strands::statics::Settings;
//!
//! let case = strands_cases::find("cantilever-end-moment").expect("a case of that name");
//! for outcome in case.solve(case.elements, Order::Fourth, &Settings::default()) {
//!     assert!(outcome?.worst() < case.tolerance);
//! }
//! # Ok::<(), strands_cases::CaseError>(())
//! ```
//!
//! Planar cases lie in the plane of x and y with the base at the origin and its tangent along x. A problem with a prescribed tip pose has many
//! equilibria, and a solver may return any of them; [`Answer::index`] says how stable each is.
//!
//! A [`CriticalCase`] has families of problems that a load leads through, and the loads at which their primary branch loses its stability.
//!
//! [`bank`] has rods drawn at random, to find what a solver cannot do.
//!
//! A [`VibrationCase`] has rods that vibrate a little, with their frequencies; [`Vibration`] measures them. A [`MotionCase`]
//! is a rod that moves far.
//!
//! [`falling`] is a wire that swings under its weight, of which the motion is known.
//!
//! [`ropes`] hardly bend: one is skipped, and one falls from where it is folded.
//!
//! [`turning`] has rods that turn steadily or nearly as rigid bodies do, and a column that a following force makes flutter.
//!
//! [`wild`] has problems that nobody would pose, to find what breaks a solver.
//!
//! [`workloads`] are long runs of problems, each next to the one before, as an interactive program has them.

mod arcs;
pub mod bank;
mod buckled;
mod case;
mod columns;
mod critical;
mod expected;
pub mod falling;
mod frequencies;
mod heavy;
mod lateral;
mod motions;
pub mod net;
mod planar;
mod pose;
pub mod ropes;
mod setup;
mod spatial;
mod spring;
pub mod swinging;
mod table;
mod three_points;
mod tip_wrench;
pub mod turning;
mod uniform;
mod vibration;
pub mod wild;
pub mod workloads;

pub use case::{Answer, Case, CaseError, Outcome, Row, Start};
pub use critical::{Branch, CriticalCase, CriticalLoad, Family};
pub use expected::{Comparison, Expected, Quantity, Value};
pub use frequencies::{VibrationCase, VibrationRow, all_vibrations};
pub use motions::{Moment, MotionCase, all_motions};
pub use setup::{Setup, Tip};
pub use vibration::{Vibration, VibrationError};

/// Every case.
pub fn all() -> Vec<Case> {
    [
        planar::cases(),
        buckled::cases(),
        heavy::cases(),
        arcs::cases(),
        spatial::cases(),
        spring::cases(),
        tip_wrench::cases(),
        pose::cases(),
        three_points::cases(),
    ]
    .concat()
}

/// Every case of critical loads.
pub fn all_critical() -> Vec<CriticalCase> {
    [columns::cases(), lateral::cases(), arcs::critical_cases()].concat()
}

/// The case of that name.
pub fn find(name: &str) -> Option<Case> {
    all().into_iter().find(|case| case.name == name)
}
