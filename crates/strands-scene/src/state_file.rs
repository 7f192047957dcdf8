//! States of simulations as files, from which they go on to the same bits; where things touch, to round-off: in which order the linear system is solved depends on what touched before.

use core::fmt;

use serde::{Deserialize, Serialize};
use strands::assembly::MassMatrix;
use strands::contact::{Contact, End, Passage, Through, Toucher};
use strands::dynamics::{Means, Past, Power, State};
use strands::math::{Mat3, Pose, Vec3, Vec6};
use thiserror::Error;

use crate::Model;

/// The format that is written and read. In the first one angular momenta were about a place of all, and the second did not say what moves.
const FORMAT: u32 = 4;

/// Lengths and masses that differ by less than this part are the same.
const SAME: f64 = 1e-12;

/// What a state's file is not.
#[derive(Debug, Error)]
pub enum StateError {
    /// It has not the form of one.
    #[error("not the state of a simulation: {0}; give a file that `strands simulate --save` has written")]
    Form(#[from] serde_json::Error),
    /// It is of another version.
    #[error("a state of format {0}, and this program reads format {FORMAT}; write it anew with `strands simulate --save`", FORMAT = FORMAT)]
    Format(u32),
    /// It is of other rods or bodies.
    #[error(
        "the state is of {there}, and this scene has {here} there: give a state of the same rods and bodies"
    )]
    Other {
        /// What it is of.
        there: String,
        /// What the scene has in that place.
        here: String,
    },
}

type Row<const N: usize> = Vec<[f64; N]>;

/// A state as written. Of a pose the columns of its rotation, then its position; of all else the angular part, then the linear.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    format: u32,
    /// What moves.
    rods: Vec<WrittenRod>,
    bodies: Vec<WrittenBody>,
    time: f64,
    poses: Row<12>,
    velocities: Row<6>,
    momenta: Row<6>,
    wrenches: Row<6>,
    dissipated: f64,
    worked: f64,
    power: [f64; 2],
    next_step: f64,
    past: WrittenPast,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    contacts: Vec<WrittenContact>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    passages: Vec<WrittenPassage>,
}

