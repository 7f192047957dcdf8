//! One stage of a step: Newton's method on the frames at which momentum has changed by what acts there.

use super::{Simulation, State, StepFailure, Taken};
use crate::element::DiagonalPoint;
use crate::math::{Mat3, Pose, Quat, Vec3, Vec6, Wrench, exp_coefficients, tangent_inverse};
use crate::rod::{Kinematics, NodeInertia};
use crate::statics::{Inertial, Motion, Problem, meet, rigid_compliance};

/// Round-off of a frame, with room, over that of a number.
const ROUND_OFF: f64 = 4.0;

/// What is known of a stage, and what comes of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Stage {
    /// The frames at the step's beginning, and what canonical coordinates about them, momenta and exponents would be without rates at this time.
    base: Vec<Pose>,
    offsets: Vec<Vec6>,
    known_momenta: Vec<Wrench>,
    /// How much a rate counts, s.
    of_rate: f64,
    /// The laws of the elements with what their rates add, where the rod is viscous.
    points: Vec<DiagonalPoint>,
    inertial: Vec<Inertial>,
    /// What comes of it.
    pub coordinate_rates: Vec<Vec6>,
    pub velocities: Vec<Vec6>,
    pub momenta: Vec<Wrench>,
    pub strain_rates: Vec<Vec6>,
}

impl Stage {
    /// Begins a step.
    pub fn begin(&mut self, state: &State, problem: &Problem, viscous: bool) {
        self.base.clone_from(&state.poses);
        self.points.clear();
        self.strain_rates.clear();
        if viscous {
            self.points.extend_from_slice(problem.rod.diagonal_points().unwrap_or_default());
            self.strain_rates.resize(self.points.len(), Vec6::ZERO);
        }
        let nodes = state.poses.len();
        let none = Inertial { exerts: Wrench::ZERO, by_turn: Mat3::ZERO, by_shift: [Mat3::ZERO; 2] };
        self.inertial.resize(nodes, none);
        self.coordinate_rates.resize(nodes, Vec6::ZERO);
        self.velocities.resize(nodes, Vec6::ZERO);
        self.momenta.resize(nodes, Wrench::ZERO);
    }

    /// Sets up a stage in which a rate counts so much, s. Without rates all would be as at the step's beginning.
    pub fn set_up(&mut self, of_rate: f64, state: &State) {
        self.of_rate = of_rate;
        self.offsets.clear();
        self.offsets.resize(state.poses.len(), Vec6::ZERO);
        self.known_momenta.clone_from(&state.momenta);
    }

    /// Adds so much of earlier rates.
    pub fn add_history(&mut self, times: f64, coordinate_rates: &[Vec6], momentum_rates: &[Wrench]) {
        self.offsets.iter_mut().zip(coordinate_rates).for_each(|(offset, rate)| *offset += *rate * times);
        self.known_momenta.iter_mut().zip(momentum_rates).for_each(|(known, rate)| *known += *rate * times);
    }

    /// For backward differences of order 2: a third of what has changed since the step before goes on.
    pub fn look_back(&mut self, poses: &[Pose], momenta: &[Wrench]) {
        for (i, base) in self.base.iter().enumerate() {
            self.offsets[i] += coordinates(base, &poses[i]) * (-1.0 / 3.0);
            let now = self.known_momenta[i];
            self.known_momenta[i] += (now - momenta[i]) * (1.0 / 3.0);
        }
    }

    /// Guesses the rates of the coordinates.
    pub fn predict_by_velocities(&mut self, rates: &[Vec6]) {
        let nodes = self.coordinate_rates.len();
        self.coordinate_rates.copy_from_slice(&rates[..nodes]);
    }

    /// The rates of the momenta.
    pub fn momentum_rates(&self) -> impl Iterator<Item = Wrench> {
        let per_rate = 1.0 / self.of_rate;
        self.momenta.iter().zip(&self.known_momenta).map(move |(now, known)| (*now - *known) * per_rate)
    }

    /// What is lent to the compliance against shifts, over `L³/EI`, on the way to a solution: a rod that cannot stretch has none.
    fn lent(&self, problem: &Problem) -> f64 {
        let (rod, scale) = (&problem.rod, problem.rod.scale());
        if rod.kinematics() == Kinematics::Cosserat {
            return 0.0;
        }
        let inertia = rod.mass() * scale.length / scale.force / (self.of_rate * self.of_rate);
        rigid_compliance(1.0 + problem.load_size() + inertia)
    }

