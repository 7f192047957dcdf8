//! What the cases of contact are made of: round rods along a curve, and what is looked at independently of how contacts are found.

use strands::assembly::Assembly;
use strands::dynamics::{Integrator, Settings, Simulation, Start, State};
use strands::load::NodalLoads;
use strands::math::{Mat3, Pose, Vec3};
use strands::rod::{
    Kinematics, Material, Mesh, Order, Profile, RestShape, Rod, RodDescription, Section, Station,
};
use strands::statics::{Problem, Support};

/// Backward Euler's method, the one that knows contact.
pub const EULER: Settings = Settings {
    integrator: Integrator::ImplicitEuler,
    time_step: 1e-3,
    local_error: None,
    tolerance: 1e-7,
    max_iterations: 60,
    bounded: false,
    mass_damping: 0.0,
};

/// A thread of one material: its radius, m, Young's modulus, Pa, Poisson's ratio and density, kg/m³.
#[derive(Clone, Copy)]
pub struct Thread {
    pub radius: f64,
    pub modulus: f64,
    pub poisson: f64,
    pub density: f64,
}

impl Thread {
    /// Its stiffness against bending, N·m².
    pub fn bending(&self) -> f64 {
        self.modulus * core::f64::consts::PI * self.radius.powi(4) / 4.0
    }

    /// A straight rod of it from a frame on, cut into pieces, each given by where it ends and its number of elements.
    pub fn rod(&self, base: Pose, pieces: &[(f64, usize)]) -> Rod {
        self.rod_of(Section::Circle { radius: self.radius }, base, pieces)
    }

    /// The same of another section.
    pub fn rod_of(&self, section: Section, base: Pose, pieces: &[(f64, usize)]) -> Rod {
        let material = Material::from_poisson(self.modulus, self.poisson, self.density).unwrap();
        let description = RodDescription {
            length: pieces[pieces.len() - 1].0,
            kinematics: Kinematics::Cosserat,
            profile: Profile::Stations(vec![Station { s: 0.0, section, material }]),
            rest: RestShape::default(),
            base,
        };
        Rod::new(description, Mesh::from_pieces(pieces).unwrap(), Order::Second).unwrap()
    }
}

/// A rod that nothing holds or loads.
pub fn free(rod: Rod) -> Problem {
    let (loads, start) = (NodalLoads::none(&rod), Support::free(rod.description().base));
    Problem { loads, start, ..Problem::cantilever(rod) }
}

/// Frames along a line of places, without twist, of which `d1` begins about where it is said.
pub fn framed(places: &[Vec3], mut first: Vec3) -> Vec<Pose> {
    let last = places.len() - 1;
    let frame = |i: usize| {
        let along = (places[(i + 1).min(last)] - places[i.saturating_sub(1)]).normalized().unwrap();
        let across = first - along * first.dot(along);
        first = across.normalized().unwrap_or_else(|| along.any_orthonormal());
        Pose { rotation: Mat3::from_cols(first, along.cross(first), along), position: places[i] }
    };
    (0..=last).map(frame).collect()
}

/// A line through so fine a line of places, to be asked for the place at some length along it.
pub struct Line {
    places: Vec<Vec3>,
    lengths: Vec<f64>,
}

impl Line {
    pub fn through(places: Vec<Vec3>) -> Self {
        let mut lengths = vec![0.0];
        for pair in places.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
        }
        Self { places, lengths }
    }

    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    pub fn at(&self, s: f64) -> Vec3 {
        let k = self.lengths.partition_point(|length| *length < s).clamp(1, self.places.len() - 1);
        let part = (s - self.lengths[k - 1]) / (self.lengths[k] - self.lengths[k - 1]);
        self.places[k - 1] + (self.places[k] - self.places[k - 1]) * part
    }
}

/// At rest in some frames, all rods one after the other.
pub fn at_rest(assembly: &Assembly, poses: Vec<Pose>) -> State {
    let simulation = Simulation::new(assembly.clone(), EULER, Start::Shape(poses)).unwrap();
    simulation.state().clone()
}

/// How near the axes of elements come to each other, of one rod those that are more elements apart than so many, by alternating projections.
pub fn least_distance(rods: &[&[Pose]], between: usize) -> f64 {
    let mut least = f64::INFINITY;
    let ends = |rod: usize, i: usize| (rods[rod][i].position, rods[rod][i + 1].position);
    for one in 0..rods.len() {
        for other in one..rods.len() {
            for i in 0..rods[one].len() - 1 {
                let (a, b) = ends(one, i);
                let first = if one == other { i + 1 + between } else { 0 };
                for j in first..rods[other].len() - 1 {
                    let (c, d) = ends(other, j);
                    if (a - c).norm() > (b - a).norm() + (d - c).norm() + least {
                        continue;
                    }
                    let mut s = 0.5;
                    for _ in 0..200 {
                        let t = ((a + (b - a) * s - c).dot(d - c) / (d - c).dot(d - c)).clamp(0.0, 1.0);
                        let before = s;
                        s = ((c + (d - c) * t - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
                        least = least.min((a + (b - a) * s - c - (d - c) * t).norm());
                        if (s - before).abs() < 1e-9 {
                            break;
                        }
                    }
                }
            }
        }
    }
    least
}

/// Where all has come to rest: by steps of backward Euler's method that are longer and longer beside a time, s, of slow motion, as one that is long beside all motion solves for
/// the equilibrium.
pub fn settled(assembly: &Assembly, mut state: State, slow: f64) -> Simulation {
    const STEPS: [(f64, usize); 8] =
        [(1e-4, 5), (1e-3, 10), (1e-2, 20), (0.1, 20), (1.0, 20), (10.0, 10), (1e3, 5), (1e5, 5)];
    let mut last = None;
    for (step, steps) in STEPS {
        let settings = Settings { time_step: step * slow, mass_damping: 0.1 / (step * slow), ..EULER };
        let start = Start::State(Box::new(state));
        let mut simulation = Simulation::new(assembly.clone(), settings, start).unwrap();
        for k in 0..steps {
            let made = simulation.step();
            made.unwrap_or_else(|failure| panic!("steps of {step}, {k}: {failure}"));
        }
        state = simulation.state().clone();
        last = Some(simulation);
    }
    last.unwrap()
}
