//! Newton's method for one stage of a step.

use super::consistent::Couplings;
use super::contacts::Contacts;
use super::stage::{Resistance, Stage};
use super::{Simulation, State, StepFailure, Taken};
use crate::assembly::{Assembly, MassMatrix, Member, Strand, Ties};
use crate::math::{Pose, SimdLevel, Vec3, Wrench, larger};
use crate::rod::{Kinematics, NodeInertia};
use crate::statics::{Motion, Network, Nodal, Problem, Record, Slopes, Support, meet, rigid_compliance};
use core::ops::Range;

/// Round-off of a frame, with room, over that of a number.
const ROUND_OFF: f64 = 4.0;

/// A stage of bounded cost that leaves more than this over is of no use, nor is any of which round-off leaves more.
const USABLE: f64 = 0.1;

/// A stage of [`Simulation::shortest_stage`] leaves so much over for round-off.
const SURE: f64 = 1e-3;

/// After a step of no more than this, rad and over half the length, slopes are kept.
const NEAR: f64 = 1e-2;
/// Slopes serve as long as each step leaves no more than this part of the residual.
const SERVES: f64 = 1e-2;

/// What a guess may leave over, beside what a solution may: else what is nearly at rest would stay where it is.
const OF_GUESS: f64 = 1e-2;

/// So often at most a step is shortened until no surface passes through another.
const SHORTENED: usize = 20;
/// It is about known what presses where no more than this is left over.
const PRESSES: f64 = 1e-2;
/// Friction is told anew where no more than this is left over of all else.
const ANCHORED: f64 = 1e-3;
/// What friction bears is about known where it is off by no more than so much of all that presses.
const MISLED: f64 = 1e-3;
/// What can be cut is given up where so many iterations have left more than there was at first, or when friction was told anew.
const SOON: usize = 8;
/// So much of what surfaces allow is taken.
const WITHIN: f64 = 0.9;

/// In a stage so long, s, nothing accelerates.
const LONG: f64 = 1e9;

/// Rods and bodies that move independently of all others.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub rods: Vec<RodSystem>,
    pub bodies: Vec<usize>,
    /// The system of them all, where joints tie them.
    pub network: Option<Network>,
}

/// A rod's system.
#[derive(Clone, Debug)]
pub(super) struct RodSystem {
    pub rod: usize,
    /// Its first frame and its first element.
    first: usize,
    first_element: usize,
    /// The residual that round-off leaves where it is guessed, times the square of how much a rate counts, s².
    round_off: f64,
    pub nodal: Nodal,
    pub record: Record,
    pub couplings: Couplings,
}

/// All that a group's residual depends on beside its frames.
struct Given<'a> {
    assembly: &'a Assembly,
    ties: &'a Ties,
    inertia: &'a [NodeInertia],
    lengths: &'a [f64],
    lost: f64,
    tolerance: f64,
    level: SimdLevel,
}

impl RodSystem {
    pub fn new(assembly: &Assembly, rod: usize) -> Self {
        let (first, first_element) = (assembly.nodes(rod).start, assembly.elements(rod).start);
        let mut record = Record::default();
        let strand = &assembly.strands[rod];
        record.fit(strand.problem.rod.elements());
        let couplings = match strand.mass_matrix {
            MassMatrix::Lumped => Couplings::default(),
            MassMatrix::Consistent => Couplings::new(&strand.problem.rod),
        };
        Self { rod, first, first_element, round_off: 0.0, nodal: Nodal::default(), record, couplings }
    }

    /// The frames of its nodes.
    pub fn nodes(&self) -> Range<usize> {
        self.first..self.first + self.record.poses.len()
    }

    /// Its elements, where those of all rods are numbered one after the other.
    pub fn elements(&self) -> Range<usize> {
        self.first_element..self.first_element + self.record.wrenches.len()
    }

