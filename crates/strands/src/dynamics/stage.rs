//! One stage of a step: frames at which momentum has changed by what acts there.

use super::State;
use super::coordinates::{Follow, LookBack, at_coordinates, coordinates};
use super::inertia::TakeInertia;
use crate::assembly::Drag;
use crate::element::DiagonalPoint;
use crate::math::{Mat3, Pose, SimdLevel, Vec3, Vec6, Wrench, dispatch, so3_tangent};
use crate::rod::{NodeInertia, exponents};
use crate::statics::{Coupled, Inertial, Slopes};
use core::ops::Range;

/// What is known of a stage, and what comes of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Stage {
    /// The frames at the step's beginning, and what canonical coordinates about them and momenta would be without rates at this time.
    pub base: Vec<Pose>,
    pub offsets: Vec<Vec6>,
    pub known_momenta: Vec<Wrench>,
    /// The same of the exponents of viscous elements.
    strains: Vec<Vec6>,
    known_strains: Vec<Vec6>,
    /// Whether the frames are those in the middle of a step, and the velocities at its beginning.
    pub middle: bool,
    pub velocities_before: Vec<Vec6>,
    /// How much a rate counts, s.
    pub of_rate: f64,
    /// The laws of the elements with what their rates add, where a rod is viscous.
    pub points: Vec<DiagonalPoint>,
    pub inertial: Vec<Inertial>,
    /// Of each element whose nodes' momenta are coupled.
    pub coupled: Vec<Coupled>,
    /// What the air exerts on the frames, N.
    pub drags: Vec<Vec3>,
    /// What comes of it.
    pub coordinate_rates: Vec<Vec6>,
    pub velocities: Vec<Vec6>,
    pub momenta: Vec<Wrench>,
    pub strain_rates: Vec<Vec6>,
}

/// What slows frames down.
pub(super) struct Resistance<'a> {
    /// The momentum that they lose, over itself, 1/s.
    pub lost: f64,
    /// The drag of the air around a rod, how long a piece of it each node stands for (m), and how fast the air moves.
    pub air: Option<(Drag, &'a [f64], Vec3)>,
}

impl Stage {
    /// Begins a step, in which some rods are viscous: their nodes and elements.
    pub fn begin(&mut self, state: &State, viscous: &[(Range<usize>, Range<usize>)]) {
        self.base.clone_from(&state.poses);
        let (frames, elements) = (state.poses.len(), state.wrenches.len());
        self.strains.resize(elements, Vec6::ZERO);
        for (nodes, elements) in viscous {
            for (strain, x) in
                self.strains[elements.clone()].iter_mut().zip(exponents(&state.poses[nodes.clone()]))
            {
                *strain = x;
            }
        }
        let none = Inertial { exerts: Wrench::ZERO, by_turn: Mat3::ZERO, by_shift: Mat3::ZERO };
        self.inertial.resize(frames, none);
        let none = Coupled { near_by_far: Mat3::ZERO, far_by_near: Mat3::ZERO, by_shift: 0.0 };
        self.coupled.resize(elements, none);
        self.drags.clear();
        self.drags.resize(frames, Vec3::ZERO);
        self.coordinate_rates.resize(frames, Vec6::ZERO);
        self.velocities.resize(frames, Vec6::ZERO);
        self.momenta.resize(frames, Wrench::ZERO);
        self.strain_rates.clear();
        self.strain_rates.resize(elements, Vec6::ZERO);
        self.points.resize(elements, DiagonalPoint { compliance: Vec6::ZERO, rest: Vec6::ZERO });
    }

    /// Sets up a stage in which a rate counts so much, s. Without rates all would be as at the step's beginning.
    pub fn set_up(&mut self, of_rate: f64, state: &State) {
        self.of_rate = of_rate;
        self.offsets.clear();
        self.offsets.resize(state.poses.len(), Vec6::ZERO);
        self.known_momenta.clone_from(&state.momenta);
        self.known_strains.clone_from(&self.strains);
    }

    /// Adds so much of earlier rates.
    pub fn add_history(
        &mut self,
        times: f64,
        coordinate_rates: &[Vec6],
        momentum_rates: &[Wrench],
        strain_rates: &[Vec6],
    ) {
        self.known_strains.iter_mut().zip(strain_rates).for_each(|(known, rate)| *known += *rate * times);
        self.offsets.iter_mut().zip(coordinate_rates).for_each(|(offset, rate)| *offset += *rate * times);
        self.known_momenta.iter_mut().zip(momentum_rates).for_each(|(known, rate)| *known += *rate * times);
    }

    /// For backward differences of order 2: a third of what has changed in the step before, at whose beginning the frames and momenta were these, goes on. Guesses
    /// the rates too.
    pub fn look_back(
        &mut self,
        (poses, momenta): (&[Pose], &[Wrench]),
        velocities: &[Vec6],
        viscous: &[(Range<usize>, Range<usize>)],
        level: SimdLevel,
    ) {
        for (nodes, elements) in viscous {
            for (e, before) in elements.clone().zip(exponents(&poses[nodes.clone()])) {
                let now = self.known_strains[e];
                self.known_strains[e] += (now - before) * (1.0 / 3.0);
            }
        }
        for (now, before) in self.known_momenta.iter_mut().zip(momenta) {
            *now += (*now - *before) * (1.0 / 3.0);
        }
        dispatch(level, LookBack { stage: self, before: poses, velocities });
    }

