//! Surfaces that touch.

use super::rod;
use crate::assembly::{Assembly, Member, Strand};
use crate::contact::{Obstacle, Shape, Surfaces};
use crate::dynamics::{Integrator, Settings, Simulation, SimulationError, Start, State};
use crate::load::NodalLoads;
use crate::math::{Mat3, Pose, Quat, Vec3};
use crate::rod::{Kinematics, Material, Order, Rod};
use crate::statics::{Problem, Support};

pub(super) const RADIUS: f64 = 1e-3;
const FLOOR: Obstacle = Obstacle {
    shape: Shape::Plane { point: Vec3::ZERO, normal: Vec3::X },
    friction: None,
    body: None,
    tissue: None,
};

pub(super) const EULER: Settings = Settings {
    integrator: Integrator::ImplicitEuler,
    time_step: 1e-3,
    local_error: None,
    tolerance: 1e-7,
    max_iterations: 60,
    bounded: false,
    mass_damping: 0.0,
};

/// A rod that begins in some frame, free, under a gravity.
pub(super) fn free(rod: Rod, base: Pose, gravity: Vec3) -> Problem {
    let (mut description, elements) = (rod.description().clone(), rod.elements());
    description.base = base;
    let rod = Rod::with_elements(description, elements, &[], Order::Second).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, gravity);
    Problem { loads, start: Support::free(base), ..Problem::cantilever(rod) }
}

/// A rod along z from a place on, held at both ends.
pub(super) fn held(rod: Rod, z: f64) -> Problem {
    let base = Pose { position: Vec3::new(0.0, 0.0, z), ..Pose::IDENTITY };
    let (last, problem) = (rod.elements(), free(rod, base, Vec3::ZERO));
    let [a, b] = [0, last].map(|node| problem.rod.rest_poses()[node]);
    Problem { start: Support::clamped(a), end: Support::clamped(b), ..problem }
}

pub(super) fn steel() -> Rod {
    let steel = Material::from_poisson(200e9, 0.3, 7850.0).unwrap();
    rod(0.1, RADIUS, steel, Kinematics::Cosserat, 10)
}

pub(super) fn suture(elements: usize) -> Rod {
    let nylon = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    rod(0.1, 0.2e-3, nylon, Kinematics::Cosserat, elements)
}

fn on_floor(problem: Problem, friction: f64) -> Assembly {
    Assembly { surfaces: Some(Surfaces { friction }), obstacles: vec![FLOOR], ..problem.into() }
}

/// The friction, the slope, and how a rod that lies along it and one that lies across are accelerated, and the latter turned, times its radius (closed form): whether it slides
/// is seen by these.
#[test]
fn a_rod_on_an_incline_sticks_or_slides_and_rolls() {
    const G: f64 = 9.81;
    for friction in [0.1, 0.3, 0.5] {
        for degrees in [5.0_f64, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let slides = G * (sin - friction * cos);
            let along = [slides.max(0.0), 0.0];
            let rolls = 2.0 / 3.0 * G * sin;
            let across =
                if sin <= 3.0 * friction * cos { [rolls, rolls] } else { [slides, 2.0 * friction * G * cos] };
            for (down, [expected, turned]) in [(Vec3::Z, along), (Vec3::Y, across)] {
                let gravity = Vec3::X * (-G * cos) + down * (G * sin);
                let base = Pose { position: Vec3::new(1.016 * RADIUS, 0.0, 0.0), ..Pose::IDENTITY };
                let assembly = on_floor(free(steel(), base, gravity), friction);
                let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
                for _ in 0..20 {
                    simulation.step().unwrap();
                }
                let (state, middle) = (simulation.state(), simulation.state().velocities[5]);
                let acceleration = middle.linear.dot(down) / state.time;
                let spin = (state.poses[5].rotation * middle.angular).z.abs() * RADIUS / state.time;
                let near = |a: f64, b: f64| (a - b).abs() < 1e-4 * G;
                assert!(
                    near(acceleration, expected) && near(spin, turned),
                    "{friction}, {degrees}°: {acceleration} for {expected}, {spin} for {turned}"
                );
                if expected == 0.0 {
                    // What sticks does not creep.
                    let lay = state.poses[5].position;
                    for _ in 0..100 {
                        simulation.step().unwrap();
                    }
                    let crept = (simulation.state().poses[5].position - lay).norm();
                    assert!(crept < 1e-11, "{friction}, {degrees}°: {crept:e}");
                }
            }
        }
    }
}