    fn take_motion(&mut self, given: &Given, stage: &mut Stage, slopes: Slopes) {
        let strand = &given.assembly.strands[self.rod];
        let (nodes, elements) = (self.nodes(), self.elements());
        let moves = strand.drag != Default::default();
        let resistance = Resistance {
            lost: given.lost,
            air: moves.then(|| (strand.drag, &given.lengths[nodes.clone()], given.assembly.wind)),
        };
        let (viscosity, poses) = (strand.viscosity, &self.record.poses);
        let elastic = strand.problem.rod.diagonal_points().unwrap_or_default();
        if stage.middle {
            stage.take_inertia_at_middle(nodes, given.inertia, poses, &resistance);
            self.couplings.take(stage, [self.first, self.first_element], poses, given.lost, slopes);
            stage.take_secants(elements, self.first, elastic, viscosity, poses);
            return;
        }
        stage.take_inertia(nodes, given.inertia, poses, &resistance, (given.level, slopes));
        self.couplings.take(stage, [self.first, self.first_element], poses, given.lost, slopes);
        if viscosity > 0.0 {
            stage.take_viscosity(elements, elastic, viscosity);
        }
    }

    fn motion<'a>(&self, assembly: &'a Assembly, stage: &'a Stage) -> Motion<'a> {
        let strand = &assembly.strands[self.rod];
        let elastic = strand.problem.rod.diagonal_points().unwrap_or_default();
        let taken = &stage.points[self.elements()];
        let points = if stage.middle || strand.viscosity > 0.0 { taken } else { elastic };
        let coupled = if self.couplings.is_empty() { &[][..] } else { &stage.coupled[self.elements()] };
        Motion { points, inertial: &stage.inertial[self.nodes()], coupled }
    }
}

/// What is lent to the compliance against shifts, over `L³/EI`, on the way to a solution: a rod that cannot stretch has none. So that it does not matter, the more
/// hangs from the rod, so heavy (N) and of such a mass (kg), the less that is.
fn lent(problem: &Problem, of_rate: f64, (weight, mass): (f64, f64)) -> f64 {
    let (rod, scale) = (&problem.rod, problem.rod.scale());
    if rod.kinematics() == Kinematics::Cosserat {
        return 0.0;
    }
    let inertia = (rod.mass() + mass) * scale.length / (of_rate * of_rate);
    rigid_compliance(loaded(problem) + (weight + inertia) / scale.force)
}

/// The residual that round-off of the frames leaves, times the square of how much a rate counts: places and turns are known to so much, and rates of rates
/// are that over the time squared.
fn round_off(problem: &Problem, poses: &[Pose]) -> f64 {
    let scale = problem.rod.scale();
    let far = poses.iter().fold(0.0, |far: f64, pose| far.max(pose.position.max_abs()));
    let of =
        |node: &NodeInertia| (node.mass * far / scale.force).max(node.rotational.max_abs() / scale.moment);
    let most = problem.rod.node_inertia().iter().map(of).fold(0.0, f64::max);
    ROUND_OFF * f64::EPSILON * most
}

/// What loads a rod, over `EI/L²`, and no less than one.
fn loaded(problem: &Problem) -> f64 {
    1.0 + problem.load_size()
}

/// What a rod carries, over `EI/L²` and `EI/L`, and no less than one.
fn carried(problem: &Problem, wrenches: &[Wrench]) -> f64 {
    let scale = problem.rod.scale();
    let size = |w: &Wrench| (w.linear.max_abs() / scale.force).max(w.angular.max_abs() / scale.moment);
    wrenches.iter().map(size).fold(1.0, f64::max)
}

impl Group {
    /// Takes the frames that all are guessed to have, and what the elements carry.
    fn guess(&mut self, assembly: &Assembly, ties: &Ties, poses: &mut [Pose], state: &State) {
        self.hold(assembly, poses);
        for system in &mut self.rods {
            let (nodes, elements) = (system.nodes(), system.elements());
            system.round_off = round_off(&assembly.strands[system.rod].problem, &state.poses[nodes]);
            system.record.wrenches.copy_from_slice(&state.wrenches[elements]);
        }
        self.meet(assembly, ties, poses);
        self.take_frames(poses);
    }

    /// The same of its rods over what each carries, or what `least` says of its problem where that is more.
    fn round_off(&self, assembly: &Assembly, least: fn(&Problem) -> f64) -> f64 {
        let of = |system: &RodSystem| {
            let problem = &assembly.strands[system.rod].problem;
            system.round_off / carried(problem, &system.record.wrenches).max(least(problem))
        };
        self.rods.iter().map(of).fold(0.0, f64::max)
    }

