//! What rods pass through in a stage.

use super::SimulationError;
use super::stage::Stage;
use crate::assembly::{Assembly, Strand};
use crate::contact::{Axis, End, Eyelet, Held, Hold, Passage, Shape, Through, weights};
use crate::math::{Mat3, Pose, Vec3, Wrench};
use crate::statics::{Touch, TouchEnd};

/// The passages of a stage, and how they hold their rods.
#[derive(Clone, Debug, Default)]
pub(super) struct Passages {
    list: Vec<Passage>,
    held: Vec<Option<Held>>,
}

/// A stretch of a rod that is inside an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inside {
    pub rod: usize,
    pub obstacle: usize,
    /// Between which places along the rod, m.
    pub along: [f64; 2],
}

/// The passages through eyelets, as all starts.
pub(super) fn of_eyelets(assembly: &Assembly) -> Vec<Passage> {
    let of = |(i, eyelet): (usize, &Eyelet)| {
        let Eyelet { rod, at, place, body, .. } = *eyelet;
        Passage { through: Through::Eyelet(i), rod, at, place, body, force: Vec3::ZERO }
    };
    assembly.eyelets.iter().enumerate().map(of).collect()
}

/// Whether the eyelets and the tissue are such that can hold rods.
pub(super) fn check(assembly: &Assembly) -> Result<(), SimulationError> {
    if assembly.surfaces.is_none() && !assembly.eyelets.is_empty() {
        return Err(SimulationError::EyeletsWithoutContact);
    }
    let positive = |value: f64| value > 0.0 && value.is_finite();
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    let fits = |what, value, fits: bool, wanted| {
        if fits { Ok(()) } else { Err(SimulationError::Setting { what, value, wanted }) }
    };
    let holds = |hold: &Hold| {
        fits(
            "the stiffness of what a rod passes through",
            hold.stiffness,
            positive(hold.stiffness),
            "greater than 0",
        )?;
        fits("its friction", hold.friction, not_negative(hold.friction), "0 or more")?;
        fits("its grip", hold.grip, not_negative(hold.grip), "0 or more")
    };
    for (i, eyelet) in assembly.eyelets.iter().enumerate() {
        let is_along = |strand: &Strand| eyelet.at > 0.0 && eyelet.at < strand.problem.rod.length();
        let is_of_body = eyelet.body.is_none_or(|body| body < assembly.bodies.len());
        if !assembly.strands.get(eyelet.rod).is_some_and(is_along) || !is_of_body {
            return Err(SimulationError::NoEyelet(i));
        }
        holds(&eyelet.hold)?;
    }
    for (i, obstacle) in assembly.obstacles.iter().enumerate() {
        let Some(tissue) = obstacle.tissue else { continue };
        if matches!(obstacle.shape, Shape::Bore { .. }) {
            return Err(SimulationError::BoreOfTissue(i));
        }
        if let Shape::Mesh(mesh) = &obstacle.shape
            && !mesh.is_closed()
        {
            return Err(SimulationError::OpenTissue(i));
        }
        let pierced_by = tissue.pierced_by;
        fits("the force that pierces tissue", pierced_by, not_negative(pierced_by), "0 or more")?;
        holds(&tissue.hold)?;
    }
    Ok(())
}

/// How what a rod passes through holds it, if there still is such a thing, and the rod has not been drawn through it.
fn hold(assembly: &Assembly, passage: &Passage) -> Option<Hold> {
    match passage.through {
        Through::Eyelet(eyelet) => Some(assembly.eyelets.get(eyelet)?.hold),
        Through::Into { obstacle, end, .. } | Through::OutOf { obstacle, end } => {
            let hold = assembly.obstacles.get(obstacle)?.tissue?.hold;
            (passage.at != along(assembly, passage.rod, end.other())).then_some(hold)
        }
    }
}

/// How far along its rod an end is, m.
pub(super) fn along(assembly: &Assembly, rod: usize, end: End) -> f64 {
    match end {
        End::Start => 0.0,
        End::End => assembly.strands[rod].problem.rod.length(),
    }
}

/// The energy of the springs of what rods pass through, J.
pub(super) fn elastic(assembly: &Assembly, passages: &[Passage]) -> f64 {
    let of =
        |passage: &Passage| Some(0.5 * passage.force.dot(passage.force) / hold(assembly, passage)?.stiffness);
    passages.iter().filter_map(of).sum()
}

/// Whether an assembly has what a rod passes through so.
pub(super) fn is_of(assembly: &Assembly, passage: &Passage) -> bool {
    let is_along = |rod: usize| {
        let strand = assembly.strands.get(rod);
        strand.is_some_and(|strand| (0.0..=strand.problem.rod.length()).contains(&passage.at))
    };
    let body = match passage.through {
        Through::Eyelet(eyelet) => {
            let of = assembly.eyelets.get(eyelet).filter(|of| of.rod == passage.rod);
            of.map(|of| of.body)
        }
        Through::Into { obstacle, .. } | Through::OutOf { obstacle, .. } => {
            assembly.obstacles.get(obstacle).filter(|of| of.tissue.is_some()).map(|of| of.body)
        }
    };
    is_along(passage.rod) && body == Some(passage.body)
}

