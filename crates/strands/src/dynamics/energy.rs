//! Where the energy of what moves is, and what holds it.

use super::newton::RodSystem;
use super::{Simulation, passages};
use crate::assembly::Member;
use crate::math::{Pose, Vec3, Vec6, Wrench};
use crate::rod::{NodeInertia, exponents};
use crate::statics::Support;

/// The energy of an assembly, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Of its motion.
    pub kinetic: f64,
    /// Stored in it.
    pub elastic: f64,
    /// Of dead loads and pulls, gravity among them.
    pub load: f64,
    /// Taken out of it by damping and drag since the start: less than nothing where wind has put in more.
    pub dissipated: f64,
    /// Put into it by supports, hands and loads that follow since the start.
    pub worked: f64,
}

impl Budget {
    /// What stays the same where the integrator takes nothing away and adds nothing: all that there is and was taken out, less what was put in.
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.load + self.dissipated - self.worked
    }
}

/// How fast energy goes through what is not conservative, W, or how much of it went, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Out of the assembly by damping and drag.
    pub dissipated: f64,
    /// Into it by supports, hands and loads that follow.
    pub worked: f64,
}

impl Power {
    /// Adds the energy that goes in so long a time, s.
    pub fn add(&mut self, power: Self, seconds: f64) {
        self.dissipated += power.dissipated * seconds;
        self.worked += power.worked * seconds;
    }
}

impl Simulation {
    /// Where the energy is now.
    pub fn energy(&self) -> Budget {
        let state = &self.state;
        let (mut elastic, mut load) = (0.0, 0.0);
        for (rod, strand) in self.assembly.strands.iter().enumerate() {
            let poses = &state.poses[self.assembly.nodes(rod)];
            let points = strand.problem.rod.diagonal_points().unwrap_or_default();
            for (x, point) in exponents(poses).zip(points) {
                let strain = x - point.rest;
                elastic += 0.5 * squares_over(&strain.to_array(), &point.compliance.to_array());
            }
            load += strand.problem.loads.energy(poses);
        }
        elastic += passages::elastic(&self.assembly, &state.passages);
        for (body, pose) in self.assembly.bodies.iter().zip(&state.poses[self.assembly.first_body()..]) {
            load -= body.load.linear.dot(pose.position);
        }
        Budget { kinetic: self.kinetic(), elastic, load, dissipated: state.dissipated, worked: state.worked }
    }

    /// The energy of motion, J.
    fn kinetic(&self) -> f64 {
        let Self { state, work, .. } = self;
        let lumped = |i: usize| {
            let NodeInertia { mass, rotational } = work.inertia[i];
            let Wrench { angular, linear } = state.momenta[i].turned_back_by(&state.poses[i].rotation);
            let turning = squares_over(&angular.to_array(), &rotational.to_array());
            0.5 * (turning + linear.dot(linear) / mass)
        };
        // With momenta `p`, so that what is left over of them counts: `p·v − ½ v·M v`.
        let coupled = |system: &RodSystem| {
            let nodes = system.nodes();
            let less = system.couplings.less(|node| state.velocities[nodes.start + node]);
            let of = |i: usize| {
                let velocity = state.velocities[i];
                state.momenta[i].dot(twist(&state.poses[i], velocity))
                    - 0.5 * work.inertia[i].twice_energy(velocity)
            };
            nodes.map(of).sum::<f64>() + 0.5 * less
        };
        let rods = work.groups.iter().flat_map(|group| &group.rods).map(|system| {
            if system.couplings.is_empty() { system.nodes().map(lumped).sum() } else { coupled(system) }
        });
        let bodies = (self.assembly.first_body()..state.poses.len()).map(lumped);
        rods.sum::<f64>() + bodies.sum::<f64>()
    }

