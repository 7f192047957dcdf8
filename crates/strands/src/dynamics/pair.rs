//! Two pieces that may touch, and what they exert on each other.

use super::near::RANGE;
use super::stage::Stage;
use crate::contact::{Contact, Ends, Kind, Law, Meeting, Multipliers, Response, Toucher};
use crate::math::{Mat3, Pose, Vec3, Wrench};
use crate::statics::{Touch, TouchEnd};

/// The gap at which surfaces rest, over the radius of the thinner one: more than elements are [let](LET) nearer.
const RESTS: f64 = 1.6e-2;
/// By how much of that radius they give way at most, and the load that takes half of it over `EI` and its square: then a contact is as stiff as what bends beside it (and as one after Hertz is).
const GIVES: f64 = 1e-2;
const LOAD: f64 = 3e-3;
/// The gap at which a contact bears as much as its stiffness at the resting gap, over that one.
const SMOOTHING: f64 = 1e-4;
/// Surfaces touch where they press with more than so much of what the smoothing is, which they never do a radius apart.
const FELT: f64 = 0.1;
/// Elements that are beside each other touch at their nodes: a pair of them is let nearer by as much as this part of the thickness where the ends of neither are further across the
/// other than so much of it. That is more than nodes [give way](GIVES): else, where they bear much, the pair does too, in a place that jumps from one end to the other.
const CROSSING: f64 = 0.1;
const LET: f64 = 6e-3;
/// On the way to a solution surfaces may pass into each other by so much of their radii, and so nothing passes through anything; where it is solved they are apart.
const SINKS: f64 = 0.5;
/// Surfaces are near where their gap is less than so much of the radius of the thinner one.
const NEAR: f64 = 0.1;
/// What is known to press slides after a slip of no more than so much of the radius of the thinner one, while forces are sought.
const SLIDES: f64 = 1e-3;
/// In one iteration surfaces slide or go apart by no more than so much of that radius, or of how far they slide in the step.
const SHIFTS: f64 = 0.2;
/// A surface goes on in another piece of it where the cosine between normals is more.
const SAME_WAY: f64 = 0.9;
/// A pair resists nothing where its stiffness is less than so much of what it has when it touches.
const NONE: f64 = 1e-6;

/// The two sides of a pair that may touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    pub between: [Toucher; 2],
    kind: Kind,
    /// The frames of its points, but of those that stand still.
    pub frames: [Option<usize>; 4],
    /// Where points are from their frames, in these' axes, or where they stand still. Nodes are where their frames are.
    fixed: Ends,
    /// Less than nothing of a side that is around the other.
    radii: [f64; 2],
}

/// A pair that may touch, and what its sides exert on each other.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub sides: Sides,
    pub law: Law,
    pub known: Multipliers,
    /// Whether it slides freely as yet: nothing is known of its forces.
    is_new: bool,
    /// Where it meets, if it is in range, and how it was looked at there last.
    meets: Option<(Meeting, Ends)>,
    pub looked: Option<Looked>,
    /// How the first side shifts against the second in the step that the linear system gave last, m.
    shift: Vec3,
    /// Whether it sticks where it is looked at next, however great its friction is there.
    sticks: bool,
    /// How it responded where it last slid the other way, and how much that still counts: half as much each time (the Illinois method).
    opposite: Option<(Response, f64)>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Looked {
    meeting: Meeting,
    points: Ends,
    /// From the points to the places that touch.
    arms: Ends,
    /// How fast the first side moves against the second there, m/s.
    velocity: Vec3,
    pub response: Response,
}

/// What a pair has left that does not meet any more.
#[derive(Clone, Debug)]
pub(super) struct Left {
    between: [Toucher; 2],
    law: Law,
    known: Multipliers,
    is_new: bool,
    looked: Looked,
    opposite: Option<(Response, f64)>,
}

impl Sides {
    /// Two pieces of rods, by their ends.
    pub fn of_rods(between: [Toucher; 2], frames: [usize; 4], radii: [f64; 2]) -> Self {
        Self { between, kind: Kind::Segments, frames: frames.map(Some), fixed: [Vec3::ZERO; 4], radii }
    }

    /// A piece of a rod, and one that stands still or moves with a frame.
    pub fn with_wall(
        between: [Toucher; 2],
        kind: Kind,
        [a, b]: [usize; 2],
        (frame, fixed): (Option<usize>, [Vec3; 3]),
        radii: [f64; 2],
    ) -> Self {
        let [c, d, e] = fixed;
        let (frames, fixed) = if kind.first_points() == 1 {
            ([Some(a), frame, frame, frame], [Vec3::ZERO, c, d, e])
        } else {
            ([Some(a), Some(b), frame, frame], [Vec3::ZERO, Vec3::ZERO, c, d])
        };
        Self { between, kind, frames, fixed, radii }
    }

