//! The answer of a simulation, as scripts read it.

use super::{Frame, MovedBody, MovedRod};
use crate::model::Model;
use crate::write::Shape;
use crate::write::json::ReactionAnswer;
use indexmap::IndexMap;
use serde::Serialize;
use strands::contact::{Contact, Passage, Through, Toucher};

/// How a simulation went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ran {
    /// How many steps were made.
    pub steps: usize,
    /// Simulated seconds a second.
    pub real_time_factor: f64,
    /// Why there are no more.
    pub end: End,
}

/// Why a simulation ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// It was as long as was asked for.
    Finished,
    /// Someone ended it.
    Interrupted,
    /// A step could not be made: why.
    Failed(String),
}

#[derive(Serialize)]
struct Answer<'a> {
    scene: &'a str,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
    steps: usize,
    real_time_factor: f64,
    frames: Vec<FrameAnswer<'a>>,
}

#[derive(Serialize)]
struct FrameAnswer<'a> {
    t: f64,
    energy: EnergyAnswer,
    newton_iterations: usize,
    residual: f64,
    rods: IndexMap<&'a str, RodAnswer<'a>>,
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    bodies: IndexMap<&'a str, BodyAnswer>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    contacts: Vec<ContactAnswer<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passages: Vec<PassageAnswer<'a>>,
}

#[derive(Serialize)]
struct EnergyAnswer {
    kinetic: f64,
    elastic: f64,
    gravity: f64,
    dissipated: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    work: Option<f64>,
}

#[derive(Serialize)]
struct RodAnswer<'a> {
    s: &'a [f64],
    position: Vec<[f64; 3]>,
    orientation: Vec<[f64; 4]>,
    velocity: Vec<[f64; 3]>,
    angular_velocity: Vec<[f64; 3]>,
    strain: Vec<[f64; 6]>,
    stress: Vec<[f64; 6]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    reactions: Vec<ReactionAnswer>,
}

#[derive(Serialize)]
struct BodyAnswer {
    position: [f64; 3],
    orientation: [f64; 4],
    velocity: [f64; 3],
    angular_velocity: [f64; 3],
}

#[derive(Serialize)]
struct ContactAnswer<'a> {
    between: [ToucherAnswer<'a>; 2],
    point: [f64; 3],
    normal: [f64; 3],
    gap: f64,
    force: [f64; 3],
}

#[derive(Serialize)]
struct PassageAnswer<'a> {
    through: ThroughAnswer<'a>,
    rod: &'a str,
    s: f64,
    point: [f64; 3],
    force: [f64; 3],
}

#[derive(Serialize)]
#[serde(untagged)]
enum ThroughAnswer<'a> {
    Eyelet { eyelet: usize },
    Obstacle { obstacle: usize },
    Body { body: &'a str },
}

