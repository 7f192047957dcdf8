//! The two ends of a shooting problem: what is unknown at the far end, and what must hold at the near one.
//!
//! At the end `s = L` each of the six freedoms has one unknown: where it is fixed, the reaction along it; where it is free,
//! the place along it. So the number of unknowns is always six, whatever is prescribed. At the start each freedom has one
//! residual in the same way: where it is fixed, the place must be right; where it is free, the wrench must vanish.
//!
//! Turns about the fixed frame's axes are the components of the rotation vector `φ = log(R*ᵀ R)`; the moment that works on `φᵢ`
//! is `J(φ)⁻ᵀ eᵢ`, with `J` the tangent on SO(3). With all turns free or all fixed both reduce to the material axes.

use super::march::Section;
use super::problem::{Problem, Support};
use super::solution::Guess;
use super::variation::{Columns, Variation, turned_by};
use crate::load::Pull;
use crate::math::{Mat3, Mat6, Pose, Quat, Vec3, Vec6, Wrench, so3_tangent, so3_tangent_inverse};
use crate::rod::Scale;

/// The end of a rod, or a node between, with its reaction: force in world axes, moment by the turns of the fixed frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndState {
    pub pose: Pose,
    reaction: Wrench,
}

/// A node: what holds it, and the loads on it.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    pub support: &'a Support,
    /// The dead wrench, world axes.
    world: Wrench,
    /// The follower wrench, body axes.
    body: Wrench,
    /// The pulls towards points.
    pulls: &'a [Pull],
}

/// How a node is held that nothing holds.
const FREE: &Support = &Support {
    fixed: [false; 6],
    pose: Pose::IDENTITY,
    turn_axes: Mat3::IDENTITY,
    shift_axes: Mat3::IDENTITY,
    grip: None,
};

impl<'a> Node<'a> {
    /// The end of a rod.
    pub fn end(problem: &'a Problem) -> Self {
        Self::new(problem, problem.rod.elements(), &problem.end)
    }

    /// A node between the ends, or the end.
    pub fn of(problem: &'a Problem, node: usize) -> Self {
        Self::new(problem, node, problem.support(node).unwrap_or(FREE))
    }

    fn new(problem: &'a Problem, node: usize, support: &'a Support) -> Self {
        let loads = &problem.loads;
        Self { support, world: loads.world[node], body: loads.body[node], pulls: loads.pulls_at(node) }
    }
}

/// Which of an end's turns are fixed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Turns {
    Free,
    Fixed,
    Mixed,
}

impl Support {
    fn turns(&self) -> Turns {
        match self.fixed[..3].iter().filter(|fixed| **fixed).count() {
            0 => Turns::Free,
            3 => Turns::Fixed,
            _ => Turns::Mixed,
        }
    }

    /// The axis of a freedom: of a turn in the fixed frame, of a shift in the world.
    fn axis(&self, freedom: usize) -> Vec3 {
        if freedom < 3 { self.turn_axes.cols[freedom] } else { self.shift_axes.cols[freedom - 3] }
    }

    /// The rotation vector from the fixed frame.
    fn turn_of(&self, pose: &Pose) -> Vec3 {
        self.pose.rotation.turn_to(&pose.rotation)
    }
}

impl EndState {
    /// The end as a guess has it, moved so that what is fixed is met.
    pub fn from_guess(problem: &Problem, guess: &Guess) -> Self {
        Self::of(&Node::end(problem), &guess.pose, guess.wrench)
    }

