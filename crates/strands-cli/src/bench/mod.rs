//! `strands bench`: what the solvers cost on this machine.

mod clock;
mod instructions;
mod motion;
mod problems;

pub use instructions::{count, run};

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;
use strands::dynamics::{SimulationError, StepFailure};
use strands::math::{Pose, SimdLevel, Wrench};
use strands::rod::{Kinematics, Order, RodError};
use strands::statics::{
    Batch, BatchError, Guess, Jacobian, Method, Problem, Scheme, Settings, Solution, SolveFailure,
    SolveReport, Workspace, follow, solve,
};
use strands_cases::bank;
use strands_cases::net::NetError;

/// What `--help` says about the figures.
pub const NAMES: &str = "\
Figures (of a steel wire 0.5 m long, 2 mm thick, where no other is named; one thread):
  simd_width                       numbers of 64 bits in one vector instruction
  sweep.order1 .order2 .order4 .multistep
                                   one sweep of 100 elements, µs; with .element, ns an element;
                                   .order2.kirchhoff is of an inextensible wire
  warm.median warm.p999            both ends held, 100 elements, under gravity, residual
                                   1e-10: search after the hand moved by 0.3 % of the length
                                   and 1°, from the last solution, µs
  warm.iterations                  mean Newton iterations of those
  equilibrium.warm.median .p999    the same with all frames at once, µs; .factorisations, mean
  equilibrium.iteration.100 .1000 .10000
                                   one of its iterations on that many elements (linearise, factor,
                                   solve), ns for each of a node's six numbers
  batch.rod batch.faster           as equilibrium.warm, of eight rods followed side by side, each with a
                                   hand of its own, µs for one of them; and how many times faster than
                                   one after the other, in the same run
  motion.bdf2 .midpoint .sdirk4    the wire, clamped, straight at first, falls: one step of 2 ms, 100
                                   elements, µs; with .error, how far its tip is from its modes, root
                                   mean square over the first second, % of what it sinks by at rest
  motion.iteration.100 .1000 .10000
                                   of a step of 1 ms by bdf2, what one Newton iteration takes on that many
                                   elements, ns for each of a node's six numbers
  motion.swing.25 .50 .100 .200    a suture of that many elements swings undamped, 1 ms a step, bdf2: how many
                                   times faster than real time; .fine_wire, .tube of 100
  motion.bounded.median .p999 .worst
                                   the same suture of 200 elements, two Newton iterations a step, 60 s: one
                                   step, ms
  motion.rest .error               a steel wire of 0.8 m, 100 elements, damped, until its tip stays within
                                   1e-3 of where it rests, ms; how far it then ends from there, over the fall
  motion.tree motion.net           one step of the scene willow (242 elements, 4 ms) and of a net of 20 × 20
                                   ropes (1,520 elements, 2 ms), ms
  jacobian.variational_lanes .variational .finite_differences .finite_difference_lanes
                                   one Jacobian, over one sweep of the same rod, from times of
                                   whole solves; by finite differences it is six sweeps, which
                                   sets the scale
  cost.50 … cost.5000              one sweep of that many elements, ns an element
  cost.worst_over_best             the largest of those over the smallest
  suture-pose steel-pose steel-wrench
                                   with .median and .worst: 300 frames of a moving end, 100
                                   elements, residual 1e-10, each from the one before, µs
  bank.mean .median .p99 .worst    rods drawn at random, clamped at the base and held at the tip,
                                   100 elements, from rest, ms; .unsolved and .unstable of 10000

Times are medians of batches that take turns. With --instructions the figures are counts, the same in
every run: of an element in a sweep (sweep.*) and in a Jacobian by lanes (jacobian), by callgrind,
which has instructions up to AVX2.";

