//! Newton's method on all nodes of a rod at once.
//!
//! Unknown are the frames of the nodes and the wrench that each element carries; what must vanish is the imbalance of each node and the
//! slack of each element, which is what its exponent is off by for its law to hold. Eliminating the wrenches element by element leaves a block
//! tridiagonal system in the variations `η` of the frames. With `F` an element's resistance, `w` the wrench that it carries, `q` the change of it
//! that takes up the slack, and `A η = ad*(η) w`, the change of what it exerts is
//!
//! ```text
//! F (η_b − η_a) + q + A η_b
//! ```
//!
//! on its far node, and the opposite on its near one. The pivots are those of a Newton step on the energy (the augmented Lagrangian at the wrenches
//! as they are), so by the number of negative ones a step shows whether it leads down, and at an equilibrium whether that is stable.
//!
//! Every node's variation and moments are seen from fixed axes where it is, an element's from where its far node is, in which lengths, forces and moments
//! are numbers of order one. (Seen from one place for all, the stiffness against stretching times the square of the distance from there would stand beside
//! that against twisting: of a long thin rod that hardly stretches nothing would be left of the latter.)

mod axes;
mod elements;
mod elimination;
mod motion;
mod network;
mod second_variation;
mod side_by_side;

use axes::Axes;
use elements::Look;
pub(crate) use elements::take_strains;
pub(crate) use elimination::Inertia;
use elimination::{Block, Eliminate, Square, Substitute, pair, parts, seen_from_near, times};
use motion::Coupling;
pub(crate) use motion::{Coupled, Inertial, Motion};
pub(crate) use network::{Network, Touch, TouchEnd};
pub(crate) use second_variation::SecondVariation;
use second_variation::TURNING;
pub(crate) use side_by_side::{SideBySide, of_lane};

use super::boundary::{displacements, displacements_slope, meet};
use super::march::Record;
use super::problem::Problem;
use crate::coupling::Grip;
use crate::element::{self, DiagonalPoint, Resistance};
use crate::math::{Kernel, Mat3, Mat6, Pose, Real, SimdLevel, Vec3, Vec6, Wrench, dispatch, larger, largest};
use crate::rod::{Order, Rod};

/// The round-off of all pivots together, over that of the largest entry of a stiffness times the number of elements, with room: columns askew to
/// the axes, which are the worst, have a fourth of it.
const ROUND_OFF: f64 = 16.0;

/// An element where it is, as seen from its far node's place.
#[derive(Clone, Copy, Debug)]
struct Link<R> {
    /// To there from the near node.
    arm: Vec3<R>,
    carried: Wrench<Vec3<R>>,
    /// The change of what it carries that takes up its slack.
    pull: Wrench<Vec3<R>>,
}

/// How an element resists where it was linearised, as seen from its far node's place, `arm` from its near one's.
#[derive(Clone, Copy, Debug)]
struct Resists<R> {
    arm: Vec3<R>,
    stiffness: Square<R>,
}

/// How a node is held: its free displacements, one a column, which freedoms are fixed, and the stiffness that comes from how the free
/// displacements turn.
#[derive(Clone, Debug)]
struct Hold<R> {
    node: usize,
    free: Square<R>,
    /// One where fixed, zero where free.
    fixed: [R; 6],
    curved: Square<R>,
}