/// All that is read before the format is known.
#[derive(Deserialize)]
struct Headed {
    format: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenRod {
    elements: usize,
    length: f64,
    mass: f64,
    /// Where its mass matrix is the consistent one.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    consistent: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenBody {
    mass: f64,
}

impl PartialEq for WrittenRod {
    fn eq(&self, other: &Self) -> bool {
        self.elements == other.elements
            && near(self.length, other.length)
            && near(self.mass, other.mass)
            && self.consistent == other.consistent
    }
}

impl PartialEq for WrittenBody {
    fn eq(&self, other: &Self) -> bool {
        near(self.mass, other.mass)
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

impl fmt::Display for WrittenRod {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { elements, length, mass, consistent } = self;
        write!(f, "a rod of {elements} elements, {length:?} m and {mass:?} kg")?;
        if *consistent { write!(f, " with a consistent mass matrix") } else { Ok(()) }
    }
}

impl fmt::Display for WrittenBody {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a body of {:?} kg", self.mass)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum WrittenPast {
    None,
    Before { poses: Row<12>, momenta: Row<6> },
    Rates { momentum: Row<6>, strain: Row<6>, means: Option<WrittenMeans> },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenContact {
    between: [WrittenToucher; 2],
    point: [f64; 3],
    normal: [f64; 3],
    gap: f64,
    force: [f64; 3],
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum WrittenToucher {
    Element { rod: usize, element: usize },
    Node { rod: usize, node: usize },
    Obstacle { obstacle: usize, part: usize },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenPassage {
    through: WrittenThrough,
    rod: usize,
    at: f64,
    place: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    body: Option<usize>,
    force: [f64; 3],
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum WrittenThrough {
    Eyelet { eyelet: usize },
    Into { obstacle: usize, end: WrittenEnd, been_inside: bool },
    OutOf { obstacle: usize, end: WrittenEnd },
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum WrittenEnd {
    Start,
    End,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenMeans {
    velocity: Row<6>,
    momentum: Row<6>,
    strain: Row<6>,
}

/// The state of a scene in motion as a file's text.
pub fn state_json(model: &Model, state: &State) -> String {
    let (rods, bodies) = what_moves(model);
    let written = Written {
        format: FORMAT,
        rods,
        bodies,
        time: state.time,
        poses: poses_out(&state.poses),
        velocities: sixes_out(&state.velocities),
        momenta: sixes_out(&state.momenta),
        wrenches: sixes_out(&state.wrenches),
        dissipated: state.dissipated,
        worked: state.worked,
        power: [state.power.dissipated, state.power.worked],
        next_step: state.next_step,
        contacts: state.contacts.iter().map(contact_out).collect(),
        passages: state.passages.iter().map(passage_out).collect(),
        past: match &state.past {
            Past::None => WrittenPast::None,
            Past::Before { poses, momenta } => {
                WrittenPast::Before { poses: poses_out(poses), momenta: sixes_out(momenta) }
            }
            Past::Rates { momentum, strain, means } => WrittenPast::Rates {
                momentum: sixes_out(momentum),
                strain: sixes_out(strain),
                means: means.as_ref().map(|means| WrittenMeans {
                    velocity: sixes_out(&means.velocity),
                    momentum: sixes_out(&means.momentum),
                    strain: sixes_out(&means.strain),
                }),
            },
        },
    };
    serde_json::to_string(&written).unwrap_or_else(|error| unreachable!("numbers have a form: {error}"))
}

/// The state of a scene in motion that a file's text is of.
///
/// # Errors
/// Where it is not the text of a state, or of one of other rods and bodies.
pub fn read_state(model: &Model, text: &str) -> Result<State, StateError> {
    let Headed { format } = serde_json::from_str(text)?;
    if format != FORMAT {
        return Err(StateError::Format(format));
    }
    let written: Written = serde_json::from_str(text)?;
    let (rods, bodies) = what_moves(model);
    same(&written.rods, &rods)?;
    same(&written.bodies, &bodies)?;
    let [dissipated, worked] = written.power;
    Ok(State {
        time: written.time,
        poses: poses_in(&written.poses),
        velocities: sixes_in(&written.velocities),
        momenta: sixes_in(&written.momenta),
        wrenches: sixes_in(&written.wrenches),
        dissipated: written.dissipated,
        worked: written.worked,
        power: Power { dissipated, worked },
        next_step: written.next_step,
        contacts: written.contacts.into_iter().map(contact_in).collect(),
        passages: written.passages.into_iter().map(passage_in).collect(),
        past: match written.past {
            WrittenPast::None => Past::None,
            WrittenPast::Before { poses, momenta } => {
                Past::Before { poses: poses_in(&poses), momenta: sixes_in(&momenta) }
            }
            WrittenPast::Rates { momentum, strain, means } => Past::Rates {
                momentum: sixes_in(&momentum),
                strain: sixes_in(&strain),
                means: means.map(|means| Means {
                    velocity: sixes_in(&means.velocity),
                    momentum: sixes_in(&means.momentum),
                    strain: sixes_in(&means.strain),
                }),
            },
        },
    })
}

fn what_moves(model: &Model) -> (Vec<WrittenRod>, Vec<WrittenBody>) {
    let rods = model.rods.iter().map(|of| {
        let rod = &of.problem.rod;
        let consistent = of.mass_matrix == MassMatrix::Consistent;
        WrittenRod { elements: rod.elements(), length: rod.length(), mass: rod.mass(), consistent }
    });
    let bodies = model.bodies.iter().map(|of| WrittenBody { mass: of.body.inertia.mass });
    (rods.collect(), bodies.collect())
}

/// Refuses those that are not the same.
fn same<T: PartialEq + fmt::Display>(there: &[T], here: &[T]) -> Result<(), StateError> {
    let said = |of: Option<&T>| of.map_or_else(|| "none".to_owned(), T::to_string);
    for k in 0..there.len().max(here.len()) {
        let (there, here) = (there.get(k), here.get(k));
        if there != here {
            return Err(StateError::Other { there: said(there), here: said(here) });
        }
    }
    Ok(())
}

fn passage_out(passage: &Passage) -> WrittenPassage {
    let end = |end: End| match end {
        End::Start => WrittenEnd::Start,
        End::End => WrittenEnd::End,
    };
    let through = match passage.through {
        Through::Eyelet(eyelet) => WrittenThrough::Eyelet { eyelet },
        Through::Into { obstacle, end: of, been_inside } => {
            WrittenThrough::Into { obstacle, end: end(of), been_inside }
        }
        Through::OutOf { obstacle, end: of } => WrittenThrough::OutOf { obstacle, end: end(of) },
    };
    let Passage { rod, at, place, body, force, .. } = *passage;
    WrittenPassage { through, rod, at, place: place.to_array(), body, force: force.to_array() }
}

fn passage_in(written: WrittenPassage) -> Passage {
    let end = |end: WrittenEnd| match end {
        WrittenEnd::Start => End::Start,
        WrittenEnd::End => End::End,
    };
    let through = match written.through {
        WrittenThrough::Eyelet { eyelet } => Through::Eyelet(eyelet),
        WrittenThrough::Into { obstacle, end: of, been_inside } => {
            Through::Into { obstacle, end: end(of), been_inside }
        }
        WrittenThrough::OutOf { obstacle, end: of } => Through::OutOf { obstacle, end: end(of) },
    };
    let WrittenPassage { rod, at, place, body, force, .. } = written;
    Passage { through, rod, at, place: place.into(), body, force: force.into() }
}

fn contact_out(contact: &Contact) -> WrittenContact {
    let between = contact.between.map(|toucher| match toucher {
        Toucher::Element { rod, element } => WrittenToucher::Element { rod, element },
        Toucher::Node { rod, node } => WrittenToucher::Node { rod, node },
        Toucher::Obstacle { obstacle, part } => WrittenToucher::Obstacle { obstacle, part },
    });
    let Contact { point, normal, gap, force, .. } = *contact;
    let [point, normal, force] = [point, normal, force].map(Vec3::to_array);
    WrittenContact { between, point, normal, gap, force }
}

fn contact_in(written: WrittenContact) -> Contact {
    let between = written.between.map(|toucher| match toucher {
        WrittenToucher::Element { rod, element } => Toucher::Element { rod, element },
        WrittenToucher::Node { rod, node } => Toucher::Node { rod, node },
        WrittenToucher::Obstacle { obstacle, part } => Toucher::Obstacle { obstacle, part },
    });
    let [point, normal, force] = [written.point, written.normal, written.force].map(Vec3::from);
    Contact { between, point, normal, gap: written.gap, force }
}

fn sixes_out(sixes: &[Vec6]) -> Row<6> {
    sixes.iter().map(|six| six.to_array()).collect()
}

fn sixes_in(rows: &Row<6>) -> Vec<Vec6> {
    rows.iter().map(|row| Vec6::from(*row)).collect()
}

fn poses_out(poses: &[Pose]) -> Row<12> {
    let out = |pose: &Pose| {
        let [a, b, c] = pose.rotation.cols.map(Vec3::to_array);
        let parts = [a, b, c, pose.position.to_array()];
        core::array::from_fn(|k| parts[k / 3][k % 3])
    };
    poses.iter().map(out).collect()
}

fn poses_in(rows: &Row<12>) -> Vec<Pose> {
    let vector = |row: &[f64; 12], k: usize| Vec3::new(row[k], row[k + 1], row[k + 2]);
    let pose = |row: &[f64; 12]| Pose {
        rotation: Mat3::from_cols(vector(row, 0), vector(row, 3), vector(row, 6)),
        position: vector(row, 9),
    };
    rows.iter().map(pose).collect()
}
