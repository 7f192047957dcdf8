//! What can go wrong in motion.

use crate::assembly::AssemblyError;
use crate::contact::Toucher;
use crate::statics::SolveFailure;
use thiserror::Error;

/// Why there is no next step. The state is that before it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepFailure {
    /// Newton's method did not come to the tolerance.
    #[error(
        "at {} s a step of {} s was not solved in {} iterations: residuals {}",
        seconds(*time), seconds(*step), history.len() - 1, written(history)
    )]
    NotConverged {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
        /// The residuals.
        history: Vec<f64>,
    },
    /// A pivot vanished, or a frame is not finite.
    #[error(
        "at {} s a step of {} s led nowhere: residuals {}; what nothing keeps from turning needs inertia about every axis",
        seconds(*time), seconds(*step), written(history)
    )]
    Singular {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
        /// The residuals until then.
        history: Vec<f64>,
    },
    /// What holds a rod would take it through a surface.
    #[error("at {} s supports would, in a step of {} s, take a rod through a surface", seconds(*time), seconds(*step))]
    Blocked {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
    },
    /// What acts in a step so short cannot be told from the round-off of where the frames are.
    #[error("at {} s a step of {} s is too short: round-off leaves a residual of {left:.1e}", seconds(*time), seconds(*step))]
    TooShort {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
        /// The residual that round-off leaves.
        left: f64,
    },
}

impl StepFailure {
    /// The same of a longer step, which began before.
    pub(super) fn in_step(mut self, began: f64, seconds: f64) -> Self {
        let (Self::NotConverged { time, step, .. }
        | Self::Singular { time, step, .. }
        | Self::Blocked { time, step }
        | Self::TooShort { time, step, .. }) = &mut self;
        (*time, *step) = (began, seconds);
        self
    }
}

/// A time to six digits.
fn seconds(time: f64) -> String {
    let digits = format!("{time:.5e}");
    digits.parse().map_or(digits, |time: f64| format!("{time:?}"))
}

fn written(history: &[f64]) -> String {
    history.iter().map(|residual| format!("{residual:.1e}")).collect::<Vec<_>>().join(", ")
}

/// Why an assembly cannot be simulated.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// A rod is not of order 2 with a diagonal law.
    #[error("rod {0}: only rods of order 2 whose law is diagonal in the strains can move")]
    Law(usize),
    /// A rod or body has no mass somewhere.
    #[error("{what} {which} has no mass somewhere: what moves needs one everywhere")]
    Massless {
        /// "rod" or "body".
        what: &'static str,
        /// Its number.
        which: usize,
    },
    /// A number of the settings cannot be.
    #[error("{what} is {value}, and must be {wanted}")]
    Setting {
        /// Which.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// Two methods have another inside by which their error is known.
    #[error("steps are chosen by their error with \"sdirk4\" and \"tr_bdf2\" only, not with \"{0}\"")]
    NoErrorOf(&'static str),
    /// The midpoint rule is for rods alone.
    #[error(
        "the midpoint rule is for rods without bodies and hinges: take another integrator, \"bdf2\" or \"tr_bdf2\""
    )]
    NoMidpoint,
    /// The midpoint rule keeps energy where its steps are solved only.
    #[error(
        "steps of bounded cost are not for the midpoint rule, which keeps energy only where they are solved: take \"bdf2\""
    )]
    UnboundedMidpoint,
    /// Methods that look back, or ahead, on steps without impacts do not know of them.
    #[error("what touches moves by \"implicit_euler\" only, not by \"{0}\"")]
    NoContactBy(&'static str),
    /// No error is known of steps with impacts.
    #[error("steps of what touches are all alike: give `time_step`, and leave out `tolerance`")]
    NoErrorOfContact,
    /// What is left over of contact forces would let surfaces through.
    #[error("steps of bounded cost are not for what touches: leave out newton_iterations")]
    UnboundedContact,
    /// A state has a contact of what there is not.
    #[error("the state has a contact between {} and {}, which there is not: give a state of the same rods and obstacles", between[0], between[1])]
    UnknownContact {
        /// Of what.
        between: [Toucher; 2],
    },
    /// A state has a passage through what there is not.
    #[error(
        "in the state rod {rod} passes at s = {at} m through an eyelet or a hole that there is not: give a state of the same rods and obstacles"
    )]
    UnknownPassage {
        /// Which rod.
        rod: usize,
        /// Where along it, m.
        at: f64,
    },
    /// An eyelet is of a rod or a body that there is not, or beyond its rod's ends.
    #[error(
        "eyelet {0} is not about a place of a rod, between its ends, in the world or on a body: put it there"
    )]
    NoEyelet(usize),
    /// Eyelets act where surfaces touch only.
    #[error("there are eyelets, and nothing touches: say how surfaces do")]
    EyeletsWithoutContact,
    /// Of what a rod is inside there is no surface to pierce.
    #[error("obstacle {0} is a bore, and tissue is what an end goes into: give it another shape")]
    BoreOfTissue(usize),
    /// What an end goes into has an inside.
    #[error("obstacle {0} is tissue, and its mesh is not closed: close it, or give the sheet a thickness")]
    OpenTissue(usize),
    /// Surfaces pass into each other where all starts.
    #[error("where all starts {} passes into {}: put them apart", between[0], between[1])]
    Overlap {
        /// Which.
        between: [Toucher; 2],
    },
    /// Where it starts a rod would not be where it is held.
    #[error(
        "in the shape that it starts from rod {rod} is not where it is held at s = {s} m: start in equilibrium, or hold it there"
    )]
    NotHeldThere {
        /// The rod.
        rod: usize,
        /// Where along it, m.
        s: f64,
    },
    /// The state is of another assembly.
    #[error(
        "the state, of {} frames and {} elements, does not fit what moves, of {} and {}: give a state of the same rods, elements and bodies",
        got[0], got[1], needed[0], needed[1]
    )]
    Unfit {
        /// How many frames and elements it has.
        got: [usize; 2],
        /// How many the assembly has.
        needed: [usize; 2],
    },
    /// The state is none that a step can begin from.
    #[error("the state has numbers that are not finite, or a next step that is not longer than nothing")]
    NotFinite,
    /// The joints cannot be.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A rod has no equilibrium to start from.
    #[error("rod {rod} has no equilibrium to start from: {reason}")]
    NoEquilibrium {
        /// The rod.
        rod: usize,
        /// Why.
        reason: Box<SolveFailure>,
    },
    /// Rods and bodies that are tied together do not come to rest.
    #[error(
        "no equilibrium to start from was found{}: if nothing holds what moves there is none, and start = \"rest\" is the way",
        if history.is_empty() { String::new() } else { format!(" (residuals {})", written(history)) }
    )]
    NoRest {
        /// The residuals of the last step towards it.
        history: Vec<f64>,
    },
}

impl SimulationError {
    /// The rods that it is about, whose numbers its text names as `rod 0`.
    pub fn rods(&self) -> Vec<usize> {
        match self {
            Self::Law(rod)
            | Self::NotHeldThere { rod, .. }
            | Self::NoEquilibrium { rod, .. }
            | Self::Massless { what: "rod", which: rod } => vec![*rod],
            Self::Overlap { between } | Self::UnknownContact { between } => {
                between.iter().filter_map(Toucher::rod).collect()
            }
            _ => Vec::new(),
        }
    }
}