    /// A node moved so that what is fixed is met, where the rod before it carries so much more than the rod beyond it.
    pub fn of(node: &Node, pose: &Pose, more: Wrench) -> Self {
        let end = node.support;
        let pose = meet(end, pose);
        let mut state = Self { pose, reaction: Wrench::ZERO };
        // What there is beyond the loads is the reaction.
        let beyond = more - state.wrench(node);
        let force = pose.rotation * beyond.linear;
        let moment = match end.turns() {
            Turns::Free => Vec3::ZERO,
            Turns::Fixed => beyond.angular,
            // J⁻ᵀ λ = m, so λ = Jᵀ m.
            Turns::Mixed => so3_tangent(end.turn_of(&pose)).transpose_mul(beyond.angular),
        };
        let (moment, force) = (end.turn_axes.transpose_mul(moment), end.shift_axes.transpose_mul(force));
        for i in 0..3 {
            state.reaction.angular[i] = if end.fixed[i] { moment[i] } else { 0.0 };
            state.reaction.linear[i] = if end.fixed[3 + i] { force[i] } else { 0.0 };
        }
        state
    }

    /// The same reaction, at an end that is held elsewhere.
    pub fn moved(&self, problem: &Problem) -> Self {
        Self { pose: meet(&problem.end, &self.pose), reaction: self.reaction }
    }

    /// The frame and internal wrench at the end: loads, reaction and grip together.
    pub fn section(&self, problem: &Problem) -> Section {
        Section { pose: self.pose, wrench: self.wrench(&Node::end(problem)) }
    }

    /// What acts on the node, in its frame: loads, reaction and grip together.
    pub fn wrench(&self, node: &Node) -> Wrench {
        let mut wrench = self.world_wrench(node).turned_back_by(&self.pose.rotation) + node.body;
        wrench.angular += self.reaction_moment(node.support);
        wrench
    }

    /// The moment of the reaction, in the end's frame.
    fn reaction_moment(&self, end: &Support) -> Vec3 {
        let moment = end.turn_axes * self.reaction.angular;
        match end.turns() {
            Turns::Free => Vec3::ZERO,
            Turns::Fixed => moment,
            Turns::Mixed => so3_tangent_inverse(end.turn_of(&self.pose)).transpose_mul(moment),
        }
    }

    /// What acts on the node in world axes: dead loads, pulls, the reaction's force, the grip.
    fn world_wrench(&self, node: &Node) -> Wrench {
        let mut world = node.world;
        node.pulls.iter().for_each(|pull| world.linear += pull.force(self.pose.position));
        world.linear += node.support.shift_axes * self.reaction.linear;
        if let Some(grip) = &node.support.grip {
            world += grip.wrench(&self.pose);
        }
        world
    }

    /// How the section at the end changes with each unknown.
    pub fn columns(&self, problem: &Problem) -> Columns {
        self.columns_at(&Node::end(problem))
    }

    /// How a node's frame and what acts on it change with each unknown.
    pub fn columns_at(&self, node: &Node) -> Columns {
        let end = node.support;
        let rotation = self.pose.rotation;
        let turns = end.turns();
        let phi = if turns == Turns::Mixed { end.turn_of(&self.pose) } else { Vec3::ZERO };
        let (j, j_inverse) = (so3_tangent(phi), so3_tangent_inverse(phi));
        let body_axes = self.world_wrench(node).turned_back_by(&self.pose.rotation);
        let grip = end.grip.as_ref().map(|grip| grip.stiffness(&self.pose));
        core::array::from_fn(|k| {
            let axis = end.axis(k);
            let mut column = Variation { frame: Vec6::ZERO, wrench: Wrench::ZERO };
            match (end.fixed[k], k < 3) {
                (true, true) => column.wrench.angular = j_inverse.transpose_mul(axis),
                (true, false) => column.wrench.linear = rotation.transpose_mul(axis),
                (false, true) => {
                    let turn = j * axis;
                    column.frame.angular = turn;
                    column.wrench = turned_by(body_axes, turn);
                    if turns == Turns::Mixed {
                        column.wrench.angular += self.reaction_moment_slope(end, phi, k);
                    }
                    if let Some((by_turn, _)) = &grip {
                        column.wrench.angular += rotation.transpose_mul(*by_turn * turn);
                    }
                }
                (false, false) => {
                    column.frame.linear = rotation.transpose_mul(axis);
                    for pull in node.pulls {
                        column.wrench.linear += rotation.transpose_mul(pull.slope(self.pose.position) * axis);
                    }
                    if let Some((_, by_shift)) = &grip {
                        column.wrench.linear += rotation.transpose_mul(*by_shift * axis);
                    }
                }
            }
            column
        })
    }

