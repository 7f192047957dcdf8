//! What rods pass through in a stage, and what ends of rods pierce after it.

use super::stage::Stage;
use super::{Simulation, SimulationError};
use crate::assembly::{Assembly, Member, Strand};
use crate::contact::{Axis, Contact, End, Eyelet, Held, Hold, Passage, Shape, Through, Toucher};
use crate::math::{Mat3, Pose, Vec3, Wrench};
use crate::statics::{Touch, TouchEnd};

/// An end that is held goes into tissue where its surface would be nearer than so much of its radius.
const TOUCHES: f64 = 1.1;
/// A hole is where an end is while no more of the rod than so many radii is through it.
const AT_END: f64 = 2.0;
/// So often a stretch is halved to find where it goes through a surface.
const HALVINGS: usize = 40;

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
        let pierced_by = tissue.pierced_by;
        fits("the force that pierces tissue", pierced_by, not_negative(pierced_by), "0 or more")?;
        holds(&tissue.hold)?;
    }
    Ok(())
}

/// How what a rod passes through holds it.
fn hold(assembly: &Assembly, passage: &Passage) -> Hold {
    let of_tissue = |obstacle: usize| assembly.obstacles[obstacle].tissue.map(|tissue| tissue.hold);
    match passage.through {
        Through::Eyelet(eyelet) => assembly.eyelets[eyelet].hold,
        Through::Into(obstacle, ..) | Through::OutOf(obstacle, _) => of_tissue(obstacle)
            .unwrap_or_else(|| unreachable!("a state with holes in what is not tissue is refused")),
    }
}

/// The energy of the springs of what rods pass through, J.
pub(super) fn elastic(assembly: &Assembly, passages: &[Passage]) -> f64 {
    let of = |passage: &Passage| 0.5 * passage.force.dot(passage.force) / hold(assembly, passage).stiffness;
    passages.iter().map(of).sum()
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
        Through::Into(obstacle, ..) | Through::OutOf(obstacle, _) => {
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
            let Through::Into(obstacle, end, _) = passage.through else { continue };
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
            let nodes = assembly.nodes(passage.rod);
            let axis = Axis {
                nodes: &poses[nodes.clone()],
                along: assembly.strands[passage.rod].problem.rod.mesh().nodes(),
            };
            let at = place(assembly, passage, poses);
            let now = hold(assembly, passage).hold(&axis, passage.at, at);
            let mut exert = |frame: usize, force: Vec3, arm: Vec3| {
                stage.inertial[frame].exerts += Wrench::new(arm.cross(force), force);
            };
            exert(nodes.start + now.element, now.force * (1.0 - now.part), Vec3::ZERO);
            exert(nodes.start + now.element + 1, now.force * now.part, Vec3::ZERO);
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
            let weights = [1.0 - held.part, held.part, -1.0, 0.0];
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
            None => *passage,
        })
    }
}

/// Where an end that has gone into an obstacle has come out again, if it has.
fn out_of(list: &[Passage], rod: usize, obstacle: usize, end: End) -> Option<&Passage> {
    let later = list[1..].iter().filter(|passage| passage.rod == rod);
    let mut later = later.filter(|passage| match passage.through {
        Through::Into(of, by, _) | Through::OutOf(of, by) => of == obstacle && by == end,
        Through::Eyelet(_) => false,
    });
    later.next().filter(|passage| matches!(passage.through, Through::OutOf(..)))
}

/// How far along its rod an end is, m.
fn along(assembly: &Assembly, rod: usize, end: End) -> f64 {
    match end {
        End::Start => 0.0,
        End::End => assembly.strands[rod].problem.rod.length(),
    }
}

fn node(assembly: &Assembly, rod: usize, end: End) -> usize {
    match end {
        End::Start => 0,
        End::End => assembly.strands[rod].problem.rod.elements(),
    }
}

/// An obstacle of tissue, and how to see it from the world.
struct Seen<'a> {
    assembly: &'a Assembly,
    obstacle: usize,
    poses: &'a [Pose],
}