    fn thickness(&self) -> f64 {
        self.radii[0] + self.radii[1]
    }

    fn thin(&self) -> f64 {
        if self.radii[1] > 0.0 { self.radii[0].min(self.radii[1]) } else { self.radii[0] }
    }

    fn points(&self, poses: &[Pose]) -> Ends {
        core::array::from_fn(|k| match self.frames[k] {
            None => self.fixed[k],
            Some(frame) if self.fixed[k] == Vec3::ZERO => poses[frame].position,
            Some(frame) => poses[frame].position + poses[frame].rotation * self.fixed[k],
        })
    }

    /// The side that a point is of.
    fn side(&self, point: usize) -> usize {
        usize::from(point >= self.kind.first_points())
    }

    /// What part of the way from some frames to others it allows, so that nothing passes through anything.
    pub fn free_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        let (before, after) = (self.points(from), self.points(to));
        let second = self.radii[1].max(0.0).min(self.radii[0]);
        let apart = self.thickness() - SINKS * (self.radii[0] + second);
        let shifts = core::array::from_fn(|k| after[k] - before[k]);
        self.kind.free_part(&before, &shifts, apart, self.radii[1])
    }

    /// How far the surfaces are apart, where they meet.
    pub fn gap(&self, poses: &[Pose]) -> Option<f64> {
        self.kind.meet(&self.points(poses)).map(|meeting| meeting.distance - self.thickness())
    }

    /// How far two segments are from being beside each other: how far the ends of the shorter are across the longer. More than enough where one is a point.
    fn crossing(&self, points: &Ends) -> f64 {
        let (a, b) = (points[1] - points[0], points[3] - points[2]);
        if a == Vec3::ZERO || b == Vec3::ZERO || self.kind.first_points() == 1 {
            return f64::INFINITY;
        }
        a.cross(b).norm() / a.norm().max(b.norm())
    }
}

impl Pair {
    /// With its laws, of a friction, a stiffness, N/m, and a rod's stiffness against bending, N·m².
    pub fn new(sides: Sides, friction: f64, stiffness: f64, bending: f64) -> Self {
        let thin = sides.thin();
        let gives = (GIVES * thin, LOAD * bending / (thin * thin));
        Self {
            sides,
            law: Law::new(friction, stiffness, SMOOTHING * stiffness * RESTS * thin, gives),
            known: Multipliers::NONE,
            is_new: true,
            meets: None,
            looked: None,
            shift: Vec3::ZERO,
            sticks: false,
            opposite: None,
        }
    }

    /// Takes what is known of its forces.
    pub fn know(&mut self, known: Multipliers, careful: bool) {
        self.law.slides_after(SLIDES * self.sides.thin(), known.pressed);
        (self.known, self.is_new) = (known, careful);
    }

    /// Finds where it meets. What pressed and does not meet any more leaves its forces.
    pub fn meet(&mut self, poses: &[Pose]) -> Option<Left> {
        let points = self.sides.points(poses);
        let in_range =
            |meeting: &Meeting| meeting.distance - self.sides.thickness() < RANGE * self.sides.thin();
        self.meets = self.sides.kind.meet(&points).filter(in_range).map(|meeting| (meeting, points));
        if self.meets.is_some() {
            return None;
        }
        let (law, known, opposite) = (self.law, self.known, self.opposite.take());
        self.known = Multipliers::NONE;
        let looked = self.looked.take().filter(|_| known.pressed > 0.0)?;
        Some(Left { between: self.sides.between, law, known, is_new: self.is_new, looked, opposite })
    }

    /// Whether it is where what slides from one face of an obstacle to the next goes on: it meets with about the same normal, and was not looked at yet.
    pub fn goes_on_from(&self, left: &Left) -> bool {
        let of = |between: &[Toucher; 2]| (between[0], between[1].obstacle());
        let along =
            |(meeting, _): &(Meeting, Ends)| meeting.normal.dot(left.looked.meeting.normal) > SAME_WAY;
        self.sides.kind == Kind::Face
            && of(&self.sides.between) == of(&left.between)
            && self.looked.is_none()
            && self.meets.as_ref().is_some_and(along)
    }

