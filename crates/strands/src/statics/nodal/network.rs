//! The linear system of rods and bodies that joints tie together.
//!
//! Seen from fixed axes, frames that are tied rigidly have one and the same variation, and one that hangs by a ball joint or a hinge has that of its
//! parent and a turn about the joint of its own: `η = η_parent + S r`. So every frame's variation is a sum over few unknowns, `η = Σ T x`, and the
//! blocks of the rods' own systems go, as `Tᵀ K T`, into one sparse system of blocks of six. It is eliminated in an order in which each unknown has as few neighbours as
//! possible when it is its turn (minimum degree): a tree from its leaves inwards, without a block more than it has.

mod structure;
mod touch;
mod wide;

use structure::Structure;
pub(crate) use touch::{Touch, TouchEnd};
use wide::Wide;

use super::elimination::{
    SMALLEST_PIVOT, Square, add, block_from, on_far, pair, parts, product, seen_from_near, subtract,
    subtract_dead_moment_slope, subtract_inertial_slopes, transposed,
};
use super::{Axes, Inertial, Nodal, grip_acts};
use crate::assembly::{Assembly, Body, Member, Ties};
use crate::math::{Kernel, Pose, SimdLevel, Vec3, Vec6, Wrench, dispatch, larger};
use crate::statics::Support;
use crate::statics::boundary::{displacements, displacements_slope};
use core::ops::Range;

const NONE: Square<f64> = [[0.0; 6]; 6];
const IDENTITY: Square<f64> = {
    let mut identity = NONE;
    let mut k = 0;
    while k < 6 {
        identity[k][k] = 1.0;
        k += 1;
    }
    identity
};

/// Where a body is, and what acts on it beside joints, in the network's axes; what the rods' [`Nodal`] is for their nodes.
#[derive(Clone, Copy, Debug)]
struct FreeFrame {
    place: Vec3,
    load: Wrench,
    resists: Square<f64>,
    unsure: f64,
}

/// A part of a frame's variation: an unknown, and the motions (its columns) that it stands for.
#[derive(Clone, Copy, Debug)]
struct Term {
    unknown: usize,
    motions: Square<f64>,
    /// Whether the motions are the frame's own variation.
    whole: bool,
}

/// The system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Network {
    axes: Axes,
    /// The rods in it, and the number (in the network) of each one's first frame.
    rods: Vec<(usize, usize)>,
    bodies: Vec<usize>,
    first_body: usize,
    /// The numbers that the assembly has for the network's frames, and what they are.
    frames: Vec<usize>,
    members: Vec<Member>,
    /// The network's numbers for the assembly's frames.
    number: Vec<usize>,
    /// The frames' terms: of a frame without joints one of its own.
    terms: Vec<Term>,
    terms_of: Vec<Range<usize>>,
    /// For frames that hang from others, roots first: number, parent, tie.
    hanging: Vec<(usize, usize, usize)>,
    /// Of each frame, where it is in that list.
    hangs: Vec<Option<usize>>,
    /// The unknowns that stand in each other's equations, of frames that touch the later ones, and the unknown at each place in the order.
    edges: Vec<[usize; 2]>,
    own_edges: usize,
    unknown_at: Vec<usize>,
    structure: Structure,
    diagonal: Vec<Wide>,
    upper: Vec<Wide>,
    lower: Vec<Wide>,
    /// Of each unknown, the factors of its pivot and the inverses of what stands on their diagonal.
    pivots: Vec<(Square<f64>, [f64; 6])>,
    right: Vec<[f64; 6]>,
    /// What each frame is out of balance by, with all that hangs from it.
    borne: Vec<Wrench>,
    /// Where each unknown's moments are about, what is out of balance along it, and beside what that is small.
    abouts: Vec<Vec3>,
    imbalance: Vec<[f64; 6]>,
    scale: Vec<f64>,
    free: Vec<FreeFrame>,
    free_steps: Vec<Vec6>,
}