/// The least distance of the surfaces of elements, by another way than contacts are found: alternating projections.
fn least_gap(poses: &[Pose], radius: f64, between: usize) -> f64 {
    let mut least = f64::INFINITY;
    let ends = |i: usize| (poses[i].position, poses[i + 1].position);
    for i in 0..poses.len() - 1 {
        for j in i + between..poses.len() - 1 {
            let ((a, b), (c, d)) = (ends(i), ends(j));
            if (a - c).norm() > (b - a).norm() + (d - c).norm() + 4.0 * radius {
                continue;
            }
            let mut s = 0.5;
            for _ in 0..300 {
                let t = ((a + (b - a) * s - c).dot(d - c) / (d - c).dot(d - c)).clamp(0.0, 1.0);
                s = ((c + (d - c) * t - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
                least = least.min((a + (b - a) * s - c - (d - c) * t).norm());
            }
        }
    }
    least - 2.0 * radius
}

#[test]
fn a_suture_that_falls_onto_a_floor_comes_to_rest_there() {
    let turn = Quat::from_rotation_vector(Vec3::new(0.1, 0.4, 0.0)).to_matrix();
    let base = Pose { rotation: turn, position: Vec3::new(5e-3, 0.0, 0.0) };
    let mut strand: Strand = free(suture(40), base, Vec3::X * -9.81).into();
    strand.viscosity = 1e-3;
    let assembly =
        Assembly { surfaces: Some(Surfaces { friction: 0.3 }), obstacles: vec![FLOOR], ..strand.into() };
    let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
    let (weight, began) = {
        let rod = &simulation.assembly().strands[0].problem.rod;
        (rod.mass() * 9.81, simulation.energy().total())
    };
    let mut last = began;
    for step in 0..400 {
        simulation.step().unwrap();
        for pose in &simulation.state().poses {
            assert!(pose.position.x > 0.2e-3, "step {step}: {}", pose.position.x);
        }
        let total = simulation.energy().total();
        assert!(total < last + 1e-9 * weight, "step {step}: {total:e} after {last:e}");
        last = total;
    }
    let state = simulation.state();
    let fastest = state.velocities.iter().map(|velocity| velocity.linear.norm()).fold(0.0, f64::max);
    let borne: Vec3 = state.contacts.iter().fold(Vec3::ZERO, |sum, contact| sum + contact.force);
    assert!(fastest < 1e-6, "{fastest:e}");
    assert!((borne - Vec3::X * weight).norm() < 1e-3 * weight, "{borne:?} of {weight:e}");
    // It rests on it, and not above.
    let highest = state.poses.iter().map(|pose| pose.position.x).fold(0.0, f64::max);
    assert!(highest < 1.017 * 0.2e-3, "{highest:e}");
}

#[test]
fn a_rod_comes_to_rest_across_another_and_on_a_ball() {
    // The first lies across, held at both ends; the second falls onto it off its middle and slides down, or sticks.
    let held = held(steel(), -0.05);
    let across = Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y);
    let base = Pose { rotation: across, position: Vec3::new(3e-3, -0.05, 0.003) };
    let falls = free(steel(), base, Vec3::X * -9.81);
    let ball = Obstacle {
        shape: Shape::Capsule { ends: [Vec3::new(0.0, 0.03, 0.003); 2], radius: 1e-3 },
        friction: Some(1.0),
        body: None,
        tissue: None,
    };
    let assembly = Assembly {
        strands: vec![held.into(), falls.into()],
        surfaces: Some(Surfaces { friction: 0.5 }),
        obstacles: vec![ball],
        ..Assembly::default()
    };
    let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
    for step in 0..200 {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        let (poses, contacts) = (&simulation.state().poses, &simulation.state().contacts);
        let least = contacts.iter().map(|contact| contact.gap).fold(f64::INFINITY, f64::min);
        assert!(least > 0.0, "step {step}: {least:e}");
        assert!(poses.iter().all(|pose| pose.position.is_finite()));
    }
    let state = simulation.state();
    // On the rod at its middle and on the ball: it stays on both, as its middle is between.
    let middle = state.poses[11 + 5].position;
    assert!((middle.x - 2e-3).abs() < 2e-4, "{middle:?}");
    let up: f64 = state.contacts.iter().map(|contact| contact.force.x.abs()).sum();
    let weight = simulation.assembly().strands[1].problem.rod.mass() * 9.81;
    assert!((up / weight - 1.0).abs() < 0.01, "{up:e} of {weight:e}");
}

/// A suture along a trefoil (Shastri 1992) whose ends go off to both sides, at rest there, with its ends clamped.
fn knotted(elements: usize) -> (Problem, State) {
    const END: f64 = 2.12;
    const FINE: usize = 100_000;
    let curve = |k: usize| {
        let t = END * (2.0 * k as f64 / FINE as f64 - 1.0);
        Vec3::new(t.powi(3) - 3.0 * t, t.powi(4) - 4.0 * t * t, t.powi(5) - 10.0 * t)
    };
    let mut lengths = vec![0.0];
    for k in 1..=FINE {
        lengths.push(lengths[k - 1] + (curve(k) - curve(k - 1)).norm());
    }
    let place = |i: usize| {
        let s = lengths[FINE] * i as f64 / elements as f64;
        let k = lengths.partition_point(|length| *length < s).clamp(1, FINE);
        let part = (s - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
        (curve(k - 1) + (curve(k) - curve(k - 1)) * part) * (0.1 / lengths[FINE])
    };
    let places: Vec<Vec3> = (0..=elements).map(place).collect();
    let mut first = Vec3::ZERO;
    let poses: Vec<Pose> = (0..=elements)
        .map(|i| {
            let along = places[(i + 1).min(elements)] - places[i.saturating_sub(1)];
            let along = along.normalized().unwrap();
            first =
                (first - along * first.dot(along)).normalized().unwrap_or_else(|| along.any_orthonormal());
            Pose { rotation: Mat3::from_cols(first, along.cross(first), along), position: places[i] }
        })
        .collect();
    let rod = free(suture(elements), poses[0], Vec3::ZERO);
    let problem =
        Problem { start: Support::clamped(poses[0]), end: Support::clamped(poses[elements]), ..rod };
    let state = State::at_rest(&problem.clone().into(), poses, EULER.time_step);
    (problem, state)
}

/// How hard a knot's ends are pulled when they have been pulled apart in steps of so many s, N.
fn pulled(time_step: f64) -> f64 {
    const ELEMENTS: usize = 100;
    const SPEED: f64 = 0.1;
    const SECONDS: f64 = 0.2;
    let (problem, state) = knotted(ELEMENTS);
    let strand = Strand { viscosity: 1e-3, ..problem.into() };
    let assembly = Assembly { surfaces: Some(Surfaces { friction: 0.2 }), ..strand.into() };
    // It is bent, and would whip: it comes to rest slowly first.
    let slow = Settings { time_step: 2e-5, mass_damping: 1e4, ..EULER };
    let mut simulation = Simulation::new(assembly.clone(), slow, Start::State(Box::new(state))).unwrap();
    for _ in 0..400 {
        simulation.step().unwrap();
    }
    let state = State { time: 0.0, ..simulation.state().clone() };
    let settings = Settings { time_step, mass_damping: 5.0, ..EULER };
    let mut simulation = Simulation::new(assembly, settings, Start::State(Box::new(state))).unwrap();
    let ends = [0, ELEMENTS].map(|node| Member::Node { rod: 0, node });
    for step in 0..(SECONDS / time_step).round() as usize {
        for (member, way) in ends.into_iter().zip([-0.5, 0.5]) {
            simulation.support_mut(member).unwrap().pose.position.z += way * SPEED * time_step;
        }
        let made = simulation.step();
        made.unwrap_or_else(|failure| panic!("steps of {time_step} s, step {step}: {failure}"));
        // Three elements of a millimetre are more than the half turn of the tightest bend.
        let least = least_gap(&simulation.state().poses, 0.2e-3, 3);
        assert!(least > 0.0, "steps of {time_step} s, step {step}: {least:e}");
    }
    assert!(simulation.state().contacts.len() > 3);
    simulation.reaction(ends[1]).linear.norm()
}

#[test]
fn a_knot_is_pulled_tight_with_the_same_force_in_steps_of_any_length() {
    let [half, one, two] = [5e-4, 1e-3, 2e-3].map(pulled);
    println!("{half} N, {one} N and {two} N");
    assert!(one > 0.02, "{one}");
    for other in [half, two] {
        assert!((other / one - 1.0).abs() < 0.05, "{half} {one} {two}");
    }
}

#[test]
fn what_cannot_touch_is_refused() {
    let base = Pose { position: Vec3::new(0.9 * RADIUS, 0.0, 0.0), ..Pose::IDENTITY };
    let within = on_floor(free(steel(), base, Vec3::ZERO), 0.0);
    let refused = Simulation::new(within.clone(), EULER, Start::Rest).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "where all starts node 0 of rod 0 passes into obstacle 0: put them apart"
    );
    let by = Settings { integrator: Integrator::Bdf2, ..EULER };
    let refused = Simulation::new(within, by, Start::Rest).unwrap_err();
    assert!(matches!(refused, SimulationError::NoContactBy("bdf2")), "{refused}");
}

#[test]
fn nothing_passes_through_anything_however_long_the_steps() {
    // A thin strand falls onto one that is held, by many times their thickness in a step, and nothing is near at first.
    let nylon = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    let thin = || rod(0.05, 1e-4, nylon, Kinematics::Cosserat, 20);
    let held = held(thin(), -0.025);
    let across = Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y);
    for (height, gravity) in [(6.5e-4, 9.81), (2e-3, 9.81), (5e-3, 98100.0)] {
        let base = Pose { rotation: across, position: Vec3::new(height, -0.024, 0.001) };
        let assembly = Assembly {
            strands: vec![held.clone().into(), free(thin(), base, Vec3::X * -gravity).into()],
            surfaces: Some(Surfaces { friction: 0.3 }),
            ..Assembly::default()
        };
        let settings = Settings { time_step: 0.01, ..EULER };
        let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
        for step in 0..8 {
            if let Err(failure) = simulation.step() {
                // It may not be solved, but is never solved with what has passed through.
                println!("{height} m, step {step}: {failure}");
                break;
            }
            let poses = &simulation.state().poses;
            let gap = |k: usize| poses[21 + k].position.x - poses[10].position.x;
            let above = (0..=20).map(gap).fold(f64::NEG_INFINITY, f64::max);
            assert!(above > 0.0, "{height} m, step {step}: {above:e}");
        }
    }
}