/// The linear system, and its solution.
#[derive(Clone, Debug)]
pub(crate) struct Nodal<R = f64> {
    axes: Axes,
    links: Vec<Link<R>>,
    resists: Vec<Resists<R>>,
    /// What acts on each node beside its elements, and how that changes with its frame, where it does otherwise than a dead force at its place.
    loads: Vec<Wrench<Vec3<R>>>,
    load_slopes: Vec<(usize, Square<R>)>,
    /// How what the change of its momentum exerts on each node of a rod that moves changes: the moment with a turn, the force with a shift.
    inertial_slopes: Vec<[Mat3<Vec3<R>>; 2]>,
    /// Of each element of a rod that moves whose nodes' momenta are coupled.
    couplings: Vec<Coupling<R>>,
    holds: Vec<Hold<R>>,
    /// Where the nodes are, from the axes' origin; of rods side by side, nothing.
    places: Vec<Vec3<R>>,
    /// How the variation of a node, seen from where the one after it is, follows from that one's; in its seventh column what it has by itself.
    follows: Vec<Block<R>>,
    /// The factors of each node's pivot, of a rod alone.
    pivots: Vec<Square<R>>,
    /// How the nodes of a rod that moves were held and turned where its slopes were taken, and how they have turned since: their steps are then in axes
    /// that are turned back by that. Nothing where slopes are new.
    held: Vec<Hold<R>>,
    turned: Vec<Mat3>,
    since: Vec<Mat3>,
    /// How each node turns (rad) and shifts (over the length).
    pub steps: Vec<Vec6<Vec3<R>>>,
    /// Another right-hand side, where one is asked for, and its solution.
    pub others: Vec<Wrench<Vec3<R>>>,
    pub other_steps: Vec<Vec6<Vec3<R>>>,
    other_pulls: Vec<Wrench<Vec3<R>>>,
}

impl<R> Default for Nodal<R> {
    fn default() -> Self {
        Self {
            axes: Axes::default(),
            links: Vec::new(),
            resists: Vec::new(),
            loads: Vec::new(),
            load_slopes: Vec::new(),
            inertial_slopes: Vec::new(),
            couplings: Vec::new(),
            holds: Vec::new(),
            places: Vec::new(),
            follows: Vec::new(),
            pivots: Vec::new(),
            held: Vec::new(),
            turned: Vec::new(),
            since: Vec::new(),
            steps: Vec::new(),
            others: Vec::new(),
            other_steps: Vec::new(),
            other_pulls: Vec::new(),
        }
    }
}

/// Whether how all resists is taken anew where a rod is looked at, or stays as it was when it was solved last: near by, that serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slopes {
    Anew,
    Kept,
}

/// How far a state is from equilibrium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distance {
    /// The largest force (over `EI/L²`) and moment (over `EI/L`) by which a node is out of balance, over the largest wrench carried where that is
    /// larger.
    pub imbalance: f64,
    /// The turn (rad) and shift (over the length) by which the slack of all elements together may displace the rod's end.
    pub slack: f64,
}

impl Distance {
    /// The larger of the two; NaN where either is.
    pub fn residual(&self) -> f64 {
        larger(self.imbalance, self.slack)
    }
}

impl Nodal {
    /// Linearises a rod about a state, `lent` (over `L³/EI`) lent to its compliance against shifts as long as that state has slack, and says how far
    /// the state is from equilibrium. `None` where an element's law cannot be solved there.
    pub fn linearise(
        &mut self,
        problem: &Problem,
        level: SimdLevel,
        lent: f64,
        state: &mut Record,
    ) -> Option<Distance> {
        self.axes = Axes::new(problem, state);
        self.linearise_in_its_axes(problem, level, lent, state)
    }

    fn linearise_in_its_axes(
        &mut self,
        problem: &Problem,
        level: SimdLevel,
        lent: f64,
        state: &mut Record,
    ) -> Option<Distance> {
        let rod = &problem.rod;
        let slack = match if rod.order() == Order::Second { rod.diagonal_points() } else { None } {
            Some(points) => self.look_at_elements(rod, points, level, (lent, Slopes::Anew), state),
            None => self.linearise_any(rod, lent, state)?,
        };
        self.inertial_slopes.clear();
        self.couplings.clear();
        self.since.clear();
        self.load(problem, state);
        Some(self.measure(problem, level, slack, state))
    }

    /// Looks at elements of order 2 with a diagonal law. Gives the largest slack.
    fn look_at_elements(
        &mut self,
        rod: &Rod,
        points: &[DiagonalPoint],
        level: SimdLevel,
        (lent, slopes): (f64, Slopes),
        state: &Record,
    ) -> f64 {
        let Self { axes, links, resists, .. } = self;
        match slopes {
            Slopes::Anew => dispatch(level, Look::<true> { rod, points, axes, lent, state, links, resists }),
            Slopes::Kept => dispatch(level, Look::<false> { rod, points, axes, lent, state, links, resists }),
        }
    }

