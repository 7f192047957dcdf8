//! A rod cut into segments at joints, for multiple shooting: what is unknown at each joint, what must vanish, and its derivative.
//!
//! Joints are the nodes that are held between the ends, as many others as keep what is wrong at one from growing too much on the way to the
//! next, and the end. A joint's unknowns are those of an end (see [`boundary`](super::boundary)) and the wrench of the rod beyond it, six each; at
//! the end there is no rod beyond. A segment is marched from its far joint to its near one, where the frame and wrench that it arrives with
//! must be the joint's. At the start what is fixed must be met.

use super::almost_block_diagonal::{AlmostBlockDiagonal, END, JOINT, Twelve};
use super::boundary::{EndState, Node, residual, residual_slope, unknown_scale};
use super::march::{Record, Section, march_along};
use super::problem::Problem;
use super::solution::Scheme;
use super::variation::{Columns, Variation, vary_along};
use crate::math::{Mat3, SimdLevel, Vec3, Vec6, Wrench, larger, largest, tangent_inverse};
use crate::rod::Scale;

/// By which power of e a disturbance may grow along a segment. So does what a Newton step leaves, for its second order: with more, segments would be
/// fewer and iterations more.
const GROWTH: f64 = 2.0;
/// Beyond this the rod is cut anew.
const MOST_GROWTH: f64 = 4.0;

/// A joint's unknowns.
#[derive(Clone, Copy, Debug)]
struct Joint {
    node: usize,
    state: EndState,
    /// The wrench with which the segment beyond arrives, before what acts on the joint.
    beyond: Wrench,
}

/// A state of the unknowns, and what it leads to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chain {
    joints: Vec<Joint>,
    /// With what each segment arrives at its near joint.
    arrivals: Vec<Section>,
    /// What is wrong at the start, in the [units](units).
    start: [f64; END],
    /// What is wrong at each joint but the end, in the same units; and room for the end's.
    gaps: Vec<Twelve>,
    /// The same in one number, as [`Settings::tolerance`](super::Settings) has it, wrenches over the largest where that is larger.
    pub residual: f64,
}

/// The lengths, moments and forces in which the unknowns are of order one: those of the length over which the rod bends.
pub(crate) fn units(problem: &Problem, record: &Record) -> Scale {
    let scale = problem.rod.scale();
    let shorter = (1.0 + record.largest_force() / scale.force).sqrt();
    Scale {
        length: scale.length / shorter,
        moment: scale.moment * shorter,
        force: scale.force * shorter * shorter,
    }
}

impl Chain {
    /// Cuts a rod whose state is on record, no segment longer than a part of the rod.
    pub fn cut(&mut self, problem: &Problem, record: &Record, longest: f64) {
        let rod = &problem.rod;
        let (n, nodes) = (rod.elements(), rod.mesh().nodes());
        self.joints.clear();
        let mut held = problem.between.iter().map(|(node, _)| *node).chain([n]).peekable();
        let (mut growth, mut from) = (0.0, 0.0);
        for node in 1..=n {
            let (more, long) = (growth_along(problem, record, node - 1), nodes[node] - from);
            growth += more;
            let next = node < n && {
                let ahead = nodes[node + 1] - from;
                growth + more > GROWTH || ahead > longest * rod.length() * (1.0 + 1e-9)
            };
            if held.next_if_eq(&node).is_some() || next && long > 0.0 {
                let after = if node < n { record.carried_beyond(node) } else { Wrench::ZERO };
                let state = EndState::of(
                    &Node::of(problem, node),
                    &record.poses[node],
                    record.wrenches[node - 1] - after,
                );
                self.joints.push(Joint { node, state, beyond: after });
                (growth, from) = (0.0, nodes[node]);
            }
        }
    }

    /// Whether the tension has become so large that the segments have to be shorter.
    pub fn too_long(&self, problem: &Problem, record: &Record) -> bool {
        let mut first = 0;
        self.joints.iter().any(|joint| {
            let elements = core::mem::replace(&mut first, joint.node)..joint.node;
            elements.len() > 1
                && elements.map(|e| growth_along(problem, record, e)).sum::<f64>() > MOST_GROWTH
        })
    }

    /// How many segments there are.
    pub fn segments(&self) -> usize {
        self.joints.len()
    }

