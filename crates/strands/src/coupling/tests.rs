//! Passivity: over a closed motion of the hand, the coupling never gives out more energy than was put in.

use super::*;
use crate::load::NodalLoads;
use crate::math::Vec6;
use crate::rod::{Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, Stiffness};
use crate::statics::{Guess, Problem, Settings, SolveReport, Support, Workspace, follow, solve};
use proptest::prelude::*;

fn vec3(size: f64) -> impl Strategy<Value = Vec3> {
    (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// A frame turned by less than a quarter turn: there, the energy of a spring against turns is convex.
fn pose() -> impl Strategy<Value = Pose> {
    (vec3(0.85), vec3(0.2)).prop_map(|(turn, position)| Pose {
        rotation: Pose::exp(Vec6::new(turn, Vec3::ZERO)).rotation,
        position,
    })
}

/// Stiff or soft, damped or not, with limits that most motions reach or none does.
fn coupling() -> impl Strategy<Value = VirtualCoupling> {
    let damping = || prop_oneof![Just(0.0), 0.01..1.0f64];
    let limit = || prop_oneof![Just(f64::INFINITY), 0.02..0.5f64];
    (0.5..4.0f64, damping(), damping(), limit(), limit()).prop_map(
        |(stiffness, linear, angular, force, torque)| VirtualCoupling {
            linear_stiffness: 10.0 * stiffness,
            angular_stiffness: 0.1 * stiffness,
            linear_damping: linear,
            angular_damping: 0.01 * angular,
            max_force: force,
            max_torque: 0.1 * torque,
        },
    )
}

/// What the hand puts in and takes out, step by step, J.
#[derive(Debug, Default)]
struct Exchange {
    put_in: f64,
    given_out: f64,
}

impl Exchange {
    /// The hand moves from one place to another against a wrench, the opposite of which it feels.
    fn step(&mut self, wrench: Wrench, from: &Pose, to: &Pose) {
        let (turn, shift) = (turn_between(from, to), to.position - from.position);
        let work = wrench.angular.dot(turn) + wrench.linear.dot(shift);
        self.put_in += work.max(0.0);
        self.given_out -= work.min(0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Steps of any size: what is held may move along with no turn, and what goes into it is taken off.
    #[test]
    fn the_coupling_alone_gives_out_no_more_than_was_put_in(
        coupling in coupling(),
        way in prop::collection::vec((pose(), vec3(0.2)), 2..20),
        time_step in 0.001..0.1f64,
    ) {
        let held = |position| Pose { rotation: Mat3::IDENTITY, position };
        let mut exchange = Exchange::default();
        for i in 0..way.len() {
            let ((last, last_at), (hand, at)) = (way[i], way[(i + 1) % way.len()]);
            let (last_held, held) = (held(last_at), held(at));
            let last = LastFrame { hand: last, held: last_held, time_step };
            let wrench = Grip { coupling, hand, last: Some(last) }.wrench(&held);
            // Only the motion of the hand against what it holds does work on the coupling.
            let to = Pose { position: hand.position - (at - last_at), ..hand };
            exchange.step(wrench, &last.hand, &to);
        }
        let Exchange { put_in, given_out } = exchange;
        prop_assert!(given_out <= put_in * (1.0 + 1e-12), "{put_in} J in, {given_out} J out");
    }
}

/// A clamped strand that hangs in a bow, its end where nothing holds it.
fn strand() -> (Problem, Guess) {
    let stiffness = Stiffness { bending: [0.01, 0.015], torsion: 0.01, axial: 900.0, shear: [300.0; 2] };
    let description = RodDescription {
        length: 0.5,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: 0.01,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.002; 2],
        },
        rest: RestShape::Constant(Vec3::new(0.0, 2.0, 1.0)),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 24, &[], Order::Second).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.0, -9.81));
    let problem = Problem { loads, ..Problem::cantilever(rod) };
    let guess = solve(&problem, &Settings::default(), None, &mut Workspace::default()).unwrap().guess;
    (problem, guess)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, max_global_rejects: 32, ..ProptestConfig::default() })]

    /// A hand takes the end of a strand at rest around a smooth loop, small enough for the strand not to snap, and the strand follows from
    /// equilibrium to equilibrium. The work of a step is that of the mean of the wrenches at its two ends.
    #[test]
    fn a_strand_on_a_coupling_gives_out_no_more_than_was_put_in(
        coupling in coupling(),
        loops in prop::array::uniform4((vec3(0.12), vec3(0.015))),
    ) {
        const STEPS: usize = 120;
        let (mut problem, mut guess) = strand();
        let (mut workspace, mut report) = (Workspace::default(), SolveReport::default());
        let start = guess.pose;
        let waves = loops.map(|(turn, shift)| Vec6::new(turn, shift));
        let on_loop = |i: usize| {
            let t = core::f64::consts::TAU * i as f64 / STEPS as f64;
            let wave = waves[0] * t.sin() + waves[1] * (t.cos() - 1.0);
            let ripple = waves[2] * (2.0 * t).sin() + waves[3] * ((2.0 * t).cos() - 1.0);
            start.compose(&Pose::exp(wave + ripple * 0.5))
        };
        let mut last = LastFrame { hand: start, held: start, time_step: 1.0 / 60.0 };
        let mut felt = Wrench::ZERO;
        let mut exchange = Exchange::default();
        for i in 1..=STEPS {
            let grip = Grip { coupling, hand: on_loop(i), last: Some(last) };
            problem.end = Support::gripped(grip);
            let settings = Settings { tolerance: 1e-10, ..Settings::default() };
            // A loop on which the search fails, or the strand snaps over, says nothing of the coupling.
            prop_assume!(follow(&problem, &settings, &mut guess, &mut workspace, &mut report));
            prop_assume!(turn_between(&last.held, &guess.pose).norm() < 0.2);
            let wrench = grip.wrench(&guess.pose);
            exchange.step((felt + wrench) * 0.5, &last.hand, &grip.hand);
            (felt, last) = (wrench, LastFrame { hand: grip.hand, held: guess.pose, ..last });
        }
        let Exchange { put_in, given_out } = exchange;
        prop_assert!(put_in > 0.0);
        prop_assert!(given_out <= put_in * (1.0 + 2e-3), "{put_in} J in, {given_out} J out");
    }
}
