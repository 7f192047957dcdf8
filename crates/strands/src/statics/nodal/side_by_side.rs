//! Rods side by side: the nodal system of as many rods as a register holds numbers, a rod a lane.
//!
//! One rod alone follows from node to node and leaves most of a register idle. Rods of one number of elements, held at the same nodes, do the same
//! operations on other numbers, so the whole of Newton's method runs in lanes: only the supports, which are few, are met rod by rod.

use core::ops::Range;

use super::super::boundary::{displacements, displacements_slope, meet};
use super::super::march::Record;
use super::super::problem::{Problem, Support};
use super::elimination::{Eliminate, Inertia, Square, add_coadjoint, parts, subtract_dead_moment_slope};
use super::{Axes, Hold, Imbalance, Link, Nodal, Resists};
use crate::element::{Resistance, diagonal_resistance};
use crate::math::{Kernel, Mat3, Pose, Real, Register, Vec3, Vec6, Wide, Wrench, larger, largest, logs};

/// As many rods as there are lanes, their states, and their linear systems. All in each rod's own axes, as those of one rod.
#[derive(Clone, Debug)]
pub(crate) struct SideBySide<R> {
    /// How many rods there are; lanes beyond them repeat the last.
    rods: usize,
    axes: Vec<Axes>,
    elements: Vec<Fixed<R>>,
    /// The dead load of each node, and the one that follows it.
    dead: Vec<Wrench<Vec3<R>>>,
    follower: Vec<Wrench<Vec3<R>>>,
    any_follower: bool,
    poses: Vec<Pose<Vec3<R>>>,
    wrenches: Vec<Wrench<Vec3<R>>>,
    /// States that were kept, and the axes that they were seen from.
    kept_axes: Vec<Axes>,
    kept_poses: Vec<Pose<Vec3<R>>>,
    kept_wrenches: Vec<Wrench<Vec3<R>>>,
    system: Nodal<R>,
}

/// What of an element does not change.
#[derive(Clone, Copy, Debug)]
struct Fixed<R> {
    compliance: Vec6<Vec3<R>>,
    rest: Vec6<Vec3<R>>,
    /// Its part of the length.
    part: R,
}

impl<R: Register> SideBySide<R> {
    /// Rods of order 2 with diagonal laws, of one number of elements, without their loads and states. Where there are fewer than lanes, the last one
    /// is taken again.
    pub fn new(problems: &[Problem]) -> Self {
        let problem = |lane: usize| of_lane(problems, lane);
        let n = problem(0).rod.elements();
        let axes: Vec<Axes> = (0..R::LANES)
            .map(|lane| {
                let scale = problem(lane).rod.scale();
                let origin = problem(lane).start.pose.position;
                Axes { origin, length: scale.length, force: scale.force, moment: scale.moment }
            })
            .collect();
        let mut elements = Vec::with_capacity(n);
        for e in 0..n {
            let mut fixed = Fixed { compliance: Vec6::zero(), rest: Vec6::zero(), part: R::zero() };
            for (lane, axes) in axes.iter().enumerate() {
                let rod = &problem(lane).rod;
                let Some(points) = rod.diagonal_points() else { unreachable!("the law is diagonal") };
                fixed.compliance.put(lane, axes.compliance(points[e].compliance));
                fixed.rest.put(lane, axes.shift(points[e].rest));
                fixed.part.put_number(lane, rod.element_length(e) / rod.length());
            }
            elements.push(fixed);
        }
        Self {
            rods: problems.len(),
            axes,
            elements,
            dead: vec![Wrench::zero(); n + 1],
            follower: vec![Wrench::zero(); n + 1],
            any_follower: false,
            poses: vec![Pose::IDENTITY.splat(); n + 1],
            wrenches: vec![Wrench::zero(); n],
            kept_axes: Vec::new(),
            kept_poses: Vec::new(),
            kept_wrenches: Vec::new(),
            system: Nodal::default(),
        }
    }

    /// The lanes of a rod.
    fn lanes_of(&self, rod: usize) -> Range<usize> {
        rod..if rod + 1 == self.rods { R::LANES } else { rod + 1 }
    }

