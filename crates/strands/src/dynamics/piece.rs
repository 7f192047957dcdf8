//! A step, or a piece of it, by each integrator: its stages, and what the next one looks back on.

use super::energy::Power;
use super::holds::Held;
use super::integrator::{GeneralizedAlpha, IMPLICIT_EULER, Integrator, RungeKutta, SDIRK4, TR_BDF2};
use super::{Means, Past, Simulation, StepFailure, Taken, Work};
use crate::math::{Pose, Vec6, Wrench};

/// Where a method needs rates to begin with, two steps of backward Euler's method find them, each this part of a step long, or more where round-off asks for it,
/// and no more than that.
const BEGINNING: f64 = 1e-4;
const LONGEST_BEGINNING: f64 = 0.1;
/// Where that fails, so many times longer ones are tried.
const LONGER: f64 = 10.0;

/// A part of a step: where it begins and how long it is, over the whole.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub begin: f64,
    pub length: f64,
}

pub(super) const WHOLE: Piece = Piece { begin: 0.0, length: 1.0 };

impl Simulation {
    pub(super) fn piece(
        &mut self,
        integrator: Integrator,
        held: &Held,
        piece: Piece,
    ) -> Result<Taken, StepFailure> {
        match integrator {
            Integrator::ImplicitEuler => self.runge_kutta(&IMPLICIT_EULER, held, piece),
            Integrator::Sdirk4 => self.begin_with_rates(&SDIRK4, held, piece),
            Integrator::TrBdf2 => self.begin_with_rates(&TR_BDF2, held, piece),
            Integrator::Midpoint => self.midpoint(held, piece.begin + 0.5 * piece.length, piece.length),
            Integrator::Bdf2 | Integrator::GeneralizedAlpha { .. } if !self.looks_back(integrator) => {
                let (poses, momenta) = (self.state.poses.clone(), self.state.momenta.clone());
                let taken = self.begin_with_rates(&TR_BDF2, held, piece)?;
                self.look_back_on(integrator, poses, momenta);
                Ok(taken)
            }
            Integrator::Bdf2 => self.bdf2(held),
            Integrator::GeneralizedAlpha { spectral_radius } => self.generalized_alpha(spectral_radius, held),
        }
    }

    /// Whether there is what the integrator looks back on.
    fn looks_back(&self, integrator: Integrator) -> bool {
        match self.state.past {
            Past::Before { .. } => integrator == Integrator::Bdf2,
            Past::Rates { means: Some(_), .. } => matches!(integrator, Integrator::GeneralizedAlpha { .. }),
            Past::None | Past::Rates { means: None, .. } => false,
        }
    }

    /// After a step of another method gives the integrator what it looks back on.
    pub(super) fn look_back_on(&mut self, integrator: Integrator, poses: Vec<Pose>, momenta: Vec<Wrench>) {
        let Self { state, work, .. } = self;
        match integrator {
            Integrator::Bdf2 => state.past = Past::Before { poses, momenta },
            Integrator::GeneralizedAlpha { spectral_radius } => {
                let Past::Rates { momentum, strain, means } = &mut state.past else { return };
                // How long ago the rates were as their means are, over the step (Arnold, Brüls & Cardona 2015).
                let GeneralizedAlpha { alpha_m, alpha_f, .. } = GeneralizedAlpha::new(spectral_radius);
                let ago = alpha_f - alpha_m;
                let earlier = |now: Vec6, before: Vec6| now + (before - now) * ago;
                let Work { stage, coordinate_rates, momentum_rates, strain_rates, .. } = work;
                let velocity = stage.coordinate_rates.iter().zip(coordinate_rates).enumerate();
                let velocity = velocity
                    .map(|(i, (now, before))| stage.turned_with(i, &state.poses[i], earlier(*now, *before)));
                let mean = |now: &[Vec6], before: &[Vec6]| -> Vec<Vec6> {
                    now.iter().zip(before).map(|(now, before)| earlier(*now, *before)).collect()
                };
                *means = Some(Means {
                    velocity: velocity.collect(),
                    momentum: mean(momentum, momentum_rates),
                    strain: mean(strain, strain_rates),
                });
            }
            Integrator::ImplicitEuler | Integrator::Midpoint | Integrator::Sdirk4 | Integrator::TrBdf2 => {}
        }
    }