    /// Gives the rods their nodes' frames.
    fn take_frames(&mut self, poses: &[Pose]) {
        for system in &mut self.rods {
            let nodes = system.nodes();
            system.record.poses.copy_from_slice(&poses[nodes]);
        }
    }

    /// Takes the frames of the rods' nodes from them.
    fn give_frames(&self, poses: &mut [Pose]) {
        for system in &self.rods {
            poses[system.nodes()].copy_from_slice(&system.record.poses);
        }
    }

    /// Puts bodies where they are held, and together what is tied.
    fn meet(&self, assembly: &Assembly, ties: &Ties, poses: &mut [Pose]) {
        for body in &self.bodies {
            let pose = &mut poses[assembly.first_body() + body];
            if let Some(support) = &assembly.bodies[*body].support {
                *pose = meet(support, pose);
            }
        }
        if let Some(network) = &self.network {
            for tie in network.ties() {
                let tie = &ties.list[tie];
                poses[tie.child] = tie.met(&poses[tie.parent], &poses[tie.child]);
            }
        }
    }

    /// Linearises the group about its frames, or where the slopes are kept looks at how far these are from what must hold; gives the residual.
    fn linearise(
        &mut self,
        given: &Given,
        stage: &mut Stage,
        contacts: &mut Contacts,
        poses: &mut [Pose],
        slopes: Slopes,
    ) -> f64 {
        let Given { assembly, level, .. } = *given;
        for system in &mut self.rods {
            system.take_motion(given, stage, slopes);
        }
        if self.network.is_none() {
            let [system] = &mut self.rods[..] else { return f64::NAN };
            let problem = &assembly.strands[system.rod].problem;
            let motion = system.motion(assembly, stage);
            let lends = (lent(problem, stage.of_rate, (0.0, 0.0)), slopes);
            return system.nodal.linearise_moving(problem, level, lends, &motion, &system.record).residual();
        }
        let resistance = Resistance { lost: given.lost, air: None };
        for &body in &self.bodies {
            let frame = assembly.first_body() + body;
            let of = &poses[frame..frame + 1];
            stage.take_inertia(frame..frame + 1, given.inertia, of, &resistance, (level, slopes));
        }
        self.give_frames(poses);
        let off = contacts.look(assembly, stage, poses);
        let Some(network) = &mut self.network else { return f64::NAN };
        let new = contacts.new_ties(assembly, network).map(Iterator::collect::<Vec<_>>);
        if let Some(touching) = new {
            network.tie(&touching);
        }
        let origin = poses[network.frames()[0]].position;
        let axes = network.axes(assembly, origin);
        let bodies = self.bodies.iter().map(|body| &assembly.bodies[*body]);
        let hangs = bodies.fold((0.0, 0.0), |(weight, mass), body| {
            (weight + body.load.linear.norm(), mass + body.inertia.mass)
        });
        let mut slack = off / axes.length();
        for system in &mut self.rods {
            let problem = &assembly.strands[system.rod].problem;
            let motion = system.motion(assembly, stage);
            let lends = (lent(problem, stage.of_rate, hangs), slopes);
            let RodSystem { nodal, record, .. } = system;
            slack = larger(slack, nodal.linearise_in(axes, problem, level, lends, &motion, record).slack);
        }
        for &body in &self.bodies {
            let frame = assembly.first_body() + body;
            let pose = poses[frame];
            let NodeInertia { mass, .. } = given.inertia[frame];
            let moved = f64::EPSILON * pose.position.max_abs() / (stage.of_rate * stage.of_rate);
            let unsure = ROUND_OFF * mass * moved / given.tolerance;
            network.add_body(&assembly.bodies[body], &pose, &stage.inertial[frame], unsure);
        }
        larger(
            slack,
            network.gather(
                assembly,
                given.ties,
                self.rods.iter().map(|system| &system.nodal),
                poses,
                contacts.touches(assembly, poses),
                level,
            ),
        )
    }

    /// Whether slopes can be kept: of a rod alone, whose laws do not change with every iteration as the midpoint rule's.
    fn keeps_slopes(&self, stage: &Stage) -> bool {
        self.network.is_none() && !stage.middle
    }

