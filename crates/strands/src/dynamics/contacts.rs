//! What touches in a stage, and what it exerts: found near by, solved for with the frames.

use super::near::Neighbours;
use super::pair::{Left, Pair};
use super::passages::Passages;
use super::stage::Stage;
use crate::assembly::{Assembly, Strand};
use crate::contact::{Contact, Multipliers, Passage, Toucher};
use crate::math::Pose;
use crate::statics::{Network, Touch};

/// So many that begin to touch in a stage are many.
const MANY: usize = 3;

/// All pairs that are within range in a stage.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    neighbours: Neighbours,
    pub passages: Passages,
    pairs: Vec<Pair>,
    /// What touched at the stage's beginning, by what it is between.
    known: Vec<Contact>,
    /// What pressed and met no more in a look.
    left: Vec<Left>,
    /// The coefficient of friction where nothing else is said, and how stiff rods are against a push, N/m, and against bending, N·m².
    friction: f64,
    stiffness: Vec<[f64; 2]>,
    /// Whether all slides freely at first, and friction is told what it bears.
    careful: bool,
    /// How many have begun to press in a stage's first iteration.
    new: usize,
}

impl Contacts {
    /// Forgets what there is: it has changed.
    pub fn forget(&mut self) {
        self.neighbours.forget();
    }

    /// Begins a stage, in which frames move from where they are to about where others are, with the forces that were known.
    pub fn begin(
        &mut self,
        assembly: &Assembly,
        friction: f64,
        (from, to): (&[Pose], &[Pose]),
        of_rate: f64,
        (known, passages): (&[Contact], &[Passage]),
    ) {
        self.passages.begin(passages);
        self.find(assembly, (from, to), from);
        self.new = 0;
        self.friction = friction;
        self.stiffness.clear();
        let strands = assembly.strands.iter();
        self.stiffness.extend(strands.map(|strand| [push_stiffness(strand, of_rate), bending(strand)]));
        self.pairs.clear();
        self.known.clear();
        self.known.extend_from_slice(known);
        self.known.sort_by_key(|contact| contact.between);
    }

    /// Takes pairs that have come within range.
    fn meet(&mut self, poses: &[Pose]) {
        let Self { neighbours, pairs, known, friction, stiffness, careful, .. } = self;
        neighbours.met(poses, |sides, rods, own_friction| {
            let softest = |of: fn(&[f64; 2]) -> f64| {
                rods.iter().flatten().map(|rod| of(&stiffness[*rod])).fold(f64::INFINITY, f64::min)
            };
            let friction = own_friction.unwrap_or(*friction);
            let mut pair = Pair::new(sides, friction, softest(|of| of[0]), softest(|of| of[1]));
            if let Ok(at) = known.binary_search_by_key(&sides.between, |contact| contact.between) {
                let Contact { force, normal, .. } = known[at];
                let pressed = force.dot(normal);
                pair.know(Multipliers { pressed, anchor: force - normal * pressed, bound: None }, *careful);
            }
            pairs.push(pair);
        });
    }

    /// What part of the way from some frames to others surfaces allow, where it is known what may touch.
    pub fn free_part(&mut self, from: &[Pose], to: &[Pose]) -> f64 {
        self.neighbours.free_part(from, to)
    }

    /// What part of the way from some frames to others is where it is known what may touch.
    pub fn known_part(&self, from: &[Pose], to: &[Pose]) -> f64 {
        self.neighbours.known_part(from, to)
    }

    /// Finds anew what may touch, where a frame has gone far since it was found, in a stage that began elsewhere.
    pub fn follow(&mut self, assembly: &Assembly, began: &[Pose], poses: &[Pose]) {
        if !self.neighbours.is_left(poses) {
            return;
        }
        let mut known: Vec<Contact> = self.contacts(poses).collect();
        known.sort_by_key(|contact| contact.between);
        self.known = known;
        self.pairs.clear();
        self.find(assembly, (poses, poses), began);
    }

    /// Finds what may touch while frames go from some places to others, but for what is inside of tissue, in a stage that began where they were.
    fn find(&mut self, assembly: &Assembly, (from, to): (&[Pose], &[Pose]), began: &[Pose]) {
        self.neighbours.find(assembly, from, to);
        self.neighbours.leave_out(&self.passages.inside(assembly), began);
    }

    /// Looks at all pairs: adds what they exert to what acts on the frames, and gives what their normal laws are off by, m.
    pub fn look(&mut self, assembly: &Assembly, stage: &mut Stage, poses: &[Pose]) -> f64 {
        self.passages.look(assembly, stage, poses);
        self.meet(poses);
        self.left.extend(self.pairs.iter_mut().filter_map(|pair| pair.meet(poses)));
        for left in self.left.drain(..) {
            if let Some(pair) = self.pairs.iter_mut().find(|pair| pair.goes_on_from(&left)) {
                pair.go_on_from(left);
            }
        }
        self.pairs.iter_mut().map(|pair| pair.look(stage, poses)).fold(0.0, f64::max)
    }