    /// Ends a look: what supports hold, and how far all is from equilibrium.
    fn measure(&mut self, problem: &Problem, level: SimdLevel, slack: f64, state: &Record) -> Distance {
        let axes = self.axes;
        self.places.clear();
        self.places.extend(state.poses.iter().map(|pose| axes.at(pose.position)));
        self.load_slopes.sort_unstable_by_key(|(node, _)| *node);
        self.holds.clear();
        for (node, end) in problem.supports() {
            let turned = state.poses[node].from_itself();
            let curved = displacements_slope(end, &turned, self.imbalance(node)).to_rows();
            let free = displacements(end, &turned).to_rows();
            self.holds.push(Hold { node, free, fixed: end.fixed.map(f64::from), curved });
        }
        let imbalance = dispatch(level, Imbalance { system: self });
        Distance { imbalance, slack: slack * self.links.len() as f64 }
    }

    /// Elements of any order and law, one after the other. Gives the largest slack.
    fn linearise_any(&mut self, rod: &Rod, lent: f64, state: &mut Record) -> Option<f64> {
        let Self { axes, links, resists, .. } = self;
        let mut worst = 0.0;
        links.clear();
        resists.clear();
        for e in 0..rod.elements() {
            let (near, far) = (&state.poses[e], &state.poses[e + 1]);
            let relative = near.between(far);
            let share = lent * rod.element_length(e) / rod.length() * axes.length / axes.force;
            let (turned, w) = (&far.rotation, state.wrenches[e]);
            let Resistance { stiffness, pull, slack } =
                element::resistance(rod, e, w, &relative, turned, &mut state.strains[e], share)?;
            worst = larger(worst, largest(&axes.shift(slack).to_array()));
            let stiffness = axes.stiffness(&Mat6 { blocks: stiffness }).to_rows();
            let arm = (far.position - near.position) * (1.0 / axes.length);
            let carried = axes.wrench(w.turned_by(turned));
            links.push(Link { arm, carried, pull: axes.wrench(pull) });
            resists.push(Resists { arm, stiffness });
        }
        Some(worst)
    }

    /// What acts on the nodes beside the elements.
    fn load(&mut self, problem: &Problem, state: &Record) {
        let axes = self.axes;
        self.loads.clear();
        self.load_slopes.clear();
        for (i, pose) in state.poses.iter().enumerate() {
            let (mut load, body) = (axes.wrench(problem.loads.world[i]), axes.wrench(problem.loads.body[i]));
            let pulls = problem.loads.pulls_at(i);
            if body == Wrench::ZERO && pulls.is_empty() {
                self.loads.push(load);
                continue;
            }
            let mut slope = Mat6::ZERO;
            for pull in pulls {
                load.linear += pull.force(pose.position) * (1.0 / axes.force);
                let by_shift = pull.slope(pose.position).scaled(axes.length / axes.force);
                slope = slope.add(&force_slope(Mat3::ZERO, by_shift));
            }
            if body != Wrench::ZERO {
                let carried = body.turned_by(&pose.rotation);
                load += carried;
                slope = slope.add(&element::coadjoint_by_strain(carried));
                // The elimination adds that of every force that acts.
                slope = slope.add(&dead_moment_slope(carried.linear).scaled(-1.0));
            }
            self.loads.push(load);
            self.load_slopes.push((i, slope.to_rows()));
        }
        for (node, end) in problem.supports() {
            let Some(grip) = &end.grip else { continue };
            let (wrench, slope) = grip_acts(grip, &state.poses[node], &axes);
            self.loads[node] += wrench;
            self.load_slopes.push((node, slope.to_rows()));
        }
    }

