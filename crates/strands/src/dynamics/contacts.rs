//! What touches in a stage, and what it exerts: found near by, solved for with the frames.

use super::stage::Stage;
use crate::assembly::{Assembly, Strand};
use crate::contact::{
    Aabb, Contact, Ends, Law, Multipliers, Nearest, Response, Shape, Surfaces, Toucher, fastest, free_part,
    free_part_of_gap, overlapping,
};
use crate::math::{Pose, Vec3, Wrench};
use crate::statics::{Network, Touch, TouchEnd};

/// The gap at which surfaces rest, over the radius of the thinner one: so no iteration that is not yet solved lets them through, and it is more than elements are [let](LET) nearer.
const RESTS: f64 = 6e-3;
/// The gap at which a contact bears as much as its stiffness at the resting gap, over that one.
const SMOOTHING: f64 = 1e-4;
/// Surfaces touch where they press with more than so much of what the smoothing is, which they never do a radius apart.
const FELT: f64 = 0.1;
/// What may touch is found anew where a frame is further from where it was than so many radii.
const REACH: f64 = 2.0;
/// Elements of a rod may touch where more of it is between them than so many radii: it cannot bend back on itself in less.
const BETWEEN: f64 = 3.5;
/// Elements that are beside each other touch at their nodes: a pair of them is let nearer by as much as this part of the thickness where the ends of neither are further across the
/// other than so much of it.
const CROSSING: f64 = 0.1;
const LET: f64 = 2.5e-3;
/// Surfaces are near where their gap is less than so much of the radius of the thinner one.
const NEAR: f64 = 0.1;
/// A pair resists nothing where its stiffness is less than so much of what it has when it touches.
const NONE: f64 = 1e-6;

/// A pair that may touch.
#[derive(Clone, Debug)]
struct Pair {
    between: [Toucher; 2],
    /// The frames of the ends of its segments, but of those that stand still.
    frames: [Option<usize>; 4],
    /// Where ends are that stand still.
    still: Ends,
    radii: [f64; 2],
    law: Law,
    /// The normal where it is that of a plane.
    plane: Option<Vec3>,
    known: Multipliers,
    /// Where it was looked at last.
    looked: Option<Looked>,
    /// How it responded where it last slid the other way.
    opposite: Option<Response>,
}

#[derive(Clone, Copy, Debug)]
struct Looked {
    nearest: Nearest,
    ends: Ends,
    normal: Vec3,
    distance: f64,
    /// From the ends to the places that touch.
    arms: [Vec3; 2],
    /// How fast the first side moves against the second there, m/s.
    velocity: Vec3,
    response: Response,
}

/// All pairs that may touch in a stage.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    pairs: Vec<Pair>,
    /// Those for which the linear system was made last: what touches other frames than it is between.
    known: Vec<[Toucher; 2]>,
    /// Where frames were, and how far from there all that they may touch is known, m.
    places: Vec<Vec3>,
    reach: Vec<f64>,
}

/// The rods' elements and nodes as segments.
struct Segment {
    toucher: Toucher,
    frames: [usize; 2],
    /// Where along its rod, m.
    along: [f64; 2],
    radius: f64,
    rod: usize,
}

