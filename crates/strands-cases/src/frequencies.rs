//! Rods and rings that vibrate a little, with their frequencies.

use crate::table::Table;
use crate::turning::Rotor;
use crate::uniform::Uniform;
use crate::vibration::{Vibration, VibrationError};
use core::f64::consts::{PI, TAU};
use std::sync::Arc;
use strands::assembly::{Assembly, Body, Joint, JointKind, MassMatrix, Member};
use strands::load::NodalLoads;
use strands::math::{Pose, Vec3, Vec6};
use strands::rod::{NodeInertia, RodError};
use strands::statics::{Problem, Support};

/// A named rod that vibrates.
#[derive(Clone)]
pub struct VibrationCase {
    /// Its name, as one types it.
    pub name: &'static str,
    /// What it is, in a line.
    pub title: &'static str,
    /// Who published it, and how the figures were found.
    pub source: &'static str,
    /// How many elements it has, and half as many.
    pub elements: usize,
    /// The relative error of what these two meshes say of a rod of endlessly many elements.
    pub tolerance: f64,
    /// The relative error on the finer mesh alone.
    pub on_mesh: f64,
    /// Its rows.
    pub rows: Vec<VibrationRow>,
}

/// Some frequencies of a rod.
#[derive(Clone)]
pub struct VibrationRow {
    /// What sets it apart from the other rows.
    pub label: String,
    /// The lowest circular frequencies of the modes that the push excites, rad/s.
    pub frequencies: Vec<f64>,
    build: Arc<Build>,
    /// What everything is pushed with, in the world but for turns, and how it is along the rod.
    push: Vec6,
    along: Along,
}

type Build = dyn Fn(usize) -> Result<Assembly, RodError> + Send + Sync;

/// How a push is along a rod.
#[derive(Clone, Copy)]
enum Along {
    /// Such that it excites all modes.
    Growing,
    /// As half a sine wave.
    Sine,
}

impl VibrationRow {
    fn new(
        label: impl Into<String>,
        frequencies: Vec<f64>,
        push: Vec6,
        build: impl Fn(usize) -> Result<Assembly, RodError> + Send + Sync + 'static,
    ) -> Self {
        Self { label: label.into(), frequencies, build: Arc::new(build), push, along: Along::Growing }
    }

    /// The same with another mass matrix of all rods.
    pub fn with_mass_matrix(self, mass_matrix: MassMatrix) -> Self {
        let build = self.build.clone();
        let build = move |elements| {
            let mut assembly = build(elements)?;
            assembly.strands.iter_mut().for_each(|strand| strand.mass_matrix = mass_matrix);
            Ok(assembly)
        };
        Self { build: Arc::new(build), ..self }
    }

    /// Its frequencies with so many elements, rad/s.
    ///
    /// # Errors
    /// Where it cannot be cut into them, a step of it is not solved, or fewer are found than are known.
    pub fn with_elements(&self, elements: usize) -> Result<Vec<f64>, VibrationError> {
        let assembly = (self.build)(elements)?;
        let ends = [self.frequencies.first(), self.frequencies.last()];
        let middle: f64 = ends.into_iter().flatten().product::<f64>().sqrt();
        let frames = assembly.frames();
        let push = (0..frames).map(|frame| {
            // The bodies are at the rods' ends.
            let x = (frame as f64 / elements as f64).min(1.0);
            self.push
                * match self.along {
                    Along::Growing => (2.0 * x).exp(),
                    Along::Sine => (PI * x).sin(),
                }
        });
        let push: Vec<Vec6> = push.collect();
        let wanted = self.frequencies.len();
        let found = Vibration::new(assembly, 1.0 / middle)?.frequencies(&push, wanted)?;
        if found.len() < wanted {
            return Err(VibrationError::TooFew { wanted, found: found.len() });
        }
        Ok(found)
    }

    /// Its frequencies with so many elements, and those of endlessly many by what half as many say too: errors are of second order.
    ///
    /// # Errors
    /// As [`VibrationRow::with_elements`].
    pub fn on_two_meshes(&self, elements: usize) -> Result<[Vec<f64>; 2], VibrationError> {
        let (coarse, fine) = (self.with_elements(elements / 2)?, self.with_elements(elements)?);
        let beyond = fine.iter().zip(&coarse).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect();
        Ok([fine, beyond])
    }
}

/// Every case of vibrations.
pub fn all_vibrations() -> Vec<VibrationCase> {
    vec![slender(), shearing(), waves(), tip_inertia(), rings(), hanging(), dispersion(), turning()]
}

const ALONG_X: Vec6 = Vec6::new(Vec3::ZERO, Vec3::X);
const ALONG_Y: Vec6 = Vec6::new(Vec3::ZERO, Vec3::Y);
const ALONG_Z: Vec6 = Vec6::new(Vec3::ZERO, Vec3::Z);
const TWIST: Vec6 = Vec6::new(Vec3::Z, Vec3::ZERO);

