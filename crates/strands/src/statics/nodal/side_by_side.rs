//! Rods side by side: the nodal system of as many rods as a register holds numbers, a rod a lane.
//!
//! One rod alone follows from node to node and leaves most of a register idle. Rods of one number of elements, held at the same nodes, do the same
//! operations on other numbers, so the whole of Newton's method runs in lanes: only the supports, which are few, are met rod by rod.

use core::ops::Range;

use super::super::boundary::{displacements, displacements_slope, meet};
use super::super::march::Record;
use super::super::problem::{Problem, Support};
use super::elimination::{Eliminate, Inertia, Square, minus_hat, pair, parts};
use super::second_variation::TURNING;
use super::{Axes, Hold, Link, Nodal, ROUND_OFF, along_screw};
use crate::element::{Resistance, diagonal_resistance};
use crate::math::{Kernel, Mat3, Pose, Real, Register, Vec3, Vec6, Wide, Wrench};

/// As many rods as there are lanes, their states, and their linear systems. All in each rod's own fixed axes, in which lengths, forces and moments
/// are numbers of order one.
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
    /// States that were kept.
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
        let problem = |lane: usize| &problems[lane.min(problems.len() - 1)];
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
                let compliance = points[e].compliance;
                let scaled = Vec6::new(
                    compliance.angular * axes.moment,
                    compliance.linear * (axes.force / axes.length),
                );
                fixed.compliance.put(lane, scaled);
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
        self.kept_poses.clone_from(&self.poses);
        self.kept_wrenches.clone_from(&self.wrenches);
    }

    /// Gives one of the rods its kept state back.
    pub fn take_back(&mut self, rod: usize, origin: Vec3) {
        for lane in self.lanes_of(rod) {
            self.axes[lane].origin = origin;
            for (pose, kept) in self.poses.iter_mut().zip(&self.kept_poses) {
                pose.put(lane, &kept.lane(lane));
            }
            for (wrench, kept) in self.wrenches.iter_mut().zip(&self.kept_wrenches) {
                wrench.put(lane, kept.lane(lane));
            }
        }
    }

    /// Where the axes of a rod begin.
    pub fn origin(&self, rod: usize) -> Vec3 {
        self.axes[rod].origin
    }

    /// Gives the state of one of the rods, but for the strains.
    pub fn take_state(&self, lane: usize, state: &mut Record) {
        let axes = &self.axes[lane];
        state.fit(self.wrenches.len());
        for (pose, wide) in state.poses.iter_mut().zip(&self.poses) {
            *pose = axes.in_world(&wide.lane(lane));
        }
        for (wrench, wide) in state.wrenches.iter_mut().zip(&self.wrenches) {
            let w = wide.lane(lane);
            *wrench = Wrench::new(w.angular * axes.moment, w.linear * axes.force);
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
        R::run(Measure { side: self, slack })
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
                let pose = poses[node].lane(lane);
                let free = displacements(end, &pose).to_rows();
                let curved = displacements_slope(end, &pose, imbalance.lane(lane)).to_rows();
                for r in 0..6 {
                    hold.fixed[r].put_number(lane, f64::from(end.fixed[r]));
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
        R::run(RoundOff { system: &self.system })
    }

    /// Of each rod [`Nodal::stiffness_along_step`].
    pub fn stiffness_along_step(&self) -> R {
        R::run(AlongStep { system: &self.system })
    }

    /// The largest force that an element of each rod carries, over `EI/L²`.
    pub fn largest_force(&self) -> R {
        R::run(LargestForce { wrenches: &self.wrenches })
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
            let motion = motions[lane.min(problems.len() - 1)];
            let (axes, end) = (&self.axes[lane], self.poses[last].lane(lane));
            let turn = end.rotation * motion.angular;
            let shift = end.rotation * motion.linear * (1.0 / axes.length);
            first.put(lane, Vec6::new(turn, shift - turn.cross(self.system.places[last].lane(lane))));
        }
        self.system.links.iter_mut().for_each(|link| link.pull = Wrench::zero());
        R::run(Answer { system: &mut self.system, end: first });
        self.take(problems, f64::INFINITY, false, moves);
    }
}

fn nth_support(problems: &[Problem], lane: usize, at: usize) -> Option<(usize, &Support)> {
    problems[lane.min(problems.len() - 1)].supports().nth(at)
}

/// The larger of two numbers in each lane, not a number where either is.
#[inline(always)]
fn larger<R: Real>(a: R, b: R) -> R {
    R::select((b - a).at_most(0.0), a, b) + a * R::zero()
}

/// The same with the largest part of a vector. Without closures, as all here: they are not always put in line, and must be for their instructions.
#[inline(always)]
fn largest<R: Real>(most: R, v: Vec6<Vec3<R>>) -> R {
    let most = larger(larger(larger(most, v.angular.x.abs()), v.angular.y.abs()), v.angular.z.abs());
    larger(larger(larger(most, v.linear.x.abs()), v.linear.y.abs()), v.linear.z.abs())
}