impl Contacts {
    /// Finds what may touch while frames move from where they are to about where others are, with the forces that were known.
    pub fn find(
        &mut self,
        assembly: &Assembly,
        surfaces: &Surfaces,
        from: &[Pose],
        to: &[Pose],
        of_rate: f64,
        known: &[Contact],
    ) {
        self.pairs.clear();
        self.known.clear();
        let segments = segments(assembly);
        self.places.clear();
        self.places.extend(to.iter().map(|pose| pose.position));
        self.reach.clear();
        self.reach.resize(to.len(), f64::INFINITY);
        for segment in &segments {
            for frame in segment.frames {
                self.reach[frame] = self.reach[frame].min(REACH * segment.radius);
            }
        }
        let margin = |segment: &Segment| REACH * segment.radius;
        let boxes = segments.iter().map(|segment| {
            let around = segment.radius + margin(segment);
            let [before, after] = [from, to].map(|poses| {
                let [a, b] = segment.frames.map(|frame| poses[frame].position);
                Aabb::of_segment(a, b, around)
            });
            before.with(&after)
        });
        let boxes: Vec<Aabb> = boxes.collect();
        let stiffness: Vec<f64> =
            assembly.strands.iter().map(|strand| push_stiffness(strand, of_rate)).collect();
        let friction = surfaces.friction;
        for segment in &segments {
            for (number, obstacle) in assembly.obstacles.iter().enumerate() {
                let of_node = matches!(segment.toucher, Toucher::Node { .. });
                // A plane meets nodes first, a ball elements; what is long may be beside an element too.
                let (still, radius, plane) = match obstacle.shape {
                    Shape::Plane { point, normal } if of_node => ([point; 2], 0.0, Some(normal)),
                    Shape::Capsule { ends, radius } if !of_node || ends[0] != ends[1] => (ends, radius, None),
                    Shape::Plane { .. } | Shape::Capsule { .. } => continue,
                };
                let law = law(obstacle.friction.unwrap_or(friction), stiffness[segment.rod], segment.radius);
                let between = [segment.toucher, Toucher::Obstacle(number)];
                let pair = Pair {
                    frames: [Some(segment.frames[0]), Some(segment.frames[1]), None, None],
                    still: [Vec3::ZERO, Vec3::ZERO, still[0], still[1]],
                    plane,
                    ..Pair::new(between, [segment.radius, radius], law)
                };
                if pair.comes_within(margin(segment), from, to) {
                    self.pairs.push(pair);
                }
            }
        }
        overlapping(&boxes, |a, b| {
            let (a, b) = (&segments[a], &segments[b]);
            if !may_touch(a, b) {
                return;
            }
            let law = law(friction, stiffness[a.rod].min(stiffness[b.rod]), a.radius.min(b.radius));
            let pair = Pair {
                frames: [a.frames[0], a.frames[1], b.frames[0], b.frames[1]].map(Some),
                ..Pair::new([a.toucher, b.toucher], [a.radius, b.radius], law)
            };
            if pair.comes_within(margin(a) + margin(b), from, to) {
                self.pairs.push(pair);
            }
        });
        self.pairs.sort_unstable_by_key(|pair| pair.between);
        for contact in known {
            if let Ok(at) = self.pairs.binary_search_by_key(&contact.between, |pair| pair.between) {
                let pressed = contact.force.dot(contact.normal);
                let anchor = contact.force - contact.normal * pressed;
                self.pairs[at].known = Multipliers { pressed, anchor };
            }
        }
    }

