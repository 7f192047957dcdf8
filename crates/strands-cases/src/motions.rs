//! Rods that move far, with where they are known to be.

use crate::frequencies::WAVES;
use crate::table::Table;
use crate::uniform::Uniform;
use crate::vibration::VibrationError;
use core::f64::consts::TAU;
use strands::assembly::Member;
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Mat3, Pose, Quat, Vec3, Vec6, Wrench};
use strands::rod::{Kinematics, Stiffness};
use strands::statics::{Problem, Support};

/// A named motion.
#[derive(Clone)]
pub struct MotionCase {
    /// Its name, as one types it.
    pub name: &'static str,
    /// What it is, in a line.
    pub title: &'static str,
    /// Who published it, and how the figures were found.
    pub source: &'static str,
    /// How many elements it has, and half as many.
    pub elements: usize,
    /// How a step is made.
    pub integrator: Integrator,
    /// How long it is, s.
    pub time_step: f64,
    /// How far off the rod may be on the finer mesh, m.
    pub on_mesh: f64,
    /// How far off it may be by what both meshes say of endlessly many elements, m.
    pub tolerance: f64,
    /// Where it is, over time.
    pub moments: Vec<Moment>,
    /// Where it starts, and how it is then held and loaded.
    begin: fn(usize, Settings) -> Result<Simulation, VibrationError>,
    /// What is done to it for a step between two times, s.
    act: fn(&mut Simulation, [f64; 2]),
}

/// Where a rod is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The time, s.
    pub time: f64,
    /// Its start, its end and its centre of mass, m.
    pub places: [Vec3; 3],
}

impl Moment {
    /// The greatest distance from another, m.
    pub fn apart(&self, other: &Self) -> f64 {
        self.places.iter().zip(&other.places).map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max)
    }

    fn of(simulation: &Simulation) -> Self {
        let (rod, poses) = (&simulation.assembly().strands[0].problem.rod, &simulation.state().poses);
        let nodes = rod.node_inertia().iter().zip(poses);
        let sum = nodes.fold(Vec3::ZERO, |sum, (node, pose)| sum + pose.position * node.mass);
        let places = [poses[0].position, poses[rod.elements()].position, sum * (1.0 / rod.mass())];
        Self { time: simulation.state().time, places }
    }
}

impl MotionCase {
    /// The simulation, where it begins.
    ///
    /// # Errors
    /// Where the rod cannot be cut into so many elements, or cannot move.
    pub fn begin(&self, elements: usize, settings: Settings) -> Result<Simulation, VibrationError> {
        (self.begin)(elements, settings)
    }

    /// Makes a step, with what acts during it.
    ///
    /// # Errors
    /// Where it is not solved.
    pub fn step(&self, simulation: &mut Simulation) -> Result<(), VibrationError> {
        let time = simulation.state().time;
        (self.act)(simulation, [time, time + simulation.settings().time_step]);
        simulation.step()?;
        Ok(())
    }

    /// Where the rod is at all the times that are known.
    ///
    /// # Errors
    /// As [`MotionCase::begin`] and [`MotionCase::step`].
    pub fn with_elements(&self, elements: usize, time_step: f64) -> Result<Vec<Moment>, VibrationError> {
        let settings = Settings { integrator: self.integrator, time_step, ..Settings::default() };
        let mut simulation = self.begin(elements, settings)?;
        let mut moments = Vec::with_capacity(self.moments.len());
        for known in &self.moments {
            while !simulation.has_come_to(known.time) {
                self.step(&mut simulation)?;
            }
            moments.push(Moment::of(&simulation));
        }
        Ok(moments)
    }

    /// The same, and where it would be with endlessly many elements by what half as many say too: errors are of second order.
    ///
    /// # Errors
    /// As [`MotionCase::with_elements`].
    pub fn on_two_meshes(&self) -> Result<[Vec<Moment>; 2], VibrationError> {
        let coarse = self.with_elements(self.elements / 2, self.time_step)?;
        let fine = self.with_elements(self.elements, self.time_step)?;
        let beyond = fine.iter().zip(&coarse).map(|(fine, coarse)| {
            let place = |i: usize| (fine.places[i] * 4.0 - coarse.places[i]) * (1.0 / 3.0);
            Moment { time: fine.time, places: [place(0), place(1), place(2)] }
        });
        let beyond = beyond.collect();
        Ok([fine, beyond])
    }
}

