//! The state behind a session: a scene, the hand, and the last good solutions.

use strands::coupling::{Grip, LastFrame, VirtualCoupling};
use strands::math::Pose;
use strands::statics::{End, Guess, Settings, Solution, SolveReport, Workspace, solve};
use strands_scene::{FixName, Model, ModelRod, Place, Scene, SceneFile, SupportFile};

/// How the hand holds the rod's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandMode {
    /// As the scene has it.
    Scene,
    /// The hand imposes its frame.
    Pose,
    /// The hand holds on through a spring and damper.
    Coupling,
}

impl HandMode {
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "scene" => Some(Self::Scene),
            "pose" => Some(Self::Pose),
            "coupling" => Some(Self::Coupling),
            _ => None,
        }
    }
}

/// How often a frame may halve its way to the hand before it gives up until the next one.
const HALVINGS_IN_A_FRAME: usize = 3;

pub struct State {
    scene: Scene,
    solutions: Vec<Solution>,
    held: usize,
    workspace: Workspace,
    pub mode: HandMode,
    pub hand: Pose,
    pub coupling: VirtualCoupling,
    last_hand: Pose,
    outcome: Outcome,
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
        Ok(Self { scene, solutions, held, workspace, mode, hand, coupling, last_hand: hand, outcome })
    }

    pub fn replace(&mut self, text: &str, file_name: &str) -> Result<(), String> {
        let scene = read(text, file_name)?;
        let same_rods = scene.model.rods.len() == self.scene.model.rods.len();
        let guess = same_rods.then(|| self.solution().guess);
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
        let report = self.solution().report.clone();
        self.outcome = Outcome { report, reason: None, saturated: false };
        Ok(())
    }

    pub fn file(&self) -> &SceneFile {
        &self.scene.file
    }

    /// The scene with the held rod's end fixed where the hand is.
    pub fn file_with_hand(&self) -> SceneFile {
        let mut file = self.scene.file.clone();
        if self.mode == HandMode::Pose
            && let Some(rod) = file.rods.get_mut(&self.rod().name)
        {
            rod.supports.retain(|support| support.at != Place::End);
            rod.supports.push(SupportFile {
                at: Place::End,
                fix: vec![FixName::Position, FixName::Orientation],
                position: Some(self.hand.position.to_array()),
                orientation: Some(self.hand.orientation().to_wxyz()),
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

    /// Solves the held rod for where the hand is.
    pub fn solve(&mut self, time_step: f64) -> bool {
        let mut problem = self.rod().problem.clone();
        problem.end = self.end(self.rod(), time_step);
        let settings = Settings {
            max_halvings: HALVINGS_IN_A_FRAME,
            restart_from_rest: false,
            ..self.scene.model.settings
        };
        let guess: Guess = self.solution().guess;
        let (reason, report) = match solve(&problem, &settings, Some(&guess), &mut self.workspace) {
            Ok(solution) => {
                let report = solution.report.clone();
                self.solutions[self.held] = solution;
                self.last_hand = self.hand;
                (None, report)
            }
            Err(failure) => (Some(failure.reason.to_string()), failure.nearest.report),
        };
        let saturated = problem.end.grip.is_some_and(|grip| grip.saturated(&tip(self.solution())));
        let converged = reason.is_none();
        self.outcome = Outcome { report, reason, saturated };
        converged
    }

    /// How the hand holds a rod's end now.
    fn end(&self, rod: &ModelRod, time_step: f64) -> End {
        match self.mode {
            HandMode::Scene => rod.problem.end.clone(),
            HandMode::Pose => End::clamped(self.hand),
            HandMode::Coupling => {
                let held = tip(self.solution());
                let last = (time_step > 0.0).then_some(LastFrame { hand: self.last_hand, held, time_step });
                End::gripped(Grip { coupling: self.coupling, hand: self.hand, last })
            }
        }
    }

    pub fn frames(&self) -> Vec<f64> {
        flat(&self.solution().poses)
    }

    pub fn other_frames(&self) -> Vec<f64> {
        let others = self.solutions.iter().enumerate().filter(|(i, _)| *i != self.held);
        others.flat_map(|(_, solution)| flat(&solution.poses)).collect()
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

fn flat(poses: &[Pose]) -> Vec<f64> {
    let parts = |pose: &Pose| {
        let [d1, d2, d3] = pose.rotation.cols;
        [d1, d2, d3, pose.position].map(|v| v.to_array()).into_iter().flatten().collect::<Vec<f64>>()
    };
    poses.iter().flat_map(parts).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use strands::math::{Quat, Vec3};

    fn suture() -> State {
        let scene = strands_scene::bundled_scene("suture").unwrap();
        State::open(scene.text, "suture.toml").unwrap()
    }

    #[test]
    fn a_dragged_suture_follows_the_hand_and_keeps_its_shape_out_of_reach() {
        let mut state = suture();
        let start = state.hand;
        for i in 1..=60 {
            let a = f64::from(i) / 60.0;
            let turn = Quat::from_rotation_vector(Vec3::new(0.0, 0.0, 0.8 * a)).to_matrix();
            state.hand.position = start.position + Vec3::new(-0.03 * a, 0.02 * a, 0.02 * a);
            state.hand.rotation = start.rotation * turn;
            assert!(state.solve(0.0), "frame {i}: {}", state.report());
            assert!((tip(state.solution()).position - state.hand.position).norm() < 1e-9);
        }
        let good = state.frames();
        state.hand.position = Vec3::new(0.0, 0.0, 2.0);
        assert!(!state.solve(0.0));
        assert!(state.report().contains("out of reach"));
        assert_eq!(good, state.frames());
    }

    #[test]
    fn the_coupling_saturates_when_the_hand_pulls_past_the_length() {
        let mut state = suture();
        state.mode = HandMode::Coupling;
        let start = state.hand;
        let mut saturated = false;
        for i in 1..=120 {
            state.hand.position = start.position + Vec3::new(0.004 * f64::from(i), 0.0, 0.0);
            state.solve(1.0 / 60.0);
            saturated |= state.outcome.saturated;
        }
        assert!(saturated, "{}", state.report());
    }

    #[test]
    fn an_edited_scene_starts_from_the_last_shape() {
        let mut state = suture();
        let text = state.file().to_toml().replace("poisson_ratio = 0.4", "poisson_ratio = 0.3");
        state.replace(&text, "suture.toml").unwrap();
        assert_eq!(state.outcome.report.path_steps, 1);
        assert!(state.replace("nonsense = 1", "suture.toml").unwrap_err().contains("nonsense"));
    }
}