    /// Takes for the other right-hand side how what acts changes on the way to another problem (`step` long), whose supports `moved` meets
    /// already. `None` as for [`Nodal::linearise`].
    pub fn linearise_towards(
        &mut self,
        problem: &Problem,
        level: SimdLevel,
        (lent, step): (f64, f64),
        moved: &mut Record,
        scratch: &mut Self,
    ) -> Option<()> {
        scratch.axes = self.axes;
        scratch.linearise_in_its_axes(problem, level, lent, moved)?;
        // Seen from where the node is here.
        let slope = |node: usize, there: Wrench, here: Wrench| {
            (there.wrench_from(scratch.places[node] - self.places[node]) - here) * (1.0 / step)
        };
        let others = (0..=self.links.len()).map(|i| slope(i, scratch.acting(i), self.acting(i))).collect();
        let pulls = scratch.links.iter().zip(&self.links).enumerate();
        self.other_pulls = pulls.map(|(e, (a, b))| slope(e + 1, a.pull, b.pull)).collect();
        self.others = others;
        Some(())
    }

    /// Adds so many of the other solution's steps to the step.
    pub fn add_other(&mut self, times: f64) {
        self.steps.iter_mut().zip(&self.other_steps).for_each(|(step, other)| *step += *other * times);
        self.links.iter_mut().zip(&self.other_pulls).for_each(|(link, pull)| link.pull += *pull * times);
    }

    /// Makes the step so many of the other solution's.
    pub fn step_is_other(&mut self, times: f64) {
        self.steps.fill(Vec6::ZERO);
        self.links.iter_mut().for_each(|link| link.pull = Wrench::ZERO);
        self.add_other(times);
    }

    /// Takes for the other right-hand side a force and a moment on each node, for a change that moves no support.
    pub fn act_with(&mut self, forces: impl Iterator<Item = Wrench>) {
        self.others.clear();
        self.others.extend(forces);
        self.other_pulls.clear();
    }

    /// Solves for a step against a drag (over `EI/L³`, of all nodes together). Gives how many pivots are negative, or `None` where one
    /// vanishes.
    pub fn solve(&mut self, level: SimdLevel, drag: f64) -> Option<usize> {
        let drag = drag / self.links.len() as f64;
        let Inertia { negative, vanished } = dispatch(level, Eliminate { nodal: self, drag });
        (vanished == 0.0).then_some(negative as usize)
    }

    /// Solves a rod that moves once more, for what acts now, with the slopes that were taken and solved with last, as if they had turned with its nodes.
    pub fn solve_again(&mut self, level: SimdLevel, state: &Record) {
        let Self { since, turned, .. } = self;
        since.clear();
        since.extend(state.poses.iter().zip(turned).map(|(pose, then)| pose.rotation * then.transpose()));
        dispatch(level, Substitute { nodal: self });
    }

    /// Makes the step one of the given size along a motion of the nodes, each in its own frame, and what takes up the slack.
    pub fn step_along(&mut self, state: &Record, motion: &[Vec6], size: f64) {
        self.steps.clear();
        self.steps
            .extend(state.poses.iter().zip(motion).map(|(pose, motion)| motion.turned_by(&pose.rotation)));
        let part = size / self.step_size();
        self.steps.iter_mut().for_each(|step| *step = *step * part);
    }

    /// Makes the step the answer of the rod, as it was when the system was last solved, to a motion of its held end (in its own axes, as a
    /// [`Pose::log`]). Costs hardly more than to look at the nodes.
    pub fn step_with_end(&mut self, end: &Pose, motion: Vec6) {
        let turn = end.rotation * motion.angular;
        self.answer_to_end(Vec6::new(turn, end.rotation * motion.linear * (1.0 / self.axes.length)));
    }

    /// Forgets what it was last solved for.
    pub fn forget(&mut self) {
        self.links.clear();
    }

    /// Whether the system was last solved for about this state of a rod.
    pub fn is_of(&self, state: &Record) -> bool {
        let near = |(place, pose): (&Vec3, &Pose)| (*place - self.axes.at(pose.position)).norm() < 1e-2;
        self.links.len() + 1 == state.poses.len()
            && self.follows.len() == state.poses.len()
            && self.places.iter().zip(&state.poses).step_by(16).all(near)
    }