    /// `d(J(φ)⁻ᵀ λ)/dφ_k`, by a central difference (only where an end is fixed in some turns and free in others).
    fn reaction_moment_slope(&self, end: &Support, phi: Vec3, k: usize) -> Vec3 {
        let step = 1e-5;
        let moment = end.turn_axes * self.reaction.angular;
        let at = |sign: f64| so3_tangent_inverse(phi + end.axis(k) * (sign * step)).transpose_mul(moment);
        (at(1.0) - at(-1.0)) * (0.5 / step)
    }

    /// The end after a step in the unknowns.
    pub fn stepped(&self, problem: &Problem, step: &[f64; 6]) -> Self {
        self.stepped_at(&problem.end, step)
    }

    /// A node after a step in the unknowns.
    pub fn stepped_at(&self, end: &Support, step: &[f64; 6]) -> Self {
        let mut next = *self;
        let mut turn = Vec3::ZERO;
        for i in 0..3 {
            if end.fixed[i] {
                next.reaction.angular[i] += step[i];
            } else {
                turn += end.axis(i) * step[i];
            }
            if end.fixed[3 + i] {
                next.reaction.linear[i] += step[3 + i];
            } else {
                next.pose.position += end.axis(3 + i) * step[3 + i];
            }
        }
        // A search that goes far along a rail, and comes back, would bring the round-off of there with it.
        next.pose.position = held_place(end, next.pose.position);
        match end.turns() {
            Turns::Fixed => {}
            Turns::Free => {
                next.pose.rotation =
                    renormalised(self.pose.rotation * Quat::from_rotation_vector(turn).to_matrix());
            }
            Turns::Mixed => {
                let phi = end.turn_of(&self.pose) + turn;
                next.pose.rotation = end.pose.rotation * Quat::from_rotation_vector(phi).to_matrix();
            }
        }
        next
    }

    /// What holds the end: force and moment about the node, world axes.
    pub fn reaction(&self, problem: &Problem) -> Wrench {
        let end = &problem.end;
        let moment = self.pose.rotation * self.reaction_moment(end);
        let held = Wrench::new(moment, end.shift_axes * self.reaction.linear);
        end.grip.as_ref().map_or(held, |grip| held + grip.wrench(&self.pose))
    }
}

/// How large each unknown of the end typically is.
pub(crate) fn unknown_scale(end: &Support, scale: &Scale) -> [f64; 6] {
    core::array::from_fn(|k| match (end.fixed[k], k < 3) {
        (true, true) => scale.moment,
        (true, false) => scale.force,
        (false, true) => 1.0,
        (false, false) => scale.length,
    })
}

/// A frame turned and shifted so that what an end fixes is met.
pub(crate) fn meet(end: &Support, pose: &Pose) -> Pose {
    let mut met = *pose;
    match end.turns() {
        Turns::Free => met.rotation = renormalised(pose.rotation),
        Turns::Fixed => met.rotation = end.pose.rotation,
        Turns::Mixed => {
            let mut phi = end.turn_axes.transpose_mul(end.turn_of(pose));
            (0..3).filter(|i| end.fixed[*i]).for_each(|i| phi[i] = 0.0);
            let turn = Quat::from_rotation_vector(end.turn_axes * phi);
            met.rotation = end.pose.rotation * turn.to_matrix();
        }
    }
    met.position = held_place(end, pose.position);
    met
}

