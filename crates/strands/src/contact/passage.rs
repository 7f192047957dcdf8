//! Places through which rods slide: eyelets, and the holes that they pierce into tissue.
//!
//! An edge of a hole is a point on springs. It draws the place of the rod's axis that is in it back by so much a metre, and a rod slides through it where it
//! pulls along itself with more than what grips it and Coulomb's friction of what presses it to a side. What slides does so implicitly, told from where it was when
//! the step began: what sticks does not creep.

use crate::math::{Mat3, Pose, Vec3};

/// How the edge of a hole holds what passes through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// How stiff it is, N/m.
    pub stiffness: f64,
    /// The coefficient of friction, against what presses the rod to its side.
    pub friction: f64,
    /// How much friction there is beside that, N.
    pub grip: f64,
}

/// An eyelet: a rod slides through it from the start on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eyelet {
    /// The rod.
    pub rod: usize,
    /// How far along the rod it is at first, m of rest length from its start.
    pub at: f64,
    /// Where it is, in the world or in the axes of the body that it is of.
    pub place: Vec3,
    /// The body that it is of; else it stands still.
    pub body: Option<usize>,
    /// How it holds the rod.
    pub hold: Hold,
}

/// What an obstacle is that the ends of rods pierce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tissue {
    /// The force with which an end pierces it, N. An end whose place is held goes in without more ado, for what holds it exerts whatever is needed.
    pub pierced_by: f64,
    /// How the edges of the holes hold what has gone through.
    pub hold: Hold,
}

/// An end of a rod.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where its length is counted from.
    Start,
    /// The other one.
    End,
}

impl End {
    /// The other one.
    pub fn other(self) -> Self {
        if self == Self::Start { Self::End } else { Self::Start }
    }
}

/// What a rod passes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// An eyelet.
    Eyelet(usize),
    /// A hole through which an end has gone into an obstacle.
    Into {
        /// The obstacle.
        obstacle: usize,
        /// Which end.
        end: End,
        /// Whether it has been inside.
        been_inside: bool,
    },
    /// A hole through which it has come out again.
    OutOf {
        /// The obstacle.
        obstacle: usize,
        /// Which end.
        end: End,
    },
}

impl Through {
    /// The obstacle that a hole is in, and the end that has made it.
    pub(crate) fn hole(&self) -> Option<(usize, End)> {
        match *self {
            Self::Eyelet(_) => None,
            Self::Into { obstacle, end, .. } | Self::OutOf { obstacle, end } => Some((obstacle, end)),
        }
    }
}

/// A rod that passes through an eyelet or a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// What it passes through.
    pub through: Through,
    /// The rod.
    pub rod: usize,
    /// How far along the rod it is, m of rest length from its start.
    pub at: f64,
    /// Where the hole is when nothing pulls at it, in the world or in the axes of the body that it is of.
    pub place: Vec3,
    /// The body that it is of; else it stands still.
    pub body: Option<usize>,
    /// What it exerts on the rod, N, world axes.
    pub force: Vec3,
}

/// A rod's axis: where its nodes are, and how far along it, m.
pub(crate) struct Axis<'a> {
    pub nodes: &'a [Pose],
    pub along: &'a [f64],
}

impl Axis<'_> {
    fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The element that a place is on.
    fn element(&self, at: f64) -> usize {
        let beyond = self.along.partition_point(|along| *along <= at);
        beyond.clamp(1, self.elements()) - 1
    }

    /// From one node of an element to the other.
    fn chord(&self, element: usize) -> Vec3 {
        self.nodes[element + 1].position - self.nodes[element].position
    }

    /// The mean direction of the elements about a node.
    fn direction(&self, node: usize) -> Vec3 {
        let of = |element: usize| self.chord(element).normalized().unwrap_or(Vec3::ZERO);
        (of(node.saturating_sub(1)) + of(node.min(self.elements() - 1))) * 0.5
    }
}

