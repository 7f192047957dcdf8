//! The way to a hand that one search did not reach, in bits of work small enough that a newer hand can come between them.
//!
//! First in small steps from the last shape. Where the thread has to snap over, that way ends at the snap, and the thread is let move on to where
//! it rests with the hand a little further; where that fails too, from the shape that the scene opened with. Steps that turn a part of the thread by a radian, or lose stability, are made smaller; an unstable shape at the hand is
//! taken when no way leads to a stable one. A start from rest goes to whatever shape it finds, so it comes after all other starts: by then the
//! hand rests.

use strands::coupling::VirtualCoupling;
use strands::math::{Pose, Quat};
use strands::statics::{
    FailureReason, Guess, Problem, Reaction, Settings, Solution, SolveReport, Support, Workspace, follow,
    recall, rest_from, solve,
};

use crate::snap::is_small;

/// Iterations of one step: a coil may need thirty, and a step that fails mostly stalls long before.
const ITERATIONS: usize = 40;
/// The first step, a part of the way.
const FIRST_STEP: f64 = 0.25;
/// The step at which a way counts as blocked.
const SMALLEST_STEP: f64 = 1.0 / 256.0;
/// How far, in rad, one step may turn any part of the thread: more is a jump to another shape.
pub const LARGEST_TURN: f64 = 1.0;
/// How often the thread may snap over on one way.
const MOST_SNAPS: usize = 8;

/// A shape to start from, with the hand that holds it.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    guess: Guess,
    pub hand: Pose,
    /// What holds its end.
    reaction: Reaction,
    /// Whether a spring that holds it is at its limit.
    saturated: bool,
}

impl Start {
    pub fn new(shape: &Solution, hand: Pose, saturated: bool) -> Self {
        Self { guess: shape.guess, hand, reaction: *shape.end_reaction(), saturated }
    }

    /// Where to search for the shape that is held at `end`. On a spring the end is put where the spring does what has held it so far: a
    /// stiff one, a little stretched or slack, would do a thousand times that, or nothing. At its limit it does the same wherever it is.
    pub fn guess_at(&self, end: &Support) -> Guess {
        let Some(grip) = end.grip.as_ref().filter(|_| !self.saturated) else { return self.guess };
        let VirtualCoupling { mut linear_stiffness, linear_damping, angular_stiffness, .. } = grip.coupling;
        let mut pull = grip.hand.position * linear_stiffness - self.reaction.force;
        if let Some(last) = &grip.last {
            let damping = linear_damping / last.time_step;
            pull += (grip.hand.position - last.hand.position + last.held.position) * damping;
            linear_stiffness += damping;
        }
        if !(linear_stiffness > 0.0 && angular_stiffness > 0.0) {
            return self.guess;
        }
        let turn = Quat::from_rotation_vector(self.reaction.moment * (-1.0 / angular_stiffness)).to_matrix();
        let pose = Pose { rotation: turn * grip.hand.rotation, position: pull * (1.0 / linear_stiffness) };
        let mut guess = self.guess;
        guess.pose = pose;
        guess
    }
}

/// A way that is being walked.
#[derive(Debug)]
pub struct Way {
    at: Start,
    /// What is left to walk is one; the next step goes this far.
    step: f64,
    shape: Option<Solution>,
    /// Whether what has been reached may be shown: only then does the thread move there without a jump.
    pub continuous: bool,
    others: Vec<Start>,
    /// An unstable shape at the hand, for want of a stable one.
    unstable: Option<Solution>,
    /// Whether to look for another branch, where the one that the thread was on ends.
    may_snap: bool,
    /// How often it has been let go over to another.
    snaps: usize,
    /// Whether what the last bit brought need not be on the branch of what was before.
    pub jumped: bool,
}

/// What one bit of work brought.
#[derive(Debug)]
pub enum Bit {
    /// The hand is reached.
    Arrived(Solution),
    /// A shape nearer to it, held by the hand that is given.
    Nearer(Solution, Pose),
    /// Nothing yet.
    Trying,
    /// Nothing is left to try.
    Stuck,
}

impl Way {
    /// A way from the last shape, and if that is blocked, from others.
    pub fn new(
        last: Start,
        shape: Solution,
        others: Vec<Start>,
        unstable: Option<Solution>,
        may_snap: bool,
    ) -> Self {
        let shape = Some(shape);
        let (continuous, jumped) = (true, false);
        Self { at: last, step: FIRST_STEP, shape, continuous, others, unstable, may_snap, snaps: 0, jumped }
    }

    /// Does one bit of the work to get to a problem whose end the hand holds.
    pub fn walk(
        &mut self,
        goal: &Problem,
        hand: &Pose,
        settings: &Settings,
        workspace: &mut Workspace,
    ) -> Bit {
        self.jumped = !self.continuous;
        if self.step < SMALLEST_STEP {
            return match self.snap(goal, hand, settings, workspace) {
                Some(bit) => bit,
                None => self.start_elsewhere(goal, settings, workspace),
            };
        }
        let whole = self.step >= 1.0;
        let next = if whole { *hand } else { between(&self.at.hand, hand, self.step) };
        let mut problem = goal.clone();
        hold(&mut problem.end, next);
        if let Some(shape) = self.shape.as_ref().filter(|_| !problem.between.is_empty()) {
            recall(&problem, shape, workspace);
        }
        let short = Settings { max_iterations: ITERATIONS, ..*settings };
        let found = search(&problem, &short, self.at.guess_at(&problem.end), workspace).ok();
        let Some(found) = found.filter(|found| self.follows(found)) else {
            self.step *= 0.5;
            return Bit::Trying;
        };
        // The step is a part of what is left, so that twice the length is a little more than twice the part.
        self.step = f64::min(2.0 * self.step / (1.0 - self.step), 1.0);
        self.arrive(&problem, found, next, whole)
    }