/// A place shifted so that what an end fixes of it is met.
fn held_place(end: &Support, position: Vec3) -> Vec3 {
    if end.holds_position() {
        return end.pose.position;
    }
    if !end.fixed[3..].contains(&true) {
        return position;
    }
    let mut place = end.shift_axes.transpose_mul(position);
    let held = end.shift_axes.transpose_mul(end.pose.position);
    (0..3).filter(|i| end.fixed[3 + i]).for_each(|i| place[i] = held[i]);
    end.shift_axes * place
}

/// A rotation matrix without the round-off that products gather.
///
/// By a step of Newton's method for the polar decomposition, `R (3 − Rᵀ R)/2`, which moves an entry by round-off of itself. That matters where
/// a rod is far longer than it takes to turn into its load's direction: by how little its end points off that direction decides where its
/// start points. Along an axis of the world the matrix holds that angle however small, as an entry; a quaternion holds none below round-off.
pub(crate) fn renormalised(rotation: Mat3) -> Mat3 {
    let off = Mat3::IDENTITY - rotation.transpose() * rotation;
    if rotation.is_finite() && off.max_abs() < 1e-8 {
        rotation + rotation * off.scaled(0.5)
    } else {
        Quat::from_matrix(rotation).to_matrix()
    }
}

/// The section at the start with the first node's loads: its wrench is the opposite of the start's reaction, in the frame.
pub(crate) fn loaded_start(problem: &Problem, start: &Section) -> Section {
    let world = problem.loads.in_world(0, start.pose.position);
    let loads = problem.loads.body[0] + world.turned_back_by(&start.pose.rotation);
    Section { pose: start.pose, wrench: start.wrench + loads }
}

/// What is wrong at the start, dimensionless.
pub(crate) fn residual(problem: &Problem, start: &Section) -> [f64; 6] {
    let end = &problem.start;
    let scale = problem.rod.scale();
    let loaded = loaded_start(problem, start);
    let phi = end.turn_of(&start.pose);
    let gap = start.pose.position - end.pose.position;
    let force = loaded.pose.rotation * loaded.wrench.linear;
    let moment = match end.turns() {
        Turns::Mixed => so3_tangent(phi).transpose_mul(loaded.wrench.angular),
        _ => loaded.wrench.angular,
    };
    let (phi, moment) = (end.turn_axes.transpose_mul(phi), end.turn_axes.transpose_mul(moment));
    let (gap, force) = (end.shift_axes.transpose_mul(gap), end.shift_axes.transpose_mul(force));
    core::array::from_fn(|k| match (end.fixed[k], k < 3) {
        (true, true) => phi[k],
        (true, false) => gap[k - 3] / scale.length,
        (false, true) => moment[k] / scale.moment,
        (false, false) => force[k - 3] / scale.force,
    })
}

/// The part of a wrench about a held node, world axes, that its support can exert: it does no work on what is free.
pub(crate) fn borne(support: &Support, pose: &Pose, wrench: Wrench) -> Wrench {
    let free = displacements(support, &pose.from_itself());
    let free_turns = (0..3).filter(|k| !support.fixed[*k]).map(|k| free.blocks[0][0].cols[k]);
    let mut turns = [Vec3::ZERO; 3];
    let count = free_turns.zip(&mut turns).map(|(axis, turn)| *turn = axis).count();
    let along = |axis: Vec3, v: Vec3| axis * (axis.dot(v) / axis.dot(axis));
    let moment = match count {
        0 => wrench.angular,
        1 => wrench.angular - along(turns[0], wrench.angular),
        2 => along(turns[0].cross(turns[1]), wrench.angular),
        _ => Vec3::ZERO,
    };
    let mut force = wrench.linear;
    (3..6).filter(|k| !support.fixed[*k]).for_each(|k| force -= along(support.axis(k), force));
    Wrench::new(moment, force)
}

