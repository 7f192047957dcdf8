//! What may touch while frames stay near where they are: elements of rods, and they and pieces of obstacles.

use super::pair::Sides;
use super::passages::Inside;
use crate::assembly::{Assembly, Member};
use crate::contact::{Aabb, Ends, Kind, Nearest, Part, Toucher, Tree};
use crate::math::{Pose, Vec3};

/// Frames may be so many radii from where they were.
const REACH: f64 = 3.0;
/// A pair exerts nothing where its gap is more than so many radii of the thinner one.
pub(super) const RANGE: f64 = 1.0;
/// Pieces of a rod may touch where more of it is between them than so many radii: it cannot bend back on itself in less.
const BETWEEN: f64 = 3.5;

/// So many radii from a hole a piece of a rod that has come out of it may still be sunk.
const BESIDE: f64 = 20.0;

/// An element of a rod.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub rod: usize,
    pub element: usize,
    /// Its first node's frame; the other one's is the next.
    frame: usize,
    /// Where along its rod its nodes are, m.
    along: [f64; 2],
    pub radius: f64,
    /// Whether it is its rod's last.
    is_last: bool,
}

/// A piece of an obstacle.
#[derive(Clone, Copy, Debug)]
struct Wall {
    toucher: Toucher,
    part: Part,
    /// The frame of the body that it is of.
    frame: Option<usize>,
    friction: Option<f64>,
}

/// The pieces of obstacles that move with one frame, or stand still.
#[derive(Clone, Debug)]
struct Side {
    frame: Option<usize>,
    /// The numbers of walls without an end, and of the others in the tree.
    endless: Vec<usize>,
    ended: Vec<usize>,
    tree: Tree,
    /// How far from the frame they are at most, m.
    extent: f64,
}

/// Where a joint ties rods, or a rod and a body.
#[derive(Clone, Copy, Debug)]
struct Tied {
    /// A rod, and where along it, m.
    rod: usize,
    at: f64,
    to: TiedTo,
}

#[derive(Clone, Copy, Debug)]
enum TiedTo {
    Rod(usize, f64),
    Frame(usize),
}

/// Two pieces that may touch: an element, and another one or a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Near {
    piece: u32,
    other: Other,
    /// Whether their pairs are looked at.
    pub met: bool,
    /// Whether the piece is inside of what it would touch, by a hole.
    out: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Other {
    Piece(u32),
    Wall(u32),
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    pieces: Vec<Piece>,
    walls: Vec<Wall>,
    sides: Vec<Side>,
    tied: Vec<Tied>,
    is_made: bool,
    pub near: Vec<Near>,
    /// Where frames were, and how far from there all that they may touch is known, m.
    places: Vec<Pose>,
    reach: Vec<f64>,
    /// Where a stage begins, from where half of that is known for sure.
    origin: Vec<Pose>,
    /// How far from its frame what moves with it is at most, m.
    extent: Vec<f64>,
    tree: Tree,
    boxes: Vec<Aabb>,
    /// The pieces' middles, and how far from there they go, m.
    middles: Vec<(Vec3, f64)>,
    /// How far at most they go, m.
    shifts: Vec<f64>,
}

impl Neighbours {
    /// Forgets what there is: it has changed.
    pub fn forget(&mut self) {
        self.is_made = false;
        self.places.clear();
    }