impl Network {
    /// The system of some rods and bodies of an assembly, of all that they are tied to.
    pub fn new(assembly: &Assembly, ties: &Ties, rods: &[usize], bodies: &[usize]) -> Self {
        let mut network = Self::default();
        for &rod in rods {
            network.rods.push((rod, network.frames.len()));
            network.frames.extend(assembly.nodes(rod));
        }
        network.first_body = network.frames.len();
        network.bodies = bodies.to_vec();
        network.frames.extend(bodies.iter().map(|body| assembly.first_body() + body));
        let mut number = vec![usize::MAX; assembly.frames()];
        network.frames.iter().enumerate().for_each(|(i, frame)| number[*frame] = i);
        network.members = network.frames.iter().map(|frame| assembly.member(*frame)).collect();
        network.hangs = vec![None; network.frames.len()];
        // The unknowns of each frame: its parent's, and one of its own where it has a freedom.
        let mut unknowns = 0;
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); network.frames.len()];
        for (i, frame) in network.frames.iter().enumerate() {
            if ties.above[*frame].is_none() {
                of[i] = vec![unknowns];
                unknowns += 1;
            }
        }
        for (t, tie) in ties.list.iter().enumerate() {
            let (child, parent) = (number[tie.child], number[tie.parent]);
            if child == usize::MAX {
                continue;
            }
            network.hangs[child] = Some(network.hanging.len());
            network.hanging.push((child, parent, t));
            of[child] = of[parent].clone();
            if !tie.kind.free_turns().is_empty() {
                of[child].push(unknowns);
                unknowns += 1;
            }
        }
        network.number = number;
        for own in &of {
            let first = network.terms.len();
            let term = |at: &usize| Term { unknown: *at, motions: IDENTITY, whole: true };
            network.terms.extend(own.iter().map(term));
            network.terms_of.push(first..network.terms.len());
        }
        for i in 0..network.frames.len() {
            network.join(i, i);
            let is_last = network.rods.iter().any(|(_, first)| *first == i + 1);
            if i + 1 < network.first_body && !is_last {
                network.join(i, i + 1);
            }
        }
        network.own_edges = network.edges.len();
        network.right = vec![[0.0; 6]; unknowns];
        network.diagonal = vec![Wide::NONE; unknowns];
        network.put_in_order();
        network
    }

    /// Makes it one in which frames touch each other too, by the assembly's numbers.
    pub fn tie(&mut self, touching: &[[Option<usize>; 4]]) {
        self.edges.truncate(self.own_edges);
        for frames in touching {
            for (k, a) in frames.iter().enumerate() {
                for b in &frames[..k] {
                    if let (Some(a), Some(b)) = (a, b) {
                        self.join(self.number[*a], self.number[*b]);
                    }
                }
            }
        }
        self.put_in_order();
    }

    /// Whether frames that touch each other, by the assembly's numbers, are joined in it.
    pub fn joins(&self, frames: &[Option<usize>; 4]) -> bool {
        let unknowns = |frame: &usize| {
            let own = &self.terms[self.terms_of[self.number[*frame]].clone()];
            own.iter().map(|term| term.unknown)
        };
        let mut each = frames.iter().flatten();
        core::iter::from_fn(|| each.next().map(|a| (a, each.clone()))).all(|(a, others)| {
            others
                .flat_map(unknowns)
                .all(|b| unknowns(a).all(|a| a == b || self.structure.find(a.min(b), a.max(b)).is_some()))
        })
    }

    /// Says that the unknowns of two frames stand in each other's equations.
    fn join(&mut self, a: usize, b: usize) {
        let (first, second) = (self.terms_of[a].clone(), self.terms_of[b].clone());
        let unplaced = |network: &Self, term: usize| network.unplaced(network.terms[term].unknown);
        for (a, b) in first.flat_map(|a| second.clone().map(move |b| (a, b))) {
            let (a, b) = (unplaced(self, a), unplaced(self, b));
            if a != b {
                self.edges.push([a, b]);
                self.edges.push([b, a]);
            }
        }
    }

    /// The unknown that has a place in the order.
    fn unplaced(&self, place: usize) -> usize {
        self.unknown_at.get(place).copied().unwrap_or(place)
    }

    /// Finds an order in which the unknowns are eliminated.
    fn put_in_order(&mut self) {
        let mut edges = self.edges.clone();
        edges.sort_unstable();
        edges.dedup();
        let (structure, place) = Structure::new(self.right.len(), &edges);
        for term in &mut self.terms {
            term.unknown = place[self.unknown_at.get(term.unknown).copied().unwrap_or(term.unknown)];
        }
        self.unknown_at.resize(place.len(), 0);
        place.iter().enumerate().for_each(|(unknown, at)| self.unknown_at[*at] = unknown);
        self.upper.resize(structure.after.len(), Wide::NONE);
        self.lower.resize(structure.after.len(), Wide::NONE);
        self.structure = structure;
    }

    /// The axes in which all its rods are to be linearised.
    pub fn axes(&mut self, assembly: &Assembly, origin: Vec3) -> Axes {
        let rod = self.rods.first().map(|(rod, _)| assembly.strands[*rod].problem.rod.scale());
        self.axes = match rod {
            Some(scale) => Axes { origin, length: scale.length, force: scale.force, moment: scale.moment },
            None => Axes { origin, ..Axes::default() },
        };
        self.free.clear();
        self.axes
    }

    /// Takes what acts on the next body. Of the forces on it so much (N) is not known for round-off, which is to be within the tolerance.
    pub fn add_body(&mut self, body: &Body, pose: &Pose, inertial: &Inertial, unsure: f64) {
        let axes = self.axes;
        let mut load = axes.wrench(body.load + inertial.exerts);
        let mut resists = NONE;
        if let Some(grip) = body.support.as_ref().and_then(|support| support.grip.as_ref()) {
            let (wrench, by_frame) = grip_acts(grip, pose, &axes);
            load += wrench;
            subtract(&mut resists, &by_frame.to_rows());
        }
        let place = axes.at(pose.position);
        subtract_dead_moment_slope(&mut resists, load.linear);
        subtract_inertial_slopes(&mut resists, &inertial.slopes(&axes));
        let resists = block_from(&-place, &resists);
        self.free.push(FreeFrame {
            place,
            load: load.wrench_from(place),
            resists,
            unsure: unsure / axes.force,
        });
    }

    /// Puts the rods' systems and the bodies' together. Gives the largest force (over `EI/L²`) and moment (over `EI/L`) by which an unknown is out of
    /// balance, over the largest wrench that its rod carries where that is larger.
    pub fn gather<'a>(
        &mut self,
        assembly: &Assembly,
        ties: &Ties,
        nodals: impl Iterator<Item = &'a Nodal> + Clone,
        poses: &[Pose],
        touches: impl Iterator<Item = Touch>,
        level: SimdLevel,
    ) -> f64 {
        self.right.fill([0.0; 6]);
        self.imbalance.clear();
        self.imbalance.resize(self.right.len(), [0.0; 6]);
        self.scale.clear();
        self.scale.resize(self.right.len(), f64::MIN_POSITIVE);
        self.weigh(nodals.clone());
        for blocks in [&mut self.diagonal, &mut self.upper, &mut self.lower] {
            blocks.fill(Wide::NONE);
        }
        self.take_motions(assembly, ties, poses);
        for (at, nodal) in nodals.enumerate() {
            dispatch(level, AddRod { network: self, at, nodal });
            self.load_rod(assembly, at, nodal);
        }
        // A body that only touches rods is out of balance beside the softest of them.
        let own = |(rod, _): &(usize, usize)| assembly.strands[*rod].problem.rod.scale().force;
        let softest = self.rods.iter().map(own).fold(f64::INFINITY, f64::min) / self.axes.force;
        let softest = if softest.is_finite() { softest } else { 0.0 };
        for body in 0..self.bodies.len() {
            let frame = self.first_body + body;
            let FreeFrame { load, resists, unsure, .. } = self.free[body];
            self.add_block(frame, frame, &resists);
            self.add_right(frame, load);
            self.weigh_unknowns(frame, load, unsure.max(softest));
        }
        for touch in touches {
            self.add_touch(&touch);
        }
        self.hold(assembly, poses);
        let out = |(imbalance, scale): (&[f64; 6], &f64)| {
            imbalance.iter().fold(0.0, |most, x: &f64| larger(most, x.abs())) / scale
        };
        self.imbalance.iter().zip(&self.scale).map(out).fold(0.0, larger)
    }

    #[inline(always)]
    fn add_rod(&mut self, at: usize, nodal: &Nodal) {
        let (_, first) = self.rods[at];
        let mut slopes = nodal.load_slopes.iter().peekable();
        for node in 0..=nodal.links.len() {
            let frame = first + node;
            let mut block = NONE;
            subtract_dead_moment_slope(&mut block, nodal.loads[node].linear);
            if node > 0 {
                add(&mut block, &on_far(&nodal.resists[node - 1].stiffness, nodal.links[node - 1].carried));
            }
            while let Some((_, slope)) = slopes.next_if(|(at, _)| *at == node) {
                subtract(&mut block, slope);
            }
            if let Some(slopes) = nodal.inertial_slopes.get(node) {
                subtract_inertial_slopes(&mut block, slopes);
            }
            let mut block = block_from(&-nodal.places[node], &block);
            if let Some(after) = nodal.links.get(node) {
                let to_origin = -nodal.places[node + 1];
                let stiffness = &nodal.resists[node].stiffness;
                let near = block_from(&to_origin, stiffness);
                add(&mut block, &near);
                let (mut upper, mut lower) = (on_far(stiffness, after.carried), near);
                if let Some(coupling) = nodal.couplings.get(node) {
                    add(&mut upper, &coupling.upper);
                    lower = block_from(&to_origin, &coupling.lower);
                }
                self.add_block(frame, frame + 1, &negative(&block_from(&to_origin, &upper)));
                self.add_block(frame + 1, frame, &negative(&lower));
            }
            self.add_block(frame, frame, &block);
        }
    }

    /// Takes what acts on a rod's nodes.
    fn load_rod(&mut self, assembly: &Assembly, at: usize, nodal: &Nodal) {
        let (rod, first) = self.rods[at];
        // In the rod's own units: a thick trunk's round-off is not a twig's imbalance.
        let own = assembly.strands[rod].problem.rod.scale().force / self.axes.force;
        let carried = nodal.links.iter().fold(own, |max: f64, link| max.max(link.carried.max_abs()));
        for node in 0..=nodal.links.len() {
            self.add_right(first + node, nodal.acting(node).wrench_from(nodal.places[node]));
            self.weigh_unknowns(first + node, nodal.imbalance(node).wrench_from(nodal.places[node]), carried);
        }
    }

    /// By what each frame is out of balance with all that hangs from it.
    fn weigh<'a>(&mut self, nodals: impl Iterator<Item = &'a Nodal>) {
        self.borne.clear();
        for nodal in nodals {
            let imbalance = |node: usize| nodal.imbalance(node).wrench_from(nodal.places[node]);
            self.borne.extend((0..=nodal.links.len()).map(imbalance));
        }
        self.borne.extend(self.free.iter().map(|body| body.load));
        for &(child, parent, _) in self.hanging.iter().rev() {
            let hangs = self.borne[child];
            self.borne[parent] += hangs;
        }
    }

    /// The motions that the unknowns stand for.
    fn take_motions(&mut self, assembly: &Assembly, ties: &Ties, poses: &[Pose]) {
        self.abouts.resize(self.right.len(), Vec3::ZERO);
        for i in (0..self.frames.len()).filter(|i| self.hangs[*i].is_none()) {
            let term = &mut self.terms[self.terms_of[i].start];
            let pose = self.axes.frame(&poses[self.frames[i]]);
            self.abouts[term.unknown] = pose.position;
            let support = held(assembly, self.members[i]);
            term.whole = support.is_none();
            term.motions = support.map_or(IDENTITY, |support| displacements(support, &pose).to_rows());
        }
        for &(child, parent, tie) in &self.hanging {
            let (from, to) = (self.terms_of[parent].clone(), self.terms_of[child].clone());
            for (from, to) in from.clone().zip(to.clone()) {
                self.terms[to] = self.terms[from];
            }
            if to.len() > from.len() {
                let tie = &ties.list[tie];
                let at = self.axes.frame(&tie.place(&poses[tie.parent]));
                let mut rows = NONE;
                for (row, k) in rows.iter_mut().zip(tie.kind.free_turns()) {
                    let axis = at.rotation.cols[k];
                    *row = parts(Vec6::new(axis, at.position.cross(axis)));
                }
                let term = &mut self.terms[to.end - 1];
                (term.motions, term.whole) = (transposed(&rows), false);
            }
        }
    }

    /// Adds `Tᵀ K T`, where `K` says how what acts on one frame resists the variation of another.
    #[inline(always)]
    fn add_block(&mut self, row: usize, column: usize, block: &Square<f64>) {
        let (rows, columns) = (self.terms_of[row].clone(), self.terms_of[column].clone());
        for r in rows {
            for c in columns.clone() {
                let (row, column) = (&self.terms[r], &self.terms[c]);
                let (at, to) = (row.unknown, column.unknown);
                if row.whole && column.whole {
                    self.block_mut(at, to).add(block);
                    continue;
                }
                let right = if column.whole { *block } else { product(block, &column.motions) };
                let whole = if row.whole { right } else { product(&transposed(&row.motions), &right) };
                self.block_mut(at, to).add(&whole);
            }
        }
    }

    #[inline(always)]
    fn block_mut(&mut self, row: usize, column: usize) -> &mut Wide {
        match row.cmp(&column) {
            core::cmp::Ordering::Equal => &mut self.diagonal[row],
            core::cmp::Ordering::Less => &mut self.upper[self.structure.block(row, column)],
            core::cmp::Ordering::Greater => &mut self.lower[self.structure.block(column, row)],
        }
    }

    #[inline(always)]
    fn add_right(&mut self, frame: usize, acts: Wrench) {
        let acts = parts(acts);
        for Term { unknown, motions, .. } in &self.terms[self.terms_of[frame].clone()] {
            for (acts, motions) in acts.iter().zip(motions) {
                for (right, motion) in self.right[*unknown].iter_mut().zip(motions) {
                    *right += motion * acts;
                }
            }
        }
    }

    /// Adds what a frame is out of balance by to that of its unknowns.
    fn weigh_unknowns(&mut self, frame: usize, acts: Wrench, carried: f64) {
        for Term { unknown, motions, whole } in &self.terms[self.terms_of[frame].clone()] {
            let of = &mut self.imbalance[*unknown];
            self.scale[*unknown] = self.scale[*unknown].max(carried);
            if *whole {
                let acts = parts(acts.wrench_from(-self.abouts[*unknown]));
                of.iter_mut().zip(acts).for_each(|(of, acts)| *of += acts);
            } else {
                for (acts, motions) in parts(acts).iter().zip(motions) {
                    of.iter_mut().zip(motions).for_each(|(of, motion)| *of += motion * acts);
                }
            }
        }
    }

    /// What holds frames: what is fixed has no equation, and free motions turn with what they are of.
    fn hold(&mut self, assembly: &Assembly, poses: &[Pose]) {
        for i in 0..self.frames.len() {
            let range = self.terms_of[i].clone();
            let own = self.terms[range.end - 1];
            if let Some(at) = self.hangs[i] {
                let parent = self.hanging[at].1;
                if self.terms_of[parent].len() < range.len() {
                    self.follow_parent(i, parent, &own);
                }
                continue;
            }
            let Some(support) = held(assembly, self.members[i]) else { continue };
            let pose = self.axes.frame(&poses[self.frames[i]]);
            let curved = displacements_slope(support, &pose, self.borne[i]).to_rows();
            let block = &mut self.diagonal[own.unknown];
            block.add(&curved);
            for (k, fixed) in support.fixed.iter().enumerate() {
                block.0[k][k] += f64::from(*fixed);
            }
        }
    }

    /// A joint's free motions go with the parent: how the work on them changes as they do. The rows that they leave have no equation.
    fn follow_parent(&mut self, child: usize, parent: usize, own: &Term) {
        let borne = self.borne[child];
        let motions = transposed(&own.motions);
        let mut slope = NONE;
        for (k, row) in slope.iter_mut().enumerate() {
            let motion = Vec6::from(motions[k]);
            if motion == Vec6::ZERO {
                self.diagonal[own.unknown].0[k][k] += 1.0;
                continue;
            }
            let by_turn = motion.angular.cross(borne.angular) + motion.linear.cross(borne.linear);
            *row = parts(Vec6::new(-by_turn, -motion.angular.cross(borne.linear)));
        }
        for term in self.terms_of[parent].clone() {
            let Term { unknown, motions, .. } = self.terms[term];
            let block = product(&slope, &motions);
            self.block_mut(own.unknown, unknown).add(&block);
        }
    }

    /// Solves, and gives the rods and bodies their steps; and how many pivots are negative, or `None` where one vanishes.
    pub fn solve<'a>(
        &mut self,
        level: SimdLevel,
        nodals: impl Iterator<Item = &'a mut Nodal>,
    ) -> Option<usize> {
        let (negative, vanished) = dispatch(level, EliminateNetwork { network: self });
        self.give_steps(nodals);
        (!vanished).then_some(negative)
    }

    /// Gives the rods and bodies their steps.
    fn give_steps<'a>(&mut self, nodals: impl Iterator<Item = &'a mut Nodal>) {
        for (nodal, (_, first)) in nodals.zip(&self.rods) {
            nodal.steps.clear();
            let steps = nodal.places.iter().enumerate();
            nodal.steps.extend(steps.map(|(node, place)| self.variation(first + node, place)));
        }
        let bodies = self.free.iter().enumerate();
        self.free_steps =
            bodies.map(|(body, free)| self.variation(self.first_body + body, &free.place)).collect();
    }

    /// How a frame at a place turns and shifts.
    fn variation(&self, frame: usize, place: &Vec3) -> Vec6 {
        let mut variation = [0.0; 6];
        for Term { unknown, motions, .. } in &self.terms[self.terms_of[frame].clone()] {
            for (variation, row) in variation.iter_mut().zip(motions) {
                *variation += row.iter().zip(&self.right[*unknown]).map(|(a, x)| a * x).sum::<f64>();
            }
        }
        seen_from_near(&-*place, pair(variation))
    }

    /// The largest turn (rad) and shift (over half a length) of a body in the step.
    pub fn step_size(&self) -> f64 {
        let size = |step: &Vec6| step.angular.norm().max(2.0 * step.linear.norm());
        self.free_steps.iter().map(size).fold(0.0, larger)
    }

    /// A body's pose after a part of the step.
    pub fn taken(&self, body: usize, part: f64, pose: &Pose) -> Pose {
        let moved = Pose::exp(self.free_steps[body] * part);
        Pose {
            rotation: moved.rotation * pose.rotation,
            position: pose.position + moved.position * self.axes.length,
        }
    }

    /// What is left over of what acts on a frame and all that hangs from it: force, and moment about a place, in the world.
    pub fn left_over(&self, frame: usize, place: Vec3) -> Wrench {
        self.axes.in_units(self.borne[frame]).wrench_from(self.axes.origin - place)
    }

    /// The frames from which all others hang.
    pub fn roots(&self) -> impl Iterator<Item = (usize, Member)> {
        let roots = self.members.iter().copied().enumerate();
        roots.filter(|(i, _)| self.hangs[*i].is_none())
    }

    /// The ties in it, a parent's before its children's.
    pub fn ties(&self) -> impl Iterator<Item = usize> {
        self.hanging.iter().map(|(_, _, tie)| *tie)
    }

    /// The network's frames, by the assembly's numbers.
    pub fn frames(&self) -> &[usize] {
        &self.frames
    }
}