    /// Solves for a step, with slopes that were kept as it was solved with them last. Whether no pivot vanishes.
    fn solve(&mut self, level: SimdLevel, slopes: Slopes) -> bool {
        if let Some(network) = &mut self.network {
            return network.solve(level, self.rods.iter_mut().map(|system| &mut system.nodal)).is_some();
        }
        let RodSystem { nodal, record, .. } = &mut self.rods[0];
        if slopes == Slopes::Kept {
            nodal.solve_again(level, record);
            return true;
        }
        nodal.solve(level, 0.0).is_some()
    }

    /// Takes the step, but so little of it that no frame turns by more than a radian at once, and no surface passes through another. Gives the step's size, the largest
    /// turn (rad) and shift (over half the length).
    fn step(
        &mut self,
        assembly: &Assembly,
        ties: &Ties,
        level: SimdLevel,
        contacts: &mut Contacts,
        poses: &mut [Pose],
    ) -> f64 {
        let rods = self.rods.iter().map(|system| system.nodal.step_size()).fold(0.0, larger);
        let size = self.network.as_ref().map_or(rods, |network| larger(rods, network.step_size()));
        let mut part = (1.0 / size).min(1.0);
        if assembly.surfaces.is_none() {
            self.take(assembly, ties, level, part, poses);
            return size;
        }
        if let Some(network) = &self.network {
            part = part.min(contacts.step(network));
        }
        let before: Vec<Pose> = poses.to_vec();
        let records: Vec<Record> = self.rods.iter().map(|system| system.record.clone()).collect();
        for _ in 0..SHORTENED {
            self.take(assembly, ties, level, part, poses);
            let free = contacts.free_part(&before, poses).min(contacts.known_part(&before, poses));
            if free == 1.0 {
                break;
            }
            part *= WITHIN * free;
            poses.copy_from_slice(&before);
            for (system, record) in self.rods.iter_mut().zip(&records) {
                system.record.clone_from(record);
            }
        }
        contacts.take(part);
        size
    }

    /// Takes a part of the step.
    fn take(&mut self, assembly: &Assembly, ties: &Ties, level: SimdLevel, part: f64, poses: &mut [Pose]) {
        for RodSystem { rod, nodal, record, .. } in &mut self.rods {
            nodal.take(&assembly.strands[*rod].problem, level, part, record);
        }
        let Some(network) = &self.network else { return };
        self.give_frames(poses);
        for (at, body) in self.bodies.iter().enumerate() {
            let pose = &mut poses[assembly.first_body() + body];
            *pose = network.taken(at, part, pose);
        }
        self.meet(assembly, ties, poses);
        self.take_frames(poses);
    }

    /// Puts frames as far on the way to where they are guessed as surfaces allow, and lets those touch that may. Whether what is held may be where it is.
    fn touch(
        &mut self,
        assembly: &Assembly,
        ties: &Ties,
        of_rate: f64,
        contacts: &mut Contacts,
        poses: &mut [Pose],
        state: &State,
    ) -> bool {
        let Some(surfaces) = &assembly.surfaces else { return true };
        let (friction, known) = (surfaces.friction, (&state.contacts[..], &state.passages[..]));
        contacts.begin(assembly, friction, (&state.poses, poses), of_rate, known);
        let free = contacts.free_part(&state.poses, poses);
        if free < 1.0 {
            let part = WITHIN * free;
            for (pose, before) in poses.iter_mut().zip(&state.poses) {
                *pose = before.towards(pose, part);
            }
            self.take_frames(poses);
            self.hold(assembly, poses);
            self.meet(assembly, ties, poses);
            self.take_frames(poses);
            // What is held goes another way then.
            contacts.begin(assembly, friction, (&state.poses, poses), of_rate, known);
        }
        contacts.free_part(&state.poses, poses) == 1.0
    }

    /// Puts nodes where they are held.
    fn hold(&self, assembly: &Assembly, poses: &mut [Pose]) {
        for system in &self.rods {
            for (node, support) in assembly.strands[system.rod].problem.supports() {
                let pose = &mut poses[system.first + node];
                *pose = meet(support, pose);
            }
        }
    }