#[test]
fn rods_that_cross_at_any_angle_rest_on_each_other() {
    // Elements as long as the rods are thick cross at their middles.
    for degrees in [0.0, 0.5, 1.0, 2.0, 4.0, 6.0, 9.0, 12.0, 20.0, 90.0_f64] {
        let steel = || {
            rod(0.044, 1e-3, Material::from_poisson(200e9, 0.3, 7850.0).unwrap(), Kinematics::Cosserat, 22)
        };
        let held = held(steel(), -0.023);
        let turn = Quat::from_rotation_vector(Vec3::X * degrees.to_radians()).to_matrix();
        let base = Pose { rotation: turn, position: Vec3::new(2.1e-3, 0.0, 0.0) - turn.cols[2] * 0.023 };
        let falls = free(steel(), base, Vec3::X * -9.81);
        // It may only go up and down, and does not fall off.
        let [a, b] = [0, 22].map(|node| falls.rod.rest_poses()[node]);
        let guide = |pose| Support::clamped(pose).sliding_along(Vec3::X);
        let falls = Problem { start: guide(a), end: guide(b), ..falls };
        let assembly = Assembly {
            strands: vec![held.into(), falls.into()],
            surfaces: Some(Surfaces { friction: 0.3 }),
            ..Assembly::default()
        };
        let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
        for step in 0..60 {
            simulation.step().unwrap_or_else(|failure| panic!("{degrees}°, step {step}: {failure}"));
        }
        let state = simulation.state();
        let up: f64 = state.contacts.iter().map(|contact| contact.force.x.abs()).sum();
        let weight = simulation.assembly().strands[1].problem.rod.mass() * 9.81;
        assert!((up / weight - 1.0).abs() < 0.01, "{degrees}°: {up:e} of {weight:e}");
        assert!(state.contacts.iter().all(|contact| contact.gap > 0.0), "{degrees}°");
    }
}