    /// A piece of a step of a method with an explicit stage, which begins with the rates that the last one ended with. Where it fails the state is not that
    /// before it.
    fn begin_with_rates(
        &mut self,
        method: &RungeKutta,
        held: &Held,
        piece: Piece,
    ) -> Result<Taken, StepFailure> {
        if matches!(self.state.past, Past::Rates { .. }) {
            return self.with_rates(method, held, piece);
        }
        // Velocities may jump now, where a support begins to move, and what holds it then exerts nearly an impulse: that is what the first short step is
        // for. The second one has what acts thereafter. What is heavy and hangs from what cannot stretch may need longer ones.
        let sure = self.shortest_stage() / (self.work.step * piece.length);
        let mut part = BEGINNING.max(sure).min(LONGEST_BEGINNING);
        let before = self.state.clone();
        loop {
            match self.beginning(method, held, piece, part) {
                Err(_) if part < LONGEST_BEGINNING => part = (LONGER * part).min(LONGEST_BEGINNING),
                made => return made.map_err(|failure| failure.in_step(before.time, self.work.step)),
            }
            self.state.clone_from(&before);
        }
    }

    fn beginning(
        &mut self,
        method: &RungeKutta,
        held: &Held,
        piece: Piece,
        part: f64,
    ) -> Result<Taken, StepFailure> {
        let (mut taken, mut rest) = (Taken::default(), piece);
        for _ in 0..2 {
            let short = Piece { begin: rest.begin, length: part * piece.length };
            taken.add(self.runge_kutta(&IMPLICIT_EULER, held, short)?);
            rest = Piece { begin: rest.begin + short.length, length: rest.length - short.length };
        }
        self.remember_rates();
        taken.add(self.with_rates(method, held, rest)?);
        Ok(taken)
    }

    fn with_rates(&mut self, method: &RungeKutta, held: &Held, piece: Piece) -> Result<Taken, StepFailure> {
        let taken = self.runge_kutta(method, held, piece)?;
        self.remember_rates();
        Ok(taken)
    }

    /// Keeps the rates of the stage that was solved last.
    pub(super) fn remember_rates(&mut self) {
        let Self { state, work: Work { stage, .. }, .. } = self;
        if !matches!(state.past, Past::Rates { .. }) {
            state.past = Past::Rates { momentum: Vec::new(), strain: Vec::new(), means: None };
        }
        if let Past::Rates { momentum, strain, means } = &mut state.past {
            momentum.clear();
            momentum.extend(stage.momentum_rates());
            strain.clone_from(&stage.strain_rates);
            *means = None;
        }
    }

    fn runge_kutta(&mut self, method: &RungeKutta, held: &Held, piece: Piece) -> Result<Taken, StepFailure> {
        let h = self.work.step * piece.length;
        let (frames, elements) = (self.state.poses.len(), self.state.wrenches.len());
        let (mut taken, mut lost, mut power) = (Taken::default(), Power::default(), Power::default());
        let mut weights = method.weights();
        let Self { state, work: Work { coordinate_rates, momentum_rates, strain_rates, .. }, .. } = self;
        coordinate_rates.clear();
        momentum_rates.clear();
        strain_rates.clear();
        if let (true, Past::Rates { momentum, strain, .. }) = (method.explicit, &state.past) {
            coordinate_rates.extend_from_slice(&state.velocities);
            momentum_rates.extend_from_slice(momentum);
            strain_rates.extend_from_slice(strain);
            lost.add(state.power, weights.next().unwrap_or_default() * h);
        }
        self.begin();
        for (number, before) in method.before.iter().enumerate() {
            let Work { stage, coordinate_rates, momentum_rates, strain_rates, .. } = &mut self.work;
            stage.set_up(method.diagonal * h, &self.state);
            for (j, a) in before.iter().enumerate() {
                let (of_frames, of_elements) =
                    (j * frames..(j + 1) * frames, j * elements..(j + 1) * elements);
                let (coordinates, momenta) =
                    (&coordinate_rates[of_frames.clone()], &momentum_rates[of_frames]);
                stage.add_history(a * h, coordinates, momenta, &strain_rates[of_elements]);
            }
            held.at(piece.begin + method.time(number) * piece.length, self);
            self.pierce_by_hand();
            let Work { level, stage, coordinate_rates, poses, .. } = &mut self.work;
            match coordinate_rates.len().checked_sub(frames) {
                None => stage.predict(&self.state.velocities, poses, *level),
                Some(last) => stage.predict(&coordinate_rates[last..], poses, *level),
            }
            taken.add(self.solve_stage()?);
            let Work { stage, coordinate_rates, momentum_rates, strain_rates, .. } = &mut self.work;
            coordinate_rates.extend_from_slice(&stage.coordinate_rates);
            strain_rates.extend_from_slice(&stage.strain_rates);
            momentum_rates.extend(stage.momentum_rates());
            power = self.power();
            lost.add(power, weights.next().unwrap_or_default() * h);
        }
        self.state.power = power;
        self.take(lost, h);
        Ok(taken)
    }