    /// What is left over of a frame of the group and what hangs from it: force, and moment about a place.
    pub fn left_over(&self, frame: usize, place: Vec3) -> Option<Wrench> {
        if let Some(network) = &self.network {
            let at = network.frames().iter().position(|of| *of == frame)?;
            return Some(network.left_over(at, place));
        }
        let system = &self.rods[0];
        let nodes = system.nodes();
        nodes.contains(&frame).then(|| {
            let node = frame - nodes.start;
            system.nodal.left_over(node).wrench_from(system.record.poses[node].position - place)
        })
    }

    /// What is left over of frames that nothing holds goes into their momenta: then none is lost or made.
    fn keep_left_over(&self, assembly: &Assembly, stage: &mut Stage, poses: &[Pose]) {
        let times = if stage.middle { 2.0 * stage.of_rate } else { stage.of_rate };
        let mut keep = |frame: usize, left: Wrench| stage.momenta[frame] += left * times;
        let held = |member| assembly.support(member).is_some_and(Support::holds_anything);
        match &self.network {
            Some(network) => {
                for (at, _) in network.roots().filter(|(_, member)| !held(*member)) {
                    let frame = network.frames()[at];
                    keep(frame, network.left_over(at, poses[frame].position));
                }
            }
            None => {
                let system = &self.rods[0];
                let nodes = 0..system.record.poses.len();
                for node in nodes.filter(|node| !held(Member::Node { rod: system.rod, node: *node })) {
                    keep(system.first + node, system.nodal.left_over(node));
                }
            }
        }
    }
}

impl Simulation {
    /// Solves the stage that has been set up, from the frames in `work.poses` on.
    pub(super) fn solve_stage(&mut self) -> Result<Taken, StepFailure> {
        let mut taken = Taken::default();
        for group in 0..self.work.groups.len() {
            taken.add(self.solve_group(group)?);
        }
        Ok(taken)
    }

    /// Takes what acts where all is, as if it did not move: so what holds it is known before the first step.
    pub(super) fn weigh(&mut self) {
        let Self { assembly, settings, state, work, .. } = self;
        work.stage.begin(state, &[]);
        work.stage.set_up(LONG, state);
        work.poses.clone_from(&state.poses);
        for group in &mut work.groups {
            group.guess(assembly, &work.ties, &mut work.poses, state);
            let given = Given {
                assembly,
                ties: &work.ties,
                inertia: &work.inertia,
                lengths: &work.lengths,
                lost: 0.0,
                tolerance: settings.tolerance,
                level: work.level,
            };
            let contacts = &mut work.contacts;
            group.touch(assembly, &work.ties, LONG, contacts, &mut work.poses, state);
            group.linearise(&given, &mut work.stage, contacts, &mut work.poses, Slopes::Anew);
        }
    }

    /// In the shortest stage of which round-off leaves little over, how much a rate counts, s.
    pub(super) fn shortest_stage(&self) -> f64 {
        let of = |(rod, strand): (usize, &Strand)| {
            round_off(&strand.problem, &self.state.poses[self.assembly.nodes(rod)]) / loaded(&strand.problem)
        };
        (self.assembly.strands.iter().enumerate().map(of).fold(0.0, f64::max) / SURE).sqrt()
    }

    fn solve_group(&mut self, group: usize) -> Result<Taken, StepFailure> {
        if self.assembly.surfaces.is_none() {
            return self.solve_group_once(group);
        }
        self.work.guessed.clone_from(&self.work.poses);
        let solved = match self.solve_group_once(group) {
            Err(StepFailure::NotConverged { .. } | StepFailure::Singular { .. })
                if self.work.contacts.strike() =>
            {
                self.work.poses.clone_from(&self.work.guessed);
                self.work.contacts.be_careful(true);
                self.solve_group_once(group)
            }
            solved => solved,
        };
        self.work.contacts.be_careful(false);
        solved
    }