    /// The residual that round-off of the frames leaves: places and turns are known to so much, and rates of rates are that over the time squared.
    fn round_off(&self, problem: &Problem) -> f64 {
        let scale = problem.rod.scale();
        let far = self.base.iter().fold(0.0, |far: f64, pose| far.max(pose.position.max_abs()));
        let of = |node: &NodeInertia| {
            (node.mass * far / scale.force).max(node.rotational.max_abs() / scale.moment)
        };
        let most = problem.rod.node_inertia().iter().map(of).fold(0.0, f64::max);
        ROUND_OFF * f64::EPSILON * most / (self.of_rate * self.of_rate)
    }

    /// Takes the exponents' rates into the elements' laws: with `x = x̂ + a ẋ` a viscous law is an elastic one against another rest shape, stiffer and
    /// elsewhere. `x̂` changes with the motion, though little, and is taken anew in every iteration.
    fn take_viscosity(&mut self, elastic: &[DiagonalPoint], viscous: f64, poses: &[Pose]) {
        let stiffer = viscous / self.of_rate;
        for (e, (point, elastic)) in self.points.iter_mut().zip(elastic).enumerate() {
            let relative = poses[e].between(&poses[e + 1]);
            let twist = |node: usize| {
                let velocity = self.velocities[node];
                Vec6::new(velocity.angular, poses[node].rotation.transpose_mul(velocity.linear))
            };
            let x = relative.log();
            let apart = twist(e + 1) - relative.inverse().adjoint(twist(e));
            let rate = tangent_inverse(x).mul_vec(apart);
            let known = x - rate * self.of_rate;
            point.compliance = elastic.compliance * (1.0 / (1.0 + stiffer));
            point.rest = (elastic.rest + known * stiffer) * (1.0 / (1.0 + stiffer));
            self.strain_rates[e] = rate;
        }
    }

    /// What inertia exerts at these frames, and `lost` of their momentum a second.
    fn take_inertia(&mut self, inertia: &[NodeInertia], poses: &[Pose], origin: Vec3, lost: f64) {
        let per_rate = 1.0 / self.of_rate;
        let per_momentum = per_rate + lost;
        for (i, pose) in poses.iter().enumerate() {
            let q = coordinates(&self.base[i], pose);
            let rate = (q - self.offsets[i]) * per_rate;
            let turning = Turning::new(q.angular, rate.angular, self.of_rate);
            let NodeInertia { mass, rotational } = inertia[i];
            let spin = pose.rotation * rotational.scale(turning.velocity);
            let place = pose.position - origin;
            let momentum = Wrench::new(spin + place.cross(rate.linear) * mass, rate.linear * mass);
            let known = self.known_momenta[i];
            // Of the momentum about the node.
            let change =
                Wrench::new(spin - known.angular + place.cross(known.linear), momentum.linear - known.linear);
            let turned =
                pose.rotation * Mat3::diagonal(rotational) * turning.by_turn * pose.rotation.transpose();
            self.coordinate_rates[i] = rate;
            self.velocities[i] = Vec6::new(turning.velocity, rate.linear);
            self.momenta[i] = momentum;
            self.inertial[i] = Inertial {
                exerts: change * (-per_rate) - Wrench::new(spin, momentum.linear) * lost,
                by_turn: (turned - Mat3::hat(spin)).scaled(-per_momentum),
                by_shift: [
                    Mat3::hat(known.linear).scaled(per_rate),
                    Mat3::IDENTITY.scaled(-per_momentum * per_rate * mass),
                ],
            };
        }
    }
}

/// The canonical coordinates of a node's frame about another: its turn as a rotation vector, and its shift in the world.
fn coordinates(base: &Pose, pose: &Pose) -> Vec6 {
    Vec6::new(base.rotation.turn_to(&pose.rotation), pose.position - base.position)
}

/// The frame with these coordinates.
fn at_coordinates(base: &Pose, q: Vec6) -> Pose {
    let turn = Quat::from_rotation_vector(q.angular).to_matrix();
    Pose { rotation: base.rotation * turn, position: base.position + q.linear }
}

