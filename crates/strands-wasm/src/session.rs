//! The state behind a session: a scene, the hand, and the last good solutions.

use strands::coupling::{Grip, LastFrame, VirtualCoupling};
use strands::math::{Mat3, Pose, Strain, Vec3, Wrench};
use strands::rod::Kinematics;
use strands::statics::{End, Guess, Problem, Settings, Solution, SolveReport, Workspace, solve};
use strands_scene::{FixName, Model, ModelRod, Place, Scene, SceneFile, SupportFile};

use crate::settle::{Bit, Start, Way, within};

/// How the hand holds the rod's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandMode {
    /// As the scene has it.
    Scene,
    /// The hand imposes its frame.
    Pose,
    /// The hand holds on through a spring and damper.
    Coupling,
    /// Nobody holds it.
    Free,
}

const MODES: [(&str, HandMode); 4] = [
    ("scene", HandMode::Scene),
    ("pose", HandMode::Pose),
    ("coupling", HandMode::Coupling),
    ("free", HandMode::Free),
];

impl HandMode {
    pub fn from_name(name: &str) -> Option<Self> {
        MODES.iter().find(|(known, _)| *known == name).map(|(_, mode)| *mode)
    }

    pub fn name(self) -> &'static str {
        MODES.iter().find(|(_, mode)| *mode == self).map_or("", |(name, _)| name)
    }

    /// Whether the hand says where the end is, and not the end where the hand is.
    fn leads(self) -> bool {
        matches!(self, Self::Pose | Self::Coupling)
    }
}

/// How much of its length an inextensible thread is held at, at most.
const REACH: f64 = 0.985;

pub struct State {
    scene: Scene,
    solutions: Vec<Solution>,
    held: usize,
    workspace: Workspace,
    pub mode: HandMode,
    pub hand: Pose,
    pub coupling: VirtualCoupling,
    /// The hand of the last solution.
    last_hand: Pose,
    outcome: Outcome,
    /// What is left to try where the hand was not reached at once.
    way: Option<Way>,
    /// The shape that the scene opened with, where it is held.
    home: Option<Start>,
}

/// How the last solve went.
struct Outcome {
    report: SolveReport,
    reason: Option<String>,
    saturated: bool,
}

impl State {
    pub fn open(text: &str, file_name: &str) -> Result<Self, String> {
        let scene = read(text, file_name)?;
        let mut workspace = Workspace::default();
        let solutions = solve_all(&scene.model, &mut workspace)?;
        let held = scene.model.rods.iter().position(|rod| rod.hand.is_some()).unwrap_or(0);
        let rod = &scene.model.rods[held];
        let hand = tip(&solutions[held]);
        let coupling = rod.hand.unwrap_or_else(|| coupling_for(rod));
        let mode = if rod.problem.end.fixed == [true; 6] { HandMode::Pose } else { HandMode::Scene };
        let outcome = Outcome { report: solutions[held].report.clone(), reason: None, saturated: false };
        let home = Some(Start { guess: solutions[held].guess, hand });
        Ok(Self {
            scene,
            solutions,
            held,
            workspace,
            mode,
            hand,
            coupling,
            last_hand: hand,
            outcome,
            way: None,
            home,
        })
    }

    /// Puts an edited scene in place of this one. The hand stays, and the last solution is where the search starts.
    pub fn replace(&mut self, text: &str, file_name: &str) -> Result<(), String> {
        let same_rods = |scene: &Scene| scene.model.rods.len() == self.scene.model.rods.len();
        let scene = read(text, file_name)?;
        let guess = same_rods(&scene).then(|| self.solution().guess);
        self.put(scene, guess)
    }