    /// Takes the loads of one of the rods.
    pub fn put_loads(&mut self, rod: usize, problem: &Problem) {
        for lane in self.lanes_of(rod) {
            let axes = &self.axes[lane];
            let loads = problem.loads.world.iter().zip(&problem.loads.body);
            for ((dead, follower), (world, body)) in self.dead.iter_mut().zip(&mut self.follower).zip(loads) {
                dead.put(lane, axes.wrench(*world));
                follower.put(lane, axes.wrench(*body));
                self.any_follower |= *body != Wrench::ZERO;
            }
        }
    }

    /// Takes the state of one of the rods.
    pub fn put_state(&mut self, rod: usize, state: &Record) {
        for lane in self.lanes_of(rod) {
            // About where the rod is: far from it digits were lost.
            let axes = &mut self.axes[lane];
            axes.origin = state.poses[0].position;
            for (to, pose) in self.poses.iter_mut().zip(&state.poses) {
                to.put(lane, &axes.frame(pose));
            }
            for (to, wrench) in self.wrenches.iter_mut().zip(&state.wrenches) {
                to.put(lane, axes.wrench(*wrench));
            }
        }
    }

    /// Keeps the states of all rods as they are.
    pub fn keep(&mut self) {
        self.kept_axes.clone_from(&self.axes);
        self.kept_poses.clone_from(&self.poses);
        self.kept_wrenches.clone_from(&self.wrenches);
    }

    /// Gives one of the rods its kept state back.
    pub fn take_back(&mut self, rod: usize) {
        for lane in self.lanes_of(rod) {
            self.axes[lane] = self.kept_axes[lane];
            for (pose, kept) in self.poses.iter_mut().zip(&self.kept_poses) {
                pose.put(lane, &kept.lane(lane));
            }
            for (wrench, kept) in self.wrenches.iter_mut().zip(&self.kept_wrenches) {
                wrench.put(lane, kept.lane(lane));
            }
        }
    }

    /// Gives the state of one of the rods, but for the strains.
    pub fn take_state(&self, lane: usize, state: &mut Record) {
        let axes = &self.axes[lane];
        state.fit(self.wrenches.len());
        for (to, pose) in state.poses.iter_mut().zip(self.poses(lane)) {
            *to = pose;
        }
        for (wrench, wide) in state.wrenches.iter_mut().zip(&self.wrenches) {
            *wrench = axes.in_units(wide.lane(lane));
        }
    }

    /// The frame of a node of one of the rods.
    pub fn pose(&self, lane: usize, node: usize) -> Pose {
        self.axes[lane].in_world(&self.poses[node].lane(lane))
    }

    /// The frames of a rod's nodes.
    pub fn poses(&self, lane: usize) -> impl Iterator<Item = Pose> {
        let axes = &self.axes[lane];
        self.poses.iter().map(move |pose| axes.in_world(&pose.lane(lane)))
    }

    /// Linearises all rods about their states, `lent` to the compliance of each as in [`Nodal::linearise`], and gives their residuals, as
    /// [`Distance::residual`](super::Distance::residual): not a number where a rod cannot be linearised.
    pub fn linearise(&mut self, problems: &[Problem], lent: R) -> R {
        let slack = R::run(LineariseAll { side: self, lent });
        self.hold(problems);
        let imbalance = R::run(Imbalance { system: &self.system });
        larger(imbalance, slack * R::splat(self.wrenches.len() as f64))
    }

    /// The free displacements of the nodes that are held, rod by rod.
    fn hold(&mut self, problems: &[Problem]) {
        let Self { poses, system, .. } = self;
        system.holds.clear();
        for (at, (node, first)) in problems[0].supports().enumerate() {
            let mut hold =
                Hold { node, free: [[R::zero(); 6]; 6], fixed: [R::zero(); 6], curved: [[R::zero(); 6]; 6] };
            let imbalance = system.imbalance(node);
            for lane in 0..R::LANES {
                let end = nth_support(problems, lane, at).map_or(first, |(_, end)| end);
                for r in 0..6 {
                    hold.fixed[r].put_number(lane, f64::from(end.fixed[r]));
                }
                if end.fixed == [true; 6] {
                    continue;
                }
                let turned = poses[node].lane(lane).from_itself();
                let free = displacements(end, &turned).to_rows();
                let curved = displacements_slope(end, &turned, imbalance.lane(lane)).to_rows();
                for r in 0..6 {
                    for c in 0..6 {
                        hold.free[r][c].put_number(lane, free[r][c]);
                        hold.curved[r][c].put_number(lane, curved[r][c]);
                    }
                }
            }
            system.holds.push(hold);
        }
    }