    /// What part of the way from some frames to others surfaces allow, where it is known what may touch.
    pub fn free_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        self.pairs.iter().map(|pair| pair.free_part(from, to)).fold(1.0, f64::min)
    }

    /// What part of the way from some frames to others is where it is known what may touch: frames may be as far as their reach from where it was found.
    pub fn known_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        let part = |(i, (place, reach)): (usize, (&Vec3, &f64))| {
            let moved = (to[i].position - from[i].position).norm();
            let left = reach - (from[i].position - *place).norm();
            if moved <= left { 1.0 } else { left.max(0.0) / moved }
        };
        self.places.iter().zip(&self.reach).enumerate().map(part).fold(1.0, f64::min)
    }

    /// Takes it that frames are now where they are between those for which it was found what may touch.
    pub fn begin_at(&mut self, poses: &[Pose]) {
        self.places.clear();
        self.places.extend(poses.iter().map(|pose| pose.position));
    }

    /// Whether a frame has gone so far that what may touch has to be found anew.
    pub fn has_gone_far(&self, poses: &[Pose]) -> bool {
        let far =
            |(pose, (place, reach)): (&Pose, (&Vec3, &f64))| (pose.position - *place).norm() > 0.5 * reach;
        poses.iter().zip(self.places.iter().zip(&self.reach)).any(far)
    }

    /// Looks at all pairs: adds what they exert to what acts on the frames, and gives what their normal laws are off by, m.
    pub fn look(&mut self, stage: &mut Stage, poses: &[Pose]) -> f64 {
        self.pairs.iter_mut().map(|pair| pair.look(stage, poses)).fold(0.0, f64::max)
    }

    /// By how much slips what sticks, m.
    pub fn slips(&self) -> f64 {
        let slips = |pair: &Pair| pair.looked.map_or(0.0, |looked| looked.response.slips);
        self.pairs.iter().map(slips).fold(0.0, f64::max)
    }

    /// Tells friction from where it is now.
    pub fn anchor(&mut self) {
        for pair in &mut self.pairs {
            if let Some(looked) = pair.looked {
                pair.known.anchor = looked.response.friction;
                pair.opposite = None;
                pair.law.sticks_more();
            }
        }
    }

    /// The pairs, for the linear system.
    pub fn touches(&self) -> impl Iterator<Item = Touch> {
        self.pairs.iter().filter_map(Pair::touch)
    }

    /// The first of those that pass into each other, if any do.
    pub fn overlap(&self, poses: &[Pose]) -> Option<[Toucher; 2]> {
        self.pairs.iter().find(|pair| pair.gap(poses) <= 0.0).map(|pair| pair.between)
    }

    /// How fast energy goes by friction, and by what presses, W.
    pub fn power(&self) -> f64 {
        let of = |looked: &Looked| -looked.response.force.dot(looked.velocity);
        self.pairs.iter().filter_map(|pair| pair.looked.as_ref()).map(of).sum()
    }

    /// Whether pairs of rods touch for which the linear system is not made, which is then to be made for all that touch or nearly do.
    pub fn has_new_pairs(&mut self) -> bool {
        let of_rods = |pair: &&Pair| pair.frames[2].is_some();
        let mut touches = self.pairs.iter().filter(of_rods).filter(|pair| pair.resists());
        if touches.all(|pair| self.known.binary_search(&pair.between).is_ok()) {
            return false;
        }
        self.known.clear();
        let near = self.pairs.iter().filter(of_rods).filter(|pair| pair.resists() || pair.is_near());
        self.known.extend(near.map(|pair| pair.between));
        true
    }

    /// The frames that each of these pairs ties together.
    pub fn frames(&self) -> impl Iterator<Item = [Option<usize>; 4]> {
        let of = |between: &[Toucher; 2]| {
            let at = self.pairs.binary_search_by_key(between, |pair| pair.between);
            at.map_or([None; 4], |at| self.pairs[at].frames)
        };
        self.known.iter().map(of)
    }

    /// Takes the step that the linear system gives, also where frames take but a part of it: what presses then pushes back at once.
    pub fn take(&mut self, network: &Network) {
        for pair in &mut self.pairs {
            let Some(Looked { normal, response: Response { pull, stiffness, .. }, .. }) = pair.looked else {
                continue;
            };
            let resisted =
                pair.touch_ends().map_or(Vec3::ZERO, |ends| stiffness * network.shift_apart(&ends));
            pair.known.pressed = (pair.known.pressed + (pull - resisted).dot(normal)).max(0.0);
        }
    }

    /// What touches, with its forces.
    pub fn contacts(&self, poses: &[Pose]) -> impl Iterator<Item = Contact> {
        let touches = |pair: &&Pair| pair.known.pressed > FELT * pair.law.smoothing;
        self.pairs.iter().filter(touches).map(|pair| {
            let ends = pair.ends(poses);
            let (_, normal, distance, places) = pair.geometry(&ends);
            let gap = distance - pair.thickness();
            let point = (places[0] - normal * pair.radii[0] + places[1] + normal * pair.radii[1]) * 0.5;
            let friction = pair.looked.map_or(pair.known.anchor, |looked| looked.response.friction);
            let force = normal * pair.known.pressed + friction;
            Contact { between: pair.between, point, normal, gap, force }
        })
    }
}

impl Pair {
    /// One that stands still, of which nothing is known.
    fn new(between: [Toucher; 2], radii: [f64; 2], law: Law) -> Self {
        Self {
            between,
            frames: [None; 4],
            still: [Vec3::ZERO; 4],
            radii,
            law,
            plane: None,
            known: Multipliers::NONE,
            looked: None,
            opposite: None,
        }
    }