#[derive(Serialize)]
#[serde(untagged)]
enum ToucherAnswer<'a> {
    Element { rod: &'a str, element: usize },
    Node { rod: &'a str, node: usize },
    Obstacle { obstacle: usize },
    Body { body: &'a str },
}

/// A simulation as one JSON object: `scene`, `status` ("finished", "interrupted", or "failed" with the `reason`), `steps`, `real_time_factor` (simulated
/// seconds a second) and `frames`, each with the time `t` (s), the `energy` of all together (J: `kinetic`, `elastic`, `gravity`, which is that of all dead
/// loads, `dissipated` since the start, and, where it is known, the `work` of what has no potential), `newton_iterations` and the largest `residual`
/// since the frame before, and `rods`.
///
/// A rod has at its nodes `s` (m), `position` (m), `orientation` (quaternion, w first), `velocity` (m/s, world axes) and `angular_velocity` (rad/s, the
/// node's own axes); at its elements `strain` and `stress` as [`json`](fn@crate::write::json) has them; and, where they are known, its `reactions`. Where there
/// are `bodies`, each has the four of a node. Where surfaces touch there are `contacts`, each with what it is `between` (a `rod` and its `element` or `node`, the number
/// of an `obstacle`, or a `body`), its `point` (m), the `normal` from the second to the first, the `gap` (m) and the `force` of the second on the first (N). Where
/// rods pass through something there are `passages`, each with what it is `through` (the number of an `eyelet` or an `obstacle`, or a `body`), the `rod`, how far along
/// it the hole is (`s`, m), the `point` where it is when nothing pulls at it (m), and its `force` on the rod (N).
pub fn motion_json(model: &Model, frames: &[Frame], ran: &Ran) -> String {
    let (status, reason) = match &ran.end {
        End::Finished => ("finished", None),
        End::Interrupted => ("interrupted", None),
        End::Failed(reason) => ("failed", Some(reason.as_str())),
    };
    let Ran { steps, real_time_factor, .. } = *ran;
    let frames = frames.iter().map(|frame| answer(model, frame)).collect();
    let answer = Answer { scene: &model.name, status, reason, steps, real_time_factor, frames };
    serde_json::to_string(&answer).unwrap_or_else(|error| unreachable!("numbers and text: {error}"))
}

fn answer<'a>(model: &'a Model, frame: &'a Frame) -> FrameAnswer<'a> {
    let energy = &frame.energy;
    FrameAnswer {
        t: frame.time,
        energy: EnergyAnswer {
            kinetic: energy.kinetic,
            elastic: energy.elastic,
            gravity: energy.load,
            dissipated: energy.dissipated,
            work: energy.work,
        },
        newton_iterations: frame.iterations,
        residual: frame.residual,
        rods: frame
            .shapes(model)
            .map(|(shape, moved)| (shape.rod.name.as_str(), rod(&shape, moved)))
            .collect(),
        bodies: frame.bodies.iter().map(|moved| (moved.name.as_str(), body(moved))).collect(),
        contacts: frame.contacts.iter().map(|of| contact(model, of)).collect(),
        passages: frame.passages.iter().map(|of| passage(model, frame, of)).collect(),
    }
}

fn rod<'a>(shape: &Shape<'a>, moved: &MovedRod) -> RodAnswer<'a> {
    let MovedRod { poses, velocities, strain, stress, reactions } = moved;
    RodAnswer {
        s: shape.s(),
        position: poses.iter().map(|pose| pose.position.to_array()).collect(),
        orientation: poses.iter().map(|pose| pose.orientation().to_wxyz()).collect(),
        velocity: velocities.iter().map(|velocity| velocity.linear.to_array()).collect(),
        angular_velocity: velocities.iter().map(|velocity| velocity.angular.to_array()).collect(),
        strain: strain.iter().map(|strain| strain.to_array()).collect(),
        stress: stress.iter().map(|stress| stress.to_array()).collect(),
        reactions: reactions.iter().map(ReactionAnswer::from).collect(),
    }
}

fn body(moved: &MovedBody) -> BodyAnswer {
    BodyAnswer {
        position: moved.pose.position.to_array(),
        orientation: moved.pose.orientation().to_wxyz(),
        velocity: moved.velocity.linear.to_array(),
        angular_velocity: moved.velocity.angular.to_array(),
    }
}

fn passage<'a>(model: &'a Model, frame: &Frame, passage: &Passage) -> PassageAnswer<'a> {
    let Passage { rod, at, place, force, .. } = *passage;
    let point = match passage.body {
        Some(body) => frame.bodies[body].pose.position + frame.bodies[body].pose.rotation * place,
        None => place,
    };
    let through = match passage.through {
        Through::Eyelet(eyelet) => ThroughAnswer::Eyelet { eyelet },
        Through::Into { obstacle, .. } | Through::OutOf { obstacle, .. } => {
            match model.body_of_surface(obstacle) {
                Some(body) => ThroughAnswer::Body { body: &body.name },
                None => ThroughAnswer::Obstacle { obstacle },
            }
        }
    };
    let (point, force) = (point.to_array(), force.to_array());
    PassageAnswer { through, rod: &model.rods[rod].name, s: at, point, force }
}

fn contact<'a>(model: &'a Model, contact: &Contact) -> ContactAnswer<'a> {
    let name = |rod: usize| model.rods[rod].name.as_str();
    let between = contact.between.map(|toucher| match toucher {
        Toucher::Element { rod, element } => ToucherAnswer::Element { rod: name(rod), element },
        Toucher::Node { rod, node } => ToucherAnswer::Node { rod: name(rod), node },
        Toucher::Obstacle { obstacle, .. } => match model.body_of_surface(obstacle) {
            Some(body) => ToucherAnswer::Body { body: &body.name },
            None => ToucherAnswer::Obstacle { obstacle },
        },
    });
    let Contact { point, normal, gap, force, .. } = *contact;
    ContactAnswer {
        between,
        point: point.to_array(),
        normal: normal.to_array(),
        gap,
        force: force.to_array(),
    }
}