    /// The momentum of all, N·s, and the angular momentum about the first rod's base as it was described, N·m·s.
    pub fn momentum(&self) -> (Vec3, Vec3) {
        let moving = self.state.momenta.iter().zip(&self.state.poses);
        let sum = moving.fold(Wrench::ZERO, |sum, (momentum, pose)| {
            sum + momentum.wrench_from(pose.position - self.origin)
        });
        (sum.linear, sum.angular)
    }

    /// What held a frame at the end of the last step: force and moment about it, in the world; before the first step, what holds it if nothing accelerates.
    /// Zero where nothing holds it.
    pub fn reaction(&self, member: Member) -> Wrench {
        let held = self.assembly.support(member).is_some_and(|support| support.fixed.contains(&true));
        let Some(frame) = self.assembly.frame(member).filter(|_| held) else { return Wrench::ZERO };
        self.reaction_at(frame, self.state.poses[frame].position)
    }

    fn reaction_at(&self, frame: usize, place: Vec3) -> Wrench {
        for group in &self.work.groups {
            if let Some(left) = group.left_over(frame, place) {
                return left * -1.0;
            }
        }
        Wrench::ZERO
    }

    /// How fast energy goes through damping, drag, supports, hands and loads that follow at the stage that was solved last.
    pub(super) fn power(&self) -> Power {
        let (stage, assembly) = (&self.work.stage, &self.assembly);
        let mut power = Power::default();
        let systems = self.work.groups.iter().flat_map(|group| &group.rods);
        for system in systems {
            let RodSystem { rod, couplings, .. } = system;
            let strand = &assembly.strands[*rod];
            let problem = &strand.problem;
            if strand.viscosity > 0.0 {
                let points = problem.rod.diagonal_points().unwrap_or_default();
                let rates = stage.strain_rates[assembly.elements(*rod)].iter().zip(points);
                let squares =
                    rates.map(|(rate, point)| squares_over(&rate.to_array(), &point.compliance.to_array()));
                power.dissipated += strand.viscosity * squares.sum::<f64>();
            }
            let first = system.nodes().start;
            power.dissipated -=
                self.settings.mass_damping * couplings.less(|node| stage.velocity(first + node));
            for (node, support) in problem.supports() {
                power.worked += self.support_power(first + node, support);
            }
            for (node, load) in problem.loads.body.iter().enumerate() {
                let frame = first + node;
                let velocity = stage.velocity(frame);
                let along = self.work.poses[frame].rotation.transpose_mul(velocity.linear);
                power.worked += load.angular.dot(velocity.angular) + load.linear.dot(along);
            }
        }
        for (body, of) in assembly.bodies.iter().enumerate() {
            if let Some(support) = &of.support {
                power.worked += self.support_power(assembly.first_body() + body, support);
            }
        }
        for (frame, inertia) in self.work.inertia.iter().enumerate() {
            power.dissipated += self.settings.mass_damping * inertia.twice_energy(stage.velocity(frame));
        }
        power.dissipated += self.work.contacts.power(self.work.stage.of_rate);
        let drags = stage.drags.iter().enumerate();
        power.dissipated -= drags.map(|(frame, force)| force.dot(stage.velocity(frame).linear)).sum::<f64>();
        power
    }

    fn support_power(&self, frame: usize, support: &Support) -> f64 {
        let (pose, velocity) = (&self.work.poses[frame], self.work.stage.velocity(frame));
        let mut exerts = support.grip.as_ref().map_or(Wrench::ZERO, |grip| grip.wrench(pose));
        if support.fixed.contains(&true) {
            exerts += self.reaction_at(frame, pose.position);
        }
        exerts.dot(twist(pose, velocity))
    }
}

/// A velocity with its turn in the world too.
fn twist(pose: &Pose, velocity: Vec6) -> Vec6 {
    Vec6::new(pose.rotation * velocity.angular, velocity.linear)
}

/// `Σ x²/y`, of what is free: a strain without compliance or a turn without inertia has no energy.
fn squares_over(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| if *y > 0.0 { x * x / y } else { 0.0 }).sum()
}