    fn thickness(&self) -> f64 {
        self.radii[0] + self.radii[1]
    }

    fn ends(&self, poses: &[Pose]) -> Ends {
        core::array::from_fn(|k| self.frames[k].map_or(self.still[k], |frame| poses[frame].position))
    }

    /// Where the sides are nearest, the normal from the second to the first, the distance, and the places on both segments.
    fn geometry(&self, ends: &Ends) -> (Nearest, Vec3, f64, [Vec3; 2]) {
        let nearest = Nearest::of(ends);
        let [s, t] = nearest.at;
        if let Some(normal) = self.plane {
            let distance = (ends[0] - ends[2]).dot(normal);
            return (nearest, normal, distance, [ends[0], ends[0] - normal * distance]);
        }
        let places = [ends[0] + (ends[1] - ends[0]) * s, ends[2] + (ends[3] - ends[2]) * t];
        let distance = nearest.apart.norm();
        (nearest, nearest.apart * (1.0 / distance), distance, places)
    }

    fn gap(&self, poses: &[Pose]) -> f64 {
        let (_, _, distance, _) = self.geometry(&self.ends(poses));
        distance - self.thickness()
    }

    /// Whether the gap may become less than so much on the way from some frames to others.
    fn comes_within(&self, margin: f64, from: &[Pose], to: &[Pose]) -> bool {
        let (before, after) = (self.ends(from), self.ends(to));
        let shifts: Ends = core::array::from_fn(|k| after[k] - before[k]);
        self.gap(from) - fastest(&shifts) < margin
    }

    fn free_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        let (a, b) = (self.ends(from), self.ends(to));
        let thickness = self.thickness();
        if let Some(normal) = self.plane {
            let [before, after] = [a, b].map(|ends| (ends[0] - ends[2]).dot(normal) - thickness);
            return free_part_of_gap(before, after);
        }
        free_part(&a, &core::array::from_fn(|k| b[k] - a[k]), thickness)
    }

    fn look(&mut self, stage: &mut Stage, poses: &[Pose]) -> f64 {
        let ends = self.ends(poses);
        let (nearest, normal, distance, _) = self.geometry(&ends);
        let thickness = self.thickness();
        let rests = RESTS * self.thin();
        let mut gap = distance - thickness - rests;
        let crossing = self.crossing(&ends) / (CROSSING * thickness);
        if crossing < 1.0 {
            gap += LET * thickness * (1.0 - crossing * crossing);
        }
        let arms = [normal * -self.radii[0], normal * self.radii[1]];
        let weights = nearest.weights();
        let mut relative = Vec3::ZERO;
        for (k, frame) in self.frames.iter().enumerate() {
            let Some(frame) = *frame else { continue };
            let velocity = stage.velocity(frame);
            let spin = poses[frame].rotation * velocity.angular;
            relative += (velocity.linear + spin.cross(arms[k / 2])) * weights[k];
        }
        let slip = relative * stage.of_rate;
        let before = self.looked.map(|looked| looked.response);
        let turned =
            |response: &Response| before.filter(|before| before.friction.dot(response.friction) < 0.0);
        let mut response = self.law.respond(&self.known, normal, gap, slip, self.opposite.as_ref());
        if let Some(before) = turned(&response) {
            self.opposite = Some(before);
            response = self.law.respond(&self.known, normal, gap, slip, Some(&before));
        }
        for (k, frame) in self.frames.iter().enumerate() {
            let Some(frame) = *frame else { continue };
            let force = response.force * weights[k];
            stage.inertial[frame].exerts += Wrench::new(arms[k / 2].cross(force), force);
        }
        self.looked = Some(Looked { nearest, ends, normal, distance, arms, velocity: relative, response });
        response.off
    }

    /// How far two segments are from being beside each other: how far the ends of the shorter are across the longer. More than enough where one is a point.
    fn crossing(&self, ends: &Ends) -> f64 {
        let (a, b) = (ends[1] - ends[0], ends[3] - ends[2]);
        let longer = a.norm().max(b.norm());
        if a == Vec3::ZERO || b == Vec3::ZERO { f64::INFINITY } else { a.cross(b).norm() / longer }
    }

    /// Whether it is so near that it may soon touch.
    fn is_near(&self) -> bool {
        self.looked.is_some_and(|looked| looked.distance - self.thickness() < NEAR * self.thin())
    }

    fn thin(&self) -> f64 {
        if self.radii[1] > 0.0 { self.radii[0].min(self.radii[1]) } else { self.radii[0] }
    }

    /// Whether it resists anything worth speaking of.
    fn resists(&self) -> bool {
        self.looked.is_some_and(|looked| looked.response.stiffness.max_abs() >= NONE * self.law.stiffness)
    }

    /// The ends that its force acts on, where it resists anything.
    fn touch_ends(&self) -> Option<[Option<TouchEnd>; 4]> {
        let Looked { nearest, ends, arms, .. } = self.looked.as_ref().filter(|_| self.resists())?;
        let weights = nearest.weights();
        Some(core::array::from_fn(|k| {
            let frame = self.frames[k]?;
            Some(TouchEnd { frame, weight: weights[k], place: ends[k], touches: ends[k] + arms[k / 2] })
        }))
    }

    fn touch(&self) -> Option<Touch> {
        let ends = self.touch_ends()?;
        let Looked { nearest, ends: places, normal, distance, response, .. } = self.looked.as_ref()?;
        let bends = self.plane.is_none().then(|| {
            let beside = 0.5 * CROSSING * self.thickness();
            let mut curvature = nearest.curvature(places, *normal, *distance, beside);
            curvature.iter_mut().flatten().for_each(|block| *block = block.scaled(-self.known.pressed));
            curvature
        });
        Some(Touch { ends, pull: response.pull, stiffness: response.stiffness, bends })
    }
}