/// One measured number.
#[derive(Debug, Serialize)]
pub struct Figure {
    /// Its name, which stays the same.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// Why there is no figure.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A rod could not be built.
    #[error(transparent)]
    Rod(#[from] RodError),
    /// A problem could not be solved.
    #[error(transparent)]
    Solve(#[from] Box<SolveFailure>),
    /// Rods could not be put side by side.
    #[error(transparent)]
    Batch(#[from] BatchError),
    /// A rod could not be simulated.
    #[error(transparent)]
    Motion(#[from] SimulationError),
    /// A step could not be made.
    #[error(transparent)]
    Step(#[from] StepFailure),
    /// A net could not be made.
    #[error(transparent)]
    Net(#[from] NetError),
    /// A scene could not be read.
    #[error(transparent)]
    Scene(#[from] strands_scene::SceneError),
    /// Instructions could not be counted.
    #[error("{0}")]
    Count(String),
    /// A workload could not be run.
    #[error(transparent)]
    Workload(#[from] strands_cases::CaseError),
}

/// Measures everything.
pub fn measure() -> Result<Vec<Figure>, BenchError> {
    let mut figures = vec![figure("simd_width", SimdLevel::detect().width() as f64, "numbers")];
    figures.extend(sweeps()?);
    figures.extend(warm()?);
    figures.extend(all_at_once()?);
    figures.extend(side_by_side()?);
    figures.extend(motion::motion()?);
    figures.extend(jacobians()?);
    figures.extend(cost()?);
    figures.extend(workloads()?);
    figures.extend(bank()?);
    Ok(figures)
}

/// The figures as a table for people, and the vector instructions that they were taken with.
pub fn table(figures: &[Figure], level: SimdLevel) -> String {
    let wide = figures.iter().map(|figure| figure.name.len()).max().unwrap_or(0);
    let line = |figure: &Figure| {
        format!("  {:<wide$}  {:>10}  {}\n", figure.name, crate::units::digits(figure.value, 4), figure.unit)
    };
    let lines: String = figures.iter().map(line).collect();
    format!("Vector instructions: {}\n{lines}", level.name())
}

fn figure(name: impl Into<String>, value: f64, unit: &'static str) -> Figure {
    Figure { name: name.into(), value, unit }
}

/// Rods drawn at random, each solved once, from rest.
fn bank() -> Result<Vec<Figure>, BenchError> {
    let (settings, mut workspace) = (Settings::default(), Workspace::default());
    let (mut times, mut unsolved, mut unstable) = (Vec::new(), 0.0, 0.0);
    for number in 0..bank::RODS {
        let problem = bank::problem(number, 100, Order::Second)?;
        let start = Instant::now();
        let solution = black_box(solve(&problem, &settings, None, &mut workspace));
        times.push(start.elapsed().as_secs_f64() * 1e3);
        match solution {
            Ok(solution) if solution.report.morse_index == Some(0) => {}
            Ok(_) => unstable += 1.0,
            Err(_) => unsolved += 1.0,
        }
    }
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let mut of = |part| clock::quantile(&mut times, part);
    Ok(vec![
        figure("bank.mean", mean, "ms"),
        figure("bank.median", of(0.5), "ms"),
        figure("bank.p99", of(0.99), "ms"),
        figure("bank.worst", of(1.0), "ms"),
        figure("bank.unsolved", unsolved, "rods"),
        figure("bank.unstable", unstable, "rods"),
    ])
}

/// The named workloads: each frame's search from the frame before, 100 elements.
fn workloads() -> Result<Vec<Figure>, BenchError> {
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    let mut figures = Vec::new();
    for workload in strands_cases::workloads::all() {
        let (mut times, mut report) = (Vec::new(), SolveReport::default());
        let run = workload.run_with(100, Order::Second, &settings, |_, problem, guess, workspace| {
            let mut next = *guess;
            let start = Instant::now();
            black_box(follow(problem, &settings, &mut next, workspace, &mut report));
            times.push(start.elapsed().as_secs_f64());
            solve(problem, &settings, Some(&next), workspace)
        });
        run?;
        figures.push(figure(
            format!("{}.median", workload.name),
            clock::quantile(&mut times, 0.5) * 1e6,
            "µs",
        ));
        figures.push(figure(
            format!("{}.worst", workload.name),
            clock::quantile(&mut times, 1.0) * 1e6,
            "µs",
        ));
    }
    Ok(figures)
}

/// Elements of the rods that are swept.
const ELEMENTS: usize = 100;

/// Sweeps of the standard problem, by name.
const SWEEPS: [(&str, Order, Scheme, Kinematics); 5] = [
    ("order1", Order::First, Scheme::Element, Kinematics::Cosserat),
    ("order2", Order::Second, Scheme::Element, Kinematics::Cosserat),
    ("order2.kirchhoff", Order::Second, Scheme::Element, Kinematics::Kirchhoff),
    ("order4", Order::Fourth, Scheme::Element, Kinematics::Cosserat),
    ("multistep", Order::Second, Scheme::Multistep, Kinematics::Cosserat),
];

/// Each of them, ready to run.
fn sweep_runs() -> Result<Vec<Box<dyn FnMut()>>, BenchError> {
    let run = |(_, order, scheme, kinematics)| {
        let problem = problems::standard(ELEMENTS, order, kinematics)?;
        repeated(problem, Settings { scheme, ..Settings::default() }, None)
    };
    SWEEPS.into_iter().map(run).collect()
}

/// One sweep by each scheme.
fn sweeps() -> Result<Vec<Figure>, BenchError> {
    let times = clock::in_turn(&mut sweep_runs()?);
    let figures = SWEEPS.iter().zip(times).flat_map(|((name, ..), time)| {
        [
            figure(format!("sweep.{name}"), time * 1e6, "µs"),
            figure(format!("sweep.{name}.element"), time * 1e9 / ELEMENTS as f64, "ns"),
        ]
    });
    Ok(figures.collect())
}

/// The interactive solve: the last solution is the guess for the next place of the hand.
fn warm() -> Result<Vec<Figure>, BenchError> {
    let mut warm = Warm::of(Method::Auto, 100, 20_000)?;
    Ok(vec![
        figure("warm.median", clock::quantile(&mut warm.times, 0.5) * 1e6, "µs"),
        figure("warm.p999", clock::quantile(&mut warm.times, 0.999) * 1e6, "µs"),
        figure("warm.iterations", warm.iterations, "iterations"),
    ])
}

/// The same with all frames at once, and what an iteration costs for one of the six numbers of a node, as the rod gets longer.
fn all_at_once() -> Result<Vec<Figure>, BenchError> {
    let mut warm = Warm::of(Method::Equilibrium, 100, 5_000)?;
    let mut figures = vec![
        figure("equilibrium.warm.median", clock::quantile(&mut warm.times, 0.5) * 1e6, "µs"),
        figure("equilibrium.warm.p999", clock::quantile(&mut warm.times, 0.999) * 1e6, "µs"),
        figure("equilibrium.warm.factorisations", warm.factorisations, "factorisations"),
    ];
    for (elements, steps) in [(100, 2_000), (1_000, 200), (10_000, 20)] {
        let warm = Warm::of(Method::Equilibrium, elements, steps)?;
        let scalars = warm.factorisations * 6.0 * (elements + 1) as f64;
        let mean = warm.times.iter().sum::<f64>() / warm.times.len() as f64;
        figures.push(figure(format!("equilibrium.iteration.{elements}"), mean * 1e9 / scalars, "ns"));
    }
    Ok(figures)
}

/// Rods side by side against the same rods one after the other, their frames read.
fn side_by_side() -> Result<Vec<Figure>, BenchError> {
    const RODS: usize = 8;
    const STEPS: usize = 1_000;
    let settings = Settings { method: Method::Equilibrium, tolerance: 1e-10, ..Settings::default() };
    let problem = problems::held(ELEMENTS, problems::home())?;
    let mut batch = Batch::new(vec![problem.clone(); RODS], &settings)?;
    let mut alone = Vec::new();
    for _ in 0..RODS {
        let mut workspace = Workspace::default();
        let guess = solved(&problem, &settings, None, &mut workspace)?.guess;
        alone.push((problem.clone(), guess, workspace));
    }
    let (mut beside, mut apart) = (Vec::with_capacity(STEPS), Vec::with_capacity(STEPS));
    let (mut report, mut poses) = (SolveReport::default(), Vec::new());
    // Each hand goes the same way, some steps ahead of the one before.
    let places = problems::wander(STEPS + RODS);
    for step in 0..STEPS {
        for (rod, (problem, ..)) in alone.iter_mut().enumerate() {
            problem.end.pose = places[step + rod];
            *batch.end_mut(rod) = places[step + rod];
        }
        let start = Instant::now();
        black_box(batch.follow(&settings));
        for rod in 0..RODS {
            batch.read_poses(rod, &mut poses);
            black_box(&poses);
        }
        beside.push(start.elapsed().as_secs_f64() / RODS as f64);
        let start = Instant::now();
        for (problem, guess, workspace) in &mut alone {
            black_box(follow(problem, &settings, guess, workspace, &mut report));
        }
        apart.push(start.elapsed().as_secs_f64() / RODS as f64);
    }
    let (beside, apart) = (clock::quantile(&mut beside, 0.5), clock::quantile(&mut apart, 0.5));
    Ok(vec![figure("batch.rod", beside * 1e6, "µs"), figure("batch.faster", apart / beside, "times")])
}

/// Searches while the hand wanders.
struct Warm {
    /// Of each search, s.
    times: Vec<f64>,
    /// Means of a search.
    iterations: f64,
    factorisations: f64,
}

impl Warm {
    fn of(method: Method, elements: usize, steps: usize) -> Result<Self, BenchError> {
        let settings = Settings { method, tolerance: 1e-10, ..Settings::default() };
        let mut workspace = Workspace::default();
        let mut problem = problems::held(elements, problems::home())?;
        let mut guess = solved(&problem, &settings, None, &mut workspace)?.guess;
        let mut report = SolveReport::default();
        let (mut times, mut iterations, mut factorisations) = (Vec::with_capacity(steps), 0, 0);
        for place in problems::wander(steps) {
            problem.end.pose = place;
            let start = Instant::now();
            let converged = black_box(follow(&problem, &settings, &mut guess, &mut workspace, &mut report));
            times.push(start.elapsed().as_secs_f64());
            if !converged {
                guess = solved(&problem, &settings, Some(&guess), &mut workspace)?.guess;
            }
            iterations += report.iterations;
            factorisations += report.factorisations;
        }
        let mean = |sum: usize| sum as f64 / steps as f64;
        Ok(Self { times, iterations: mean(iterations), factorisations: mean(factorisations) })
    }
}

/// One Jacobian by each of the four ways, over one sweep.
///
/// The library gives whole solves; the parts come from their differences. A solve that starts at its solution takes one sweep and no
/// Jacobian; one that starts where the hand was takes so many sweeps and Jacobians more.
fn jacobians() -> Result<Vec<Figure>, BenchError> {
    let ways = [
        ("variational_lanes", Jacobian::VariationalLanes),
        ("variational", Jacobian::Variational),
        ("finite_differences", Jacobian::FiniteDifferences),
        ("finite_difference_lanes", Jacobian::FiniteDifferenceLanes),
    ];
    let settings = |jacobian| Settings { jacobian, tolerance: 1e-10, ..Settings::default() };
    let mut workspace = Workspace::default();
    let mut problem = problems::held(100, problems::home())?;
    let guess = solved(&problem, &settings(Jacobian::default()), None, &mut workspace)?.guess;
    // Without the Jacobian that it was found with.
    let guess = Guess::new(guess.pose, guess.wrench);
    problem.end.pose = problems::wander(1)[0];
    let moved = solved(&problem, &settings(Jacobian::default()), Some(&guess), &mut workspace)?;

    let mut runs = vec![repeated(problem.clone(), settings(Jacobian::default()), Some(moved.guess))?];
    for (_, way) in ways {
        runs.push(repeated(problem.clone(), settings(way), Some(guess))?);
    }
    let times = clock::in_turn(&mut runs);
    let (none, by_way) = (times[0], &times[1..]);
    let (sweeps, jacobians) = (moved.report.sweeps as f64 - 1.0, moved.report.jacobians as f64);
    // By finite differences a Jacobian is six sweeps and hardly more, which gives the time of one sweep.
    let sweep = (by_way[2] - none) / (sweeps + 6.0 * jacobians);
    let figures = ways.iter().zip(by_way).map(|((name, _), time)| {
        figure(format!("jacobian.{name}"), (time - none - sweeps * sweep) / (jacobians * sweep), "sweeps")
    });
    Ok(figures.collect())
}

/// The cost of an element against how many there are.
fn cost() -> Result<Vec<Figure>, BenchError> {
    let sizes = [50, 100, 200, 500, 1000, 2000, 5000];
    let mut runs = Vec::new();
    for elements in sizes {
        runs.push(repeated(
            problems::standard(elements, Order::Second, Kinematics::Cosserat)?,
            Settings::default(),
            None,
        )?);
    }
    let times = clock::in_turn(&mut runs);
    let each: Vec<f64> = sizes.iter().zip(times).map(|(n, time)| time * 1e9 / *n as f64).collect();
    let best = each.iter().copied().fold(f64::INFINITY, f64::min);
    let worst = each.iter().copied().fold(0.0, f64::max);
    let mut figures: Vec<Figure> =
        sizes.iter().zip(&each).map(|(n, value)| figure(format!("cost.{n}"), *value, "ns")).collect();
    figures.push(figure("cost.worst_over_best", worst / best, "ratio"));
    Ok(figures)
}

fn solved(
    problem: &Problem,
    settings: &Settings,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
) -> Result<Solution, BenchError> {
    solve(problem, settings, guess, workspace).map_err(|failure| BenchError::Solve(Box::new(failure)))
}

/// A run that searches again and again: from a guess, or, without one, a single sweep from any end.
fn repeated(
    problem: Problem,
    settings: Settings,
    guess: Option<Guess>,
) -> Result<Box<dyn FnMut()>, BenchError> {
    let mut workspace = Workspace::default();
    solved(&problem, &settings, guess.as_ref(), &mut workspace)?;
    let once = Settings { max_iterations: 0, ..settings };
    let settings = if guess.is_some() { settings } else { once };
    Ok(again(problem, settings, guess.unwrap_or(Guess::new(Pose::IDENTITY, Wrench::ZERO))))
}

/// The same search each time.
fn again(problem: Problem, settings: Settings, start: Guess) -> Box<dyn FnMut()> {
    let (mut workspace, mut report) = (Workspace::default(), SolveReport::default());
    Box::new(move || {
        let mut guess = start;
        black_box(follow(black_box(&problem), &settings, &mut guess, &mut workspace, &mut report));
    })
}