/// A place of an axis.
struct Place {
    at: f64,
    element: usize,
    /// How far along the element, from 0 to 1.
    part: f64,
    position: Vec3,
    /// The direction in which it goes on there, which turns evenly from node to node, and how it changes with the part.
    tangent: Vec3,
    turns: Vec3,
    /// The size of the mean of the directions.
    size: f64,
}

impl Place {
    fn new(axis: &Axis, element: usize, at: f64) -> Self {
        let [from, to] = [axis.along[element], axis.along[element + 1]];
        let part = (at - from) / (to - from);
        let [near, far] = [axis.direction(element), axis.direction(element + 1)];
        let mean = near + (far - near) * part;
        let size = mean.norm();
        // Folded back on itself it goes on nowhere.
        let tangent = mean.normalized().unwrap_or(Vec3::ZERO);
        let turn = (far - near) * (1.0 / size.max(f64::MIN_POSITIVE));
        let turns = turn - tangent * turn.dot(tangent);
        let position = axis.nodes[element].position + axis.chord(element) * part;
        Self { at, element, part, position, tangent, turns, size }
    }

    /// How the tangent turns with a shift of each node of the element, those beyond left where they are.
    fn by_node(&self, axis: &Axis) -> [Mat3; 2] {
        let Self { element, part, tangent, size, .. } = *self;
        // A direction turns with its ends across itself, and the mean of those about a node is of half of each.
        let across = |of: Vec3| Mat3::IDENTITY - Mat3::outer(of, of);
        let ends = |element: usize, weight: f64| {
            let chord = axis.chord(element);
            let length = chord.norm();
            across(chord * (1.0 / length)).scaled(weight / (length * size))
        };
        let last = axis.elements() - 1;
        let before = element.checked_sub(1).map_or(Mat3::ZERO, |before| ends(before, 0.5 * (1.0 - part)));
        let after = if element < last { ends(element + 1, 0.5 * part) } else { Mat3::ZERO };
        let first = if element == 0 { 0.5 * (1.0 - part) } else { 0.0 };
        let own = ends(element, 0.5 + first + if element == last { 0.5 * part } else { 0.0 });
        [before - own, own - after].map(|by| across(tangent) * by)
    }
}

/// How a hole holds a rod where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    /// The element that is in it, how far along the rod it is, and how far along the element, from 0 to 1.
    pub element: usize,
    pub at: f64,
    pub part: f64,
    /// What it exerts on the rod, N, and with how much of that against what slides.
    pub force: Vec3,
    pub rubs: f64,
    /// How that changes with a shift of the rod's two nodes and the hole, N/m, for what each of them bears.
    pub slopes: [[Mat3; 3]; 3],
}

/// So many secants at most find how far a rod slides.
const SECANTS: usize = 60;

impl Hold {
    /// How it holds a rod that was in it so far along, now that the hole is in a place.
    pub(crate) fn hold(&self, axis: &Axis, was_at: f64, hole: Vec3) -> Held {
        let mut from = Place::new(axis, axis.element(was_at), was_at);
        let pull = |place: &Place| (place.position - hole) * -self.stiffness;
        let along = pull(&from).dot(from.tangent);
        let way = along.signum();
        if self.over(pull(&from), &from, way) <= 0.0 {
            return self.sticks(&from, pull(&from));
        }
        // It slides where the spring pulls along it with more than the bound: to where it does not.
        loop {
            let (node, next) = if way > 0.0 {
                (from.element + 1, from.element + 1)
            } else {
                (from.element, from.element.wrapping_sub(1))
            };
            let to = Place::new(axis, from.element, axis.along[node]);
            if self.over(pull(&to), &to, way) <= 0.0 {
                return self.slides_between(axis, hole, [&from, &to], way);
            }
            if next >= axis.elements() {
                return self.ends(axis, &to, pull(&to), way);
            }
            from = Place::new(axis, next, axis.along[node]);
        }
    }

