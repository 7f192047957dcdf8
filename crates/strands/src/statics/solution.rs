//! What a solve gives: the shape, the stress, the reactions, and a report of how it went.

use super::shooting::Inverse;
use crate::math::{Pose, Strain, Stress, Vec3, Wrench};
use thiserror::Error;

/// Which solver made a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The one that fits: the sweeps where they suffice, shooting elsewhere.
    #[default]
    Auto,
    /// Two sweeps: the standard boundary value problem of the paper, one end clamped and the wrench at the other given.
    Sweep,
    /// A search for the unknown half of the frame and wrench at the end.
    Shooting,
    /// The same for the frame and wrench at several places along the rod at once.
    MultipleShooting,
    /// All frames at once, moving to where the rod rests.
    Equilibrium,
}

impl Method {
    /// Its name in scene files and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Sweep => "sweep",
            Self::Shooting => "shooting",
            Self::MultipleShooting => "multiple_shooting",
            Self::Equilibrium => "equilibrium",
        }
    }
}

/// How an element's exponent is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// By its own local equation, of the rod's order.
    #[default]
    Element,
    /// With the strains of the two neighbours already known, extrapolated, in place of the unknown one: `σ = T(h ε*)ᵀ w`,
    /// `ε* = ε̂ + 2 e₁ − e₂` where the elements are of one length. Explicit, of Adams's kind, second order (the multistep variant that the
    /// paper mentions). Not for order 4.
    Multistep,
}

/// How the Jacobian of the shooting residual is found. All give the same solution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jacobian {
    /// The linearised recurrence, its six columns in SIMD lanes.
    #[default]
    VariationalLanes,
    /// The linearised recurrence, one column after the other.
    Variational,
    /// Differences of perturbed marches, as in the paper.
    FiniteDifferences,
    /// Differences of perturbed marches that run side by side in SIMD lanes.
    FiniteDifferenceLanes,
}

/// How to solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Which solver.
    pub method: Method,
    /// How an element's exponent is found.
    pub scheme: Scheme,
    /// How the Jacobian is found.
    pub jacobian: Jacobian,
    /// The residual at which a solution is accepted: turns in rad, shifts over the rod's length, forces and moments over
    /// `EI/L²` and `EI/L`.
    pub tolerance: f64,
    /// How many Newton iterations one search may take. Where all frames move at once, a rod that is still on its way may take eight steps for each.
    pub max_iterations: usize,
    /// How many times a failed search may halve its step on the way from the last solution, or from rest.
    pub max_halvings: usize,
    /// Whether a search that fails from a guess starts again from rest. An interactive loop says no: it keeps its time, and the shape it has.
    pub restart_from_rest: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            scheme: Scheme::default(),
            jacobian: Jacobian::default(),
            tolerance: 1e-9,
            max_iterations: 40,
            max_halvings: 12,
            restart_from_rest: true,
        }
    }
}

impl Settings {
    /// A step that has been halved as often as it may be.
    pub(crate) fn halved(&self, step: f64) -> f64 {
        0.5_f64.powi(i32::try_from(self.max_halvings).unwrap_or(i32::MAX)) * step
    }
}

/// The frame and the wrench at the rod's end: all that a solution is known by, and where the next search starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// The frame at `s = L`.
    pub pose: Pose,
    /// The internal wrench at `s = L`, in that frame, N·m and N.
    pub wrench: Wrench,
    /// The inverse Jacobian that the search which found them ended with. The next search starts with it too, and forms its own where this
    /// one does not serve.
    pub(crate) inverse: Option<Inverse>,
}

impl Guess {
    /// A guess from the frame and the internal wrench at `s = L`.
    pub const fn new(pose: Pose, wrench: Wrench) -> Self {
        Self { pose, wrench, inverse: None }
    }
}

/// What a support exerts on the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// Where, m.
    pub s: f64,
    /// Force, world axes, N.
    pub force: Vec3,
    /// Moment about the node, world axes, N·m.
    pub moment: Vec3,
}

/// Energies, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Stored in the rod.
    pub elastic: f64,
    /// Of the dead forces, minus force times position; and of the pulls towards points, tension times distance.
    pub load: f64,
}

impl Energy {
    /// Both together.
    pub fn total(&self) -> f64 {
        self.elastic + self.load
    }
}

/// How a solve went.
#[derive(Clone, Debug, PartialEq)]
pub struct SolveReport {
    /// Which solver made it.
    pub method: Method,
    /// Newton iterations.
    pub iterations: usize,
    /// The last residual, dimensionless as in [`Settings::tolerance`].
    pub residual: f64,
    /// The residual at each iteration.
    pub residual_history: Vec<f64>,
    /// How often the line search cut a step.
    pub line_search_cuts: usize,
    /// Sweeps along the rod.
    pub sweeps: usize,
    /// Jacobians of shooting.
    pub jacobians: usize,
    /// Factorisations of the nodal system, or of that of multiple shooting.
    pub factorisations: usize,
    /// Steps on the way from the last solution or from rest; 1 where the search converged at once.
    pub path_steps: usize,
    /// How many ways there are to lower the energy. `None` where the loads have no potential (follower loads), and where elements are so long for
    /// what they carry that a way down may be one element's and not the rod's.
    pub morse_index: Option<usize>,
}

impl Default for SolveReport {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            iterations: 0,
            residual: f64::INFINITY,
            residual_history: Vec::new(),
            line_search_cuts: 0,
            sweeps: 0,
            jacobians: 0,
            factorisations: 0,
            path_steps: 0,
            morse_index: None,
        }
    }
}