    fn put(&mut self, scene: Scene, guess: Option<Guess>) -> Result<(), String> {
        let mut solutions = Vec::with_capacity(scene.model.rods.len());
        for (i, rod) in scene.model.rods.iter().enumerate() {
            let mut problem = rod.problem.clone();
            let guess = if i == self.held { guess } else { None };
            if i == self.held {
                problem.end = self.end(rod, 0.0);
            }
            match solve(&problem, &scene.model.settings, guess.as_ref(), &mut self.workspace) {
                Ok(solution) => solutions.push(solution),
                Err(failure) => return Err(format!("rod `{}`: {failure}", rod.name)),
            }
        }
        self.held = self.held.min(solutions.len() - 1);
        self.scene = scene;
        self.solutions = solutions;
        // The old home belongs to another rod.
        self.home = None;
        let report = self.solution().report.clone();
        self.reached(report);
        Ok(())
    }

    /// What [`restore`](State::restore) needs beside the scene's text: the hand, the coupling, and where the search starts.
    pub fn snapshot(&self) -> Vec<f64> {
        let guess = &self.solution().guess;
        let wrench = guess.wrench.to_array();
        let poses = [flat(&[self.hand]), flat(&[guess.pose])].concat();
        [poses, wrench.to_vec(), coupling_numbers(&self.coupling).to_vec()].concat()
    }

    /// Goes back to an earlier state.
    pub fn restore(&mut self, text: &str, mode: HandMode, numbers: &[f64]) -> Result<(), String> {
        let [hand, pose, wrench, coupling] = [0..12, 12..24, 24..30, 30..36].map(|range| numbers.get(range));
        let (Some(hand), Some(pose), Some(wrench), Some(coupling)) = (hand, pose, wrench, coupling) else {
            return Err(format!("a snapshot has 36 numbers, not {}", numbers.len()));
        };
        let scene = read(text, "scene.json")?;
        let wrench = Wrench::new(vector(&wrench[..3]), vector(&wrench[3..]));
        let before = (self.mode, self.hand, self.coupling);
        (self.mode, self.hand) = (mode, unflat(hand));
        self.coupling = coupling_from(coupling.try_into().unwrap_or([0.0; 6]));
        let restored = self.put(scene, Some(Guess::new(unflat(pose), wrench)));
        if restored.is_err() {
            (self.mode, self.hand, self.coupling) = before;
        }
        restored
    }

    pub fn file(&self) -> &SceneFile {
        &self.scene.file
    }

    /// The scene with the held rod's end fixed where the hand has brought it.
    pub fn file_with_hand(&self) -> SceneFile {
        let tip = tip(self.solution());
        let mut file = self.scene.file.clone();
        if self.mode.leads()
            && let Some(rod) = file.rods.get_mut(&self.rod().name)
        {
            rod.supports.retain(|support| support.at != Place::End);
            rod.supports.push(SupportFile {
                at: Place::End,
                fix: vec![FixName::Position, FixName::Orientation],
                position: Some(tip.position.to_array()),
                orientation: Some(tip.orientation().to_wxyz()),
            });
        }
        file
    }

    pub fn model(&self) -> &Model {
        &self.scene.model
    }

    pub fn rod(&self) -> &ModelRod {
        &self.scene.model.rods[self.held]
    }

    pub fn solution(&self) -> &Solution {
        &self.solutions[self.held]
    }

    pub fn named_solutions(&self) -> Vec<(&str, &Solution)> {
        self.scene.model.rods.iter().map(|rod| rod.name.as_str()).zip(&self.solutions).collect()
    }

    /// Solves the held rod for where the hand is, with one search from the last shape. Where that is not enough, [`settle`](State::settle)
    /// goes on. Without a hand that leads, nobody waits for the next frame: then the search may start again from rest.
    pub fn solve(&mut self, time_step: f64) -> bool {
        let mut problem = self.rod().problem.clone();
        problem.end = self.end(self.rod(), time_step);
        let leads = self.mode.leads();
        let whole = self.scene.model.settings;
        let settings =
            if leads { Settings { max_halvings: 0, restart_from_rest: false, ..whole } } else { whole };
        let last = self.solution();
        let (guess, stable) = (last.guess, last.report.morse_index == Some(0));
        let mut found = solve(&problem, &settings, Some(&guess), &mut self.workspace);
        let is_stable = |solution: &Solution| solution.report.morse_index == Some(0);
        if !leads
            && !found.as_ref().is_ok_and(is_stable)
            && let Ok(other) = solve(&problem, &whole, None, &mut self.workspace)
        {
            found = Ok(other);
        }
        match found {
            // A search that lost stability has landed on another branch: small steps may stay on this one.
            Ok(solution) if !leads || !stable || is_stable(&solution) => {
                self.take(solution, self.hand);
                true
            }
            Ok(unstable) => {
                let report = unstable.report.clone();
                self.set_out("the shape that was found is not stable".to_owned(), report, Some(unstable));
                false
            }
            Err(failure) => {
                self.set_out(failure.reason.to_string(), failure.nearest.report, None);
                false
            }
        }
    }