/// What fixes a frame, if anything does.
fn held(assembly: &Assembly, member: Member) -> Option<&Support> {
    assembly.support(member).filter(|support| support.fixed.contains(&true))
}

/// Adds a rod's system.
struct AddRod<'a> {
    network: &'a mut Network,
    at: usize,
    nodal: &'a Nodal,
}

impl Kernel for AddRod<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.network.add_rod(self.at, self.nodal);
    }
}

#[inline(always)]
fn negative(block: &Square<f64>) -> Square<f64> {
    block.map(|row| row.map(|x| -x))
}

/// Eliminates the unknowns one after the other, and puts the solution back together in their right-hand sides. Gives how many pivots are negative, and
/// whether one vanishes.
struct EliminateNetwork<'a> {
    network: &'a mut Network,
}

impl Kernel for EliminateNetwork<'_> {
    type Output = (usize, bool);

    #[inline(always)]
    fn run(self) -> (usize, bool) {
        let Network { structure, diagonal, upper, lower, pivots, right, .. } = &mut *self.network;
        pivots.clear();
        let (mut negative, mut vanished) = (0, false);
        for p in 0..diagonal.len() {
            let mut pivot = diagonal[p].square();
            let scales = factor(&mut pivot);
            let size: f64 = (0..6).map(|k| diagonal[p].0[k][k].abs()).sum();
            for scale in scales {
                negative += usize::from(scale <= 0.0);
                // Not a number counts as vanished too.
                let firm = (1.0 / scale).abs() > SMALLEST_PIVOT * size;
                vanished |= !firm;
            }
            pivots.push((pivot, scales));
            let after = structure.range(p);
            for block in after.clone() {
                reduce(&pivot, &scales, &mut upper[block].0);
            }
            // What the blocks of this one change stands behind them.
            let end = after.end;
            for block in after {
                let q = structure.after[block];
                diagonal[q].subtract_product(&lower[block], &upper[block]);
            }
            let (upper, upper_later) = upper.split_at_mut(end);
            let (lower, lower_later) = lower.split_at_mut(end);
            for &[i, j, target] in &structure.pairs[structure.pair_begins[p]..structure.pair_begins[p + 1]] {
                upper_later[target - end].subtract_product(&lower[i], &upper[j]);
                lower_later[target - end].subtract_product(&lower[j], &upper[i]);
            }
        }
        substitute(structure, pivots, upper, lower, right);
        (negative, vanished)
    }
}