#[test]
fn a_rod_rests_along_a_long_obstacle_and_in_a_valley_of_two() {
    for degrees in [0.0, 1e-4, 0.01, 0.1, 1.0_f64] {
        let turn = Quat::from_rotation_vector(Vec3::Y * degrees.to_radians()).to_matrix();
        let base = Pose { rotation: turn, position: Vec3::new(4e-3, 0.0, 0.0) };
        let side = |y: f64| Obstacle {
            shape: Shape::Capsule { ends: [Vec3::new(0.0, y, -0.05), Vec3::new(0.0, y, 0.15)], radius: 2e-3 },
            friction: None,
            body: None,
            tissue: None,
        };
        let assembly = Assembly {
            surfaces: Some(Surfaces { friction: 0.3 }),
            obstacles: vec![side(-2e-3), side(2e-3)],
            ..free(steel(), base, Vec3::X * -9.81).into()
        };
        let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
        for step in 0..100 {
            simulation.step().unwrap_or_else(|failure| panic!("{degrees}°, step {step}: {failure}"));
        }
        let lies = simulation.state().poses[5].position;
        // Surfaces rest 0.016 radii apart.
        let height = ((3e-3 + 0.016 * RADIUS).powi(2) - 2e-3_f64.powi(2)).sqrt();
        assert!(
            (lies.x - height).abs() < 0.01 * RADIUS && lies.y.abs() < 1e-3 * RADIUS,
            "{degrees}°: {lies:?}"
        );
    }
}