impl Seen<'_> {
    fn to_own(&self, point: Vec3) -> Vec3 {
        match self.assembly.obstacles[self.obstacle].body {
            None => point,
            Some(body) => {
                let pose = &self.poses[self.assembly.first_body() + body];
                pose.rotation.transpose() * (point - pose.position)
            }
        }
    }

    fn distance(&self, point: Vec3) -> f64 {
        self.assembly.obstacles[self.obstacle].shape.distance(self.to_own(point))
    }

    /// What part of the way from outside to inside the surface is at.
    fn crossing(&self, outside: Vec3, inside: Vec3) -> f64 {
        let (mut out, mut within) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (out + within);
            let is_out = self.distance(outside + (inside - outside) * middle) > 0.0;
            *(if is_out { &mut out } else { &mut within }) = middle;
        }
        within
    }

    fn passage(&self, through: Through, rod: usize, at: f64, place: Vec3) -> Passage {
        let body = self.assembly.obstacles[self.obstacle].body;
        Passage { through, rod, at, place: self.to_own(place), body, force: Vec3::ZERO }
    }
}

impl Simulation {
    /// The obstacles of tissue, with the force that pierces them, N.
    fn tissues(&self) -> Vec<(usize, f64)> {
        let all = self.assembly.obstacles.iter().enumerate();
        all.filter_map(|(i, obstacle)| Some((i, obstacle.tissue?.pierced_by))).collect()
    }

    /// The ends of rods, with their nodes' frames and radii.
    fn ends(&self) -> Vec<(usize, End, usize, f64)> {
        let of = |rod: usize| {
            [End::Start, End::End].map(|end| {
                let node = node(&self.assembly, rod, end);
                let [a, b] = self.assembly.strands[rod].problem.rod.half_extent()[node];
                (rod, end, self.assembly.nodes(rod).start + node, a.max(b))
            })
        };
        (0..self.assembly.strands.len()).flat_map(of).collect()
    }

    /// The number of the passage by which an end is in an obstacle now, if it is.
    fn entry(&self, rod: usize, end: End, obstacle: usize) -> Option<usize> {
        let list = &self.state.passages;
        let of = |passage: &Passage| match passage.through {
            Through::Into(of, by, _) | Through::OutOf(of, by) => {
                passage.rod == rod && of == obstacle && by == end
            }
            Through::Eyelet(_) => false,
        };
        let last = list.iter().rposition(of)?;
        matches!(list[last].through, Through::Into(..)).then_some(last)
    }

    /// Lets ends that are held go into tissue where they are led there in the next step.
    pub(super) fn pierce_by_hand(&mut self) {
        let tissues = self.tissues();
        if tissues.is_empty() {
            return;
        }
        for (rod, end, frame, radius) in self.ends() {
            let node = node(&self.assembly, rod, end);
            let support = self.assembly.support(Member::Node { rod, node });
            let Some(support) = support.filter(|support| support.fixed[3..] == [true; 3]) else { continue };
            let (from, to) = (self.state.poses[frame].position, support.pose.position);
            for &(obstacle, _) in &tissues {
                let seen = Seen { assembly: &self.assembly, obstacle, poses: &self.state.poses };
                let goes_in = seen.distance(to) < TOUCHES * radius;
                if !goes_in || self.entry(rod, end, obstacle).is_some() || seen.distance(from) < 0.0 {
                    continue;
                }
                // Beside it, it may go on.
                if seen.distance(to) > seen.distance(from) {
                    continue;
                }
                let place =
                    if seen.distance(to) < 0.0 { from + (to - from) * seen.crossing(from, to) } else { to };
                let through = Through::Into(obstacle, end, false);
                let passage = seen.passage(through, rod, along(&self.assembly, rod, end), place);
                self.state.passages.push(passage);
            }
        }
    }

