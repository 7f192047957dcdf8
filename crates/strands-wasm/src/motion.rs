//! A scene in motion: its rods step by step in time, and what is grabbed of them.
//!
//! [`Motion`] stands beside [`Session`](crate::Session). The page says how much time has passed, and gets back as many steps as that makes and as
//! its budget allows. What it draws lies between the last two steps, so that slow motion is smooth.

mod bodies;
mod grab;
mod obstacles;
mod pace;
mod rods;

use crate::numbers::flat;
use grab::Grab;
use pace::Pace;
use rods::Borne;
use strands::math::{Pose, Quat, Vec3};
use wasm_bindgen::prelude::*;

pub use rods::Rods;

#[wasm_bindgen]
unsafe extern "C" {
    /// The worker's clock, ms.
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// A scene in motion.
#[wasm_bindgen]
pub struct Motion {
    moving: Moving,
}

#[wasm_bindgen]
impl Motion {
    /// Puts the rods of a scene where its `[dynamics]` says that they start.
    ///
    /// # Errors
    /// The message of what is wrong in the scene, or why a rod of it cannot move.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, file_name: &str) -> Result<Motion, String> {
        Ok(Self { moving: Moving::open(text, file_name)? })
    }

    /// The rods as JSON: `[{ name, nodes }, …]`. All flat arrays hold one rod after the other in this order.
    pub fn rods(&self) -> String {
        self.moving.rods.named().to_string()
    }

    /// What the bodies look like, as JSON: `[{ name, shape }, …]`. A shape is of the `kind` `ball`, `capsule` or `cylinder`, with its `radius` and, of the
    /// last two, the `length` along the third axis, a `block` with its `size`, the edges along its axes, or a `ring` about the third axis, with the `radius` of its
    /// centre line and the `wire_radius`, m. A body that has none is a ball of 2,000 kg/m³.
    pub fn body_shapes(&self) -> String {
        self.moving.bodies.to_string()
    }

    /// What the obstacles look like, as JSON: `[shape, …]`. A shape is of the `kind` `plane`, with a `point` and the `normal`; `capsule` or `cylinder`, with the
    /// `ends` of its axis and the `radius`; `tube`, the inside of one without end, with a `point` and the direction of its `axis`, and its `radius`; `ring`, with its middle
    /// as `point`, its `axis`, the `radius` of its centre line and the `wire_radius`; or `mesh`, with
    /// its `corners`, three numbers each, and the numbers of those of its `triangles`, m. A ball is a capsule whose ends are the same.
    pub fn obstacles(&self) -> String {
        self.moving.obstacles.to_string()
    }

    /// Half extents along `d1` and `d2` at each node, m.
    pub fn half_extent(&self) -> Vec<f64> {
        self.moving.rods.half_extent()
    }

    /// Lets so much time pass, s, for at most `budget` ms of the clock; time for which there are no means is given up. Gives whether
    /// every step was made. One that was not leaves the rods as they were, and says why in the [`report`](Motion::report).
    pub fn advance(&mut self, seconds: f64, budget: f64) -> bool {
        self.moving.advance(seconds, budget, now)
    }

    /// Makes one step, and gives whether it was made.
    pub fn step(&mut self) -> bool {
        self.moving.advance_by_one(now)
    }

    /// Goes back to the start, to the same bits. What was grabbed is let go.
    pub fn rewind(&mut self) {
        self.moving.rewind();
    }

    /// Lets the air around move, m/s. Only rods with drag feel it.
    pub fn set_wind(&mut self, x: f64, y: f64, z: f64) {
        self.moving.rods.set_wind(Vec3::new(x, y, z));
    }

    /// Takes hold of a node of a rod, where it is. A number that there is not is ignored.
    pub fn grab(&mut self, rod: usize, node: usize) {
        self.moving.grab(rod, node);
    }

    /// Moves the hand that has grabbed: position in m, orientation as a quaternion.
    #[expect(clippy::too_many_arguments, reason = "plain numbers cross to JavaScript without allocating")]
    pub fn pull(&mut self, x: f64, y: f64, z: f64, qw: f64, qx: f64, qy: f64, qz: f64) {
        if let Some(orientation) = Quat::from_wxyz([qw, qx, qy, qz]) {
            self.moving.pull(Pose::from_parts(Vec3::new(x, y, z), orientation));
        }
    }

    /// Lets go: what was free flies on, and what was held firmly stays where it was brought.
    pub fn release(&mut self) {
        self.moving.release();
    }

    /// The frames of the nodes of all rods, between the last two steps: twelve numbers each, `d1 d2 d3` and the position.
    pub fn frames(&self) -> Vec<f64> {
        flat(&self.moving.shown())
    }

    /// The frames of the bodies at that time, in the same way, in the order of [`body_shapes`](Motion::body_shapes).
    pub fn bodies(&self) -> Vec<f64> {
        flat(&self.moving.shown_bodies())
    }

    /// What touched in the last step: nine numbers each, the point (m), the unit normal, and the force (N) along which it pushes and rubs, on the rod or on the first of two.
    pub fn contacts(&self) -> Vec<f64> {
        obstacles::flat(self.moving.rods.contacts())
    }

    /// What rods pass through, eyelets and holes: nine numbers each, where the rod is in it (m) between the last two steps, to where its force has drawn the edge, the
    /// unit direction of the rod there, and the force on the rod (N) in the last step.
    pub fn passages(&self) -> Vec<f64> {
        self.moving.shown_passages()
    }

    /// What the elements of all rods bear, body frame: first their strains, six numbers each, then moments and forces, six numbers each, and last their
    /// elastic energy per length, J/m.
    pub fn borne(&self) -> Vec<f64> {
        let Borne { strain, stress, energy_density } = self.moving.rods.borne();
        [strain, stress, energy_density].concat()
    }

    /// How it goes, as JSON: `time` (s), `time_step` (s), `steps` (since the start), `behind` (how much of the time that was to pass has been given up
    /// since the start, s), the energies `kinetic`, `elastic`, `load`, `dissipated` and `worked`, what hands have put in (J), of the last step `iterations` and `residual`, `step_ms` (what
    /// a step of the last call took, null where it made none), `failure` (why the last step was not made, or null), and `grabbed`: `{ rod, node,
    /// force }` (the force that the hand exerts, N) or null.
    pub fn report(&self) -> String {
        self.moving.report()
    }
}