impl SolveReport {
    /// Empties the report, keeping its room.
    pub(crate) fn restart(&mut self, method: Method) {
        let mut residual_history = core::mem::take(&mut self.residual_history);
        residual_history.clear();
        *self = Self { method, residual_history, path_steps: 1, ..Self::default() };
    }
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Frames of the nodes.
    pub poses: Vec<Pose>,
    /// Strains of the elements (the mean of the two points for order 4), body frame.
    pub strain: Vec<Strain>,
    /// Stresses of the elements (the mean of the two points for order 4), body frame.
    pub stress: Vec<Stress>,
    /// What holds the start, the places between in order, and the end.
    pub reactions: Vec<Reaction>,
    /// Its energies.
    pub energy: Energy,
    /// The frame and wrench at the end.
    pub guess: Guess,
    /// How the solve went.
    pub report: SolveReport,
}

/// Why a solve gave no equilibrium.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FailureReason {
    /// Two supports are further apart than an inextensible rod is long between them.
    #[error(
        "out of reach: the rod is held at s = {from} m and at s = {to} m in places {distance:.6} m apart, and it is inextensible and \
         {length:.6} m long between; bring them nearer, or let the rod stretch (kinematics = \"cosserat\")"
    )]
    OutOfReach {
        /// Distance of the places, m.
        distance: f64,
        /// Length of the rod between, m.
        length: f64,
        /// Where along the rod the first of them is, m.
        from: f64,
        /// Where the second is, m.
        to: f64,
    },
    /// The search stopped short.
    #[error(
        "no equilibrium found: the residual stays at {residual:.3e} (tolerance {tolerance:.1e}) after {iterations} iterations; \
         use more elements, less load, or a support nearer to where the rod would be without it"
    )]
    NotConverged {
        /// The smallest residual reached.
        residual: f64,
        /// The tolerance asked for.
        tolerance: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// The rod is so taut that it bends over less than an element.
    #[error(
        "no equilibrium found: on its elements, up to {element_length:.3e} m long, the rod comes to a tension of {tension:.3e} N, under which it \
         would bend over {bending_length:.3e} m; shorter elements may bear less: use {needed} or more, or pull less"
    )]
    TooCoarse {
        /// The largest internal force of the last state that was an equilibrium on the way, N. Elements that are too long bear more than the rod.
        tension: f64,
        /// `√(EI/T)`, m.
        bending_length: f64,
        /// The longest element, m.
        element_length: f64,
        /// As many elements as have half that bending length, and no more than four times those that there are: with them the tension is another.
        needed: usize,
    },
    /// The supports leave the rod free to move as a whole, or the problem is singular there.
    #[error(
        "the problem is singular: the supports may leave the rod free to move or turn as a whole; fix more of its ends"
    )]
    Singular,
    /// The method that was asked for does not solve this kind of problem.
    #[error(
        "the sweep needs one end clamped and the other free: {what}; use method = \"shooting\" or \"auto\""
    )]
    NotStandard {
        /// What is not as it should be.
        what: &'static str,
    },
    /// The equilibrium solver was asked for with a scheme that derives from no energy.
    #[error(
        "the equilibrium solver lowers the rod's energy, and elements of order 1 and the multistep scheme derive from none; \
         use order 2 or 4, or method = \"shooting\""
    )]
    NoEnergy,
    /// The loads are summed onto the nodes of another rod.
    #[error(
        "the loads are those of a rod of {loads} nodes, and this one has {nodes}; sum them onto this rod (NodalLoads::none(&rod))"
    )]
    LoadsOfAnotherRod {
        /// For how many nodes there are loads.
        loads: usize,
        /// How many the rod has.
        nodes: usize,
    },
    /// A hand holds the rod's start.
    #[error(
        "a hand can hold the rod's end only, and this one holds its start; build the rod the other way round, or clamp its start"
    )]
    GripAtStart,
    /// Shooting was asked for, and supports between the ends are unknown to it.
    #[error(
        "shooting, and with it the multistep scheme, searches for what is unknown at the end, and this rod is held between its ends too; use \
         method = \"auto\", \"equilibrium\" or \"multiple_shooting\""
    )]
    HeldBetween,
    /// Shooting was asked for, and it does not follow loads towards a point.
    #[error(
        "shooting, and with it the multistep scheme, takes loads that keep their direction in the world or in the rod, and here one pulls towards a \
         point; use method = \"auto\" or \"equilibrium\""
    )]
    PulledToAPoint,
    /// A support between the ends is not at a node between them, or they are out of order.
    #[error(
        "supports between the ends must be at nodes 1 to {} in growing order, each once, and there is one at node {node}; find a node by \
         its place (rod.mesh().node_at(s))", last - 1
    )]
    SupportAt {
        /// The node.
        node: usize,
        /// The last node of the rod.
        last: usize,
    },
    /// The scheme does not go with multiple shooting.
    #[error(
        "the multistep scheme takes its strains from the elements before, and multiple shooting begins anew in each segment; use \
         scheme = \"element\", or method = \"shooting\""
    )]
    SchemeOfSegments,
    /// The scheme does not go with the rod's order.
    #[error(
        "the multistep scheme takes one strain an element, and a rod of order {order} has two; use scheme = \"element\", or order = 2"
    )]
    SchemeOfOrder {
        /// The rod's order.
        order: usize,
    },
    /// A number became infinite or NaN.
    #[error("the numbers overflowed at node {node}: the loads may be far too large for the rod's stiffness")]
    NotFinite {
        /// The node nearest the end where it was first seen.
        node: usize,
    },
}

/// A solve without an equilibrium: why, and how far it got.
#[derive(Clone, Debug, Error)]
#[error("{reason}")]
pub struct SolveFailure {
    /// Why.
    pub reason: FailureReason,
    /// The state of the smallest residual. Not an equilibrium; for the eye only.
    pub nearest: Box<Solution>,
}