    /// Does a little more to get to the hand, and gives whether there is more to do.
    pub fn settle(&mut self) -> bool {
        let Some(mut way) = self.way.take() else { return false };
        let mut problem = self.rod().problem.clone();
        problem.end = self.end(self.rod(), 0.0);
        let hand = if self.mode == HandMode::Pose { problem.end.pose } else { self.hand };
        match way.walk(&problem, &hand, &self.scene.model.settings, &mut self.workspace) {
            Bit::Arrived(solution) => {
                self.take(solution, hand);
                return false;
            }
            Bit::Nearer(solution, hand) => {
                self.solutions[self.held] = solution;
                self.last_hand = hand;
            }
            Bit::Trying => {}
            Bit::Stuck => return false,
        }
        self.way = Some(way);
        true
    }

    fn take(&mut self, solution: Solution, hand: Pose) {
        let report = solution.report.clone();
        self.solutions[self.held] = solution;
        self.last_hand = hand;
        self.reached(report);
    }

    fn reached(&mut self, report: SolveReport) {
        self.way = None;
        if !self.mode.leads() {
            self.hand = tip(self.solution());
        }
        let end = self.end(self.rod(), 0.0);
        let saturated = end.grip.is_some_and(|grip| grip.saturated(&tip(self.solution())));
        self.outcome = Outcome { report, reason: None, saturated };
    }

    fn set_out(&mut self, reason: String, report: SolveReport, unstable: Option<Solution>) {
        let last = Start { guess: self.solution().guess, hand: self.last_hand };
        let others = if self.mode.leads() { self.home.into_iter().collect() } else { Vec::new() };
        self.way = Some(Way::new(last, self.solution().clone(), others, unstable));
        self.outcome = Outcome { report, reason: Some(reason), saturated: false };
    }

    /// How the hand holds a rod's end now.
    fn end(&self, rod: &ModelRod, time_step: f64) -> End {
        match self.mode {
            HandMode::Scene => rod.problem.end.clone(),
            HandMode::Free => End::free(tip(self.solution())),
            HandMode::Pose => End::clamped(reachable(rod, &self.hand)),
            HandMode::Coupling => {
                let held = tip(self.solution());
                let last = (time_step > 0.0).then_some(LastFrame { hand: self.last_hand, held, time_step });
                End::gripped(Grip { coupling: self.coupling, hand: self.hand, last })
            }
        }
    }

    /// How far the hand is from what the thread reaches, m: more than nothing only where the thread cannot stretch to it.
    fn beyond(&self) -> f64 {
        let held = reachable(self.rod(), &self.hand);
        if self.mode == HandMode::Pose { (self.hand.position - held.position).norm() } else { 0.0 }
    }

    pub fn frames(&self) -> Vec<f64> {
        flat(&self.solution().poses)
    }

    pub fn other_frames(&self) -> Vec<f64> {
        let others = self.solutions.iter().enumerate().filter(|(i, _)| *i != self.held);
        others.flat_map(|(_, solution)| flat(&solution.poses)).collect()
    }

    /// Elastic energy per length of each element of the held rod, J/m.
    pub fn energy_density(&self) -> Vec<f64> {
        let rod = &self.rod().problem.rod;
        let density = |(e, strain): (usize, &Strain)| {
            let points = rod.points(e);
            let sum: f64 = points.iter().map(|point| point.law.energy(*strain - point.rest)).sum();
            sum / points.len() as f64
        };
        self.solution().strain.iter().enumerate().map(density).collect()
    }