    /// Presses and slides on as another one did.
    pub fn go_on_from(&mut self, left: Left) {
        (self.law, self.known, self.looked, self.opposite) =
            (left.law, left.known, Some(left.looked), left.opposite);
        self.is_new = left.is_new;
    }

    /// Looks at it where it meets: adds what it exerts to what acts on the frames, and gives what its normal law is off by, m.
    pub fn look(&mut self, stage: &mut Stage, poses: &[Pose]) -> f64 {
        let Some((meeting, points)) = self.meets else { return 0.0 };
        let (thickness, thin) = (self.sides.thickness(), self.sides.thin());
        let Meeting { weights, normal, distance, places, .. } = meeting;
        let mut gap = distance - thickness - RESTS * thin;
        let crossing = self.sides.crossing(&points) / (CROSSING * thickness.abs());
        if crossing < 1.0 {
            gap += LET * thickness * (1.0 - crossing * crossing);
        }
        let touched = [places[0] - normal * self.sides.radii[0], places[1] + normal * self.sides.radii[1]];
        let arms: Ends = match self.sides.kind {
            Kind::Plane | Kind::Face => core::array::from_fn(|k| {
                let side = self.sides.side(k);
                if side == 0 || self.sides.frames[k].is_none() {
                    touched[side] - places[side]
                } else {
                    touched[1] - points[k]
                }
            }),
            _ => core::array::from_fn(|k| touched[self.sides.side(k)] - places[self.sides.side(k)]),
        };
        let mut velocity = Vec3::ZERO;
        for (k, frame) in self.sides.frames.iter().enumerate() {
            let Some(frame) = *frame else { continue };
            let (of, pose) = (stage.velocity(frame), &poses[frame]);
            let arm = arms[k] + (points[k] - pose.position);
            velocity += (of.linear + (pose.rotation * of.angular).cross(arm)) * weights[k];
        }
        let slip = velocity * stage.of_rate;
        let before = self.looked.map(|looked| looked.response);
        let law = if self.is_new { self.law.smooth() } else { self.law };
        let mut response = law.respond(&self.known, normal, gap, slip, self.opposite.as_ref(), self.sticks);
        if let Some(before) = before.filter(|before| before.friction.dot(response.friction) < 0.0) {
            self.opposite = Some((before, 1.0));
            response = law.respond(&self.known, normal, gap, slip, self.opposite.as_ref(), self.sticks);
        }
        if let Some((_, counts)) = &mut self.opposite {
            *counts *= 0.5;
        }
        for (k, frame) in self.sides.frames.iter().enumerate() {
            let Some(frame) = *frame else { continue };
            let force = response.force * weights[k];
            let arm = arms[k] + (points[k] - poses[frame].position);
            stage.inertial[frame].exerts += Wrench::new(arm.cross(force), force);
        }
        self.sticks = false;
        let off = response.off;
        self.looked = Some(Looked { meeting, points, arms, velocity, response });
        off
    }

    /// Whether it presses and slides freely as yet.
    pub fn waits(&self) -> bool {
        self.is_new && self.known.pressed > FELT * self.law.smoothing
    }

    /// Lets it rub, now that it is about known what presses.
    pub fn rub(&mut self, careful: bool) {
        if self.waits() {
            self.is_new = false;
            if careful {
                self.known.bound = Some(self.law.friction * self.known.pressed);
            }
            self.law.slides_after(SLIDES * self.sides.thin(), self.known.pressed);
        }
    }

    /// By how much what friction is told to bear is off, N.
    pub fn misled(&self) -> f64 {
        let off = |bound: f64| (bound - self.law.friction * self.known.pressed).abs();
        self.known.bound.map_or(0.0, off)
    }

    /// Tells friction from where it is now.
    pub fn anchor(&mut self) {
        if let Some(looked) = &self.looked {
            self.known.anchor = looked.response.friction;
            let bears = self.law.friction * self.known.pressed;
            self.known.bound = self.known.bound.map(|_| bears);
            self.opposite = None;
            self.sticks = looked.response.slips > 0.0;
            self.law.sticks_more();
        }
    }

    /// Whether it is so near that it may soon touch.
    pub fn is_near(&self) -> bool {
        let near =
            |looked: &Looked| looked.meeting.distance - self.sides.thickness() < NEAR * self.sides.thin();
        self.looked.as_ref().is_some_and(near)
    }

    /// Whether it resists anything worth speaking of.
    pub fn resists(&self) -> bool {
        let stiffness = |looked: &Looked| looked.response.stiffness.max_abs();
        self.looked.as_ref().is_some_and(|looked| stiffness(looked) >= NONE * self.law.stiffness)
    }