    /// Goes on from what has been found.
    fn arrive(&mut self, problem: &Problem, found: Solution, at: Pose, whole: bool) -> Bit {
        let saturated = problem.end.grip.is_some_and(|grip| grip.saturated(&found.guess.pose));
        self.at = Start::new(&found, at, saturated);
        if whole {
            return Bit::Arrived(found);
        }
        self.shape = Some(found.clone());
        if self.continuous { Bit::Nearer(found, at) } else { Bit::Trying }
    }

    /// Where the branch that the thread is on ends: lets it move on to where it rests with the hand further on.
    fn snap(
        &mut self,
        goal: &Problem,
        hand: &Pose,
        settings: &Settings,
        workspace: &mut Workspace,
    ) -> Option<Bit> {
        let may = self.may_snap && self.continuous && self.snaps < MOST_SNAPS;
        let last = self.shape.as_ref().filter(|_| may)?;
        let whole = is_small(&self.at.hand, hand, goal.rod.length());
        let next = if whole { *hand } else { between(&self.at.hand, hand, FIRST_STEP) };
        let mut problem = goal.clone();
        hold(&mut problem.end, next);
        let found = rest_from(&problem, settings, last, workspace).ok().filter(is_stable)?;
        (self.snaps, self.jumped, self.step) = (self.snaps + 1, true, FIRST_STEP);
        Some(self.arrive(&problem, found, next, whole))
    }

    /// Whether a shape is the next one on the way, and not on another branch.
    fn follows(&self, found: &Solution) -> bool {
        let Some(before) = &self.shape else { return true };
        let lost = found.report.morse_index > before.report.morse_index.max(Some(0));
        !lost && largest_turn(&before.poses, &found.poses) <= LARGEST_TURN
    }

    /// From another start, and when none is left, from rest: the branch that the thread was on may end here, and then it snaps to another.
    fn start_elsewhere(&mut self, goal: &Problem, settings: &Settings, workspace: &mut Workspace) -> Bit {
        let Some(start) = self.others.pop() else {
            self.jumped = true;
            let snapped = if self.may_snap { solve(goal, settings, None, workspace).ok() } else { None };
            let snapped = snapped.filter(is_stable);
            return snapped.or_else(|| self.unstable.take()).map_or(Bit::Stuck, Bit::Arrived);
        };
        (self.at, self.step, self.shape, self.continuous) = (start, FIRST_STEP, None, false);
        Bit::Trying
    }
}

/// One search and nothing more, where `solve` would go on to a way of its own, which could not be interrupted.
///
/// # Errors
/// Why nothing was found, and how the search went.
pub fn search(
    problem: &Problem,
    settings: &Settings,
    mut guess: Guess,
    workspace: &mut Workspace,
) -> Result<Solution, Box<(FailureReason, SolveReport)>> {
    let mut report = SolveReport::default();
    if follow(problem, settings, &mut guess, workspace, &mut report) {
        return match solve(problem, settings, Some(&guess), workspace) {
            Ok(mut solution) => {
                solution.report.iterations += report.iterations;
                Ok(solution)
            }
            Err(failure) => Err(Box::new((failure.reason, failure.nearest.report))),
        };
    }
    let reason = if report.residual.is_finite() {
        let (residual, iterations) = (report.residual, report.iterations);
        FailureReason::NotConverged { residual, tolerance: settings.tolerance, iterations }
    } else {
        FailureReason::NotFinite { node: problem.rod.elements() }
    };
    Err(Box::new((reason, report)))
}

/// Puts the end that a hand holds somewhere else.
fn hold(end: &mut Support, hand: Pose) {
    match &mut end.grip {
        Some(grip) => grip.hand = hand,
        None => end.pose = hand,
    }
}

/// A place on the straight line between two poses, turned on the shorter way.
fn between(from: &Pose, to: &Pose, part: f64) -> Pose {
    let turn = from.between(to).log().angular;
    Pose {
        rotation: from.rotation * Quat::from_rotation_vector(turn * part).to_matrix(),
        position: from.position + (to.position - from.position) * part,
    }
}

/// Whether nothing lowers its energy, as far as that can be told.
pub fn is_stable(found: &Solution) -> bool {
    found.report.morse_index.unwrap_or(0) == 0
}

pub fn largest_turn(before: &[Pose], after: &[Pose]) -> f64 {
    let stride = (before.len() / 8).max(1);
    let pairs = before.iter().zip(after).step_by(stride);
    pairs.map(|(a, b)| a.rotation.turn_to(&b.rotation).norm()).fold(0.0, f64::max)
}