/// An angular velocity `T(θ) θ̇` in a node's own axes.
struct Turning {
    velocity: Vec3,
    /// How it changes with a turn of the frame, in its own axes, which is `T(θ) δθ`, where `θ = Δ + a θ̇` with a known `Δ`.
    by_turn: Mat3,
}

impl Turning {
    fn new(theta: Vec3, rate: Vec3, of_rate: f64) -> Self {
        let k = exp_coefficients(theta.dot(theta));
        let (hat, of_rate_hat) = (Mat3::hat(theta), Mat3::hat(rate));
        let tangent = Mat3::IDENTITY - hat.scaled(k.b) + (hat * hat).scaled(k.c);
        // The change of T with θ, times θ̇.
        let (once, twice) = (theta.cross(rate), theta.cross(theta.cross(rate)));
        let by_theta = of_rate_hat.scaled(k.b) - (Mat3::hat(once) + hat * of_rate_hat).scaled(k.c)
            + Mat3::outer(twice * k.dc - once * k.db, theta * 2.0);
        let by_turn = (tangent.scaled(1.0 / of_rate) + by_theta) * tangent.inverse();
        Self { velocity: tangent * rate, by_turn }
    }
}

/// The exponents between neighbouring frames.
pub(super) fn exponents(poses: &[Pose]) -> impl Iterator<Item = Vec6> {
    poses.windows(2).map(|pair| pair[0].between(&pair[1]).log())
}

impl Simulation {
    /// Solves the stage that has been set up.
    pub(super) fn solve_stage(&mut self) -> Result<Taken, StepFailure> {
        let Self { problem, settings, state, origin, work } = self;
        let damping = settings.damping;
        let inertia = problem.rod.node_inertia();
        let stage = &mut work.stage;
        for (i, pose) in work.record.poses.iter_mut().enumerate() {
            *pose =
                at_coordinates(&stage.base[i], stage.offsets[i] + stage.coordinate_rates[i] * stage.of_rate);
        }
        work.record.wrenches.copy_from_slice(&state.wrenches);
        for (node, support) in problem.supports() {
            work.record.poses[node] = meet(support, &work.record.poses[node]);
        }
        work.history.clear();
        let singular = |history: &[f64]| StepFailure::Singular {
            time: state.time,
            step: settings.time_step,
            history: history.to_vec(),
        };
        let tolerance = settings.tolerance.max(work.stage.round_off(problem));
        let lent = work.stage.lent(problem);
        let mut iterations = 0;
        let residual = loop {
            work.stage.take_inertia(inertia, &work.record.poses, *origin, damping.mass);
            let mut points = problem.rod.diagonal_points().unwrap_or_default();
            if damping.viscous > 0.0 {
                work.stage.take_viscosity(points, damping.viscous, &work.record.poses);
                points = &work.stage.points;
            }
            let motion = Motion { points, inertial: &work.stage.inertial };
            let distance = work.nodal.linearise_moving(problem, work.level, lent, &motion, &mut work.record);
            let residual = distance.map_or(f64::NAN, |distance| distance.residual());
            work.history.push(residual);
            if !residual.is_finite() {
                return Err(singular(&work.history));
            }
            let spent = iterations == settings.max_iterations;
            let enough = if settings.bounded { spent } else { residual <= tolerance };
            if enough {
                break residual;
            }
            if spent {
                let (time, step) = (state.time, settings.time_step);
                return Err(StepFailure::NotConverged { time, step, history: work.history.clone() });
            }
            if work.nodal.solve(work.level, 0.0).is_none() {
                return Err(singular(&work.history));
            }
            // No node turns by more than a radian at once.
            let part = (1.0 / work.nodal.step_size()).min(1.0);
            work.nodal.take(problem, work.level, part, &mut work.record);
            iterations += 1;
        };
        // What is left over of a free node goes into its momentum: then none is lost or made.
        for (i, momentum) in work.stage.momenta.iter_mut().enumerate() {
            let held = problem.support(i).is_some_and(|support| support.holds_anything());
            if !held {
                let left = work.nodal.left_over(i) * work.stage.of_rate;
                let place = work.record.poses[i].position - *origin;
                *momentum += Wrench::new(left.angular + place.cross(left.linear), left.linear);
            }
        }
        Ok(Taken { iterations, residual })
    }
}
