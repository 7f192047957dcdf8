//! The state behind a session: a scene, the hand, and the last good solutions.

use strands::coupling::{Grip, LastFrame, VirtualCoupling};
use strands::math::{Pose, Quat, Strain, Wrench};
use strands::statics::{
    Guess, Problem, Reaction, Solution, SolveReport, Support, Workspace, recall, rest_from, solve,
};
use strands_scene::{CouplingFile, FixName, HandFile, Model, ModelRod, Place, Scene, SceneFile, SupportFile};

use crate::hand::{HandMode, coupling_for, reachable};
use crate::motion::Rods;
use crate::numbers::{coupling_numbers, flat, hand_from, unflat, vector};
use crate::settle::{Bit, LARGEST_TURN, Start, Way, is_stable, largest_turn, search};
use crate::snap::{Motion, is_far, is_small};

pub struct State {
    scene: Scene,
    solutions: Vec<Solution>,
    held: usize,
    workspace: Workspace,
    mode: HandMode,
    pub hand: Pose,
    coupling: VirtualCoupling,
    /// The hand of the last solution.
    last_hand: Pose,
    outcome: Outcome,
    /// What is left to try where the hand was not reached at once.
    way: Option<Way>,
    /// Whether no other branch was found since the hand was last reached: looking again would hold up the hand in vain.
    stuck: bool,
    /// Whether the thread has snapped over in the last solve or bit of the way.
    snapped: bool,
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
        let leads = rod.problem.end.fixed == [true; 6] && !scene.model.moves_only();
        let mode = if leads { HandMode::Pose } else { HandMode::Scene };
        let outcome = Outcome { report: solutions[held].report.clone(), reason: None, saturated: false };
        let home = Some(Start::new(&solutions[held], hand, false));
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
            stuck: false,
            snapped: false,
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
        // A text that went through the page may have its rods in another order.
        let held = scene.model.rods.iter().position(|rod| rod.name == self.rod().name).unwrap_or(0);
        let solutions = if scene.model.moves_only() {
            solve_all(&scene.model, &mut self.workspace)?
        } else {
            self.solve_anew(&scene.model, held, guess)?
        };
        self.held = held;
        self.scene = scene;
        self.solutions = solutions;
        self.snapped = false;
        // The old home belongs to another rod.
        self.home = None;
        let report = self.solution().report.clone();
        self.reached(report);
        Ok(())
    }

    /// Solves all rods, one of which the hand holds.
    fn solve_anew(
        &mut self,
        model: &Model,
        held: usize,
        guess: Option<Guess>,
    ) -> Result<Vec<Solution>, String> {
        let mut solutions = Vec::with_capacity(model.rods.len());
        for (i, rod) in model.rods.iter().enumerate() {
            let mut problem = rod.problem.clone();
            let guess = if i == held { guess } else { None };
            if i == held {
                problem.end = self.end(rod, 0.0);
            }
            let solved = solve(&problem, &model.settings, guess.as_ref(), &mut self.workspace);
            solutions.push(solved.map_err(|failure| format!("rod `{}`: {failure}", rod.name))?);
        }
        Ok(solutions)
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
        // The scene may have none, where nobody has changed it.
        let coupling = hand_from(&self.rod().name, coupling.try_into().unwrap_or([0.0; 6]));
        let before = (self.mode, self.hand, self.coupling);
        self.coupling = checked(&coupling)?;
        (self.mode, self.hand) = (mode, unflat(hand));
        let restored = self.put(scene, Some(Guess::new(unflat(pose), wrench)));
        if restored.is_err() {
            (self.mode, self.hand, self.coupling) = before;
        }
        restored
    }

    /// Changes how the hand holds on. A spring takes hold where it does what has held the thread so far, so that nothing moves.
    ///
    /// # Errors
    /// Where the spring is so soft that there is no such place, and where joints tie the rods; the mode is then as it was.
    pub fn set_mode(&mut self, mode: HandMode) -> Result<(), String> {
        if self.moves_only() {
            return Err(
                "joints tie the rods of this scene: let it move, and take hold of them there".to_owned()
            );
        }
        if mode == HandMode::Coupling && self.mode != mode {
            let (held, reaction) = (tip(self.solution()), *self.solution().end_reaction());
            let by_turn = reaction.moment * (1.0 / self.coupling.angular_stiffness);
            let by_shift = reaction.force * (1.0 / self.coupling.linear_stiffness);
            if !(by_turn.is_finite() && by_shift.is_finite()) {
                return Err("the hand's spring is too soft to hold the thread: make it stiffer".to_owned());
            }
            self.hand = Pose {
                rotation: Quat::from_rotation_vector(by_turn).to_matrix() * held.rotation,
                position: held.position + by_shift,
            };
            self.last_hand = self.hand;
        }
        self.mode = mode;
        self.way = None;
        Ok(())
    }

    /// The coupling's stiffness, damping and limits in [the page's order](coupling_numbers).
    pub fn coupling(&self) -> [f64; 6] {
        coupling_numbers(&self.coupling)
    }

    /// Sets the coupling, and writes it into the scene.
    ///
    /// # Errors
    /// The first number that a scene could not have either; the coupling is then as it was.
    pub fn set_coupling(&mut self, numbers: [f64; 6]) -> Result<(), String> {
        let hand = hand_from(&self.rod().name, numbers);
        self.coupling = checked(&hand)?;
        self.scene.model.rods[self.held].hand = Some(self.coupling);
        self.scene.file.coupling = Some(CouplingFile { hand });
        Ok(())
    }

    /// Whether its rods come to rest by moving only, and the shapes are those that they start to move from.
    pub fn moves_only(&self) -> bool {
        self.scene.model.moves_only()
    }

    pub fn file(&self) -> &SceneFile {
        &self.scene.file
    }

    /// The scene with the held rod's end fixed where the hand has brought it, however the scene has held it.
    pub fn file_with_hand(&self) -> SceneFile {
        let tip = tip(self.solution());
        let length = self.rod().problem.rod.length();
        let mut file = self.scene.file.clone();
        if self.mode.leads()
            && let Some(rod) = file.rods.get_mut(&self.rod().name)
        {
            rod.supports.retain(|support| !support.at.is_end(length));
            rod.supports.push(SupportFile {
                at: Place::End,
                fix: vec![FixName::Position, FixName::Orientation],
                position: Some(tip.position.to_array()),
                orientation: Some(tip.orientation().to_wxyz()),
                slide_along: None,
                turn_about: None,
                motion: Vec::new(),
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

    /// Solves the held rod for where the hand is, with one search from the last shape. Where its branch ends or loses its stability, the thread
    /// is let move on to where it rests. Where that is not enough, [`settle`](State::settle) goes on. Without a hand that leads nobody waits for the next frame, and the thread comes to rest as one that starts from rest.
    pub fn solve(&mut self, time_step: f64) -> bool {
        // They stay where they are shown.
        if self.moves_only() {
            return true;
        }
        let mut problem = self.rod().problem.clone();
        problem.end = self.end(self.rod(), time_step);
        let whole = self.scene.model.settings;
        self.snapped = false;
        let found = if self.mode.leads() {
            if !problem.between.is_empty() {
                // What the supports between bear is not in the guess.
                recall(&problem, &self.solutions[self.held], &mut self.workspace);
            }
            let guess = self.last_start().guess_at(&problem.end);
            search(&problem, &whole, guess, &mut self.workspace)
        } else {
            let guess = self.solution().guess;
            solve(&problem, &whole, None, &mut self.workspace)
                .or_else(|_| solve(&problem, &whole, Some(&guess), &mut self.workspace))
                .map_err(|failure| Box::new((failure.reason, failure.nearest.report)))
        };
        // The stability of a thread on a spring says nothing of the branch that it is on.
        let may_be_unstable = self.mode != HandMode::Pose || self.solution().report.morse_index != Some(0);
        match found {
            Ok(solution) if !self.has_left(&solution) => {
                self.take(solution, self.aim());
                true
            }
            _ if self.move_on(&problem) => true,
            // A search that lost stability has landed on another branch: small steps may stay on this one.
            Ok(solution) if may_be_unstable || solution.report.morse_index == Some(0) => {
                self.take(solution, self.aim());
                true
            }
            Ok(unstable) => {
                let report = unstable.report.clone();
                self.set_out("the shape that was found is not stable".to_owned(), report, Some(unstable));
                false
            }
            Err(miss) => {
                let (reason, report) = *miss;
                self.set_out(reason.to_string(), report, None);
                false
            }
        }
    }

    /// Whether a search has left the branch that the thread is on, or this one has lost its stability.
    fn has_left(&self, found: &Solution) -> bool {
        if !self.mode.leads() {
            return false;
        }
        let last = self.solution();
        // On a spring the thread may have been unstable from the start, as it was taken hold of.
        let was_stable = self.mode == HandMode::Pose || last.report.morse_index == Some(0);
        let hand = largest_turn(&[self.last_hand], &[self.aim()]);
        was_stable && !is_stable(found) || largest_turn(&last.poses, &found.poses) > hand + LARGEST_TURN
    }

    /// Lets the thread move on from its last shape to where it rests with the hand where it is now. Gives whether it came to rest.
    fn move_on(&mut self, problem: &Problem) -> bool {
        let aim = self.aim();
        let within = self.beyond() == 0.0 && is_small(&self.last_hand, &aim, problem.rod.length());
        if !self.mode.leads() || self.stuck || !within {
            return false;
        }
        let settings = &self.scene.model.settings;
        let rests = rest_from(problem, settings, &self.solutions[self.held], &mut self.workspace);
        let Some(found) = rests.ok().filter(is_stable) else { return false };
        self.snapped = self.is_snap(&found, &aim);
        self.take(found, aim);
        true
    }

    /// Whether a shape is far from the last one, beyond what the hand has done since.
    fn is_snap(&self, found: &Solution, hand: &Pose) -> bool {
        let motion = Motion::of(&self.last_hand, hand);
        is_far(&self.solution().poses, &found.poses, motion, self.rod().problem.rod.length())
    }

    /// Whether the thread has snapped over in the last solve or bit of the way.
    pub fn snapped(&self) -> bool {
        self.snapped
    }

    /// Does a little more to get to the hand, and gives whether there is more to do.
    pub fn settle(&mut self) -> bool {
        let Some(mut way) = self.way.take() else { return false };
        let mut problem = self.rod().problem.clone();
        problem.end = self.end(self.rod(), 0.0);
        let hand = self.aim();
        self.snapped = false;
        match way.walk(&problem, &hand, &self.scene.model.settings, &mut self.workspace) {
            Bit::Arrived(solution) => {
                self.snapped = way.jumped && self.is_snap(&solution, &hand);
                self.take(solution, hand);
                return false;
            }
            Bit::Nearer(solution, hand) => {
                self.snapped = way.jumped && self.is_snap(&solution, &hand);
                self.solutions[self.held] = solution;
                self.last_hand = hand;
            }
            Bit::Trying => {}
            Bit::Stuck => {
                // Out of reach no other branch was looked for.
                self.stuck |= self.beyond() == 0.0;
                return false;
            }
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
        self.stuck = false;
        if !self.mode.leads() {
            self.hand = tip(self.solution());
            self.last_hand = self.hand;
        }
        let end = self.end(self.rod(), 0.0);
        let saturated = end.grip.is_some_and(|grip| grip.saturated(&tip(self.solution())));
        self.outcome = Outcome { report, reason: None, saturated };
    }

    fn set_out(&mut self, reason: String, report: SolveReport, unstable: Option<Solution>) {
        let last = self.last_start();
        let others = if self.mode.leads() { self.home.into_iter().collect() } else { Vec::new() };
        // Pulled taut a thread has no other branch: a start from rest would hold up the next hand in vain.
        let may_snap = !self.stuck && self.beyond() == 0.0;
        self.way = Some(Way::new(last, self.solution().clone(), others, unstable, may_snap));
        self.outcome = Outcome { report, reason: Some(reason), saturated: false };
    }

    /// How the hand holds a rod's end now.
    fn end(&self, rod: &ModelRod, time_step: f64) -> Support {
        match self.mode {
            HandMode::Scene => rod.problem.end.clone(),
            HandMode::Free => Support::free(tip(self.solution())),
            HandMode::Pose => Support::clamped(reachable(rod, &self.hand)),
            HandMode::Coupling => {
                let held = tip(self.solution());
                let last = (time_step > 0.0).then_some(LastFrame { hand: self.last_hand, held, time_step });
                Support::gripped(Grip { coupling: self.coupling, hand: self.hand, last })
            }
        }
    }

    /// The last shape as one to start from.
    fn last_start(&self) -> Start {
        Start::new(self.solution(), self.last_hand, self.outcome.saturated)
    }

    /// Where the hand wants the end: within the reach of a thread that it holds firmly.
    fn aim(&self) -> Pose {
        if self.mode == HandMode::Pose { reachable(self.rod(), &self.hand) } else { self.hand }
    }

    /// How far the hand is from what the thread reaches, m: more than nothing only where the thread cannot stretch to it.
    fn beyond(&self) -> f64 {
        (self.hand.position - self.aim().position).norm()
    }

    /// The rods that the hand does not hold, with their shapes.
    pub fn others(&self) -> impl Iterator<Item = (&ModelRod, &Solution)> {
        let all = self.scene.model.rods.iter().zip(&self.solutions).enumerate();
        all.filter(|(i, _)| *i != self.held).map(|(_, rod)| rod)
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
        let json = |reaction: &Reaction| serde_json::json!({ "force": reaction.force.to_array(), "moment": reaction.moment.to_array() });
        let [start, end] = [solution.start_reaction(), solution.end_reaction()].map(json);
        let held = self.rod().problem.between.iter().zip(&solution.reactions[1..]);
        let between: Vec<_> = held
            .map(|((node, _), reaction)| {
                let mut support = json(reaction);
                support["node"] = (*node).into();
                support
            })
            .collect();
        serde_json::json!({
            "rod": self.rod().name,
            "status": if reason.is_none() { "converged" } else { "failed" },
            "reason": reason,
            "moves_only": self.moves_only(),
            "settling": self.way.is_some(),
            "snapped": self.snapped,
            "mode": self.mode.name(),
            "beyond": self.beyond(),
            "method": report.method.name(),
            "iterations": report.iterations,
            "residual": report.residual,
            "sweeps": report.sweeps,
            "path_steps": report.path_steps,
            "morse_index": report.morse_index,
            "elements": solution.strain.len(),
            "energy": solution.energy.total(),
            "elastic_energy": solution.energy.elastic,
            "saturated": saturated,
            "start": start,
            "end": end,
            "between": between,
        })
        .to_string()
    }
}

fn checked(hand: &HandFile) -> Result<VirtualCoupling, String> {
    hand.coupling().map_err(|error| error.to_string())
}

pub fn read(text: &str, file_name: &str) -> Result<Scene, String> {
    let mut scene = Scene::parse(text, file_name, None).map_err(|error| error.to_string())?;
    // A tolerance needs where each rod rests.
    if !scene.model.moves_only() {
        scene.model = scene.model.refined().map_err(|error| error.to_string())?;
    }
    Ok(scene)
}

/// Where each rod rests; rods that come to rest by moving only are where they start to.
fn solve_all(model: &Model, workspace: &mut Workspace) -> Result<Vec<Solution>, String> {
    if model.moves_only() {
        return Ok(Rods::of(model)?.shapes());
    }
    let solved = model.rods.iter().map(|rod| {
        solve(&rod.problem, &model.settings, None, workspace)
            .map_err(|failure| format!("rod `{}`: {failure}", rod.name))
    });
    solved.collect()
}

fn tip(solution: &Solution) -> Pose {
    solution.poses[solution.poses.len() - 1]
}

#[cfg(test)]
mod tests;
