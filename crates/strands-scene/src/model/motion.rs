//! What moves in a scene, and how steps are made.

use super::{Model, ModelBody, ModelRod};
use crate::file::IntegratorName;
use strands::assembly::{Assembly, JointKind, Keyframes, Member, Strand};
use strands::contact::Obstacle;
use strands::dynamics::{self, Integrator, Simulation, SimulationError, Start};
use strands::math::{Pose, Vec3, Vec6};
use strands::rod::Kinematics;

/// What generalised-α leaves after a step of a motion that is much faster, where the scene does not say it.
const SPECTRAL_RADIUS: f64 = 0.5;

/// Iterations of a step in which surfaces touch.
const CONTACT_ITERATIONS: usize = 60;

/// Frames a second, where the scene does not say it.
pub const OUTPUT_RATE: f64 = 60.0;

impl Model {
    /// Its rods, bodies and joints, what moves them and what slows them down, to simulate.
    pub fn assembly(&self) -> Assembly {
        let rods = self.rods.iter().enumerate().flat_map(|(number, rod)| rod.moving(number));
        let bodies = self.bodies.iter().enumerate().filter_map(|(number, body)| body.moving(number));
        Assembly {
            strands: self.rods.iter().map(ModelRod::strand).collect(),
            bodies: self.bodies.iter().map(|body| body.body.clone()).collect(),
            joints: self.joints.clone(),
            moving: rods.chain(bodies).collect(),
            wind: self.wind,
            surfaces: self.surfaces,
            obstacles: self.obstacles.iter().cloned().chain(self.body_surfaces()).collect(),
            eyelets: self.eyelets.clone(),
        }
    }

    /// The surfaces of bodies, which are touched as obstacles that move.
    fn body_surfaces(&self) -> impl Iterator<Item = Obstacle> {
        let surface = |(body, of): (usize, &ModelBody)| {
            let shape = of.shape.as_ref()?.surface();
            Some(Obstacle { shape, friction: None, body: Some(body), tissue: of.tissue })
        };
        self.bodies.iter().enumerate().filter_map(surface)
    }

    /// The body that a surface of the [assembly](Model::assembly) is of, where it is none of the scene's obstacles.
    pub fn body_of_surface(&self, obstacle: usize) -> Option<&ModelBody> {
        let at = obstacle.checked_sub(self.obstacles.len())?;
        self.bodies.iter().filter(|body| body.shape.is_some()).nth(at)
    }

    /// Where its `[dynamics]` says that motion starts, and in equilibrium where they say nothing; `None` where they name the file of a saved state.
    pub fn start(&self) -> Option<Start> {
        match self.dynamics.start.as_deref().unwrap_or("equilibrium") {
            "equilibrium" => Some(Start::Equilibrium),
            "rest" => Some(Start::Rest),
            "initial" => Some(Start::Shape(self.starts())),
            _ => None,
        }
    }

    /// The frames of the initial shapes of rods, or at rest where they have none, and of bodies at rest.
    pub(crate) fn starts(&self) -> Vec<Pose> {
        let rods = self.rods.iter().flat_map(ModelRod::starts);
        rods.chain(self.bodies.iter().map(|body| body.body.pose)).collect()
    }