/// Puts the solution together in the right-hand sides.
#[inline(always)]
fn substitute(
    structure: &Structure,
    pivots: &[(Square<f64>, [f64; 6])],
    upper: &[Wide],
    lower: &[Wide],
    right: &mut [[f64; 6]],
) {
    for (p, (pivot, scales)) in pivots.iter().enumerate() {
        let mut x = right[p].map(|x| [x]);
        reduce(pivot, scales, &mut x);
        let x = x.map(|[x]| x);
        right[p] = x;
        for block in structure.range(p) {
            for (row, right) in lower[block].0.iter().zip(&mut right[structure.after[block]]) {
                *right -= dot(row, &x);
            }
        }
    }
    for p in (0..pivots.len()).rev() {
        let mut x = right[p];
        for block in structure.range(p) {
            for (x, row) in x.iter_mut().zip(&upper[block].0) {
                *x -= dot(row, &right[structure.after[block]]);
            }
        }
        right[p] = x;
    }
}

#[inline(always)]
fn dot(a: &[f64; 8], b: &[f64; 6]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]) + (a[4] * b[4] + a[5] * b[5])
}

/// Triangular factors in place, without interchange; gives the pivots' inverses.
#[inline(always)]
fn factor(block: &mut Square<f64>) -> [f64; 6] {
    let mut scales = [0.0; 6];
    for k in 0..6 {
        scales[k] = 1.0 / block[k][k];
        for i in k + 1..6 {
            block[i][k] *= scales[k];
            for c in k + 1..6 {
                block[i][c] -= block[k][c] * block[i][k];
            }
        }
    }
    scales
}

/// Solves with the factors for several right-hand sides in place.
#[inline(always)]
fn reduce<const COLUMNS: usize>(factors: &Square<f64>, scales: &[f64; 6], x: &mut [[f64; COLUMNS]; 6]) {
    for k in 0..6 {
        for i in k + 1..6 {
            for c in 0..COLUMNS {
                x[i][c] -= x[k][c] * factors[i][k];
            }
        }
    }
    for k in (0..6).rev() {
        for c in 0..COLUMNS {
            x[k][c] *= scales[k];
        }
        for i in 0..k {
            for c in 0..COLUMNS {
                x[i][c] -= x[k][c] * factors[i][k];
            }
        }
    }
}