/// Every case of motions.
pub fn all_motions() -> Vec<MotionCase> {
    vec![
        pulled_at_once(),
        soft_drop(),
        released_steel(),
        flying_plane(),
        flying_space(),
        flying_space_round(),
        spinning_helix(),
        spun_arm(),
    ]
}

/// The places of a table of both ends and the centre.
fn moments(text: &'static str) -> Vec<Moment> {
    let table = Table::read(text);
    let records = table.records().map(|record| Moment {
        time: record.number("t"),
        places: ["start_", "end_", "centre_"].map(|place| record.vector(place)),
    });
    records.collect()
}

fn nothing(_: &mut Simulation, _: [f64; 2]) {}

/// A rod that stretches and shears.
fn stretching(length: f64, stiffness: Stiffness, mass: f64, inertia: Vec3) -> Uniform {
    Uniform { length, kinematics: Kinematics::Cosserat, stiffness, mass, inertia }
}

/// At the origin with the tangent along x.
fn along_x() -> Pose {
    Pose { rotation: Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X), position: Vec3::ZERO }
}

fn pulled_at_once() -> MotionCase {
    const LENGTH: f64 = WAVES.length;
    const STRAIN: f64 = 1e-3;
    let rod = WAVES.rod();
    // The time that a wave takes from end to end. Both the end's way and the centre's go back as they came after two of it.
    let across = LENGTH * (rod.mass / rod.stiffness.axial).sqrt();
    let moments = [0.5, 1.0, 1.5, 2.5, 3.0, 3.5, 4.5, 5.5, 6.5, 7.5].map(|waves: f64| {
        let since: f64 = 2.0 - (2.0 - waves.rem_euclid(4.0)).abs();
        let mean = if since <= 1.0 { 0.5 * since * since } else { since - 0.5 - 0.5 * (since - 1.0).powi(2) };
        let moved = |by: f64| Vec3::Z * (LENGTH * STRAIN * by);
        let places = [Vec3::ZERO, Vec3::Z * LENGTH + moved(since), Vec3::Z * (0.5 * LENGTH) + moved(mean)];
        Moment { time: waves * across, places }
    });
    MotionCase {
        name: "pulled-at-once",
        title: "A rod that is pulled at once: its end goes twice as far as at rest, and back",
        source: "Graff, Wave Motion in Elastic Solids, 1975, ch. 2",
        elements: 100,
        integrator: Integrator::Midpoint,
        // So that all times that are known are ends of steps.
        time_step: across / 200.0,
        on_mesh: 0.01 * LENGTH * STRAIN,
        tolerance: 0.01 * LENGTH * STRAIN,
        moments: moments.into(),
        begin: |elements, settings| {
            let rod = WAVES.rod();
            let force = Wrench::new(Vec3::ZERO, Vec3::Z * (STRAIN * rod.stiffness.axial));
            let rod = rod.rod(Pose::IDENTITY, Vec3::ZERO, elements)?;
            let pull = PointLoad { at: LENGTH, wrench: force, frame: Frame::World };
            let loads = NodalLoads::none(&rod).with_point(&rod, &pull)?;
            Ok(Simulation::new(Problem { loads, ..Problem::cantilever(rod) }, settings, Start::Rest)?)
        },
        act: nothing,
    }
}

fn soft_drop() -> MotionCase {
    MotionCase {
        name: "soft-drop",
        title: "A soft cantilever on which its weight begins to act",
        source: "Discontinuous Galerkin spectral elements to 3e-8 m, and another Galerkin method to 2e-7 m",
        elements: 80,
        integrator: Integrator::Sdirk4,
        time_step: 2.5e-3,
        on_mesh: 1e-3,
        tolerance: 1e-4,
        moments: moments(include_str!("../data/soft_drop.csv")),
        begin: |elements, settings| {
            let rod =
                Uniform::round(0.5, 0.01, [1e6, 1e6 / 3.0], 1000.0).rod(along_x(), Vec3::ZERO, elements)?;
            let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Y * -9.81);
            Ok(Simulation::new(Problem { loads, ..Problem::cantilever(rod) }, settings, Start::Rest)?)
        },
        act: nothing,
    }
}