    /// Solves for the steps against a drag on each rod, as [`Nodal::solve`].
    pub fn solve(&mut self, drag: R) -> Inertia<R> {
        let part = 1.0 / self.wrenches.len() as f64;
        let drag = R::from_lanes(|lane| drag.number(lane) * part);
        R::run(Eliminate { nodal: &mut self.system, drag })
    }

    /// Of each rod [`Nodal::round_off`].
    pub fn round_off(&self) -> R {
        R::run(Of { side: self, figure: Figure::RoundOff })
    }

    /// Of each rod [`Nodal::stiffness_along_step`].
    pub fn stiffness_along_step(&self) -> R {
        R::run(Of { side: self, figure: Figure::StiffnessAlongStep })
    }

    /// The largest force that an element of each rod carries, over `EI/L²`.
    pub fn largest_force(&self) -> R {
        R::run(Of { side: self, figure: Figure::LargestForce })
    }

    /// Takes the step of each rod, where its `moves` is one: as much of it as moves no node further than `stride`, or `whole` if it moves none
    /// further, and else nothing.
    pub fn take(&mut self, problems: &[Problem], stride: f64, whole: bool, moves: R) {
        R::run(TakeAll { side: self, stride, whole, moves });
        for at in 0..self.system.holds.len() {
            let node = self.system.holds[at].node;
            for lane in 0..R::LANES {
                let Some((_, end)) = nth_support(problems, lane, at) else { continue };
                let met = self.axes[lane].frame(&meet(end, &self.pose(lane, node)));
                self.poses[node].put(lane, &met);
            }
        }
    }

    /// Moves each rod whose `moves` is one, as it was when the system was last solved, on as it answers to a motion of its held end (in that end's
    /// axes, as a [`Pose::log`]), as [`Nodal::step_with_end`].
    pub fn follow_ends(&mut self, problems: &[Problem], motions: &[Vec6], moves: R) {
        let last = self.wrenches.len();
        let mut first = Vec6::zero();
        for lane in 0..R::LANES {
            let motion = motions[lane.min(self.rods - 1)];
            let (axes, end) = (&self.axes[lane], self.poses[last].lane(lane));
            let turn = end.rotation * motion.angular;
            first.put(lane, Vec6::new(turn, end.rotation * motion.linear * (1.0 / axes.length)));
        }
        R::run(Answer { system: &mut self.system, end: first });
        self.take(problems, f64::INFINITY, false, moves);
    }
}

/// What belongs to a lane of what there is for each rod: lanes beyond the rods repeat the last.
pub(crate) fn of_lane<T>(rods: &[T], lane: usize) -> &T {
    &rods[lane.min(rods.len() - 1)]
}

fn nth_support(problems: &[Problem], lane: usize, at: usize) -> Option<(usize, &Support)> {
    of_lane(problems, lane).supports().nth(at)
}

/// Nothing where it stays. Without closures, as all here: they are not always put in line, and must be for their instructions.
#[inline(always)]
fn unless<R: Real>(stays: R::Mask, v: Vec6<Vec3<R>>) -> Vec6<Vec3<R>> {
    Vec6::new(unless_vector(stays, v.angular), unless_vector(stays, v.linear))
}

#[inline(always)]
fn unless_vector<R: Real>(stays: R::Mask, v: Vec3<R>) -> Vec3<R> {
    let none = R::zero();
    Vec3::new(R::select(stays, none, v.x), R::select(stays, none, v.y), R::select(stays, none, v.z))
}

struct LineariseAll<'a, R> {
    side: &'a mut SideBySide<R>,
    lent: R,
}