    fn solve_group_once(&mut self, group: usize) -> Result<Taken, StepFailure> {
        let Self { assembly, settings, state, work, .. } = self;
        let group = &mut work.groups[group];
        let (ties, stage, contacts, level) = (&work.ties, &mut work.stage, &mut work.contacts, work.level);
        group.guess(assembly, ties, &mut work.poses, state);
        let may = group.touch(assembly, ties, stage.of_rate, contacts, &mut work.poses, state);
        let per_square = 1.0 / (stage.of_rate * stage.of_rate);
        let tolerance = settings.tolerance;
        let mut given = Given {
            assembly,
            ties,
            inertia: &work.inertia,
            lengths: &work.lengths,
            lost: settings.mass_damping,
            tolerance: OF_GUESS * tolerance,
            level,
        };
        work.history.clear();
        let (time, step) = (state.time, work.step);
        let singular = |history: &[f64]| StepFailure::Singular { time, step, history: history.to_vec() };
        if !may {
            return Err(StepFailure::Blocked { time, step });
        }
        let mut iterations = 0;
        // What is left over of a step that keeps energy adds up over all steps: one iteration more takes it to round-off.
        let mut last = !stage.middle;
        // When friction was told anew last.
        let mut told = 0;
        let (mut slopes, mut before) = (Slopes::Anew, f64::INFINITY);
        let residual = loop {
            let mut residual = group.linearise(&given, stage, contacts, &mut work.poses, slopes);
            if iterations == 1 {
                contacts.count_new();
            }
            let floor = group.round_off(assembly, |_| 1.0) * per_square;
            // What has come to touch rubs when it is about known what presses.
            if residual <= PRESSES && contacts.wait() {
                contacts.rub();
                residual = group.linearise(&given, stage, contacts, &mut work.poses, slopes);
            }
            // What friction bears follows what presses again when it is about known.
            if contacts.is_careful() && residual <= ANCHORED && !contacts.wait() {
                if contacts.misled() <= MISLED {
                    contacts.follow_pressed();
                } else {
                    contacts.anchor();
                }
                told = iterations;
                residual = group.linearise(&given, stage, contacts, &mut work.poses, slopes);
            }
            // What sticks is let slip a little; where all else is solved, friction is told anew, so that it slips less.
            let slips = contacts.slips() / assembly.size();
            if !contacts.is_careful()
                && slips > tolerance
                && residual <= ANCHORED.max(given.tolerance).max(floor)
            {
                contacts.anchor();
                told = iterations;
                residual = group.linearise(&given, stage, contacts, &mut work.poses, slopes);
            }
            residual = larger(residual, slips);
            work.history.push(residual);
            if !residual.is_finite() {
                return Err(singular(&work.history));
            }
            let spent = iterations == settings.max_iterations;
            let solved = residual <= given.tolerance.max(floor) && !contacts.is_careful();
            if spent && (settings.bounded && residual <= USABLE || solved)
                || solved && last && !settings.bounded
            {
                break residual;
            }
            last |= solved;
            let strays = work.hasty && iterations >= told + SOON && residual > work.history[told];
            if spent || strays {
                return Err(StepFailure::NotConverged { time, step, history: work.history.clone() });
            }
            if slopes == Slopes::Kept && residual > tolerance.max(floor).max(SERVES * before) {
                slopes = Slopes::Anew;
                group.linearise(&given, stage, contacts, &mut work.poses, slopes);
            }
            if !group.solve(level, slopes) {
                // Where nothing keeps what is at rest from turning, a long step has no solution better than one that is good enough.
                if residual <= tolerance.max(floor) {
                    break residual;
                }
                return Err(singular(&work.history));
            }
            let size = group.step(assembly, ties, level, contacts, &mut work.poses);
            if assembly.surfaces.is_some() {
                contacts.follow(assembly, &state.poses, &work.poses);
            }
            let near = size <= NEAR && group.keeps_slopes(stage);
            slopes = if near { Slopes::Kept } else { Slopes::Anew };
            (before, given.tolerance) = (residual, tolerance);
            iterations += 1;
        };
        let left = group.round_off(assembly, loaded) * per_square;
        if left > USABLE {
            return Err(StepFailure::TooShort { time, step, left });
        }
        group.give_frames(&mut work.poses);
        for system in &group.rods {
            if assembly.strands[system.rod].viscosity > 0.0 && !stage.middle {
                stage.take_strain_rates(system.elements(), &system.record.poses);
            }
        }
        group.keep_left_over(assembly, stage, &work.poses);
        Ok(Taken { iterations, residual })
    }
}