/// Nothing where it stays.
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
        system.links.resize(
            wrenches.len(),
            Link { stiffness: [[zero; 6]; 6], carried: Wrench::zero(), pull: Wrench::zero() },
        );
        for (e, fixed) in elements.iter().enumerate() {
            let far = poses[e + 1];
            let relative = poses[e].between(&far);
            let mut x = relative.log_of_small_turn();
            if !R::all(x.angular.x.at_most(f64::INFINITY)) {
                log_of_large_turns(&relative, &mut x);
            }
            let wrench = wrenches[e];
            let Resistance { stiffness, pull, slack } =
                diagonal_resistance(fixed.compliance, fixed.rest, lent * fixed.part, x, wrench, &far);
            worst = largest(worst, slack);
            let link = &mut system.links[e];
            for r in 0..6 {
                for c in 0..6 {
                    let column = &stiffness[r / 3][c / 3].cols[c % 3];
                    link.stiffness[r][c] = [column.x, column.y, column.z][r % 3];
                }
            }
            link.carried = far.carry_wrench(wrench);
            link.pull = pull;
        }
        system.places.clear();
        system.loads.clear();
        system.load_slopes.clear();
        for (i, pose) in poses.iter().enumerate() {
            let (at, load) = (pose.position, dead[i]);
            system.places.push(at);
            let mut acts = Wrench::new(load.angular + at.cross(load.linear), load.linear);
            let mut slope = [[zero; 6]; 6];
            let force = Mat3::hat(load.linear);
            put_block(&mut slope, 0, 0, &(force * Mat3::hat(at)));
            put_block(&mut slope, 0, 3, &force.scaled(-R::one()));
            if *any_follower {
                let carried = pose.carry_wrench(follower[i]);
                acts += carried;
                add_coadjoint(&mut slope, carried);
            }
            system.loads.push(acts);
            system.load_slopes.push((i, slope));
        }
        worst
    }
}

/// Where the turn of an element is too large for the short way.
#[cold]
#[inline(never)]
fn log_of_large_turns<R: Wide>(relative: &Pose<Vec3<R>>, x: &mut Vec6<Vec3<R>>) {
    for lane in 0..R::LANES {
        if x.angular.x.number(lane).is_nan() {
            x.put(lane, relative.lane(lane).log());
        }
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

/// Adds `ad*(η) w` as a matrix of `η`, as [`element::coadjoint_by_strain`](crate::element::coadjoint_by_strain).
#[inline(always)]
fn add_coadjoint<R: Real>(to: &mut Square<R>, w: Wrench<Vec3<R>>) {
    minus_hat(to, 0, 0, w.angular);
    minus_hat(to, 0, 3, w.linear);
    minus_hat(to, 3, 0, w.linear);
}

/// Ends [`SideBySide::linearise`]: how far all are from equilibrium.
struct Measure<'a, R> {
    side: &'a SideBySide<R>,
    slack: R,
}

impl<R: Real> Kernel for Measure<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { side: SideBySide { system, .. }, slack } = self;
        let (mut carried, mut imbalance) = (R::one(), R::zero());
        for link in &system.links {
            carried = largest(carried, link.carried);
        }
        let mut holds = system.holds.iter().peekable();
        for (node, place) in system.places.iter().enumerate() {
            let acts = system.imbalance(node);
            let about = match holds.next_if(|hold| hold.node == node) {
                Some(hold) => hold.along_free(acts),
                None => Wrench::new(acts.angular - place.cross(acts.linear), acts.linear),
            };
            imbalance = largest(imbalance, about);
        }
        larger(imbalance / carried, slack * R::splat(system.links.len() as f64))
    }
}

struct RoundOff<'a, R> {
    system: &'a Nodal<R>,
}

impl<R: Real> Kernel for RoundOff<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let mut stiffest = R::zero();
        for link in &self.system.links {
            for k in 0..6 {
                stiffest = larger(stiffest, link.stiffness[k][k].abs());
            }
        }
        stiffest * R::splat(ROUND_OFF * f64::EPSILON * self.system.links.len() as f64)
    }
}

struct AlongStep<'a, R> {
    system: &'a Nodal<R>,
}

impl<R: Real> Kernel for AlongStep<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let system = self.system;
        let (mut work, mut size) = (R::zero(), R::zero());
        for (i, (step, place)) in system.steps.iter().zip(&system.places).enumerate() {
            let shift = step.linear + step.angular.cross(*place);
            work += step.dot(system.acting(i));
            size += step.angular.dot(step.angular) * R::splat(TURNING) + shift.dot(shift);
        }
        R::splat(system.links.len() as f64) * work / size
    }
}

struct LargestForce<'a, R> {
    wrenches: &'a [Wrench<Vec3<R>>],
}

impl<R: Real> Kernel for LargestForce<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let mut squared = R::zero();
        for wrench in self.wrenches {
            squared = larger(squared, wrench.linear.dot(wrench.linear));
        }
        squared.sqrt()
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
            let mut squared = zero;
            for (step, place) in system.steps.iter().zip(&system.places) {
                let shift = step.linear + step.angular.cross(*place);
                squared = larger(squared, step.angular.dot(step.angular));
                squared = larger(squared, shift.dot(shift) * R::splat(4.0));
            }
            let wanted = R::splat(stride) / squared.sqrt();
            let within = (one - wanted).at_most(0.0);
            part = R::select(within, one, if whole { zero } else { wanted });
        }
        let stays = R::select(moves.at_most(0.5), zero, part).at_most(0.0);
        for e in 0..wrenches.len() {
            let change = system.links[e].change(system.steps[e], system.steps[e + 1], part, &poses[e + 1]);
            wrenches[e] += unless(stays, change);
        }
        for i in 0..poses.len() {
            let by = along_screw(unless(stays, system.steps[i]), part, system.places[i]);
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
        let Self { system, end } = self;
        let last = system.links.len();
        system.steps[last] = end;
        let mut x = parts(end);
        for i in (0..last).rev() {
            let mut next = [R::zero(); 6];
            for (next, row) in next.iter_mut().zip(&system.follows[i]) {
                *next = (row[0] * x[0] + row[1] * x[1])
                    + (row[2] * x[2] + row[3] * x[3])
                    + (row[4] * x[4] + row[5] * x[5]);
            }
            system.steps[i] = pair(next);
            x = next;
        }
    }
}