/// What is behind [`Motion`].
struct Moving {
    rods: Rods,
    /// What the bodies look like.
    bodies: serde_json::Value,
    /// And the obstacles.
    obstacles: serde_json::Value,
    grab: Option<Grab>,
    pace: Pace,
    failure: Option<String>,
}

impl Moving {
    fn open(text: &str, file_name: &str) -> Result<Self, String> {
        let model = crate::session::read(text, file_name)?.model;
        Ok(Self {
            rods: Rods::of(&model)?,
            bodies: bodies::drawn(&model),
            obstacles: obstacles::drawn(&model),
            grab: None,
            pace: Pace::default(),
            failure: None,
        })
    }

    fn advance(&mut self, seconds: f64, budget: f64, clock: impl Fn() -> f64) -> bool {
        let due = self.pace.due(seconds, self.rods.time_step());
        let began = clock();
        for made in 0..due {
            if made > 0 && clock() - began >= budget {
                self.pace.give_up(due - made, self.rods.time_step());
                return self.count(made, clock() - began);
            }
            if !self.one() {
                self.count(made, clock() - began);
                return false;
            }
        }
        self.count(due, clock() - began)
    }

    fn advance_by_one(&mut self, clock: impl Fn() -> f64) -> bool {
        let began = clock();
        let made = self.one();
        self.count(usize::from(made), clock() - began);
        self.pace.stop();
        made
    }

    fn count(&mut self, made: usize, milliseconds: f64) -> bool {
        self.pace.made(made, milliseconds);
        true
    }

    /// One step of all rods.
    fn one(&mut self) -> bool {
        if let Some(grab) = &mut self.grab {
            grab.follow(&mut self.rods);
        }
        self.failure = self.rods.step().err();
        if let Some(grab) = self.grab.as_mut().filter(|_| self.failure.is_some()) {
            grab.slip(&mut self.rods);
            self.failure = self.rods.step().err();
        }
        self.failure.is_none()
    }

    fn rewind(&mut self) {
        self.grab = None;
        self.rods.rewind();
        self.pace = Pace::default();
        self.failure = None;
    }

    fn grab(&mut self, rod: usize, node: usize) {
        self.release();
        self.grab = Grab::of(&mut self.rods, rod, node);
    }

    fn pull(&mut self, hand: Pose) {
        if let Some(grab) = &mut self.grab {
            grab.target = hand;
        }
    }

    fn release(&mut self) {
        if let Some(grab) = self.grab.take() {
            grab.let_go(&mut self.rods);
        }
    }

    fn shown(&self) -> Vec<Pose> {
        self.rods.between(self.pace.part(self.rods.time_step()))
    }

    fn shown_bodies(&self) -> Vec<Pose> {
        self.rods.bodies_between(self.pace.part(self.rods.time_step()))
    }

    fn shown_passages(&self) -> Vec<f64> {
        self.rods.rings(self.pace.part(self.rods.time_step()))
    }

    fn report(&self) -> String {
        let (energy, last) = (self.rods.energy(), self.rods.last_step());
        let grabbed = self.grab.as_ref().map(|grab| {
            let force = grab.force(&self.rods).to_array();
            serde_json::json!({ "rod": grab.rod, "node": grab.node, "force": force })
        });
        serde_json::json!({
            "time": self.rods.time(),
            "time_step": self.rods.time_step(),
            "steps": self.pace.steps,
            "behind": self.pace.behind,
            "kinetic": energy.kinetic,
            "elastic": energy.elastic,
            "load": energy.load,
            "dissipated": energy.dissipated,
            "worked": energy.worked,
            "iterations": last.iterations,
            "residual": last.residual,
            "step_ms": self.pace.step_ms,
            "failure": self.failure,
            "grabbed": grabbed,
        })
        .to_string()
    }
}

#[cfg(test)]
mod tests;