    fn bdf2(&mut self, held: &Held) -> Result<Taken, StepFailure> {
        let h = self.work.step;
        self.begin();
        let Self { state, work: Work { level, stage, viscous, .. }, .. } = self;
        stage.set_up(2.0 / 3.0 * h, state);
        let Past::Before { poses, momenta } = &state.past else {
            unreachable!("the step before is known where this is called")
        };
        stage.look_back((poses, momenta), &state.velocities, viscous, *level);
        held.at(1.0, self);
        let Work { level, stage, poses, .. } = &mut self.work;
        stage.follow(poses, *level);
        let taken = self.solve_stage()?;
        let lost = self.trapezoid(h);
        let state = &mut self.state;
        if let Past::Before { poses, momenta } = &mut state.past {
            poses.copy_from_slice(&state.poses);
            momenta.copy_from_slice(&state.momenta);
        }
        self.take(lost, h);
        Ok(taken)
    }

    fn generalized_alpha(&mut self, radius: f64, held: &Held) -> Result<Taken, StepFailure> {
        let GeneralizedAlpha { alpha_m, alpha_f, gamma } = GeneralizedAlpha::new(radius);
        let h = self.work.step;
        let of_now = gamma / (1.0 - alpha_m);
        self.begin();
        let stage = &mut self.work.stage;
        stage.set_up(of_now * (1.0 - alpha_f) * h, &self.state);
        if let Past::Rates { momentum, strain, means: Some(means) } = &self.state.past {
            let of_mean = h * (1.0 - gamma - of_now * alpha_m);
            stage.add_history(of_mean, &means.velocity, &means.momentum, &means.strain);
            stage.add_history(h * of_now * alpha_f, &self.state.velocities, momentum, strain);
        }
        held.at(1.0, self);
        let Work { level, stage, poses, .. } = &mut self.work;
        stage.predict(&self.state.velocities, poses, *level);
        let taken = self.solve_stage()?;
        let lost = self.trapezoid(h);
        let Self { state, work: Work { stage, poses, .. }, .. } = self;
        let mean = |now: Vec6, before: Vec6, mean: Vec6| {
            (now * (1.0 - alpha_f) + before * alpha_f - mean * alpha_m) * (1.0 / (1.0 - alpha_m))
        };
        if let Past::Rates { momentum, strain, means: Some(means) } = &mut state.past {
            for (e, rate) in stage.strain_rates.iter().enumerate() {
                means.strain[e] = mean(*rate, strain[e], means.strain[e]);
                strain[e] = *rate;
            }
            for (i, rate) in stage.momentum_rates().enumerate() {
                let velocity = mean(stage.coordinate_rates[i], state.velocities[i], means.velocity[i]);
                means.velocity[i] = stage.turned_with(i, &poses[i], velocity);
                means.momentum[i] = mean(rate, momentum[i], means.momentum[i]);
                momentum[i] = rate;
            }
        }
        self.take(lost, h);
        Ok(taken)
    }

    /// Begins a step, or a piece of it, in which viscous rods are those that are so now.
    pub(super) fn begin(&mut self) {
        let Self { assembly, state, work: Work { stage, viscous, .. }, .. } = self;
        viscous.clear();
        let rods = assembly.strands.iter().enumerate().filter(|(_, strand)| strand.viscosity > 0.0);
        viscous.extend(rods.map(|(rod, _)| (assembly.nodes(rod), assembly.elements(rod))));
        stage.begin(state, viscous);
    }

    /// The energy that goes in a step that looks at its end alone, by what went at the end of the one before.
    fn trapezoid(&mut self, h: f64) -> Power {
        let mut lost = Power::default();
        lost.add(self.state.power, 0.5 * h);
        self.state.power = self.power();
        lost.add(self.state.power, 0.5 * h);
        lost
    }

    /// Ends a step, or a piece of it, where its last stage is.
    pub(super) fn take(&mut self, lost: Power, seconds: f64) {
        let Self { assembly, state, work: Work { groups, stage, poses, contacts, .. }, .. } = self;
        state.poses.copy_from_slice(poses);
        for system in groups.iter().flat_map(|group| &group.rods) {
            state.wrenches[system.elements()].copy_from_slice(&system.record.wrenches);
        }
        state.velocities.copy_from_slice(&stage.velocities);
        state.momenta.copy_from_slice(&stage.momenta);
        state.contacts.clear();
        state.contacts.extend(contacts.contacts(poses));
        state.contacts.sort_by_key(|contact| contact.between);
        if assembly.surfaces.is_some() {
            state.passages.clear();
            state.passages.extend(contacts.passages.taken());
        }
        state.dissipated += lost.dissipated;
        state.worked += lost.worked;
        state.time += seconds;
        self.pierce();
    }
}