#[test]
fn rods_piled_side_by_side_come_to_rest() {
    for friction in [0.0, 0.3] {
        let lies = |x: f64, y: f64| {
            let position = Vec3::new(x * RADIUS, y * RADIUS, 0.0);
            free(steel(), Pose { position, ..Pose::IDENTITY }, Vec3::X * -9.81).into()
        };
        let assembly = Assembly {
            strands: vec![lies(1.02, -1.02), lies(1.02, 1.02), lies(2.85, 0.0)],
            surfaces: Some(Surfaces { friction }),
            obstacles: vec![FLOOR],
            ..Assembly::default()
        };
        let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
        for step in 0..60 {
            simulation.step().unwrap_or_else(|failure| panic!("{friction}, step {step}: {failure}"));
        }
        let top = simulation.state().poses[22 + 5].position.x;
        // Without friction the two below are pushed apart.
        assert!(if friction > 0.0 { top > 2.6 * RADIUS } else { top < 2.6 * RADIUS }, "{friction}: {top:e}");
    }
}

/// Three rods side by side, and three across them that fall onto them: every step is solved, nothing passes through anything, and they lie in two layers.
#[test]
fn crossed_layers_fall_onto_each_other() {
    let rubber = Material::from_poisson(5e6, 0.45, 1100.0).unwrap();
    let lies = |at: f64, is_across: bool| {
        let (first, height) = (-0.03, if is_across { 3.5 } else { 1.1 } * RADIUS);
        let base = if is_across {
            Pose {
                rotation: Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y),
                position: Vec3::new(height, first, at),
            }
        } else {
            Pose { position: Vec3::new(height, at, first), ..Pose::IDENTITY }
        };
        let strand = rod(0.06, RADIUS, rubber, Kinematics::Cosserat, 20);
        let mut strand: Strand = free(strand, base, Vec3::X * -9.81).into();
        strand.viscosity = 5e-3;
        strand
    };
    let places = [-0.012, 0.001, 0.013];
    let strands = places.iter().map(|at| lies(*at, false)).chain(places.iter().map(|at| lies(*at, true)));
    let assembly = Assembly {
        strands: strands.collect(),
        surfaces: Some(Surfaces { friction: 0.3 }),
        obstacles: vec![FLOOR],
        ..Assembly::default()
    };
    let settings = Settings { mass_damping: 40.0, ..EULER };
    let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
    for step in 0..400 {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        let least = simulation.state().contacts.iter().map(|contact| contact.gap).fold(1.0, f64::min);
        assert!(least > 0.0, "step {step}: {least:e}");
    }
    for (node, pose) in simulation.state().poses.iter().enumerate() {
        // Layers are a diameter apart; the ends of the upper ones hang.
        let heights = if node < 63 { 1.0..1.1 } else { 2.5..3.1 };
        assert!(heights.contains(&(pose.position.x / RADIUS)), "{node}: {:?}", pose.position);
    }
}