/// One that bends and twists only, and turns without inertia but about itself, which nothing else may keep it from.
fn slender_rod(length: f64, bending: [f64; 2], mass: f64) -> Uniform {
    Uniform::inextensible(length, bending, mass, Vec3::Z * (1e-9 * mass * length * length))
}

/// Straight, along z.
impl Uniform {
    fn held(&self, elements: usize, [start, end]: [Hold; 2]) -> Result<Problem, RodError> {
        let rod = self.rod(Pose::IDENTITY, Vec3::ZERO, elements)?;
        let far = Pose { position: Vec3::Z * self.length, ..Pose::IDENTITY };
        let (start, end) = (start.support(Pose::IDENTITY), end.support(far));
        Ok(Problem { start, end, ..Problem::cantilever(rod) })
    }

    /// A builder of it between two holds.
    fn between(
        self,
        holds: [Hold; 2],
    ) -> impl Fn(usize) -> Result<Assembly, RodError> + Send + Sync + 'static {
        move |elements| Ok(self.held(elements, holds)?.into())
    }
}

/// How an end is held.
#[derive(Clone, Copy)]
enum Hold {
    Free,
    Clamped,
    Pinned,
    /// The same, but free along the rod: a rod that does not stretch comes nearer as it bends.
    ClampedSliding,
    PinnedSliding,
}

impl Hold {
    fn support(self, pose: Pose) -> Support {
        match self {
            Self::Free => Support::free(pose),
            Self::Clamped => Support::clamped(pose),
            Self::Pinned => Support::pinned(pose),
            Self::ClampedSliding => Support::clamped(pose).sliding_along(Vec3::Z),
            Self::PinnedSliding => Support::pinned(pose).sliding_along(Vec3::Z),
        }
    }
}

/// The roots `βL` of the characteristic equations of bending.
const CLAMPED_FREE: [f64; 5] = [
    1.875_104_068_711_96,
    4.694_091_132_974_18,
    7.854_757_438_237_61,
    10.995_540_734_875_5,
    14.137_168_391_046_5,
];
const CLAMPED_CLAMPED: [f64; 4] =
    [4.730_040_744_862_7, 7.853_204_624_095_84, 10.995_607_838_001_7, 14.137_165_491_257_5];
const CLAMPED_PINNED: [f64; 4] =
    [3.926_602_312_047_92, 7.068_582_745_628_73, 10.210_176_122_813, 13.351_768_777_754_1];
const PINNED_PINNED: [f64; 4] = [PI, 2.0 * PI, 3.0 * PI, 4.0 * PI];

fn slender() -> VibrationCase {
    const LENGTH: f64 = 0.6;
    const BENDING: [f64; 2] = [0.00128, 0.00288];
    const MASS: f64 = 0.1152;
    let rod = slender_rod(LENGTH, BENDING, MASS);
    let row = |label, roots: &[f64], plane: usize, holds| {
        let wave_speed = (BENDING[plane] / MASS).sqrt();
        let frequencies = roots.iter().map(|root| (root / LENGTH).powi(2) * wave_speed).collect();
        let push = [ALONG_Y, ALONG_X][plane];
        VibrationRow::new(format!("{label}, plane {}", plane + 1), frequencies, push, rod.between(holds))
    };
    let rows = vec![
        row("clamped and free", &CLAMPED_FREE, 0, [Hold::Clamped, Hold::Free]),
        row("clamped and free", &CLAMPED_FREE, 1, [Hold::Clamped, Hold::Free]),
        row("clamped", &CLAMPED_CLAMPED, 0, [Hold::Clamped, Hold::ClampedSliding]),
        row("free", &CLAMPED_CLAMPED, 1, [Hold::Free, Hold::Free]),
        row("clamped and pinned", &CLAMPED_PINNED, 0, [Hold::Clamped, Hold::PinnedSliding]),
        row("free and pinned", &CLAMPED_PINNED, 1, [Hold::Pinned, Hold::Free]),
        row("pinned", &PINNED_PINNED, 0, [Hold::Pinned, Hold::PinnedSliding]),
    ];
    VibrationCase {
        name: "bending-vibrations",
        title: "A slender rod that bends to and fro, its ends held in six ways",
        source: "Rayleigh, The Theory of Sound, 1877, ch. VIII",
        elements: 200,
        tolerance: 1e-6,
        on_mesh: 5e-3,
        rows,
    }
}

/// The four figures of a record.
fn figures(record: &crate::table::Record) -> Vec<f64> {
    ["w1", "w2", "w3", "w4"].map(|column| record.number(column)).to_vec()
}