    /// Where all starts. From rest, or its initial shapes, it sets off as the scene says.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn simulation(
        &self,
        settings: dynamics::Settings,
        start: Start,
    ) -> Result<Simulation, SimulationError> {
        let sets_off = match &start {
            Start::Rest => self.velocities(),
            Start::Shape(shape) => self.velocities_in(shape),
            Start::Equilibrium | Start::State(_) => None,
        };
        let mut simulation = Simulation::new(self.assembly(), settings, start)?;
        if let Some(velocities) = sets_off {
            simulation.set_velocities(&velocities);
        }
        Ok(simulation)
    }

    /// The first rod that does not stretch.
    pub fn inextensible(&self) -> Option<&ModelRod> {
        self.rods.iter().find(|rod| rod.problem.rod.kinematics() == Kinematics::Kirchhoff)
    }

    /// How steps are made. What the scene does not say is as in [`dynamics::Settings::default`]; steps that are chosen by their error are no longer than
    /// from one frame of the output to the next.
    pub fn motion(&self) -> dynamics::Settings {
        let (written, default) = (&self.dynamics, dynamics::Settings::default());
        let chosen = written.tolerance.is_some();
        let integrator = match written.integrator {
            None if self.surfaces.is_some() => Integrator::ImplicitEuler,
            None if chosen && self.inextensible().is_none() => Integrator::Sdirk4,
            None if chosen => Integrator::TrBdf2,
            None => default.integrator,
            Some(IntegratorName::Bdf2) => Integrator::Bdf2,
            Some(IntegratorName::ImplicitEuler) => Integrator::ImplicitEuler,
            Some(IntegratorName::GeneralizedAlpha) => Integrator::GeneralizedAlpha {
                spectral_radius: written.spectral_radius.unwrap_or(SPECTRAL_RADIUS),
            },
            Some(IntegratorName::Midpoint) => Integrator::Midpoint,
            Some(IntegratorName::Sdirk4) => Integrator::Sdirk4,
            Some(IntegratorName::TrBdf2) => Integrator::TrBdf2,
        };
        // What touches may come to it by and by.
        let most = if self.surfaces.is_some() { CONTACT_ITERATIONS } else { default.max_iterations };
        let longest =
            if chosen { 1.0 / written.output_rate.unwrap_or(OUTPUT_RATE) } else { default.time_step };
        dynamics::Settings {
            integrator,
            time_step: written.time_step.unwrap_or(longest),
            local_error: written.tolerance,
            // What is left over of a step is not to be taken for its error.
            tolerance: written
                .tolerance
                .map_or(default.tolerance, |error| default.tolerance.min(1e-2 * error)),
            bounded: written.newton_iterations.is_some(),
            max_iterations: written.newton_iterations.unwrap_or(most),
            mass_damping: written.mass_damping.unwrap_or(default.mass_damping),
        }
    }

    /// How all frames of the [`assembly`](Self::assembly) set off where the motion starts from rest, for
    /// [`set_velocities`](Simulation::set_velocities): bodies as they say, rods at rest but for the nodes that joints tie to such a body.
    /// `None` where nothing sets off.
    pub fn velocities(&self) -> Option<Vec<Vec6>> {
        self.velocities_in(&self.assembly().rest_poses())
    }

    /// The same where all frames are these.
    fn velocities_in(&self, rest: &[Pose]) -> Option<Vec<Vec6>> {
        let still = |body: &ModelBody| body.velocity == Vec3::ZERO && body.angular_velocity == Vec3::ZERO;
        if self.bodies.iter().all(still) {
            return None;
        }
        let assembly = self.assembly();
        let mut velocities = vec![Vec6::ZERO; rest.len()];
        let first = assembly.first_body();
        for (body, frame) in self.bodies.iter().zip(first..) {
            let angular = rest[frame].rotation.transpose_mul(body.angular_velocity);
            velocities[frame] = Vec6::new(angular, body.velocity);
        }
        for joint in &self.joints {
            let [a, b] = joint.between.map(|attachment| attachment.member);
            let ((Member::Body(body), node @ Member::Node { .. })
            | (node @ Member::Node { .. }, Member::Body(body))) = (a, b)
            else {
                continue;
            };
            let Some(frame) = assembly.frame(node) else { continue };
            let of = &self.bodies[body];
            let arm = rest[frame].position - rest[first + body].position;
            // About a ball the rod's end need not turn with the body.
            let spin = if joint.kind == JointKind::Ball { Vec3::ZERO } else { of.angular_velocity };
            velocities[frame] = Vec6::new(
                rest[frame].rotation.transpose_mul(spin),
                of.velocity + of.angular_velocity.cross(arm),
            );
        }
        Some(velocities)
    }
}

impl ModelRod {
    fn strand(&self) -> Strand {
        Strand {
            problem: self.problem.clone(),
            viscosity: self.damping,
            drag: self.drag,
            mass_matrix: self.mass_matrix,
        }
    }

    /// The frames that motion starts from: of its initial shape, or at rest.
    pub(crate) fn starts(&self) -> Vec<Pose> {
        let rod = &self.problem.rod;
        self.initial.as_ref().map_or_else(|| rod.rest_poses().to_vec(), |initial| initial.poses(rod))
    }

    /// How its supports move, where it is the rod of a number.
    fn moving(&self, rod: usize) -> Vec<Keyframes> {
        let mesh = &self.problem.rod;
        let unheld = self.starts();
        let moving = self.supports.iter().filter(|held| !held.motion.is_empty());
        let keyframes = moving.filter_map(|held| {
            let node = mesh.mesh().node_at(held.s)?;
            held.keyframes(Member::Node { rod, node }, unheld[node])
        });
        keyframes.collect()
    }
}

impl ModelBody {
    /// How its support moves, where it is the body of a number.
    fn moving(&self, body: usize) -> Option<Keyframes> {
        self.held.as_ref()?.keyframes(Member::Body(body), self.body.pose)
    }
}
