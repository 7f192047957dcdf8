//! What ends of rods pierce: they go into tissue where they press with enough or are led into it, come out of it where they are out, and rods are drawn
//! through what they passed.

use super::Simulation;
use super::passages::along;
use crate::assembly::{Assembly, Member};
use crate::contact::{End, Passage, Through, Toucher};
use crate::math::{Pose, Vec3};

/// An end that is held goes into tissue where its surface would be nearer than so much of its radius; and is out of it, where it has not been inside, where that is further.
const TOUCHES: f64 = 1.1;
/// A hole is where an end is while no more of the rod than so many radii is through it.
const AT_END: f64 = 2.0;
/// So often a stretch is halved to find where it goes through a surface.
const HALVINGS: usize = 40;

/// An end of a rod.
#[derive(Clone, Copy)]
struct Tip {
    rod: usize,
    end: End,
    node: usize,
    frame: usize,
    radius: f64,
    /// How far along the rod it is, m.
    at: f64,
}

impl Tip {
    fn new(assembly: &Assembly, rod: usize, end: End) -> Self {
        let of = &assembly.strands[rod].problem.rod;
        let node = if end == End::Start { 0 } else { of.elements() };
        let [a, b] = of.half_extent()[node];
        let frame = assembly.nodes(rod).start + node;
        Self { rod, end, node, frame, radius: a.max(b), at: along(assembly, rod, end) }
    }

    /// The number of the passage by which it is in an obstacle now, if it is.
    fn entry(&self, list: &[Passage], obstacle: usize) -> Option<usize> {
        let of = |passage: &Passage| {
            passage.rod == self.rod && passage.through.hole() == Some((obstacle, self.end))
        };
        let last = list.iter().rposition(of)?;
        matches!(list[last].through, Through::Into { .. }).then_some(last)
    }
}

/// An obstacle of tissue, where the body that it is of is.
struct Seen<'a> {
    assembly: &'a Assembly,
    obstacle: usize,
    body: Option<Pose>,
}

impl<'a> Seen<'a> {
    fn new(assembly: &'a Assembly, obstacle: usize, poses: &[Pose]) -> Self {
        let body = assembly.obstacles[obstacle].body.map(|body| poses[assembly.first_body() + body]);
        Self { assembly, obstacle, body }
    }

    /// Where what holds its body leads it in a step.
    fn led(self) -> Self {
        let of = self.assembly.obstacles[self.obstacle].body;
        let support = of.and_then(|body| self.assembly.support(Member::Body(body)));
        let led = support.filter(|support| support.fixed == [true; 6]).map(|support| support.pose);
        Self { body: led.or(self.body), ..self }
    }

    fn to_own(&self, point: Vec3) -> Vec3 {
        self.body.map_or(point, |body| body.rotation.transpose() * (point - body.position))
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

    fn entry(&self, tip: &Tip, place: Vec3) -> Passage {
        let through = Through::Into { obstacle: self.obstacle, end: tip.end, been_inside: false };
        self.passage(through, tip.rod, tip.at, place)
    }

    /// Where an end that went in so far along its rod has come out again, of a rod whose nodes are so.
    fn exit(&self, tip: &Tip, in_at: f64, nodes: &[Pose]) -> Passage {
        let along = self.assembly.strands[tip.rod].problem.rod.mesh().nodes();
        let through = Through::OutOf { obstacle: self.obstacle, end: tip.end };
        let last = nodes.len() - 1;
        let from_end = |k: usize| if tip.end == End::Start { k } else { last - k };
        // The first stretch from the end on that leads inside, or to where it went in.
        for k in 0..last {
            let [out, next] = [from_end(k), from_end(k + 1)];
            let (a, b) = (nodes[out].position, nodes[next].position);
            let to_entry = (in_at - along[out]) / (along[next] - along[out]);
            let reach = to_entry.min(1.0);
            let within = a + (b - a) * reach;
            if to_entry <= 1.0 || self.distance(within) < 0.0 {
                let part = reach * self.crossing(a, within);
                let at = along[out] + (along[next] - along[out]) * part;
                return self.passage(through, tip.rod, at, a + (b - a) * part);
            }
        }
        self.passage(through, tip.rod, in_at, nodes[from_end(0)].position)
    }
}

impl Simulation {
    /// Ends of rods, and obstacles that they may pierce with some force, N.
    fn tips(&self) -> impl Iterator<Item = (Tip, usize, f64)> + use<> {
        let obstacles = self.assembly.obstacles.iter().enumerate();
        let tissues = obstacles.filter_map(|(i, obstacle)| Some((i, obstacle.tissue?.pierced_by)));
        let tissues: Vec<_> = tissues.filter(|_| self.assembly.surfaces.is_some()).collect();
        let rods = if tissues.is_empty() { 0 } else { self.assembly.strands.len() };
        let tip = |rod| [End::Start, End::End].map(|end| Tip::new(&self.assembly, rod, end));
        let tips: Vec<Tip> = (0..rods).flat_map(tip).collect();
        tips.into_iter()
            .flat_map(move |tip| tissues.clone().into_iter().map(move |(obstacle, by)| (tip, obstacle, by)))
    }