    /// Lets ends pierce tissue where they press with enough, come out of it where they are out, and rods slide out of what they passed through.
    pub(super) fn pierce(&mut self) {
        let tissues = self.tissues();
        let ends = if tissues.is_empty() { Vec::new() } else { self.ends() };
        for (rod, end, frame, radius) in ends {
            for &(obstacle, pierced_by) in &tissues {
                let at = along(&self.assembly, rod, end);
                let place = self.state.poses[frame].position;
                let seen = Seen { assembly: &self.assembly, obstacle, poses: &self.state.poses };
                let distance = seen.distance(place);
                let Some(entry) = self.entry(rod, end, obstacle) else {
                    let presses = self.presses(rod, end, obstacle, place, radius);
                    if presses >= pierced_by {
                        let through = Through::Into(obstacle, end, false);
                        let passage = seen.passage(through, rod, at, place);
                        self.state.passages.push(passage);
                    }
                    continue;
                };
                let passed = (self.state.passages[entry].at - at).abs();
                let was_inside = matches!(self.state.passages[entry].through, Through::Into(_, _, true));
                if distance < 0.0 {
                    self.state.passages[entry].through = Through::Into(obstacle, end, true);
                } else if passed <= 0.0 && distance > radius {
                    // Out by where it went in.
                    self.state.passages.remove(entry);
                } else if was_inside && passed > AT_END * radius {
                    let passage = self.comes_out(rod, end, entry, &seen);
                    self.state.passages.push(passage);
                }
            }
        }
        self.go_back();
    }

    /// Where an end has come out of an obstacle.
    fn comes_out(&self, rod: usize, end: End, entry: usize, seen: &Seen) -> Passage {
        let nodes = &self.state.poses[self.assembly.nodes(rod)];
        let along = self.assembly.strands[rod].problem.rod.mesh().nodes();
        let in_at = self.state.passages[entry].at;
        let through = Through::OutOf(seen.obstacle, end);
        let from_end: Vec<usize> = match end {
            End::Start => (0..nodes.len()).collect(),
            End::End => (0..nodes.len()).rev().collect(),
        };
        // The first stretch from the end on that leads inside, or to where it went in.
        for pair in from_end.windows(2) {
            let [out, next] = [pair[0], pair[1]];
            let goes_by = (along[next] - in_at) * (along[out] - in_at) <= 0.0;
            let (a, b) = (nodes[out].position, nodes[next].position);
            let within = if goes_by {
                let part = (in_at - along[out]) / (along[next] - along[out]);
                a + (b - a) * part
            } else {
                b
            };
            if goes_by || seen.distance(within) < 0.0 {
                let part = seen.crossing(a, within);
                let reach =
                    if goes_by { (in_at - along[out]).abs() } else { (along[next] - along[out]).abs() };
                let at = along[out] + (along[next] - along[out]).signum() * reach * part;
                return seen.passage(through, rod, at, a + (within - a) * part);
            }
        }
        seen.passage(through, rod, in_at, nodes[from_end[0]].position)
    }

    /// Takes back holes that ends have come out of, and have gone back into.
    fn go_back(&mut self) {
        let assembly = &self.assembly;
        let list = &mut self.state.passages;
        list.retain(|passage| match passage.through {
            Through::OutOf(_, end) => (passage.at - along(assembly, passage.rod, end)).abs() > 0.0,
            Through::Eyelet(_) => passage.at > 0.0 && passage.at < along(assembly, passage.rod, End::End),
            Through::Into(..) => true,
        });
    }

    /// With how much an end of a rod presses against an obstacle, N.
    fn presses(&self, rod: usize, end: End, obstacle: usize, place: Vec3, radius: f64) -> f64 {
        let node = node(&self.assembly, rod, end);
        let element = node.saturating_sub(1);
        let of_end = |contact: &&Contact| {
            let [own, other] = contact.between;
            let is_own = match own {
                Toucher::Node { rod: of, node: at } => of == rod && at == node,
                Toucher::Element { rod: of, element: at } => of == rod && at == element,
                Toucher::Obstacle { .. } => false,
            };
            let near = (contact.point - place).norm() <= AT_END * radius;
            is_own && near && other.obstacle() == Some(obstacle)
        };
        let touching = self.state.contacts.iter().filter(of_end);
        let sum = touching
            .fold(Vec3::ZERO, |sum, contact| sum + contact.normal * contact.force.dot(contact.normal));
        sum.norm()
    }
}