    pub fn report(&self) -> String {
        let Outcome { report, reason, saturated } = &self.outcome;
        let solution = self.solution();
        let [start, end] = solution.reactions.map(|reaction| {
            serde_json::json!({ "force": reaction.force.to_array(), "moment": reaction.moment.to_array() })
        });
        serde_json::json!({
            "status": if reason.is_none() { "converged" } else { "failed" },
            "reason": reason,
            "settling": self.way.is_some(),
            "mode": self.mode.name(),
            "beyond": self.beyond(),
            "method": report.method.name(),
            "iterations": report.iterations,
            "residual": report.residual,
            "sweeps": report.sweeps,
            "path_steps": report.path_steps,
            "morse_index": report.morse_index,
            "elements": solution.strain.len(),
            "energy": solution.energy.elastic + solution.energy.load,
            "elastic_energy": solution.energy.elastic,
            "saturated": saturated,
            "start": start,
            "end": end,
        })
        .to_string()
    }
}

fn read(text: &str, file_name: &str) -> Result<Scene, String> {
    let mut scene = Scene::parse(text, file_name, None).map_err(|error| error.to_string())?;
    scene.model = scene.model.refined().map_err(|error| error.to_string())?;
    Ok(scene)
}

fn solve_all(model: &Model, workspace: &mut Workspace) -> Result<Vec<Solution>, String> {
    let solved = model.rods.iter().map(|rod| {
        solve(&rod.problem, &model.settings, None, workspace)
            .map_err(|failure| format!("rod `{}`: {failure}", rod.name))
    });
    solved.collect()
}

fn tip(solution: &Solution) -> Pose {
    solution.poses[solution.poses.len() - 1]
}

/// A coupling for a scene that gives none: stiff beside the rod, and limited to ten times what buckles it.
fn coupling_for(rod: &ModelRod) -> VirtualCoupling {
    let scale = rod.problem.rod.scale();
    VirtualCoupling {
        linear_stiffness: 200.0 * scale.force / scale.length,
        angular_stiffness: 20.0 * scale.moment,
        linear_damping: 0.0,
        angular_damping: 0.0,
        max_force: 400.0 * scale.force,
        max_torque: 40.0 * scale.moment,
    }
}

/// Where the end of a rod can be held for a hand.
fn reachable(rod: &ModelRod, hand: &Pose) -> Pose {
    let Problem { rod, start, .. } = &rod.problem;
    let tethered = rod.kinematics() == Kinematics::Kirchhoff && start.fixed[3..] == [true; 3];
    if tethered { within(hand, start.pose.position, REACH * rod.length()) } else { *hand }
}

pub fn coupling_numbers(c: &VirtualCoupling) -> [f64; 6] {
    [c.linear_stiffness, c.angular_stiffness, c.linear_damping, c.angular_damping, c.max_force, c.max_torque]
}

pub fn coupling_from(numbers: [f64; 6]) -> VirtualCoupling {
    let [linear_stiffness, angular_stiffness, linear_damping, angular_damping, max_force, max_torque] =
        numbers;
    VirtualCoupling {
        linear_stiffness,
        angular_stiffness,
        linear_damping,
        angular_damping,
        max_force,
        max_torque,
    }
}

fn vector(numbers: &[f64]) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

fn unflat(numbers: &[f64]) -> Pose {
    let [d1, d2, d3, position] = [0, 3, 6, 9].map(|i| vector(&numbers[i..i + 3]));
    Pose { rotation: Mat3 { cols: [d1, d2, d3] }, position }
}

fn flat(poses: &[Pose]) -> Vec<f64> {
    let parts = |pose: &Pose| {
        let [d1, d2, d3] = pose.rotation.cols;
        [d1, d2, d3, pose.position].map(|v| v.to_array()).into_iter().flatten().collect::<Vec<f64>>()
    };
    poses.iter().flat_map(parts).collect()
}

#[cfg(test)]
mod tests;