    /// Finds what may touch while frames move from where they are to about where others are, if it is not known.
    pub fn find(&mut self, assembly: &Assembly, from: &[Pose], to: &[Pose]) {
        if !self.is_made {
            self.make(assembly);
        }
        self.near.iter_mut().for_each(|near| near.met = false);
        self.begin_at(to);
        let is_far = |poses: &[Pose]| self.have_moved(&self.places, poses, 0.5);
        if self.places.len() == from.len() && !is_far(from) && !is_far(to) {
            return;
        }
        self.places.clear();
        self.places.extend_from_slice(to);
        self.boxes.clear();
        let boxes = self.pieces.iter().map(|piece| piece.swept(from, to, 1.0 + REACH + 0.5 * RANGE));
        self.boxes.extend(boxes);
        let Self { pieces, sides, tied, near, tree, boxes, .. } = self;
        near.clear();
        tree.plant(boxes);
        for (a, piece) in pieces.iter().enumerate() {
            tree.overlapping(&boxes[a], |b| {
                if b > a && piece.may_touch(&pieces[b], tied) {
                    near.push(Near {
                        piece: a as u32,
                        other: Other::Piece(b as u32),
                        met: false,
                        out: false,
                    });
                }
            });
        }
        for side in sides {
            let is_tied = |rod: usize| {
                let to_side =
                    |tied: &Tied| matches!(tied.to, TiedTo::Frame(frame) if Some(frame) == side.frame);
                tied.iter().any(|tied| tied.rod == rod && to_side(tied))
            };
            for (a, piece) in pieces.iter().enumerate().filter(|(_, piece)| !is_tied(piece.rod)) {
                let mut meets = |wall: usize| {
                    near.push(Near {
                        piece: a as u32,
                        other: Other::Wall(wall as u32),
                        met: false,
                        out: false,
                    });
                };
                let about = match side.frame {
                    None => boxes[a],
                    // The side may turn and shift as far as it may reach, too.
                    Some(frame) => {
                        let [before, after] = [from, to].map(|poses| {
                            let ends = piece.frames().map(|node| {
                                let (body, place) = (&poses[frame], poses[node].position);
                                body.rotation.transpose() * (place - body.position)
                            });
                            Aabb::of_segment(ends[0], ends[1], piece.radius * (1.0 + 2.0 * REACH + RANGE))
                        });
                        before.with(&after)
                    }
                };
                side.endless.iter().for_each(|wall| meets(*wall));
                side.tree.overlapping(&about, |at| meets(side.ended[at]));
            }
        }
        near.sort_unstable();
    }

    /// Leaves out what is inside of obstacles, by holes, and what beside it is still sunk into them.
    pub fn leave_out(&mut self, inside: &[Inside], poses: &[Pose]) {
        let Self { pieces, walls, near, .. } = self;
        for near in near {
            near.out = false;
            let (piece, Other::Wall(wall)) = (&pieces[near.piece as usize], near.other) else { continue };
            let wall = &walls[wall as usize];
            let own = |of: &Inside| of.rod == piece.rod && wall.toucher.obstacle() == Some(of.obstacle);
            let beside = BETWEEN * piece.radius;
            near.out = inside.iter().any(|of| own(of) && Piece::between(piece.along, of.along) < beside);
            let near_by = |of: &Inside| Piece::between(piece.along, of.along) < BESIDE * piece.radius;
            if !near.out && inside.iter().any(|of| own(of) && near_by(of)) {
                let sinks = |pair: Sides| near.out |= pair.gap(poses).is_some_and(|gap| gap <= 0.0);
                piece.pairs_with_wall(wall, sinks);
            }
        }
    }

    fn make(&mut self, assembly: &Assembly) {
        self.is_made = true;
        self.places.clear();
        self.pieces.clear();
        self.reach.clear();
        self.reach.resize(assembly.frames(), f64::INFINITY);
        self.extent.clear();
        self.extent.resize(assembly.frames(), 0.0);
        let mut thinnest = f64::INFINITY;
        for (rod, strand) in assembly.strands.iter().enumerate() {
            let of = &strand.problem.rod;
            let (first, s) = (assembly.nodes(rod).start, of.mesh().nodes());
            let radius = |node: usize| of.half_extent()[node][0].max(of.half_extent()[node][1]);
            for element in 0..of.elements() {
                let piece = Piece {
                    rod,
                    element,
                    frame: first + element,
                    along: [s[element], s[element + 1]],
                    radius: radius(element).max(radius(element + 1)),
                    is_last: element + 1 == of.elements(),
                };
                thinnest = thinnest.min(piece.radius);
                for frame in piece.frames() {
                    self.reach[frame] = self.reach[frame].min(REACH * piece.radius);
                }
                self.pieces.push(piece);
            }
        }
        self.walls.clear();
        self.sides.clear();
        for (obstacle, of) in assembly.obstacles.iter().enumerate() {
            let frame = of.body.map(|body| assembly.first_body() + body);
            let mut side = Side { frame, endless: vec![], ended: vec![], tree: Tree::default(), extent: 0.0 };
            let mut boxes = Vec::new();
            for (number, part) in of.shape.parts().into_iter().enumerate() {
                let toucher = Toucher::Obstacle { obstacle, part: number };
                let at = self.walls.len();
                self.walls.push(Wall { toucher, part, frame, friction: of.friction });
                let Some(aabb) = bounds(&part) else {
                    side.endless.push(at);
                    continue;
                };
                side.extent = side.extent.max(aabb.least.norm()).max(aabb.greatest.norm());
                side.ended.push(at);
                boxes.push(aabb);
            }
            side.tree.plant(&boxes);
            if let Some(frame) = frame {
                self.reach[frame] = REACH * thinnest;
                self.extent[frame] = self.extent[frame].max(side.extent);
            }
            self.sides.push(side);
        }
        self.tied.clear();
        for joint in &assembly.joints {
            let along = |member: Member| match member {
                Member::Node { rod, node } => {
                    Some((rod, assembly.strands[rod].problem.rod.mesh().nodes()[node]))
                }
                Member::Body(_) => None,
            };
            let members = joint.between.map(|attachment| attachment.member);
            for (one, other) in [(0, 1), (1, 0)] {
                let Some((rod, at)) = along(members[one]) else { continue };
                let to = match (along(members[other]), members[other]) {
                    (Some((rod, at)), _) => TiedTo::Rod(rod, at),
                    (None, Member::Body(body)) => TiedTo::Frame(assembly.first_body() + body),
                    (None, Member::Node { .. }) => continue,
                };
                self.tied.push(Tied { rod, at, to });
            }
        }
    }