    /// Marches all segments, on record, and says what is wrong.
    pub fn evaluate(&mut self, problem: &Problem, level: SimdLevel, units: &Scale, record: &mut Record) {
        let (rod, scale) = (&problem.rod, problem.rod.scale());
        let placeholder = Section { pose: self.joints[0].state.pose, wrench: Wrench::ZERO };
        self.arrivals.resize(self.joints.len(), placeholder);
        for (i, joint) in self.joints.iter().enumerate().rev() {
            let wrench = joint.state.wrench(&Node::of(problem, joint.node)) + joint.beyond;
            let far = Section { pose: joint.state.pose, wrench };
            let elements = self.near(i)..joint.node;
            let loads = &problem.loads;
            self.arrivals[i] = march_along(level, rod, Scheme::Element, loads, elements, far, record);
        }
        let forces = self
            .joints
            .iter()
            .map(|joint| joint.beyond.linear.norm())
            .chain([self.arrivals[0].wrench.linear.norm()]);
        let carried = forces.fold(1.0, |max: f64, force| max.max(force / scale.force));
        self.residual = 0.0;
        let (rows, fixed) = (residual(problem, &self.arrivals[0]), problem.start.fixed);
        for k in 0..END {
            let size = rows[k].abs() / if fixed[k] { 1.0 } else { carried };
            self.residual = larger(self.residual, size);
            self.start[k] = rows[k] * start_weight(fixed[k], k, &scale, units);
        }
        self.gaps.resize(self.joints.len(), [0.0; JOINT]);
        for (i, (joint, arrival)) in self.joints.iter().zip(&self.arrivals[1..]).enumerate() {
            let frame = &joint.state.pose;
            let turn = frame.rotation.turn_to(&arrival.pose.rotation);
            let shift = frame.rotation.transpose_mul(arrival.pose.position - frame.position);
            let wrench = arrival.wrench - joint.beyond;
            let sizes = [
                turn.max_abs(),
                shift.max_abs() / scale.length,
                wrench.angular.max_abs() / (scale.moment * carried),
                wrench.linear.max_abs() / (scale.force * carried),
                0.0,
                // The largest of the above passes over what is not a number.
                (turn + shift + wrench.angular + wrench.linear).dot(Vec3::ZERO),
            ];
            self.residual = larger(self.residual, largest(&sizes));
            self.gaps[i] = rows_of(Vec6::new(turn, shift), wrench, units);
        }
    }

    /// The derivative of what is wrong, factored. `None` where it is singular.
    pub fn linearise(
        &self,
        problem: &Problem,
        level: SimdLevel,
        units: &Scale,
        record: &Record,
        system: &mut AlmostBlockDiagonal,
    ) -> Option<()> {
        let (rod, scale, fixed) = (&problem.rod, problem.rod.scale(), problem.start.fixed);
        let last = self.joints.len() - 1;
        for (i, joint) in self.joints.iter().enumerate() {
            let node = Node::of(problem, joint.node);
            let sizes = unknown_scale(node.support, units);
            let own = joint.state.columns_at(&node);
            let own: Columns = core::array::from_fn(|k| times(own[k], sizes[k]));
            let elements = self.near(i)..joint.node;
            let near = &self.arrivals[i].pose;
            let (own_out, beyond_out) = if i == last {
                let [own] = vary_along(level, rod, &problem.loads, record, elements, near, &[own])?;
                (own, None)
            } else {
                let sets = [own, beyond_columns(units)];
                let [own, beyond] = vary_along(level, rod, &problem.loads, record, elements, near, &sets)?;
                (own, Some(beyond))
            };
            if i == 0 {
                let mut rows = [[0.0; JOINT]; END];
                for (set, columns) in [Some(own_out), beyond_out].iter().flatten().enumerate() {
                    let slope = residual_slope(problem, &self.arrivals[0], columns);
                    for r in 0..END {
                        let weight = start_weight(fixed[r], r, &scale, units);
                        (0..END).for_each(|k| rows[r][END * set + k] = slope[r][k] * weight);
                    }
                }
                system.begin(&rows);
            } else {
                let (before, slopes) = (&self.joints[i - 1], self.slopes(i - 1));
                let mut next = [[0.0; JOINT]; JOINT];
                for (set, columns) in [Some(own_out), beyond_out].iter().flatten().enumerate() {
                    for (k, column) in columns.iter().enumerate() {
                        put(&mut next, END * set + k, &slopes.by_arrival(column), units);
                    }
                }
                let mut here = [[0.0; JOINT]; JOINT];
                let node = Node::of(problem, before.node);
                let sizes = unknown_scale(node.support, units);
                for (k, column) in before.state.columns_at(&node).iter().enumerate() {
                    let column = times(Variation { wrench: Wrench::ZERO, ..*column }, sizes[k]);
                    put(&mut here, k, &slopes.by_joint(&column), units);
                }
                (END..JOINT).for_each(|k| here[k][k] = -1.0);
                system.push(level, &here, &next)?;
            }
        }
        system.end()
    }

    /// Solves for the step that a linearisation says: a joint each, in the units.
    pub fn step(&self, system: &AlmostBlockDiagonal, step: &mut Vec<Twelve>) {
        step.clone_from(&self.gaps);
        step.iter_mut().flatten().for_each(|x| *x = -*x);
        system.solve(&self.start.map(|x| -x), step);
    }