    /// It slides to somewhere between two places of an element: found by secants, whose far end counts half as much each time it stays (the Illinois method).
    fn slides_between(&self, axis: &Axis, hole: Vec3, [from, to]: [&Place; 2], way: f64) -> Held {
        let pull = |place: &Place| (place.position - hole) * -self.stiffness;
        let over = |place: &Place| self.over(pull(place), place, way);
        let (mut ends, mut overs) = ([from.at, to.at], [over(from), over(to)]);
        let mut last = None;
        let mut place = Place::new(axis, from.element, to.at);
        for _ in 0..SECANTS {
            let at = ends[0] + (ends[1] - ends[0]) * (overs[0] / (overs[0] - overs[1]));
            place = Place::new(axis, from.element, at);
            let now = over(&place);
            let side = usize::from(now <= 0.0);
            if last == Some(side) {
                overs[1 - side] *= 0.5;
            }
            if at == ends[0] || at == ends[1] || now == 0.0 {
                break;
            }
            (ends[side], overs[side], last) = (at, now, Some(side));
        }
        self.slides(axis, &place, pull(&place), way)
    }

    /// By how much more than friction bears it is pulled along one way, N.
    fn over(&self, pull: Vec3, place: &Place, way: f64) -> f64 {
        let along = pull.dot(place.tangent);
        let across = pull - place.tangent * along;
        way * along - self.grip - self.friction * across.norm()
    }

    fn sticks(&self, place: &Place, force: Vec3) -> Held {
        let Place { at, element, part, .. } = *place;
        let weights = weights(part);
        let slopes = weights.map(|w| weights.map(|v| Mat3::IDENTITY.scaled(-self.stiffness * w * v)));
        Held { at, element, part, force, rubs: 0.0, slopes }
    }

    /// With `f = −k (x − x₀)` and what is over of it, `g(f, t) = 0`, which says how far along it has slid.
    fn slides(&self, axis: &Axis, place: &Place, force: Vec3, way: f64) -> Held {
        let Place { at, element, part, tangent, turns, .. } = *place;
        let along = force.dot(tangent);
        let side = (force - tangent * along).normalized().unwrap_or(Vec3::ZERO);
        let by_force = tangent * way - side * self.friction;
        let by_tangent = force * way + side * (self.friction * along);
        let chord = axis.chord(element);
        let by_part = by_tangent.dot(turns) - self.stiffness * by_force.dot(chord);
        let weights = weights(part);
        let slid = weights.map(|weight| by_force * (weight * self.stiffness / by_part));
        let by_node = place.by_node(axis);
        let slid = [0, 1, 2].map(|l| match by_node.get(l) {
            Some(by) => slid[l] - by.transpose() * by_tangent * (1.0 / by_part),
            None => slid[l],
        });
        let changed = |l: usize| {
            (Mat3::IDENTITY.scaled(weights[l]) + Mat3::outer(chord, slid[l])).scaled(-self.stiffness)
        };
        let borne = [-1.0, 1.0, 0.0];
        let slopes = core::array::from_fn(|k| {
            core::array::from_fn(|l| changed(l).scaled(weights[k]) + Mat3::outer(force * borne[k], slid[l]))
        });
        Held { at, element, part, force, rubs: along.abs(), slopes }
    }