    /// What part of the way from some frames to others is where it is known what may touch.
    pub fn known_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        let part = |i: usize| {
            let goes = moved(self.extent[i], &from[i], &to[i]);
            let left = 0.5 * self.reach[i] - moved(self.extent[i], &self.origin[i], &from[i]);
            if goes <= left { 1.0 } else { left.max(0.0) / goes }
        };
        (0..self.origin.len()).map(part).fold(1.0, f64::min)
    }

    /// Whether a frame is further from where it was than such a part of its reach.
    fn have_moved(&self, places: &[Pose], poses: &[Pose], part: f64) -> bool {
        let far = |(i, pose): (usize, &Pose)| moved(self.extent[i], &places[i], pose) > part * self.reach[i];
        poses.iter().enumerate().any(far)
    }

    /// Whether a frame has gone so far in a stage that what may touch has to be found anew.
    pub fn is_left(&self, poses: &[Pose]) -> bool {
        self.have_moved(&self.origin, poses, 0.25)
    }

    /// Takes it that a stage begins where frames are, between those for which it was found what may touch.
    pub fn begin_at(&mut self, poses: &[Pose]) {
        self.origin.clear();
        self.origin.extend_from_slice(poses);
    }

    /// Gives the pairs of what has come within range, and was not before, each with the radii's lesser and its rods and friction.
    pub fn met(&mut self, poses: &[Pose], mut pair: impl FnMut(Sides, [Option<usize>; 2], Option<f64>)) {
        self.take_middles(poses);
        let Self { pieces, walls, near, middles, .. } = self;
        for near in near.iter_mut().filter(|near| !near.met && !near.out) {
            let piece = &pieces[near.piece as usize];
            let (middle, half) = middles[near.piece as usize];
            let range = half + (1.0 + RANGE) * piece.radius;
            match near.other {
                Other::Piece(other) => {
                    let (other, (to, far)) = (&pieces[other as usize], middles[other as usize]);
                    let range = range + far + other.radius;
                    let apart = middle - to;
                    if apart.dot(apart) > range * range {
                        continue;
                    }
                    // No node of one is nearer to the other.
                    let [[a, b], [c, d]] = [piece, other].map(|of| of.frames().map(|i| poses[i].position));
                    let apart = Nearest::of(&[a, b, c, d]).apart;
                    let range = (1.0 + RANGE) * piece.radius + other.radius;
                    if apart.dot(apart) > range * range {
                        continue;
                    }
                    near.met = true;
                    piece.pairs_with(other, |of| pair(of, [Some(piece.rod), Some(other.rod)], None));
                }
                Other::Wall(wall) => {
                    let wall = &walls[wall as usize];
                    if wall.distance(middle, poses) > range {
                        continue;
                    }
                    near.met = true;
                    piece.pairs_with_wall(wall, |of| pair(of, [Some(piece.rod), None], wall.friction));
                }
            }
        }
    }

    fn take_middles(&mut self, poses: &[Pose]) {
        self.middles.clear();
        self.middles.extend(self.pieces.iter().map(|piece| piece.middle(poses)));
    }

    /// What part of the way from some frames to others surfaces allow, where it is known what may touch.
    pub fn free_part(&mut self, from: &[Pose], to: &[Pose]) -> f64 {
        self.take_middles(from);
        let Self { pieces, walls, near, middles, shifts, extent, .. } = self;
        shifts.clear();
        shifts.extend(pieces.iter().map(|piece| {
            let [a, b] = piece.frames().map(|i| to[i].position - from[i].position);
            a.dot(a).max(b.dot(b)).sqrt()
        }));
        let mut part = 1.0_f64;
        for near in near.iter().filter(|near| !near.out) {
            let piece = &pieces[near.piece as usize];
            let (middle, half) = middles[near.piece as usize];
            let shift = shifts[near.piece as usize];
            match near.other {
                Other::Piece(other) => {
                    let other_shift = shifts[other as usize];
                    let (other, (to_middle, far)) = (&pieces[other as usize], middles[other as usize]);
                    let range = half + far + piece.radius + other.radius + shift + other_shift;
                    let apart = middle - to_middle;
                    if apart.dot(apart) > range * range {
                        continue;
                    }
                    // Its nodes are of it.
                    part = part.min(piece.pair(other).free_part(from, to));
                }
                Other::Wall(wall) => {
                    let wall = &walls[wall as usize];
                    let goes = |frame: usize| moved(extent[frame], &from[frame], &to[frame]);
                    let shift = shift + wall.frame.map_or(0.0, goes);
                    if wall.distance(middle, from) > half + piece.radius + shift {
                        continue;
                    }
                    piece.pairs_with_wall(wall, |pair| part = part.min(pair.free_part(from, to)));
                }
            }
        }
        part
    }
}