fn shearing() -> VibrationCase {
    let table = Table::read(include_str!("../data/timoshenko_frequencies.csv"));
    let rows = table.records().map(|record| {
        let (slenderness, poisson) = (record.number("slenderness"), record.number("poisson"));
        let radius = 1.0 / slenderness;
        let second = 0.25 * PI * radius.powi(4);
        // So that `EI` and the mass per length are 1.
        let young = 1.0 / second;
        let density = 1.0 / (PI * radius * radius);
        let rod = Uniform::round(1.0, radius, [young, young / (2.0 * (1.0 + poisson))], density);
        let label = format!("L/r = {slenderness}");
        VibrationRow::new(label, figures(&record), ALONG_X, rod.between([Hold::Clamped, Hold::Free]))
    });
    VibrationCase {
        name: "shearing-vibrations",
        title: "A cantilever that shears and has rotary inertia",
        source: "Timoshenko 1921; Huang, J. Appl. Mech. 28:579, 1961",
        elements: 200,
        tolerance: 1e-6,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

/// A soft thick rod in which waves go to and fro.
pub(crate) const WAVES: Round =
    Round { length: 0.6, radius: 0.006, moduli: [2.5e6, 2.5e6 / 3.0], density: 1200.0 };

/// A round rod by its numbers.
pub(crate) struct Round {
    pub length: f64,
    radius: f64,
    moduli: [f64; 2],
    density: f64,
}

impl Round {
    pub fn rod(&self) -> Uniform {
        Uniform::round(self.length, self.radius, self.moduli, self.density)
    }

    /// The speeds of waves over its length, 1/s: axial and torsional.
    fn rates(&self) -> [f64; 2] {
        self.moduli.map(|modulus| (modulus / self.density).sqrt() / self.length)
    }
}

const KINDS: [(&str, Vec6); 2] = [("axial", ALONG_Z), ("torsional", TWIST)];

fn waves() -> VibrationCase {
    let rows = KINDS.iter().zip(WAVES.rates()).flat_map(|((kind, push), rate)| {
        let of = move |label: &str, first: f64, step: f64, holds: [Hold; 2]| {
            let frequencies = (0..3).map(|k| rate * (first + step * f64::from(k))).collect();
            VibrationRow::new(format!("{kind}, {label}"), frequencies, *push, WAVES.rod().between(holds))
        };
        [
            of("clamped and free", 0.5 * PI, PI, [Hold::Clamped, Hold::Free]),
            of("clamped", PI, PI, [Hold::Clamped, Hold::Clamped]),
            of("free", PI, PI, [Hold::Free, Hold::Free]),
        ]
    });
    VibrationCase {
        name: "standing-waves",
        title: "A rod that stretches or twists to and fro",
        source: "Rayleigh, The Theory of Sound, 1877, ch. VII",
        elements: 100,
        tolerance: 1e-6,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

/// Inertia of the rod over that at its tip, and the root of `x tan x` of that.
const TIP_INERTIA: [(f64, f64); 3] =
    [(0.1, 0.311_052_848_200_298), (1.0, 0.860_333_589_019_38), (10.0, 1.428_870_011_214_08)];

fn tip_inertia() -> VibrationCase {
    let rows = KINDS.iter().zip(WAVES.rates()).flat_map(|((kind, push), rate)| {
        TIP_INERTIA.into_iter().map(move |(ratio, root)| {
            let build = move |elements: usize| {
                let rod = WAVES.rod();
                let mass = rod.mass * rod.length / ratio;
                let turning = rod.inertia.z * rod.length / ratio;
                let inertia = NodeInertia { mass, rotational: Vec3::new(turning, turning, turning) };
                let tip = Pose { position: Vec3::Z * rod.length, ..Pose::IDENTITY };
                let mut assembly = Assembly::from(rod.held(elements, [Hold::Clamped, Hold::Free])?);
                assembly.bodies.push(Body::new(inertia, tip));
                let members = [Member::Node { rod: 0, node: elements }, Member::Body(0)];
                let joint = Joint::at_rest(&assembly, JointKind::Rigid, members, None, Vec3::ZERO);
                assembly
                    .joints
                    .push(joint.unwrap_or_else(|_| unreachable!("the tip and the body are there")));
                Ok(assembly)
            };
            VibrationRow::new(format!("{kind}, ratio {ratio}"), vec![rate * root], *push, build)
        })
    });
    VibrationCase {
        name: "waves-with-a-body",
        title: "A rod that stretches or twists to and fro with a body at its tip",
        source: "Rayleigh, The Theory of Sound, 1877, ch. VII",
        elements: 100,
        tolerance: 1e-6,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

fn rings() -> VibrationCase {
    let table = Table::read(include_str!("../data/ring_frequencies.csv"));
    let rows = table.records().map(|record| {
        let ratio = record.figure("ratio");
        let build = move |elements: usize| {
            // Of radius 1, in the plane of x and z.
            let mut rod = slender_rod(TAU, [1.0; 2], 1.0);
            rod.stiffness.torsion = 1.0 / ratio.unwrap_or(1.0);
            let rod = rod.rod(Pose::IDENTITY, Vec3::Y, elements)?;
            let start = Support::free(Pose::IDENTITY);
            let mut assembly = Assembly::from(Problem { start, ..Problem::cantilever(rod) });
            let members = [0, elements].map(|node| Member::Node { rod: 0, node });
            let joint = Joint::at_rest(&assembly, JointKind::Rigid, members, None, Vec3::ZERO);
            assembly.joints.push(joint.unwrap_or_else(|_| unreachable!("a ring closes")));
            Ok(assembly)
        };
        let (label, push) = match ratio {
            None => ("in its plane".to_owned(), ALONG_X),
            Some(ratio) => (format!("out of its plane, EI/GJ = {ratio}"), ALONG_Y),
        };
        VibrationRow::new(label, figures(&record), push, build)
    });
    VibrationCase {
        name: "ring-vibrations",
        title: "A free ring, in its plane and out of it",
        source: "Hoppe 1871; Michell 1890; Love 1927, art. 293",
        elements: 200,
        tolerance: 2e-5,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

/// A chain, near enough.
const CHAIN: f64 = 1e-8;

fn hanging() -> VibrationCase {
    let table = Table::read(include_str!("../data/hanging_frequencies.csv"));
    let rows = table.records().map(|record| {
        let (stiffness, top) = (record.number("stiffness"), record.text("top"));
        let rod = slender_rod(1.0, [stiffness.max(CHAIN); 2], 1.0);
        let hold = if top == "pinned" { Hold::Pinned } else { Hold::Clamped };
        let build = move |elements: usize| {
            let problem = rod.held(elements, [hold, Hold::Free])?;
            let loads = NodalLoads::none(&problem.rod).with_gravity(&problem.rod, Vec3::Z);
            Ok(Problem { loads, ..problem }.into())
        };
        VibrationRow::new(format!("{top}, stiffness {stiffness}"), figures(&record), ALONG_X, build)
    });
    VibrationCase {
        name: "hanging-vibrations",
        title: "A chain and stiff cables that hang and swing",
        source: "D. Bernoulli 1732; Lamb, Hydrodynamics, 1932; stiff ones by Galerkin's method",
        elements: 200,
        // Where it is hardly stiff, it bends at its ends over less than an element.
        tolerance: 5e-5,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

fn dispersion() -> VibrationCase {
    const MODULI: [f64; 2] = [1.0, 1.0 / 2.6];
    let table = Table::read(include_str!("../data/dispersion.csv"));
    let rows = table.records().flat_map(|record| {
        let wave_number = record.number("wave_number");
        let rod = Uniform::round(PI / wave_number, 1.0, MODULI, 1.0);
        let of = move |kind: &str, frequencies: Vec<f64>, push, holds| VibrationRow {
            along: Along::Sine,
            ..VibrationRow::new(format!("{kind}, k r = {wave_number}"), frequencies, push, rod.between(holds))
        };
        let simple = [Hold::Pinned, Hold::PinnedSliding];
        let clamped = [Hold::Clamped, Hold::Clamped];
        let [lower, upper, axial, torsion] =
            ["lower", "upper", "axial", "torsion"].map(|column| record.number(column));
        // The branches are too far apart for one step where waves are long.
        let bending = if wave_number > 0.1 { vec![lower, upper] } else { vec![lower] };
        [
            of("bending", bending, ALONG_X, simple),
            of("axial", vec![axial], ALONG_Z, clamped),
            of("torsional", vec![torsion], TWIST, clamped),
        ]
    });
    VibrationCase {
        name: "dispersion",
        title: "Waves in a thick round rod, half a length of each",
        source: "Graff, Wave Motion in Elastic Solids, 1975",
        elements: 40,
        tolerance: 1e-6,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}

fn turning() -> VibrationCase {
    let rows = Rotor::all().into_iter().map(|rotor| {
        let build = move |elements: usize| Ok(rotor.pulled(elements)?.into());
        VibrationRow::new(format!("turning at {}", rotor.turning), rotor.flap.into(), ALONG_Z, build)
    });
    VibrationCase {
        name: "turning-vibrations",
        title: "A cantilever that turns about its root and vibrates along the axis",
        source: "Wright et al., J. Appl. Mech. 49:197–202, 1982; Galerkin's method",
        elements: 200,
        tolerance: 1e-5,
        on_mesh: 5e-3,
        rows: rows.collect(),
    }
}