    /// Lets ends that are held go into tissue where they are led there in the next step, or the piece of it.
    pub(super) fn pierce_by_hand(&mut self) {
        for (tip, obstacle, _) in self.tips() {
            let support = self.assembly.support(Member::Node { rod: tip.rod, node: tip.node });
            let Some(support) = support.filter(|support| support.fixed[3..] == [true; 3]) else { continue };
            if tip.entry(&self.state.passages, obstacle).is_some() {
                continue;
            }
            let (from, to) = (self.state.poses[tip.frame].position, support.pose.position);
            let now = Seen::new(&self.assembly, obstacle, &self.state.poses);
            let before = now.distance(from);
            let led = now.led();
            let after = led.distance(to);
            // Beside it, it may go on.
            let goes_in = after < TOUCHES * tip.radius && after < before && before >= 0.0;
            if !goes_in {
                continue;
            }
            let place = if after < 0.0 { from + (to - from) * led.crossing(from, to) } else { to };
            let passage = led.entry(&tip, place);
            self.state.passages.push(passage);
        }
    }

    /// Lets ends pierce tissue where they press with enough, come out of it where they are out, and rods slide out of what they passed through.
    pub(super) fn pierce(&mut self) {
        for (tip, obstacle, pierced_by) in self.tips() {
            let place = self.state.poses[tip.frame].position;
            let seen = Seen::new(&self.assembly, obstacle, &self.state.poses);
            let Some(entry) = tip.entry(&self.state.passages, obstacle) else {
                let presses = self.presses(&tip, obstacle, place);
                if presses > 0.0 && presses >= pierced_by {
                    let passage = seen.entry(&tip, place);
                    self.state.passages.push(passage);
                }
                continue;
            };
            let Passage { at, through, .. } = self.state.passages[entry];
            let (passed, distance) = ((at - tip.at).abs(), seen.distance(place));
            let was_inside = matches!(through, Through::Into { been_inside: true, .. });
            if distance < 0.0 {
                let through = Through::Into { obstacle, end: tip.end, been_inside: true };
                self.state.passages[entry].through = through;
            } else if !was_inside && distance > TOUCHES * tip.radius
                || was_inside && passed == 0.0 && distance > tip.radius
            {
                // Beside it, or out by where it went in.
                self.state.passages.remove(entry);
            } else if was_inside && passed > AT_END * tip.radius {
                let nodes = &self.state.poses[self.assembly.nodes(tip.rod)];
                let passage = seen.exit(&tip, at, nodes);
                self.state.passages.push(passage);
            }
        }
        self.leave();
    }

    /// Takes back the holes out of which ends have gone back in, those through which a rod has been drawn, and eyelets that a rod has slid out of.
    fn leave(&mut self) {
        let assembly = &self.assembly;
        let (list, poses) = (&mut self.state.passages, &self.state.poses);
        let is_clear = |obstacle: usize, tip: Tip| {
            let place = poses[tip.frame].position;
            Seen::new(assembly, obstacle, poses).distance(place) > TOUCHES * tip.radius
        };
        let mut at = 0;
        while at < list.len() {
            let Passage { through, rod, at: place, .. } = list[at];
            let is_at = |end: End| place == along(assembly, rod, end);
            match through {
                Through::Eyelet(_) if is_at(End::Start) || is_at(End::End) => {
                    list.remove(at);
                }
                Through::OutOf { end, .. } if is_at(end) => {
                    list.remove(at);
                }
                Through::OutOf { obstacle, end }
                    if is_at(end.other()) && is_clear(obstacle, Tip::new(assembly, rod, end.other())) =>
                {
                    list.remove(at);
                    let of = |passage: &Passage| {
                        passage.rod == rod && passage.through.hole() == Some((obstacle, end))
                    };
                    if let Some(entry) = list[..at].iter().rposition(of) {
                        list.remove(entry);
                        at -= 1;
                    }
                }
                _ => at += 1,
            }
        }
    }

    /// With how much an end of a rod presses against an obstacle, N.
    fn presses(&self, tip: &Tip, obstacle: usize, place: Vec3) -> f64 {
        let element = tip.node.saturating_sub(1);
        let mut sum = Vec3::ZERO;
        for contact in &self.state.contacts {
            let [own, other] = contact.between;
            let is_own = match own {
                Toucher::Node { rod, node } => rod == tip.rod && node == tip.node,
                Toucher::Element { rod, element: at } => rod == tip.rod && at == element,
                Toucher::Obstacle { .. } => false,
            };
            let near = (contact.point - place).norm() <= AT_END * tip.radius;
            if is_own && near && other.obstacle() == Some(obstacle) {
                sum += contact.normal * contact.force.dot(contact.normal);
            }
        }
        sum.norm()
    }
}