    /// By how much slips what sticks, m.
    pub fn slips(&self) -> f64 {
        let slips = |pair: &Pair| pair.looked.as_ref().map_or(0.0, |looked| looked.response.slips);
        self.pairs.iter().map(slips).fold(0.0, f64::max)
    }

    /// Whether some press and slide freely as yet.
    pub fn wait(&self) -> bool {
        self.pairs.iter().any(Pair::waits)
    }

    /// Lets those rub.
    pub fn rub(&mut self) {
        let careful = self.careful;
        self.pairs.iter_mut().for_each(|pair| pair.rub(careful));
    }

    /// Tells friction from where it is now, and what it bears where it is told that.
    pub fn anchor(&mut self) {
        self.pairs.iter_mut().for_each(Pair::anchor);
    }

    /// Whether stages begin so that all slides freely until it is about known what presses, and friction is told what it bears until that changes little.
    pub fn be_careful(&mut self, is: bool) {
        self.careful = is;
    }

    /// Takes it that a stage's first iteration has been made.
    pub fn count_new(&mut self) {
        self.new = self.pairs.iter().filter(|pair| pair.waits()).count();
    }

    /// Whether many have begun to touch at once: then nothing is known of what rubs.
    pub fn strike(&self) -> bool {
        self.new >= MANY
    }

    /// Whether it still is told that.
    pub fn is_careful(&self) -> bool {
        self.careful
    }

    /// By how much what friction is told to bear is off, over all that presses.
    pub fn misled(&self) -> f64 {
        let pressed: f64 = self.pairs.iter().map(|pair| pair.known.pressed).sum();
        self.pairs.iter().map(Pair::misled).fold(0.0, f64::max) / pressed.max(f64::MIN_POSITIVE)
    }

    /// Lets what friction bears follow what presses again.
    pub fn follow_pressed(&mut self) {
        self.pairs.iter_mut().for_each(|pair| pair.known.bound = None);
        self.careful = false;
    }

    /// The pairs, for the linear system.
    pub fn touches(&self, assembly: &Assembly, poses: &[Pose]) -> impl Iterator<Item = Touch> {
        self.pairs.iter().filter_map(Pair::touch).chain(self.passages.touches(assembly, poses))
    }

    /// The first of those that pass into each other, if any do.
    pub fn overlap(&mut self, poses: &[Pose]) -> Option<[Toucher; 2]> {
        self.meet(poses);
        let overlaps = |pair: &&Pair| pair.sides.gap(poses).is_some_and(|gap| gap <= 0.0);
        self.pairs.iter().find(overlaps).map(|pair| pair.sides.between)
    }

    /// How fast energy goes by friction, and by what presses, W.
    pub fn power(&self, of_rate: f64) -> f64 {
        self.pairs.iter().map(Pair::power).sum::<f64>() + self.passages.power(of_rate)
    }

    /// The frames of pairs that touch and are not joined in a linear system; if there are any, of all that touch or nearly do.
    pub fn new_ties(
        &self,
        assembly: &Assembly,
        network: &Network,
    ) -> Option<impl Iterator<Item = [Option<usize>; 4]>> {
        let ties = || self.pairs.iter().filter(|pair| pair.ties_frames());
        let is_new = |pair: &Pair| pair.resists() && !network.joins(&pair.sides.frames);
        let passages = || self.passages.ties(assembly);
        let any = ties().any(is_new) || passages().any(|frames| !network.joins(&frames));
        any.then(|| {
            let touching = ties().filter(|pair| pair.resists() || pair.is_near());
            touching.map(|pair| pair.sides.frames).chain(passages())
        })
    }

    /// Takes the step that the linear system gives. What part of it leaves what slides near to where it was linearised.
    pub fn step(&mut self, network: &Network) -> f64 {
        let part = |pair: &mut Pair| pair.step(|ends| network.shift_apart(ends));
        self.pairs.iter_mut().map(part).fold(1.0, f64::min)
    }

    /// Goes a part of that step.
    pub fn take(&mut self, part: f64) {
        self.pairs.iter_mut().for_each(|pair| pair.take(part));
    }

    /// What touches, with its forces, by what it is between.
    pub fn contacts(&self, poses: &[Pose]) -> impl Iterator<Item = Contact> {
        self.pairs.iter().filter_map(|pair| pair.contact(poses))
    }
}

/// How stiff a long rod is against a push across it in a stage in which a rate counts so much (s): that of a beam against one of that frequency.
fn push_stiffness(strand: &Strand, of_rate: f64) -> f64 {
    let rod = &strand.problem.rod;
    let mass = rod.mass() / rod.length();
    2.0 * core::f64::consts::SQRT_2 * bending(strand).powf(0.25) * (mass / (of_rate * of_rate)).powf(0.75)
}

fn bending(strand: &Strand) -> f64 {
    let rod = &strand.problem.rod;
    rod.scale().moment * rod.length()
}