    /// At an end of the rod it cannot slide any further: along it bears no more than friction.
    fn ends(&self, axis: &Axis, place: &Place, pull: Vec3, way: f64) -> Held {
        let Place { at, element, part, tangent, .. } = *place;
        let along = pull.dot(tangent);
        let across = pull - tangent * along;
        let side = across.normalized().unwrap_or(Vec3::ZERO);
        let bound = way * (self.grip + self.friction * across.norm());
        let force = across + tangent * bound;
        let weights = weights(part);
        let normal = Mat3::IDENTITY - Mat3::outer(tangent, tangent);
        let rubbed = Mat3::IDENTITY + Mat3::outer(tangent, side).scaled(way * self.friction);
        let by_node = place.by_node(axis);
        let changed = |l: usize| {
            let shifted = normal.scaled(-self.stiffness * weights[l]);
            let Some(turns) = by_node.get(l).copied() else { return rubbed * shifted };
            let turned = Mat3::outer(tangent, turns.transpose() * pull) + turns.scaled(along);
            rubbed * (shifted - turned) + turns.scaled(bound)
        };
        let slopes = core::array::from_fn(|k| core::array::from_fn(|l| changed(l).scaled(weights[k])));
        Held { at, element, part, force, rubs: bound.abs(), slopes }
    }
}

/// How much of a shift of what is held there is of each node of the element, and of the hole.
pub(crate) fn weights(part: f64) -> [f64; 3] {
    [1.0 - part, part, -1.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(size: f64) -> impl Strategy<Value = Vec3> {
        let part = move || -size..size;
        (part(), part(), part()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

        /// Of a rod of one element, where nothing lies beyond its nodes.
        #[test]
        fn what_a_hole_exerts_changes_as_it_says(
            bends in [vector(0.3), vector(0.3)],
            at in 0.05..0.95_f64,
            hole in vector(0.4),
            shifts in [vector(1.0), vector(1.0), vector(1.0)],
            (friction, grip) in (0.0..0.5_f64, 0.0..0.3_f64),
        ) {
            let hold = Hold { stiffness: 2.0, friction, grip };
            let held = |h: f64| {
                let ends = [bends[0], Vec3::Z + bends[1]];
                let nodes = [0, 1].map(|k| Pose { position: ends[k] + shifts[k] * h, ..Pose::IDENTITY });
                let axis = Axis { nodes: &nodes, along: &[0.0, 1.0] };
                hold.hold(&axis, at, Vec3::Z * at + hole + shifts[2] * h)
            };
            let h = 1e-6;
            let (now, [back, ahead]) = (held(0.0), [held(-h), held(h)]);
            // Not where it begins to slide, or comes to an end.
            let kind = |held: &Held| (held.at == at, held.at == 0.0 || held.at == 1.0);
            prop_assume!(kind(&back) == kind(&ahead) && kind(&now) == kind(&back));
            let weigh = |held: &Held| [held.force * (1.0 - held.part), held.force * held.part, held.force * -1.0];
            let [before, after] = [weigh(&back), weigh(&ahead)];
            for k in 0..3 {
                let said = (0..3).fold(Vec3::ZERO, |sum, l| sum + now.slopes[k][l] * shifts[l]);
                let found = (after[k] - before[k]) * (0.5 / h);
                prop_assert!((said - found).norm() < 1e-5 * (1.0 + found.norm()), "{k}: {said:?} for {found:?}");
            }
        }

        #[test]
        fn a_hole_pulls_along_with_no_more_than_friction(at in 0.0..3.0_f64, hole in vector(2.0)) {
            let hold = Hold { stiffness: 2.0, friction: 0.3, grip: 0.1 };
            let places = [Vec3::ZERO, Vec3::Z, Vec3::new(0.8, 0.0, 1.6), Vec3::new(1.8, 0.0, 1.6)];
            let nodes = places.map(|position| Pose { position, ..Pose::IDENTITY });
            let axis = Axis { nodes: &nodes, along: &[0.0, 1.0, 2.0, 3.0] };
            let held = hold.hold(&axis, at, hole);
            prop_assert!((0.0..=3.0).contains(&held.at));
            let place = Place::new(&axis, held.element, held.at);
            let along = held.force.dot(place.tangent);
            let across = (held.force - place.tangent * along).norm();
            prop_assert!(along.abs() <= 0.1 + 0.3 * across + 1e-9, "{along} {across}");
        }
    }
}