    /// Takes a part of the step.
    pub fn take(&self, problem: &Problem, level: SimdLevel, part: f64, state: &mut Record) {
        dispatch(level, Take { nodal: self, part, state });
        for (node, end) in problem.supports() {
            state.poses[node] = meet(end, &state.poses[node]);
        }
    }
}

/// Takes a part of the step, several elements side by side.
struct Take<'a> {
    nodal: &'a Nodal,
    part: f64,
    state: &'a mut Record,
}

impl Kernel for Take<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { nodal, part, state } = self;
        let axes = nodal.axes;
        for (e, link) in nodal.links.iter().enumerate() {
            let mut change = nodal.resists[e].change(nodal.steps[e], nodal.steps[e + 1]);
            if let Some(since) = nodal.since.get(e + 1) {
                change = change.turned_by(since);
            }
            let far = &state.poses[e + 1].rotation;
            state.wrenches[e] += axes.in_units(((change + link.pull) * part).turned_back_by(far));
        }
        for (i, pose) in state.poses.iter_mut().enumerate() {
            let mut step = nodal.steps[i];
            if let Some(since) = nodal.since.get(i) {
                step = step.turned_by(since);
            }
            let moved = Pose::exp(step * part);
            *pose = Pose {
                rotation: moved.rotation * pose.rotation,
                position: pose.position + moved.position * axes.length,
            };
        }
    }
}

impl<R: Real> Resists<R> {
    /// How the wrench that the element carries changes with its nodes' steps, seen from the far one's place.
    #[inline(always)]
    fn change(&self, near: Vec6<Vec3<R>>, far: Vec6<Vec3<R>>) -> Wrench<Vec3<R>> {
        let turn = far.angular - near.angular;
        let shift = far.linear - near.linear + self.arm.cross(near.angular);
        pair(times(&self.stiffness, &parts(Vec6::new(turn, shift))))
    }
}

impl<R: Real> Nodal<R> {
    /// How far, as a drag, round-off may move the eigenvalues of the system that is solved (over `EI/L³`).
    #[inline(always)]
    pub fn round_off(&self) -> R {
        // The largest entry of a positive matrix lies on its diagonal.
        let mut stiffest = R::zero();
        for resists in &self.resists {
            for k in 0..6 {
                stiffest = larger(stiffest, resists.stiffness[k][k].abs());
            }
        }
        stiffest * R::splat(ROUND_OFF * f64::EPSILON * self.links.len() as f64)
    }

    /// How stiff the rod is along the step (over `EI/L³`), by what acts on it, with the drag against which it was solved for.
    #[inline(always)]
    pub fn stiffness_along_step(&self) -> R {
        let (mut work, mut size) = (R::zero(), R::zero());
        for (i, step) in self.steps.iter().enumerate() {
            work += step.dot(self.acting(i));
            size += step.angular.dot(step.angular) * R::splat(TURNING) + step.linear.dot(step.linear);
        }
        work * R::splat(self.links.len() as f64) / size
    }

    /// The largest turn (rad) and shift (over half the length) of a node in the step.
    #[inline(always)]
    pub fn step_size(&self) -> R {
        let mut squared = R::zero();
        for step in &self.steps {
            squared = larger(squared, step.angular.dot(step.angular));
            squared = larger(squared, step.linear.dot(step.linear) * R::splat(4.0));
        }
        squared.sqrt()
    }

    /// Makes the step the answer of the rod, as it was when the system was last solved, to a step of its end.
    #[inline(always)]
    fn answer_to_end(&mut self, end: Vec6<Vec3<R>>) {
        let last = self.links.len();
        self.steps[last] = end;
        for i in (0..last).rev() {
            let next = times(&self.follows[i], &parts(self.steps[i + 1]));
            self.steps[i] = seen_from_near(&self.resists[i].arm, pair(next));
        }
        for link in &mut self.links {
            link.pull = Wrench::zero();
        }
    }

    /// The wrench that acts on a node, about it; at a held node the opposite of the reaction.
    #[inline(always)]
    fn imbalance(&self, node: usize) -> Wrench<Vec3<R>> {
        imbalance(&self.loads, &self.links, node)
    }