/// How the residual changes with each column of the variation at the start: `jacobian[row][column]`.
pub(crate) fn residual_slope(problem: &Problem, start: &Section, columns: &Columns) -> [[f64; 6]; 6] {
    let end = &problem.start;
    let scale = problem.rod.scale();
    let loaded = loaded_start(problem, start);
    let phi = end.turn_of(&start.pose);
    let j_inverse = so3_tangent_inverse(phi);
    let rotation = start.pose.rotation;
    let world_load = problem.loads.world[0].turned_back_by(&start.pose.rotation);
    let mut slope = [[0.0; 6]; 6];
    for (k, column) in columns.iter().enumerate() {
        let turn = column.frame.angular;
        let change = column.wrench + turned_by(world_load, turn);
        let d_phi = j_inverse * turn;
        let gap = rotation * column.frame.linear;
        let force = rotation * (turn.cross(loaded.wrench.linear) + change.linear);
        let moment = if end.turns() == Turns::Mixed {
            let step = 1e-5;
            let at =
                |sign: f64| so3_tangent(phi + d_phi * (sign * step)).transpose_mul(loaded.wrench.angular);
            so3_tangent(phi).transpose_mul(change.angular) + (at(1.0) - at(-1.0)) * (0.5 / step)
        } else {
            change.angular
        };
        let (d_phi, moment) = (end.turn_axes.transpose_mul(d_phi), end.turn_axes.transpose_mul(moment));
        let (gap, force) = (end.shift_axes.transpose_mul(gap), end.shift_axes.transpose_mul(force));
        for (i, row) in slope.iter_mut().enumerate() {
            row[k] = match (end.fixed[i], i < 3) {
                (true, true) => d_phi[i],
                (true, false) => gap[i - 3] / scale.length,
                (false, true) => moment[i] / scale.moment,
                (false, false) => force[i - 3] / scale.force,
            };
        }
    }
    slope
}

/// The displacements, as variations of the frame seen from the axes that it is given in, that an end leaves free, one a column; the columns of
/// those that it fixes are zero.
pub(crate) fn displacements(end: &Support, pose: &Pose) -> Mat6 {
    let turn = match end.turns() {
        Turns::Mixed => pose.rotation * so3_tangent(end.turn_of(pose)),
        _ => pose.rotation,
    };
    let mut rows = [[0.0; 6]; 6];
    for k in (0..6).filter(|k| !end.fixed[*k]) {
        rows[k] = if k < 3 {
            let axis = turn * end.axis(k);
            Vec6::new(axis, pose.position.cross(axis)).to_array()
        } else {
            Vec6::new(Vec3::ZERO, end.axis(k)).to_array()
        };
    }
    Mat6::from_rows(&rows).transpose()
}

/// How the wrench on the displacements that an end leaves free changes with each of them while the wrench itself does not, negative: the part that
/// the hold adds to the stiffness against them. By central differences, and only where an end is held in some freedoms and free in others.
pub(crate) fn displacements_slope(end: &Support, pose: &Pose, wrench: Wrench) -> Mat6 {
    let mut rows = [[0.0; 6]; 6];
    if end.fixed.iter().all(|fixed| *fixed == end.fixed[0]) {
        return Mat6::ZERO;
    }
    let free = displacements(end, pose).transpose().to_rows();
    let step = 1e-5;
    for k in (0..6).filter(|k| !end.fixed[*k]) {
        let along = Vec6::from(free[k]);
        let at = |sign: f64| {
            let x = along * (sign * step);
            let turn = Quat::from_rotation_vector(x.angular).to_matrix();
            let shift = x.linear + x.angular.cross(pose.position);
            let moved = Pose { rotation: turn * pose.rotation, position: pose.position + shift };
            displacements(end, &moved).transpose().mul_vec(wrench)
        };
        rows[k] = ((at(1.0) - at(-1.0)) * (-0.5 / step)).to_array();
    }
    Mat6::from_rows(&rows).transpose()
}
