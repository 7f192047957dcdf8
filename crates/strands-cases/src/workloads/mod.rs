//! Long runs of problems as an interactive program has them: a hand moves the tip of a rod, 300 frames, each solved from the one before.
//!
//! [`Workload::run`] runs one. A benchmark passes its own closure to [`Workload::run_with`], which is given the problem of each frame
//! and the guess from the frame before, and times what it does with them; what happens between frames is not in its time.

mod motion;
mod rods;

pub use motion::Motion;
pub(crate) use rods::{steel, suture};

use crate::table::Table;
use crate::{Answer, CaseError, Comparison, Expected, Quantity, Setup, Tip};
use strands::rod::{Order, RodError};
use strands::statics::{
    Guess, Problem, Settings, Solution, SolveFailure, SolveReport, Workspace, follow, solve,
};

/// How many frames a run has.
pub const FRAMES: usize = 300;

/// Steps from where the rod is first found to where the first frame has its tip.
const START_STEPS: usize = 400;

/// A rod and how its tip moves.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Its name, as one types it.
    pub name: &'static str,
    /// What it is, in a line.
    pub title: &'static str,
    /// Who ran it first, and how the figures were found.
    pub source: &'static str,
    /// The rod, its weight and its tip before the first frame.
    pub setup: Setup,
    /// How the tip moves.
    pub motion: Motion,
    /// What is known of some frames.
    reference: Vec<(usize, Answer)>,
}

/// A frame, solved.
#[derive(Clone, Debug)]
pub struct FrameResult {
    /// Which, from 1.
    pub frame: usize,
    /// Its solution.
    pub solution: Solution,
    /// Its reference figures beside the solution's; empty in most frames.
    pub comparisons: Vec<Comparison>,
}

/// Every workload.
pub fn all() -> Vec<Workload> {
    vec![
        Workload {
            name: "suture-pose",
            title: "A polypropylene suture, its tip held and moved",
            source: "Runge–Kutta shooting of ContinuumRobotExamples (J. Till, 2022) on 1601 nodes",
            setup: suture(),
            motion: Motion::SuturePose,
            reference: reference("suture-pose", suture().description.length),
        },
        Workload {
            name: "steel-pose",
            title: "A steel rod, its tip held and moved",
            source: "Runge–Kutta shooting of ContinuumRobotExamples (J. Till, 2022) on 1601 nodes",
            setup: steel(),
            motion: Motion::SteelPose,
            reference: reference("steel-pose", steel().description.length),
        },
        Workload {
            name: "steel-wrench",
            title: "A steel rod with a wrench at its tip that turns about",
            source: "after the tip-wrench problem of ContinuumRobotExamples (J. Till, 2022)",
            setup: steel(),
            motion: Motion::SteelWrench,
            reference: Vec::new(),
        },
    ]
}

/// The workload of that name.
pub fn find(name: &str) -> Option<Workload> {
    all().into_iter().find(|workload| workload.name == name)
}

impl Workload {
    /// The problem before the first frame, with a node in the middle of the rod.
    ///
    /// # Errors
    /// Where there are fewer than two elements.
    pub fn problem(&self, elements: usize, order: Order) -> Result<Problem, RodError> {
        self.frame(0).problem(elements, order, &[0.5 * self.setup.description.length])
    }

    /// What is given at the tip in a frame; frame 0 is where the run begins.
    pub fn tip(&self, frame: usize) -> Tip {
        self.motion.tip(self.setup.description.length, frame)
    }

    /// Moves the tip of the workload's problem to a frame.
    ///
    /// # Errors
    /// Where the problem is of another rod.
    pub fn set_frame(&self, problem: &mut Problem, frame: usize) -> Result<(), RodError> {
        self.frame(frame).apply(problem)
    }

    /// The rod in a frame.
    fn frame(&self, frame: usize) -> Setup {
        self.setup.clone().with_tip(self.tip(frame))
    }

    /// Finds the equilibrium before the first frame. Where the tip is held this is the stable one of the first mode of buckling: it is found
    /// with the tip a little short of straight, from a guess of that mode's wrench, and followed from there.
    ///
    /// # Errors
    /// Where it is not found, or lost on the way.
    pub fn begin(
        &self,
        problem: &mut Problem,
        settings: &Settings,
        workspace: &mut Workspace,
    ) -> Result<Guess, CaseError> {
        self.set_frame(problem, 0)?;
        let Some((near, guess)) = self.motion.nearly_straight(&self.setup) else {
            return Ok(solve(problem, settings, None, workspace)?.guess);
        };
        let Tip::Pose(first) = self.tip(0) else { unreachable!("only held tips start nearly straight") };
        problem.end.pose = near;
        let mut guess = solve(problem, settings, Some(&guess), workspace)?.guess;
        let mut report = SolveReport::default();
        for step in 1..=START_STEPS {
            let part = step as f64 / START_STEPS as f64;
            problem.end.pose.position = near.position + (first.position - near.position) * part;
            if !follow(problem, settings, &mut guess, workspace, &mut report) {
                guess = solve(problem, settings, Some(&guess), workspace)?.guess;
            }
        }
        Ok(guess)
    }

    /// Runs every frame.
    ///
    /// # Errors
    /// Where the beginning or a frame is not solved.
    pub fn run(
        &self,
        elements: usize,
        order: Order,
        settings: &Settings,
    ) -> Result<Vec<FrameResult>, CaseError> {
        self.run_with(elements, order, settings, |_, problem, guess, workspace| {
            solve(problem, settings, Some(guess), workspace)
        })
    }

    /// Runs every frame with a solver of the caller's, which is given the frame's number, its problem and the guess from the frame before.
    ///
    /// # Errors
    /// Where the beginning or a frame is not solved.
    pub fn run_with(
        &self,
        elements: usize,
        order: Order,
        settings: &Settings,
        mut solver: impl FnMut(usize, &Problem, &Guess, &mut Workspace) -> Result<Solution, SolveFailure>,
    ) -> Result<Vec<FrameResult>, CaseError> {
        let mut workspace = Workspace::default();
        let mut problem = self.problem(elements, order)?;
        let mut guess = self.begin(&mut problem, settings, &mut workspace)?;
        let mut results = Vec::with_capacity(FRAMES);
        for frame in 1..=FRAMES {
            self.set_frame(&mut problem, frame)?;
            let solution = solver(frame, &problem, &guess, &mut workspace)?;
            guess = solution.guess;
            let comparisons = self.compare(frame, &problem, &solution);
            results.push(FrameResult { frame, solution, comparisons });
        }
        Ok(results)
    }

    fn compare(&self, frame: usize, problem: &Problem, solution: &Solution) -> Vec<Comparison> {
        let known = self.reference.iter().filter(|(of, _)| *of == frame);
        known
            .flat_map(|(_, answer)| &answer.expected)
            .map(|expected| expected.compare(problem, solution))
            .collect()
    }
}

/// The reference frames of a workload.
fn reference(name: &str, length: f64) -> Vec<(usize, Answer)> {
    let table = Table::read(include_str!("../../data/workloads.csv"));
    let records = table.records().filter(|record| record.text("workload") == name);
    records
        .map(|record| {
            let expected = vec![
                Expected::vector(Quantity::BaseForce, record.vector("n")),
                Expected::vector(Quantity::BaseMoment, record.vector("m")),
                Expected::position(0.5 * length, record.vector("h"), length),
            ];
            (record.number("frame") as usize, Answer::new(expected))
        })
        .collect()
}