    /// What acts on a node when the elements have taken up their slack: the right-hand side of the system.
    #[inline(always)]
    pub fn acting(&self, node: usize) -> Wrench<Vec3<R>> {
        acting(&self.loads, &self.links, node)
    }
}

#[inline(always)]
fn acting<R: Real>(loads: &[Wrench<Vec3<R>>], links: &[Link<R>], node: usize) -> Wrench<Vec3<R>> {
    with_elements(imbalance(loads, links, node), links, node, |link| link.pull)
}

#[inline(always)]
fn imbalance<R: Real>(loads: &[Wrench<Vec3<R>>], links: &[Link<R>], node: usize) -> Wrench<Vec3<R>> {
    with_elements(loads[node], links, node, |link| link.carried)
}

/// What the element after a node exerts on it beside a wrench, and the one before.
#[inline(always)]
fn with_elements<R: Real>(
    mut wrench: Wrench<Vec3<R>>,
    links: &[Link<R>],
    node: usize,
    what: impl Fn(&Link<R>) -> Wrench<Vec3<R>>,
) -> Wrench<Vec3<R>> {
    if let Some(after) = links.get(node) {
        wrench += what(after).wrench_from(after.arm);
    }
    if node > 0 {
        wrench -= what(&links[node - 1]);
    }
    wrench
}

/// By how much the nodes of a rod, or of several side by side, are out of balance, at most, over the largest wrench carried where that is above one.
struct Imbalance<'a, R> {
    system: &'a Nodal<R>,
}

impl<R: Real> Kernel for Imbalance<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { system } = self;
        let (mut carried, mut imbalance) = (R::one(), R::zero());
        for link in &system.links {
            carried = larger(carried, largest(&parts(link.carried)));
        }
        let mut holds = system.holds.iter().peekable();
        for node in 0..system.loads.len() {
            let hold = holds.next_if(|hold| hold.node == node);
            let out = out_of_balance(system.imbalance(node), hold);
            imbalance = larger(imbalance, largest(&parts(out)));
        }
        imbalance / carried
    }
}

impl<R: Real> Hold<R> {
    /// The work of a wrench on each free displacement.
    #[inline(always)]
    fn along_free(&self, wrench: Wrench<Vec3<R>>) -> Wrench<Vec3<R>> {
        let (w, mut work) = (parts(wrench), [R::zero(); 6]);
        for (w, row) in w.iter().zip(&self.free) {
            for c in 0..6 {
                work[c] += row[c] * *w;
            }
        }
        pair(work)
    }
}

/// By what acts on a node, without what its hold takes.
#[inline(always)]
fn out_of_balance<R: Real>(acts: Wrench<Vec3<R>>, hold: Option<&Hold<R>>) -> Wrench<Vec3<R>> {
    hold.map_or(acts, |hold| hold.along_free(acts))
}

/// How the moment about a place of a dead force there changes with the frame.
fn dead_moment_slope(force: Vec3) -> Mat6 {
    Mat6 { blocks: [[Mat3::ZERO, Mat3::hat(force).scaled(-1.0)], [Mat3::ZERO; 2]] }
}

/// How a wrench at a frame changes with that, beside what it does as a dead one, where its moment changes by so much with the turn, and its force with the
/// shift.
#[inline]
fn force_slope(by_turn: Mat3, by_shift: Mat3) -> Mat6 {
    Mat6 { blocks: [[by_turn, Mat3::ZERO], [Mat3::ZERO, by_shift]] }
}

/// What a grip exerts on a frame, about it, and how that changes with the frame.
fn grip_acts(grip: &Grip, pose: &Pose, axes: &Axes) -> (Wrench, Mat6) {
    let (by_turn, by_shift) = grip.stiffness(pose);
    let by_turn = by_turn.scaled(1.0 / axes.moment) * pose.rotation.transpose();
    let slope = force_slope(by_turn, by_shift.scaled(axes.length / axes.force));
    (axes.wrench(grip.wrench(pose)), slope)
}