    /// Whether it is between frames that the linear system may not know to be beside each other.
    pub fn ties_frames(&self) -> bool {
        self.sides.frames[self.sides.kind.first_points()].is_some()
    }

    /// The points that its force acts on, where it resists anything.
    fn ends(&self) -> Option<[Option<TouchEnd>; 4]> {
        let Looked { meeting, points, arms, .. } = self.looked.as_ref().filter(|_| self.resists())?;
        Some(core::array::from_fn(|k| {
            let frame = self.sides.frames[k]?;
            let (weight, place) = (meeting.weights[k], points[k]);
            Some(TouchEnd { frame, weight, place, touches: place + arms[k] })
        }))
    }

    /// What it adds to the linear system.
    pub fn touch(&self) -> Option<Touch> {
        let ends = self.ends()?;
        let Looked { meeting, points, response, .. } = self.looked.as_ref()?;
        let beside = 0.5 * CROSSING * self.sides.thickness();
        let presses = self.known.pressed > 0.0;
        let curvature = presses.then(|| meeting.curvature(points, beside)).flatten();
        let (normal, friction) = (meeting.normal, response.friction);
        // How the normal turns, and how much of the force a point takes changes, with a shift of each.
        let turned = |curvature: &[[Mat3; 4]; 4], l: usize| curvature[0][l] + curvature[1][l];
        let shared = |curvature: &[[Mat3; 4]; 4], k: usize, l: usize| curvature[k][l].transpose() * normal;
        let bends = curvature.as_ref().map(|curvature| {
            core::array::from_fn(|k| {
                core::array::from_fn(|l| {
                    let along = Mat3::outer(normal, turned(curvature, l).transpose() * friction);
                    let passed_on = Mat3::outer(friction, shared(curvature, k, l));
                    along.scaled(meeting.weights[k]) - passed_on - curvature[k][l].scaled(self.known.pressed)
                })
            })
        });
        // The places that touch go round as the normal turns: with friction, for what presses points through the axis.
        let turns = curvature.as_ref().map(|curvature| {
            core::array::from_fn(|k| {
                let side = self.sides.side(k);
                let radius = if side == 0 { -self.sides.radii[0] } else { self.sides.radii[1] };
                let arm = Mat3::hat(friction).scaled(meeting.weights[k] * radius);
                let moment = (normal * radius).cross(friction);
                core::array::from_fn(|l| {
                    arm * turned(curvature, l) - Mat3::outer(moment, shared(curvature, k, l))
                })
            })
        });
        Some(Touch { ends, pull: response.pull, stiffness: response.stiffness, bends, turns })
    }

    /// Takes it how the first side shifts against the second, m, for the points that it acts on, in the step that the linear system gives. What part of that may be taken: round what
    /// is curved the normal turns as it slides.
    pub fn step(&mut self, shift_apart: impl Fn(&[Option<TouchEnd>; 4]) -> Vec3) -> f64 {
        self.shift = self.ends().map_or(Vec3::ZERO, |ends| shift_apart(&ends));
        let Some(looked) = self.looked.filter(|_| self.sides.kind != Kind::Plane) else { return 1.0 };
        let most = SHIFTS * self.sides.thin().max(looked.response.slip.norm());
        most / self.shift.norm().max(most)
    }

    /// Takes a part of that step.
    pub fn take(&mut self, part: f64) {
        let Some(Looked { meeting, response: Response { pull, stiffness, .. }, .. }) = self.looked else {
            return;
        };
        let resisted = stiffness * self.shift;
        self.known.pressed = (self.known.pressed + part * (pull - resisted).dot(meeting.normal)).max(0.0);
    }

    /// How fast energy goes by friction, and by what presses, W.
    pub fn power(&self) -> f64 {
        self.looked.as_ref().map_or(0.0, |looked| -looked.response.force.dot(looked.velocity))
    }

    /// What touches, if it does, with its force.
    pub fn contact(&self, poses: &[Pose]) -> Option<Contact> {
        if self.known.pressed <= FELT * self.law.smoothing {
            return None;
        }
        let Meeting { normal, distance, places, .. } = self.sides.kind.meet(&self.sides.points(poses))?;
        let gap = distance - self.sides.thickness();
        let point =
            (places[0] - normal * self.sides.radii[0] + places[1] + normal * self.sides.radii[1]) * 0.5;
        let friction = self.looked.map_or(self.known.anchor, |looked| looked.response.friction);
        let force = normal * self.known.pressed + friction;
        Some(Contact { between: self.sides.between, point, normal, gap, force })
    }
}