/// Where a passage is, in the world.
fn place(assembly: &Assembly, passage: &Passage, poses: &[Pose]) -> Vec3 {
    match passage.body {
        None => passage.place,
        Some(body) => {
            let pose = &poses[assembly.first_body() + body];
            pose.position + pose.rotation * passage.place
        }
    }
}

impl Passages {
    /// Begins a stage with those that there are.
    pub fn begin(&mut self, list: &[Passage]) {
        self.list.clear();
        self.list.extend_from_slice(list);
        self.held.clear();
        self.held.resize(list.len(), None);
    }

    /// The stretches of rods that are inside of obstacles.
    pub fn inside(&self, assembly: &Assembly) -> Vec<Inside> {
        let mut stretches = Vec::new();
        for (i, passage) in self.list.iter().enumerate() {
            let Through::Into { obstacle, end, .. } = passage.through else { continue };
            let out = out_of(&self.list[i..], passage.rod, obstacle, end);
            let far = out.map_or_else(|| along(assembly, passage.rod, end), |out| out.at);
            let along = [passage.at.min(far), passage.at.max(far)];
            stretches.push(Inside { rod: passage.rod, obstacle, along });
        }
        stretches
    }

    /// Looks at how they hold their rods, and adds that to what acts on the frames.
    pub fn look(&mut self, assembly: &Assembly, stage: &mut Stage, poses: &[Pose]) {
        for (passage, held) in self.list.iter().zip(&mut self.held) {
            *held = None;
            let Some(hold) = hold(assembly, passage) else { continue };
            let nodes = assembly.nodes(passage.rod);
            let axis = Axis {
                nodes: &poses[nodes.clone()],
                along: assembly.strands[passage.rod].problem.rod.mesh().nodes(),
            };
            let at = place(assembly, passage, poses);
            let now = hold.hold(&axis, passage.at, at);
            let mut exert = |frame: usize, force: Vec3, arm: Vec3| {
                stage.inertial[frame].exerts += Wrench::new(arm.cross(force), force);
            };
            let [near, far, _] = weights(now.part);
            exert(nodes.start + now.element, now.force * near, Vec3::ZERO);
            exert(nodes.start + now.element + 1, now.force * far, Vec3::ZERO);
            if let Some(body) = passage.body {
                let frame = assembly.first_body() + body;
                exert(frame, now.force * -1.0, at - poses[frame].position);
            }
            *held = Some(now);
        }
    }

    /// The frames that each one is between.
    fn frames(assembly: &Assembly, passage: &Passage, held: &Held) -> [Option<usize>; 4] {
        let first = assembly.nodes(passage.rod).start + held.element;
        let body = passage.body.map(|body| assembly.first_body() + body);
        [Some(first), Some(first + 1), body, None]
    }

    /// The same of those that are of bodies.
    pub fn ties(&self, assembly: &Assembly) -> impl Iterator<Item = [Option<usize>; 4]> {
        let of_bodies = self.list.iter().zip(&self.held).filter(|(passage, _)| passage.body.is_some());
        of_bodies.filter_map(move |(passage, held)| Some(Self::frames(assembly, passage, held.as_ref()?)))
    }

    /// What they add to the linear system.
    pub fn touches(&self, assembly: &Assembly, poses: &[Pose]) -> impl Iterator<Item = Touch> {
        self.list.iter().zip(&self.held).filter_map(move |(passage, held)| {
            let held = held.as_ref()?;
            let at = place(assembly, passage, poses);
            let weights = weights(held.part);
            let frames = Self::frames(assembly, passage, held);
            let ends = core::array::from_fn(|k| {
                let frame = frames[k]?;
                let place = if k == 2 { at } else { poses[frame].position };
                Some(TouchEnd { frame, weight: weights[k], place, touches: place })
            });
            let slope = |k: usize, l: usize| {
                if k < 3 && l < 3 { held.slopes[k][l].scaled(-1.0) } else { Mat3::ZERO }
            };
            let bends = core::array::from_fn(|k| core::array::from_fn(|l| slope(k, l)));
            Some(Touch { ends, pull: Vec3::ZERO, stiffness: Mat3::ZERO, bends: Some(bends), turns: None })
        })
    }

    /// How fast energy goes by friction in them, W, in a stage in which a rate counts so much, s.
    pub fn power(&self, of_rate: f64) -> f64 {
        let of = |(passage, held): (&Passage, &Option<Held>)| {
            let held = held.as_ref()?;
            Some(held.rubs * (held.at - passage.at).abs() / of_rate)
        };
        self.list.iter().zip(&self.held).filter_map(of).sum()
    }

    /// Where they are at the end of a stage.
    pub fn taken(&self) -> impl Iterator<Item = Passage> {
        self.list.iter().zip(&self.held).map(|(passage, held)| match held {
            Some(held) => Passage { at: held.at, force: held.force, ..*passage },
            None => Passage { force: Vec3::ZERO, ..*passage },
        })
    }
}

/// Where an end that has gone into an obstacle has come out again, if it has.
fn out_of(list: &[Passage], rod: usize, obstacle: usize, end: End) -> Option<&Passage> {
    let of = |passage: &&Passage| passage.rod == rod && passage.through.hole() == Some((obstacle, end));
    let next = list[1..].iter().find(of);
    next.filter(|passage| matches!(passage.through, Through::OutOf { .. }))
}