impl Piece {
    fn frames(&self) -> [usize; 2] {
        [self.frame, self.frame + 1]
    }

    fn swept(&self, from: &[Pose], to: &[Pose], radii: f64) -> Aabb {
        let [before, after] = [from, to].map(|poses| {
            let [a, b] = self.frames().map(|frame| poses[frame].position);
            Aabb::of_segment(a, b, radii * self.radius)
        });
        before.with(&after)
    }

    fn middle(&self, poses: &[Pose]) -> (Vec3, f64) {
        let [a, b] = self.frames().map(|frame| poses[frame].position);
        ((a + b) * 0.5, 0.5 * (b - a).norm())
    }

    /// Its nodes that are looked at with it: each one of a rod once.
    fn nodes(&self) -> impl Iterator<Item = usize> + use<> {
        0..1 + usize::from(self.is_last)
    }

    fn node(&self, node: usize) -> Toucher {
        Toucher::Node { rod: self.rod, node: self.element + node }
    }

    fn itself(&self) -> Toucher {
        Toucher::Element { rod: self.rod, element: self.element }
    }

    /// How much of its rod there is between two stretches of it.
    fn between(a: [f64; 2], b: [f64; 2]) -> f64 {
        (b[0] - a[1]).max(a[0] - b[1])
    }

    /// Whether two elements may touch: with enough of the rod between them where it is the same, or of rods that are tied.
    fn may_touch(&self, other: &Self, tied: &[Tied]) -> bool {
        let enough = BETWEEN * self.radius.max(other.radius);
        if self.rod == other.rod {
            return Self::between(self.along, other.along) > enough;
        }
        let beside = |tied: &Tied| match tied.to {
            TiedTo::Rod(rod, at) if tied.rod == self.rod && rod == other.rod => {
                let far = |along: [f64; 2], at: f64| Self::between(along, [at, at]).max(0.0);
                far(self.along, tied.at) + far(other.along, at) <= enough
            }
            _ => false,
        };
        !tied.iter().any(beside)
    }

    fn pair(&self, other: &Self) -> Sides {
        let ([a, b], [c, d]) = (self.frames(), other.frames());
        let between = [self.itself(), other.itself()];
        Sides::of_rods(between, [a, b, c, d], [self.radius, other.radius])
    }

