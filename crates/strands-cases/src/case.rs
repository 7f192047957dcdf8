//! A named problem: rows of one kind, each a rod with what acts on it and its reference answers.

use crate::{Comparison, Expected, Setup};
use strands::math::{Pose, Wrench};
use strands::rod::{Order, RodError};
use strands::statics::{Guess, Problem, Settings, Solution, SolveFailure, Workspace, solve};
use thiserror::Error;

/// A named problem with reference answers.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name, as one types it.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Who published it, and how the figures were found.
    pub source: &'static str,
    /// The relative error within which a converged solution matches.
    pub tolerance: f64,
    /// How many elements of order 4 reach the tolerance on every row.
    pub elements: usize,
    /// Its rows.
    pub rows: Vec<Row>,
    /// What was published but is too coarse to compare with.
    pub remark: Option<&'static str>,
}

/// One problem of a case.
#[derive(Clone, Debug)]
pub struct Row {
    /// What sets it apart from the other rows.
    pub label: String,
    /// The rod and what acts on it.
    pub setup: Setup,
    /// Where a solver starts.
    pub start: Start,
    /// The equilibria that are known; a solution may be any of them.
    pub answers: Vec<Answer>,
}

/// Where a solver starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// From rest.
    Cold,
    /// From the end of an equilibrium under less load, known in closed form: where a search from rest may find another one.
    Near {
        /// The frame there.
        pose: Pose,
        /// The internal wrench in it.
        wrench: Wrench,
    },
    /// From the solution of the row before, which lies on the same path of loads.
    PreviousRow,
}

/// A known equilibrium.
#[derive(Clone, Debug)]
pub struct Answer {
    /// What is known of it.
    pub expected: Vec<Expected>,
    /// How many ways there are to lower the energy from it; zero where it is stable.
    pub index: Option<usize>,
}

/// A row, solved and compared.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The problem.
    pub problem: Problem,
    /// Its solution.
    pub solution: Solution,
    /// The nearest of the row's answers.
    pub answer: usize,
    /// Each of that answer's quantities.
    pub comparisons: Vec<Comparison>,
}

/// Why a row has no outcome.
#[derive(Clone, Debug, Error)]
pub enum CaseError {
    /// The rod cannot be cut into so few elements.
    #[error(transparent)]
    Rod(#[from] RodError),
    /// The solver found no equilibrium.
    #[error(transparent)]
    Solve(#[from] SolveFailure),
}

impl Case {
    /// Solves every row, in order.
    pub fn solve(
        &self,
        elements: usize,
        order: Order,
        settings: &Settings,
    ) -> Vec<Result<Outcome, CaseError>> {
        self.solve_or_looser(elements, order, settings, &[])
    }

    /// Solves every row, in order; one that round-off keeps from its tolerance to the first of looser ones that it reaches.
    pub fn solve_or_looser(
        &self,
        elements: usize,
        order: Order,
        settings: &Settings,
        looser: &[f64],
    ) -> Vec<Result<Outcome, CaseError>> {
        let mut workspace = Workspace::default();
        let mut previous: Option<Guess> = None;
        let mut outcomes = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let guess = match row.start {
                Start::Cold => None,
                Start::Near { pose, wrench } => Some(Guess::new(pose, wrench)),
                Start::PreviousRow => previous,
            };
            let mut outcome = row.solve(elements, order, settings, guess.as_ref(), &mut workspace);
            for tolerance in looser {
                let Err(CaseError::Solve(_)) = &outcome else { break };
                let settings = Settings { tolerance: *tolerance, ..*settings };
                outcome = row.solve(elements, order, &settings, guess.as_ref(), &mut workspace);
            }
            previous = outcome.as_ref().ok().map(|outcome| outcome.solution.guess);
            outcomes.push(outcome);
        }
        outcomes
    }
}

impl Row {
    /// The problem, its mesh with nodes wherever an answer is taken.
    ///
    /// # Errors
    /// Where there are fewer elements than stretches between those places.
    pub fn problem(&self, elements: usize, order: Order) -> Result<Problem, RodError> {
        let places = self.answers.iter().flat_map(|answer| &answer.expected).filter_map(Expected::place);
        self.setup.problem(elements, order, &places.collect::<Vec<_>>())
    }

    /// Solves it and compares the solution with the nearest of the answers.
    ///
    /// # Errors
    /// As [`Row::problem`], and where the solver finds no equilibrium.
    pub fn solve(
        &self,
        elements: usize,
        order: Order,
        settings: &Settings,
        guess: Option<&Guess>,
        workspace: &mut Workspace,
    ) -> Result<Outcome, CaseError> {
        let problem = self.problem(elements, order)?;
        let solution = solve(&problem, settings, guess, workspace)?;
        let (answer, comparisons) = self.compare(&problem, &solution);
        Ok(Outcome { problem, solution, answer, comparisons })
    }

    /// The nearest of the answers, and each of its quantities beside the solution's.
    ///
    /// # Panics
    /// Where the problem is not of [`Row::problem`].
    pub fn compare(&self, problem: &Problem, solution: &Solution) -> (usize, Vec<Comparison>) {
        let all = self.answers.iter().map(|answer| {
            answer.expected.iter().map(|expected| expected.compare(problem, solution)).collect::<Vec<_>>()
        });
        all.enumerate()
            .min_by(|(_, a), (_, b)| worst(a).total_cmp(&worst(b)))
            .unwrap_or_else(|| unreachable!("every row has an answer"))
    }
}

impl Answer {
    /// An equilibrium of which the stability is not known.
    pub fn new(expected: Vec<Expected>) -> Self {
        Self { expected, index: None }
    }

    /// A stable one.
    pub fn stable(expected: Vec<Expected>) -> Self {
        Self { expected, index: Some(0) }
    }
}

impl Outcome {
    /// The largest of the relative errors.
    pub fn worst(&self) -> f64 {
        worst(&self.comparisons)
    }
}

fn worst(comparisons: &[Comparison]) -> f64 {
    // An error that is not a number is the worst of all.
    comparisons.iter().map(|comparison| comparison.error).max_by(f64::total_cmp).unwrap_or(0.0)
}