impl<R: Wide> Kernel for LineariseAll<'_, R> {
    type Output = R;

    /// Gives the largest slack.
    #[inline(always)]
    fn run(self) -> R {
        let Self { side, lent } = self;
        let SideBySide { elements, dead, follower, any_follower, poses, wrenches, system, .. } = side;
        let zero = R::zero();
        let mut worst = zero;
        let none = Link { arm: Vec3::zero(), carried: Wrench::zero(), pull: Wrench::zero() };
        system.links.resize(wrenches.len(), none);
        let none = Resists { arm: Vec3::zero(), stiffness: [[zero; 6]; 6] };
        system.resists.resize(wrenches.len(), none);
        for (e, fixed) in elements.iter().enumerate() {
            let x = logs(&poses[e].between(&poses[e + 1]));
            let turned = poses[e + 1].rotation;
            let wrench = wrenches[e];
            let Resistance { stiffness, pull, slack } =
                diagonal_resistance(fixed.compliance, fixed.rest, lent * fixed.part, x, wrench, &turned);
            worst = larger(worst, largest(&parts(slack)));
            let arm = poses[e + 1].position - poses[e].position;
            system.links[e] = Link { arm, carried: wrench.turned_by(&turned), pull };
            let to = &mut system.resists[e];
            to.arm = arm;
            let rows = &mut to.stiffness;
            put_block(rows, 0, 0, &stiffness[0][0]);
            put_block(rows, 0, 3, &stiffness[0][1]);
            put_block(rows, 3, 0, &stiffness[1][0]);
            put_block(rows, 3, 3, &stiffness[1][1]);
        }
        system.loads.clear();
        system.load_slopes.clear();
        for (i, pose) in poses.iter().enumerate() {
            let mut acts = dead[i];
            if *any_follower {
                let carried = follower[i].turned_by(&pose.rotation);
                acts += carried;
                let mut slope = [[zero; 6]; 6];
                add_coadjoint(&mut slope, carried);
                // The elimination adds that of every force that acts.
                subtract_dead_moment_slope(&mut slope, carried.linear);
                system.load_slopes.push((i, slope));
            }
            system.loads.push(acts);
        }
        worst
    }
}

#[inline(always)]
fn put_block<R: Real>(to: &mut Square<R>, row: usize, column: usize, block: &Mat3<Vec3<R>>) {
    for c in 0..3 {
        let v = block.cols[c];
        to[row][column + c] = v.x;
        to[row + 1][column + c] = v.y;
        to[row + 2][column + c] = v.z;
    }
}

/// A figure of each rod.
struct Of<'a, R> {
    side: &'a SideBySide<R>,
    figure: Figure,
}

enum Figure {
    RoundOff,
    StiffnessAlongStep,
    LargestForce,
}

impl<R: Real> Kernel for Of<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let SideBySide { system, wrenches, .. } = self.side;
        match self.figure {
            Figure::RoundOff => system.round_off(),
            Figure::StiffnessAlongStep => system.stiffness_along_step(),
            Figure::LargestForce => {
                let mut squared = R::zero();
                for wrench in wrenches {
                    squared = larger(squared, wrench.linear.dot(wrench.linear));
                }
                squared.sqrt()
            }
        }
    }
}

struct TakeAll<'a, R> {
    side: &'a mut SideBySide<R>,
    stride: f64,
    whole: bool,
    moves: R,
}

impl<R: Real> Kernel for TakeAll<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { side, stride, whole, moves } = self;
        let SideBySide { poses, wrenches, system, .. } = side;
        let (one, zero) = (R::one(), R::zero());
        let mut part = one;
        if stride.is_finite() {
            let wanted = R::splat(stride) / system.step_size();
            let within = (one - wanted).at_most(0.0);
            part = R::select(within, one, if whole { zero } else { wanted });
        }
        let stays = R::select(moves.at_most(0.5), zero, part).at_most(0.0);
        for e in 0..wrenches.len() {
            let turned = &poses[e + 1].rotation;
            let change = system.resists[e].change(system.steps[e], system.steps[e + 1]);
            let change = ((change + system.links[e].pull) * part).turned_back_by(turned);
            wrenches[e] += unless(stays, change);
        }
        for i in 0..poses.len() {
            let by = Pose::exp(unless(stays, system.steps[i]) * part);
            let pose = poses[i];
            poses[i] = Pose { rotation: by.rotation * pose.rotation, position: pose.position + by.position };
        }
    }
}

struct Answer<'a, R> {
    system: &'a mut Nodal<R>,
    end: Vec6<Vec3<R>>,
}

impl<R: Real> Kernel for Answer<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.system.answer_to_end(self.end);
    }
}