    fn pairs_with(&self, other: &Self, mut pair: impl FnMut(Sides)) {
        pair(self.pair(other));
        for (one, other) in [(self, other), (other, self)] {
            let enough = BETWEEN * one.radius.max(other.radius);
            for node in one.nodes() {
                let at = one.along[node];
                if one.rod == other.rod && Self::between([at, at], other.along) <= enough {
                    continue;
                }
                let (frame, [c, d]) = (one.frame + node, other.frames());
                let between = [one.node(node), other.itself()];
                pair(Sides::of_rods(between, [frame, frame, c, d], [one.radius, other.radius]));
            }
        }
    }

    fn pairs_with_wall(&self, wall: &Wall, mut pair: impl FnMut(Sides)) {
        let Wall { toucher, frame, .. } = *wall;
        let mut with = |kind, own: Option<usize>, still: [Vec3; 3], radius| {
            let (between, frames) = match own {
                Some(node) => ([self.node(node), toucher], [self.frame + node; 2]),
                None => ([self.itself(), toucher], self.frames()),
            };
            pair(Sides::with_wall(between, kind, frames, (frame, still), [self.radius, radius]));
        };
        match wall.part {
            Part::Plane { point, normal } => {
                let still = [point, point + normal, point];
                self.nodes().for_each(|node| with(Kind::Plane, Some(node), still, 0.0));
            }
            Part::Bore { point, axis, radius } => {
                let still = [point, point + axis, point];
                self.nodes().for_each(|node| with(Kind::Bore, Some(node), still, -radius));
            }
            Part::Face { corners } => {
                self.nodes().for_each(|node| with(Kind::Face, Some(node), corners, 0.0));
            }
            Part::Round { ends: [c, d], radius, capped } => {
                let kind = if capped { Kind::Segments } else { Kind::Between };
                with(kind, None, [c, d, d], radius);
                // What is long may be beside an element.
                if c != d {
                    self.nodes().for_each(|node| with(kind, Some(node), [c, d, d], radius));
                }
            }
        }
    }
}

impl Wall {
    /// How far a place is from it at least; of a bore from its wall, less than nothing outside.
    fn distance(&self, place: Vec3, poses: &[Pose]) -> f64 {
        let place = self.frame.map_or(place, |frame| {
            let body = &poses[frame];
            body.rotation.transpose() * (place - body.position)
        });
        let point: Ends = [place; 4];
        match self.part {
            Part::Plane { point, normal } => (place - point).dot(normal),
            Part::Bore { point, axis, radius } => {
                let from = place - point;
                radius - (from - axis * from.dot(axis)).norm()
            }
            Part::Round { ends: [c, d], radius, .. } => {
                let segment = [point[0], point[1], c, d];
                Kind::Segments.meet(&segment).map_or(f64::INFINITY, |meeting| meeting.distance) - radius
            }
            Part::Face { corners: [a, b, c] } => {
                let middle = (a + b + c) * (1.0 / 3.0);
                let far = [a, b, c].map(|corner| (corner - middle).norm());
                let around = (place - middle).norm() - far[0].max(far[1]).max(far[2]);
                let normal = (b - a).cross(c - a).normalized().unwrap_or(Vec3::ZERO);
                (place - a).dot(normal).abs().max(around)
            }
        }
    }
}

/// By how much at most what moves with a frame, and is no further from it than so much, has moved.
fn moved(extent: f64, from: &Pose, to: &Pose) -> f64 {
    let shift = (to.position - from.position).norm();
    if extent == 0.0 {
        return shift;
    }
    let turns = |k: usize| (to.rotation.cols[k] - from.rotation.cols[k]).norm();
    shift + extent * (turns(0) + turns(1) + turns(2))
}

/// The box about a piece of an obstacle that ends.
fn bounds(part: &Part) -> Option<Aabb> {
    match *part {
        Part::Plane { .. } | Part::Bore { .. } => None,
        Part::Round { ends: [a, b], radius, .. } => Some(Aabb::of_segment(a, b, radius)),
        Part::Face { corners: [a, b, c] } => {
            Some(Aabb::of_segment(a, b, 0.0).with(&Aabb::of_segment(c, c, 0.0)))
        }
    }
}