fn released_steel() -> MotionCase {
    MotionCase {
        name: "released-steel",
        title: "A steel rod from whose tip a weight is taken",
        source: "Till, Aloi & Rucker, IJRR 38:723–746, 2019; discontinuous Galerkin spectral elements to 1e-7 m",
        elements: 80,
        integrator: Integrator::Sdirk4,
        time_step: 2.5e-4,
        on_mesh: 1e-3,
        tolerance: 2e-4,
        moments: moments(include_str!("../data/released_steel.csv")),
        begin: |elements, settings| {
            const YOUNG: f64 = 207e9;
            let rod = Uniform::round(0.4, 1.2e-3, [YOUNG, YOUNG / 2.6], 8000.0);
            let rod = rod.rod(Pose::IDENTITY, Vec3::ZERO, elements)?;
            let weight = Wrench::new(Vec3::ZERO, Vec3::X * -1.962);
            let weight = PointLoad { at: rod.length(), wrench: weight, frame: Frame::World };
            let alone = NodalLoads::none(&rod).with_gravity(&rod, Vec3::X * -9.81);
            let loads = alone.clone().with_point(&rod, &weight)?;
            let problem = Problem { loads, ..Problem::cantilever(rod) };
            let mut simulation = Simulation::new(problem, settings, Start::Equilibrium)?;
            simulation.assembly_mut().strands[0].problem.loads = alone;
            Ok(simulation)
        },
        act: nothing,
    }
}

/// A straight rod of 10 m from (6, 0, 0) to (0, 8, 0), with nothing that holds it.
fn flying(elements: usize, inertia: Vec3, settings: Settings) -> Result<Simulation, VibrationError> {
    let stiffness = Stiffness { bending: [500.0; 2], torsion: 500.0, axial: 1e4, shear: [1e4; 2] };
    let (first, third) = (Vec3::new(0.8, 0.6, 0.0), Vec3::new(-0.6, 0.8, 0.0));
    let rotation = Mat3::from_cols(first, third.cross(first), third);
    let base = Pose { rotation, position: Vec3::X * 6.0 };
    let rod = stretching(10.0, stiffness, 1.0, inertia).rod(base, Vec3::ZERO, elements)?;
    let free = Problem { start: Support::free(base), ..Problem::cantilever(rod) };
    Ok(Simulation::new(free, settings, Start::Rest)?)
}

/// A dead load on the rod's start, and nothing else.
fn load_start(simulation: &mut Simulation, moment: Vec3, force: Vec3) {
    simulation.assembly_mut().strands[0].problem.loads.world[0] = Wrench::new(moment, force);
}

fn flying_plane() -> MotionCase {
    MotionCase {
        name: "flying-rod-plane",
        title: "A rod that is thrown, and flies in a plane: flying spaghetti",
        source: "Simo & Vu-Quoc, J. Appl. Mech. 53:855–863, 1986; discontinuous Galerkin spectral elements to 1e-4 m",
        elements: 80,
        integrator: Integrator::Sdirk4,
        time_step: 0.02,
        on_mesh: 0.02,
        tolerance: 2e-3,
        moments: moments(include_str!("../data/flying_plane.csv")),
        begin: |elements, settings| flying(elements, Vec3::new(10.0, 10.0, 10.0), settings),
        act: |simulation, [from, _]| {
            let acts = if from < 2.5 - 1e-9 { 1.0 } else { 0.0 };
            load_start(simulation, Vec3::Z * (-80.0 * acts), Vec3::X * (8.0 * acts));
        },
    }
}

/// The mean of a moment over a step, N·m: it grows to 200 in 2.5 s, and falls as fast.
fn pulse([from, to]: [f64; 2]) -> f64 {
    let middle = 0.5 * (from + to);
    (200.0 - 80.0 * (middle - 2.5).abs()).max(0.0)
}

fn throw(simulation: &mut Simulation, times: [f64; 2]) {
    let moment = pulse(times);
    load_start(simulation, Vec3::new(0.0, 0.5 * moment, -moment), Vec3::X * (0.1 * moment));
}

fn flying_space() -> MotionCase {
    MotionCase {
        name: "flying-rod-space",
        title: "A rod that is thrown, and flies and twists",
        source: "Simo & Vu-Quoc, CMAME 66:125–161, 1988; discontinuous Galerkin spectral elements to 3e-8 m",
        elements: 80,
        integrator: Integrator::Sdirk4,
        time_step: 0.02,
        on_mesh: 0.05,
        tolerance: 1e-3,
        moments: moments(include_str!("../data/flying_space.csv")),
        begin: |elements, settings| flying(elements, Vec3::new(10.0, 10.0, 20.0), settings),
        act: throw,
    }
}

