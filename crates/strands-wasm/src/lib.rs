//! What the page calls: a scene that a hand can hold, solved frame by frame.
//!
//! [`Session`] keeps a scene, its last good solution and the hand. The page moves the hand and calls [`Session::solve`]; shapes come back as flat
//! arrays of numbers, everything else as JSON. Errors are the texts that a person reads. [`Motion`] is the same scene moving in time.

mod bench;
mod hand;
mod motion;
mod numbers;
mod session;
mod settle;
mod snap;

use hand::HandMode;
use numbers::flat;
use session::State;
use strands::math::{Pose, Quat, Vec3};
use strands_scene::ModelRod;
use wasm_bindgen::prelude::*;

pub use bench::bench;
pub use motion::Motion;

/// The bundled scenes as JSON: `[{ name, title, text }, …]`.
#[wasm_bindgen]
pub fn bundled() -> String {
    let scenes: Vec<_> = strands_scene::bundled()
        .iter()
        .map(|scene| serde_json::json!({ "name": scene.name, "title": scene.title, "text": scene.text }))
        .collect();
    serde_json::Value::from(scenes).to_string()
}

/// A scene, its last good solution, and the hand.
#[wasm_bindgen]
pub struct Session {
    state: State,
}

#[wasm_bindgen]
impl Session {
    /// Opens a scene. The file name's ending tells TOML from JSON.
    ///
    /// # Errors
    /// The message of what is wrong in the scene.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, file_name: &str) -> Result<Session, String> {
        Ok(Self { state: State::open(text, file_name)? })
    }

    /// Puts an edited scene in place of this one; the last solution is where the next search starts, and the hand stays.
    ///
    /// # Errors
    /// The message of what is wrong in the scene; the session is then as it was.
    pub fn replace(&mut self, text: &str, file_name: &str) -> Result<(), String> {
        self.state.replace(text, file_name)
    }

    /// The scene as JSON.
    pub fn scene_json(&self) -> String {
        self.state.file().to_json()
    }

    /// The scene as TOML, with the hand's place as the end's support where the hand holds it.
    pub fn scene_toml(&self) -> String {
        self.state.file_with_hand().to_toml()
    }

    /// How the hand holds the rod's end: `"pose"` imposes its frame, `"coupling"` holds it through a spring and damper, `"scene"`
    /// leaves the end as the scene has it, `"free"` lets go.
    ///
    /// # Errors
    /// Where the mode is none of these, or the spring too soft for what has held the rod so far.
    pub fn set_mode(&mut self, mode: &str) -> Result<(), String> {
        let known = HandMode::from_name(mode).ok_or_else(|| format!("there is no hand mode `{mode}`"))?;
        self.state.set_mode(known)
    }

    /// Moves the hand: position in m, orientation as a quaternion. A quaternion without length is ignored.
    #[expect(clippy::too_many_arguments, reason = "plain numbers cross to JavaScript without allocating")]
    pub fn set_hand(&mut self, x: f64, y: f64, z: f64, qw: f64, qx: f64, qy: f64, qz: f64) {
        if let Some(orientation) = Quat::from_wxyz([qw, qx, qy, qz]) {
            self.state.hand = Pose::from_parts(Vec3::new(x, y, z), orientation);
        }
    }

    /// Where the hand is: `[x, y, z, qw, qx, qy, qz]`.
    pub fn hand(&self) -> Vec<f64> {
        let hand = &self.state.hand;
        [&hand.position.to_array()[..], &hand.orientation().to_wxyz()].concat()
    }

    /// Sets the coupling: stiffness (N/m, N·m/rad), damping (N·s/m, N·m·s/rad), limits (N, N·m; infinite where there is none).
    ///
    /// # Errors
    /// The first number that a scene could not have either; the coupling is then as it was.
    pub fn set_coupling(
        &mut self,
        kx: f64,
        kr: f64,
        dx: f64,
        dr: f64,
        max_force: f64,
        max_torque: f64,
    ) -> Result<(), String> {
        self.state.set_coupling([kx, kr, dx, dr, max_force, max_torque])
    }

    /// The coupling as `[kx, kr, dx, dr, max_force, max_torque]`.
    pub fn coupling(&self) -> Vec<f64> {
        self.state.coupling().to_vec()
    }

    /// Solves for where the hand is now, with one search. `time_step` (s) is what has passed since the last solve, for the damper. Gives
    /// whether it converged; where not, the last good shape stays, and [`settle`](Session::settle) goes on.
    pub fn solve(&mut self, time_step: f64) -> bool {
        self.state.solve(time_step)
    }

    /// Does a little more to get to a hand that one search did not reach, and gives whether there is more to do.
    pub fn settle(&mut self) -> bool {
        self.state.settle()
    }

    /// Whether the thread has snapped over to another equilibrium in the last solve, or the last bit of the way.
    pub fn snapped(&self) -> bool {
        self.state.snapped()
    }

    /// The hand, the coupling and the solution in numbers that [`restore`](Session::restore) takes back.
    pub fn snapshot(&self) -> Vec<f64> {
        self.state.snapshot()
    }

    /// Goes back to a state: the scene as JSON, the hand's mode, and a snapshot.
    ///
    /// # Errors
    /// The message of what is wrong; the session is then as it was.
    pub fn restore(&mut self, text: &str, mode: &str, numbers: &[f64]) -> Result<(), String> {
        let known = HandMode::from_name(mode).ok_or_else(|| format!("there is no hand mode `{mode}`"))?;
        self.state.restore(text, known, numbers)
    }

    /// The frames of the held rod's nodes: twelve numbers each, `d1 d2 d3` and the position.
    pub fn frames(&self) -> Vec<f64> {
        flat(&self.state.solution().poses)
    }

    /// The names of the rods that the hand does not hold.
    pub fn other_names(&self) -> Vec<String> {
        self.state.others().map(|(rod, _)| rod.name.clone()).collect()
    }

    /// The frames of the nodes of one of these rods, in the same way.
    pub fn other_frames(&self, index: usize) -> Vec<f64> {
        self.state.others().nth(index).map_or_else(Vec::new, |(_, solution)| flat(&solution.poses))
    }

    /// Its half extents along `d1` and `d2` at each node, m.
    pub fn other_half_extent(&self, index: usize) -> Vec<f64> {
        self.state.others().nth(index).map_or_else(Vec::new, |(rod, _)| half_extent(rod))
    }

    /// Strains of the held rod's elements, six numbers each, body frame.
    pub fn strain(&self) -> Vec<f64> {
        self.state.solution().strain.iter().flat_map(|strain| strain.to_array()).collect()
    }

    /// Stresses of the held rod's elements, six numbers each, body frame.
    pub fn stress(&self) -> Vec<f64> {
        self.state.solution().stress.iter().flat_map(|stress| stress.to_array()).collect()
    }

    /// Elastic energy per length of the held rod's elements, J/m.
    pub fn energy_density(&self) -> Vec<f64> {
        self.state.energy_density()
    }

    /// Half extents of the held rod along `d1` and `d2` at each node, m.
    pub fn half_extent(&self) -> Vec<f64> {
        half_extent(self.state.rod())
    }

    /// How the last solve went, as JSON: `rod` (the name of the held one), `status`, `reason`, `method`, `iterations`, `residual`, `sweeps`, `path_steps`, `morse_index`, `energy`,
    /// `saturated`, `moves_only` (whether joints tie the rods: they are shown where they start to move, and what holds them is not known), `settling` (whether there is more to do), `snapped` (whether the thread has just snapped over to another equilibrium), `mode`, `beyond` (how far the hand is out of reach, m), the reactions `start` and `end`,
    /// each `{ force, moment }` in world axes, and the same of the supports `between` them, with the `node` that each holds.
    pub fn report(&self) -> String {
        self.state.report()
    }

    /// The shape as CSV.
    pub fn shape_csv(&self) -> String {
        let model = self.state.model();
        strands_scene::write::csv(model, &self.state.named_solutions())
    }

    /// The shape as GLB.
    pub fn shape_glb(&self) -> Vec<u8> {
        let model = self.state.model();
        strands_scene::write::glb(model, &self.state.named_solutions())
    }
}

fn half_extent(rod: &ModelRod) -> Vec<f64> {
    rod.problem.rod.half_extent().iter().flatten().copied().collect()
}