    /// The state after a part of a step.
    pub fn stepped(&mut self, from: &Self, problem: &Problem, units: &Scale, step: &[Twelve], part: f64) {
        self.joints.clone_from(&from.joints);
        for (joint, step) in self.joints.iter_mut().zip(step) {
            let support = Node::of(problem, joint.node).support;
            let sizes = unknown_scale(support, units);
            let own = core::array::from_fn(|k| part * step[k] * sizes[k]);
            joint.state = joint.state.stepped_at(support, &own);
            joint.beyond += Wrench::new(
                Vec3::new(step[6], step[7], step[8]) * (part * units.moment),
                Vec3::new(step[9], step[10], step[11]) * (part * units.force),
            );
        }
    }

    /// The size of a step, and the largest turn in it, rad.
    pub fn size(&self, problem: &Problem, units: &Scale, step: &[Twelve]) -> (f64, f64) {
        let shorter = units.length / problem.rod.scale().length;
        let (mut sum, mut turn) = (0.0, 0.0);
        for (joint, step) in self.joints.iter().zip(step) {
            let fixed = Node::of(problem, joint.node).support.fixed;
            for (k, x) in step.iter().enumerate() {
                let shift = (3..6).contains(&k) && !fixed[k];
                let x = if shift { x * shorter } else { *x };
                sum += x * x;
                if k < 3 && !fixed[k] {
                    turn = larger(turn, x.abs());
                }
            }
        }
        (f64::sqrt(sum / self.joints.len() as f64), turn)
    }

    /// All that is wrong, in the units.
    #[cfg(test)]
    pub fn wrong(&self) -> Vec<f64> {
        let gaps = self.gaps[..self.joints.len() - 1].iter().flatten();
        self.start.iter().chain(gaps).copied().collect()
    }

    /// The near node of a segment.
    fn near(&self, segment: usize) -> usize {
        if segment == 0 { 0 } else { self.joints[segment - 1].node }
    }

    fn slopes(&self, joint: usize) -> GapSlopes {
        let (frame, arrival) = (&self.joints[joint].state.pose, &self.arrivals[joint + 1].pose);
        let turn = frame.rotation.turn_to(&arrival.rotation);
        GapSlopes {
            by_turn: tangent_inverse(Vec6::new(turn, Vec3::ZERO)).blocks[0][0],
            relative: frame.rotation.transpose() * arrival.rotation,
            shift: frame.rotation.transpose_mul(arrival.position - frame.position),
        }
    }
}

/// By which power of e a disturbance grows along an element under the tension on record: its length over `√(EI/T)`.
fn growth_along(problem: &Problem, record: &Record, e: usize) -> f64 {
    let rod = &problem.rod;
    let bending = rod.scale().moment * rod.length();
    rod.element_length(e) * (record.wrenches[e].linear.norm() / bending).sqrt()
}

/// What turns an equation of the start, dimensionless by the rod's scale, into the units.
fn start_weight(fixed: bool, k: usize, scale: &Scale, units: &Scale) -> f64 {
    match (fixed, k < 3) {
        (true, true) => 1.0,
        (true, false) => scale.length / units.length,
        (false, true) => scale.moment / units.moment,
        (false, false) => scale.force / units.force,
    }
}

/// How the gap between a joint's frame and that of what arrives there changes with either.
struct GapSlopes {
    by_turn: Mat3,
    relative: Mat3,
    shift: Vec3,
}

impl GapSlopes {
    fn by_arrival(&self, column: &Variation) -> Variation {
        let Vec6 { angular, linear } = column.frame;
        Variation { frame: Vec6::new(self.by_turn * angular, self.relative * linear), wrench: column.wrench }
    }

    fn by_joint(&self, column: &Variation) -> Variation {
        let Vec6 { angular, linear } = column.frame;
        // A turn of the near frame comes from the left, whose tangent is the transpose.
        let frame = Vec6::new(-self.by_turn.transpose_mul(angular), -linear - angular.cross(self.shift));
        Variation { frame, wrench: -column.wrench }
    }
}

fn times(column: Variation, size: f64) -> Variation {
    Variation { frame: column.frame * size, wrench: column.wrench * size }
}

/// The wrench beyond a joint adds to what the segment before it carries.
fn beyond_columns(units: &Scale) -> Columns {
    core::array::from_fn(|k| {
        let size = if k < 3 { units.moment } else { units.force };
        let wrench: [f64; 6] = core::array::from_fn(|i| if i == k { size } else { 0.0 });
        Variation { frame: Vec6::ZERO, wrench: wrench.into() }
    })
}

fn rows_of(frame: Vec6, wrench: Wrench, units: &Scale) -> Twelve {
    let (shift, moment, force) = (
        frame.linear * (1.0 / units.length),
        wrench.angular * (1.0 / units.moment),
        wrench.linear * (1.0 / units.force),
    );
    let (frame, wrench) = (Vec6::new(frame.angular, shift).to_array(), Vec6::new(moment, force).to_array());
    core::array::from_fn(|k| if k < 6 { frame[k] } else { wrench[k - 6] })
}

fn put(rows: &mut [Twelve; JOINT], k: usize, column: &Variation, units: &Scale) {
    let column = rows_of(column.frame, column.wrench, units);
    (0..JOINT).for_each(|r| rows[r][k] = column[r]);
}