fn flying_space_round() -> MotionCase {
    MotionCase {
        name: "flying-rod-space-even",
        title: "A rod that is thrown, and flies and twists, of the same inertia about all axes",
        moments: moments(include_str!("../data/flying_space_round.csv")),
        begin: |elements, settings| flying(elements, Vec3::new(10.0, 10.0, 10.0), settings),
        ..flying_space()
    }
}

fn spinning_helix() -> MotionCase {
    MotionCase {
        name: "spinning-helix",
        title: "A helix that flies, spins and bends as it does",
        source: "Discontinuous Galerkin spectral elements to 2e-8 m, and what is conserved",
        elements: 100,
        integrator: Integrator::Sdirk4,
        time_step: 2.5e-3,
        on_mesh: 5e-3,
        // Its start makes waves along it that are not much slower than the steps.
        tolerance: 1e-4,
        moments: moments(include_str!("../data/spinning_helix.csv")),
        begin: |elements, settings| {
            let stiffness =
                Stiffness { bending: [0.05, 0.08], torsion: 0.06, axial: 900.0, shear: [400.0; 2] };
            let (inertia, rest) = (Vec3::new(2e-5, 3e-5, 5e-5), Vec3::new(0.0, 8.0, 3.0));
            let rod = stretching(1.2, stiffness, 0.2, inertia).rod(Pose::IDENTITY, rest, elements)?;
            let free = Problem { start: Support::free(Pose::IDENTITY), ..Problem::cantilever(rod) };
            let mut simulation = Simulation::new(free, settings, Start::Rest)?;
            let centre = Moment::of(&simulation).places[2];
            let (speed, spin) = (Vec3::new(0.5, 0.2, -0.3), Vec3::new(6.0, -3.0, 9.0));
            let velocity = |pose: &Pose| {
                Vec6::new(pose.rotation.transpose_mul(spin), speed + spin.cross(pose.position - centre))
            };
            let velocities: Vec<Vec6> = simulation.state().poses.iter().map(velocity).collect();
            simulation.set_velocities(&velocities);
            Ok(simulation)
        },
        act: nothing,
    }
}

/// How far the arm has been turned at a time, rad: with 6 rad/s from 15 s on.
fn turned(time: f64) -> f64 {
    const SPEED: f64 = 6.0;
    const SECONDS: f64 = 15.0;
    if time >= SECONDS {
        return SPEED * (time - 0.5 * SECONDS);
    }
    let rate = TAU / SECONDS;
    SPEED / SECONDS * (0.5 * time * time + ((rate * time).cos() - 1.0) / (rate * rate))
}

/// The frame to which the arm is clamped.
fn shoulder(time: f64) -> Pose {
    let turn = Quat::from_rotation_vector(Vec3::Z * turned(time)).to_matrix();
    Pose { rotation: turn * along_x().rotation, position: Vec3::ZERO }
}

fn spun_arm() -> MotionCase {
    const LENGTH: f64 = 10.0;
    let table = Table::read(include_str!("../data/spun_arm.csv"));
    let moments = table.records().map(|record| {
        let time = record.number("t");
        // In the arm's base the tangent is the third axis, and what it is turned towards the first.
        let seen = Vec3::new(record.number("across"), 0.0, LENGTH + record.number("along"));
        let end = shoulder(time).rotation * seen;
        Moment { time, places: [Vec3::ZERO, end, record.vector("centre_")] }
    });
    MotionCase {
        name: "spun-arm",
        title: "A robot's arm that is spun up",
        source: "Simo & Vu-Quoc, J. Appl. Mech. 53:855–863, 1986; discontinuous Galerkin spectral elements to 3e-6 m",
        elements: 40,
        integrator: Integrator::Sdirk4,
        time_step: 10e-3,
        on_mesh: 5e-4,
        tolerance: 1e-3,
        moments: moments.collect(),
        begin: |elements, settings| {
            let stiffness = Stiffness { bending: [14e3; 2], torsion: 10e3, axial: 28e6, shear: [10e6; 2] };
            let inertia = Vec3::new(6e-4, 6e-4, 12e-4);
            let rod = stretching(LENGTH, stiffness, 1.2, inertia).rod(along_x(), Vec3::ZERO, elements)?;
            Ok(Simulation::new(Problem::cantilever(rod), settings, Start::Rest)?)
        },
        act: |simulation, [_, to]| {
            if let Some(support) = simulation.support_mut(Member::Node { rod: 0, node: 0 }) {
                support.pose = shoulder(to);
            }
        },
    }
}