fn law(friction: f64, stiffness: f64, radius: f64) -> Law {
    Law::new(friction, stiffness, SMOOTHING * stiffness * RESTS * radius)
}

/// How stiff a long rod is against a push across it in a stage in which a rate counts so much (s): that of a beam against one of that frequency.
fn push_stiffness(strand: &Strand, of_rate: f64) -> f64 {
    let rod = &strand.problem.rod;
    let bending = rod.scale().moment * rod.length();
    let mass = rod.mass() / rod.length();
    2.0 * core::f64::consts::SQRT_2 * bending.powf(0.25) * (mass / (of_rate * of_rate)).powf(0.75)
}

/// All elements and nodes of rods.
fn segments(assembly: &Assembly) -> Vec<Segment> {
    let mut segments = Vec::new();
    for (rod, strand) in assembly.strands.iter().enumerate() {
        let of = &strand.problem.rod;
        let (frames, s) = (assembly.nodes(rod), of.mesh().nodes());
        let radius = |node: usize| of.half_extent()[node][0].max(of.half_extent()[node][1]);
        for node in 0..s.len() {
            let toucher = Toucher::Node { rod, node };
            let frame = frames.start + node;
            segments.push(Segment {
                toucher,
                frames: [frame; 2],
                along: [s[node]; 2],
                radius: radius(node),
                rod,
            });
        }
        for element in 0..of.elements() {
            segments.push(Segment {
                toucher: Toucher::Element { rod, element },
                frames: [frames.start + element, frames.start + element + 1],
                along: [s[element], s[element + 1]],
                radius: radius(element).max(radius(element + 1)),
                rod,
            });
        }
    }
    segments
}

/// Whether two pieces of rods may touch: two elements, or a node and an element, with enough of the rod between them where it is the same.
fn may_touch(a: &Segment, b: &Segment) -> bool {
    let nodes = [a, b].map(|segment| matches!(segment.toucher, Toucher::Node { .. }));
    if nodes == [true, true] {
        return false;
    }
    let between = (b.along[0] - a.along[1]).max(a.along[0] - b.along[1]);
    a.rod != b.rod || between > BETWEEN * a.radius.max(b.radius)
}