    /// Guesses the rates of the coordinates, and puts the frames where these lead.
    pub fn predict(&mut self, rates: &[Vec6], poses: &mut [Pose], level: SimdLevel) {
        self.coordinate_rates.copy_from_slice(&rates[..self.base.len()]);
        self.follow(poses, level);
    }

    /// Puts the frames where the rates of their coordinates lead.
    pub fn follow(&self, poses: &mut [Pose], level: SimdLevel) {
        dispatch(level, Follow { stage: self, poses });
    }

    /// Where a frame would be without a rate, and how much a rate counts, s.
    pub fn without_rate(&self, frame: usize) -> (Pose, f64) {
        (at_coordinates(&self.base[frame], self.offsets[frame]), self.of_rate)
    }

    /// What of a momentum is exerted, where so much of it is lost, 1/s, and how a velocity changes with a place, 1/s.
    pub fn of_momentum(&self, lost: f64) -> (f64, f64) {
        let per_rate = 1.0 / self.of_rate;
        if self.middle { (0.5 * (per_rate + lost), 2.0 * per_rate) } else { (per_rate + lost, per_rate) }
    }

    /// How a frame moves in the stage.
    pub fn velocity(&self, frame: usize) -> Vec6 {
        let velocity = self.velocities[frame];
        if self.middle { (velocity + self.velocities_before[frame]) * 0.5 } else { velocity }
    }

    /// The rates of the momenta.
    pub fn momentum_rates(&self) -> impl Iterator<Item = Wrench> {
        let per_rate = 1.0 / self.of_rate;
        self.momenta.iter().zip(&self.known_momenta).map(move |(now, known)| (*now - *known) * per_rate)
    }

    /// In the axes of the velocities, a rate of the coordinates at the frames that the stage has come to.
    pub fn turned_with(&self, frame: usize, pose: &Pose, rate: Vec6) -> Vec6 {
        let theta = coordinates(&self.base[frame], pose).angular;
        Vec6::new(so3_tangent(theta) * rate.angular, rate.linear)
    }

    /// Takes the rates of the exponents of some viscous elements into their laws: with `x = x̂ + a ẋ` such a law is an elastic one against another rest
    /// shape, stiffer and elsewhere. The exponents have the same history as all else that changes in time, so a motion without strain has no rate.
    pub fn take_viscosity(&mut self, elements: Range<usize>, elastic: &[DiagonalPoint], viscosity: f64) {
        for (e, elastic) in elements.zip(elastic) {
            self.points[e] = viscous_point(elastic, self.known_strains[e], viscosity / self.of_rate);
        }
    }

    /// Takes the rates of the exponents of some elements where the stage has come to.
    pub fn take_strain_rates(&mut self, elements: Range<usize>, poses: &[Pose]) {
        for (e, x) in elements.zip(exponents(poses)) {
            self.strain_rates[e] = (x - self.known_strains[e]) * (1.0 / self.of_rate);
        }
    }

    /// What inertia and the air exert on some frames.
    pub fn take_inertia(
        &mut self,
        frames: Range<usize>,
        inertia: &[NodeInertia],
        poses: &[Pose],
        resistance: &Resistance,
        (level, slopes): (SimdLevel, Slopes),
    ) {
        let (first, lost) = (frames.start, resistance.lost);
        match slopes {
            Slopes::Anew => dispatch(level, TakeInertia::<true> { stage: self, first, inertia, poses, lost }),
            Slopes::Kept => {
                dispatch(level, TakeInertia::<false> { stage: self, first, inertia, poses, lost })
            }
        }
        self.take_drag(frames, poses, resistance, slopes);
    }

    /// What the air exerts on some frames, beside what inertia does.
    pub fn take_drag(
        &mut self,
        frames: Range<usize>,
        poses: &[Pose],
        resistance: &Resistance,
        slopes: Slopes,
    ) {
        let Some((drag, lengths, wind)) = resistance.air else { return };
        let per_rate = 1.0 / self.of_rate;
        for (at, i) in frames.enumerate() {
            let velocity = self.velocity(i).linear - wind;
            let (force, by_velocity) = air(&drag, poses[at].rotation.cols[2], velocity);
            self.drags[i] = force * lengths[at];
            self.inertial[i].exerts.linear += self.drags[i];
            if slopes == Slopes::Kept {
                continue;
            }
            let by_shift = &mut self.inertial[i].by_shift;
            *by_shift = *by_shift + by_velocity.scaled(lengths[at] * per_rate);
        }
    }
}

/// The law of an element with the stress of its rate, so many times its stiffness times how far its exponent is from the one that is known.
pub(super) fn viscous_point(elastic: &DiagonalPoint, known: Vec6, stiffer: f64) -> DiagonalPoint {
    let softer = 1.0 / (1.0 + stiffer);
    DiagonalPoint { compliance: elastic.compliance * softer, rest: (elastic.rest + known * stiffer) * softer }
}

/// What the air exerts on a rod along `tangent` that moves through it, over its length, and how that changes with the velocity.
fn air(drag: &Drag, tangent: Vec3, velocity: Vec3) -> (Vec3, Mat3) {
    let across = Mat3::IDENTITY - Mat3::outer(tangent, tangent);
    let normal = across * velocity;
    let speed = normal.norm();
    let force = velocity * -drag.linear - normal * (drag.quadratic * speed);
    let along = normal.normalized().map_or(Mat3::ZERO, |unit| Mat3::outer(unit, unit).scaled(speed));
    let slope = Mat3::IDENTITY.scaled(-drag.linear) - (across.scaled(speed) + along).scaled(drag.quadratic);
    (force, slope)
}
