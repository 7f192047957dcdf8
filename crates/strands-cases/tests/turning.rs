//! Rods that turn steadily or nearly as rigid bodies do, and a column that flutters.

use std::f64::consts::{PI, TAU};
use strands::assembly::{Assembly, Member};
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::math::{Vec3, Vec6};
use strands::statics::Problem;
use strands_cases::Vibration;
use strands_cases::turning::{BECK, PENDULUM, Rotor, Whirled, beck, pendulum, top};

fn simulated(assembly: impl Into<Assembly>, integrator: Integrator, time_step: f64) -> Simulation {
    let settings = Settings { integrator, time_step, ..Settings::default() };
    Simulation::new(assembly, settings, Start::Rest).unwrap()
}

/// All of it turning about a place, rad/s, world axes.
fn turning(simulation: &Simulation, spin: Vec3, about: Vec3) -> Vec<Vec6> {
    let poses = simulation.state().poses.iter();
    poses
        .map(|pose| Vec6::new(pose.rotation.transpose_mul(spin), spin.cross(pose.position - about)))
        .collect()
}

/// The velocities of the slowest mode along a direction.
fn slowest(problem: Problem, frequency: f64, direction: Vec3) -> Vec<Vec6> {
    let mut vibration = Vibration::new(problem.into(), 2.0 / frequency).unwrap();
    let push: Vec<Vec6> = (0..=50).map(|i| Vec6::new(Vec3::ZERO, direction * f64::from(i).powi(2))).collect();
    (0..8).fold(push, |velocities, _| {
        let next = vibration.response(&velocities).unwrap();
        let tip = next[50].linear.norm();
        next.into_iter().map(|v| v * (1.0 / tip)).collect()
    })
}

#[test]
fn a_cantilever_that_turns_vibrates_faster() {
    for rotor in Rotor::all().into_iter().filter(|rotor| [0.0, 2.0, 6.0, 12.0].contains(&rotor.turning)) {
        vibrates_faster(&rotor, Vec3::Y, rotor.lag, Integrator::Midpoint);
        for integrator in [
            Integrator::Midpoint,
            Integrator::Bdf2,
            Integrator::Sdirk4,
            Integrator::GeneralizedAlpha { spectral_radius: 0.5 },
        ] {
            vibrates_faster(&rotor, Vec3::Z, rotor.flap[0], integrator);
        }
    }
}

fn vibrates_faster(rotor: &Rotor, direction: Vec3, frequency: f64, integrator: Integrator) {
    let spin = Vec3::Z * rotor.turning;
    let period = TAU / frequency;
    let time_step = period / 400.0;
    let mode = slowest(rotor.pulled(50).unwrap(), rotor.flap[0], direction);
    let mut simulation = simulated(rotor.turned(50, 3.0 * period).unwrap(), integrator, time_step);
    let steady = turning(&simulation, spin, Vec3::ZERO);
    let started: Vec<Vec6> = steady.iter().zip(&mode).map(|(v, mode)| *v + *mode * 3e-2).collect();
    simulation.set_velocities(&started);
    let (mut crossings, mut last) = (Vec::new(), 0.0);
    while crossings.len() < 3 {
        let time = simulation.step().unwrap().time;
        // As seen from the root, whose first direction is along y at first, and the second along z.
        let poses = &simulation.state().poses;
        let seen = poses[0].rotation.transpose_mul(poses[50].position);
        let now = if direction == Vec3::Z { seen.y } else { seen.x };
        if now * last < 0.0 {
            crossings.push(time - time_step * now / (now - last));
        }
        last = now;
    }
    // Where it turns fast the mesh's error of the frequency is that along the axis times the square of their ratio. A whole period: what steps do to the steady
    // turn moves the middle about which it vibrates.
    let error = TAU / (crossings[2] - crossings[0]) / frequency - 1.0;
    assert!(error.abs() < 1e-3, "{rotor:?}, {direction:?}, {}: {error:.1e}", integrator.name());
    if direction != Vec3::Z {
        return;
    }
    // What the root carries keeps all others on their circles, which vibrations along the axis hardly change.
    let rod = &simulation.assembly().strands[0].problem.rod;
    let nodes = rod.node_inertia().iter().zip(rod.mesh().nodes());
    let pull = nodes.map(|(node, s)| node.mass * s * rotor.turning * rotor.turning).sum::<f64>();
    let root = simulation.state().wrenches[0].linear.z;
    assert!((root - pull).abs() < 1e-3 * pull + 1e-3, "{rotor:?}, {}: {root} {pull}", integrator.name());
}

#[test]
fn a_rod_that_turns_about_its_end_is_stretched() {
    for rod in Whirled::ALL {
        let mut simulation = simulated(rod.problem(40).unwrap(), Integrator::Sdirk4, 2.5e-3);
        let mut state = simulation.state().clone();
        for (pose, s) in
            state.poses.iter_mut().zip(simulation.assembly().strands[0].problem.rod.mesh().nodes())
        {
            pose.position = Vec3::X * rod.place(*s);
        }
        simulation.restore(state).unwrap();
        simulation.set_velocities(&turning(&simulation, Vec3::Z * Whirled::TURNING, Vec3::ZERO));
        let (mut extension, mut tension) = (0.0, 0.0);
        let steps = 400;
        for _ in 0..steps {
            simulation.step().unwrap();
            extension += (simulation.state().poses[40].position.norm() - rod.length) / f64::from(steps);
            tension += simulation.reaction(Member::Node { rod: 0, node: 0 }).linear.norm() / f64::from(steps);
        }
        let errors = [extension / rod.extension - 1.0, tension / rod.tension - 1.0];
        assert!(errors.iter().all(|error| error.abs() < 1e-3), "{rod:?}: {errors:?}");
    }
}

#[test]
fn a_stiff_rod_swings_as_a_pendulum() {
    for (degrees, period) in PENDULUM {
        let time_step = period / 400.0;
        let mut simulation =
            simulated(pendulum(degrees.to_radians(), 100).unwrap(), Integrator::Sdirk4, time_step);
        let mut last = simulation.state().poses[100].position.x;
        let quarter = loop {
            let time = simulation.step().unwrap().time;
            let x = simulation.state().poses[100].position.x;
            if x <= 0.0 {
                break time - time_step * x / (x - last);
            }
            last = x;
        };
        let error = 4.0 * quarter / period - 1.0;
        assert!(error.abs() < 1e-4, "{degrees}°: {error:.1e}");
    }
}

#[test]
fn a_stiff_rod_that_turns_end_over_end_is_in_tension() {
    let (started, elements) = (3.0, 40);
    for integrator in [
        Integrator::ImplicitEuler,
        Integrator::Bdf2,
        Integrator::Sdirk4,
        Integrator::Midpoint,
        Integrator::GeneralizedAlpha { spectral_radius: 0.8 },
    ] {
        let mut simulation = simulated(top(Vec3::Z * 1e-6, elements).unwrap(), integrator, 0.01);
        simulation.set_velocities(&turning(&simulation, Vec3::X * started, Vec3::Z * 0.5));
        for _ in 0..100 {
            simulation.step().unwrap();
        }
        // Backward Euler's method takes 8e-4 of the spin in a step, so it is not the same at the wrenches' time and at the velocities'. Differences of
        // places on a circle, taken as BDF2 does twice, are 2/3 of the square of a step's turn off.
        let spin = simulation.state().velocities[0].angular.norm();
        let (kept, within) = match integrator {
            Integrator::ImplicitEuler => (0.1, 2e-3),
            Integrator::Bdf2 => (1e-3, 7e-4),
            _ => (1e-3, 3e-4),
        };
        assert!((spin / started - 1.0).abs() < kept, "{}: {spin}", integrator.name());
        // What the nodes beyond the middle of an element need to stay on their circles.
        let rod = &simulation.assembly().strands[0].problem.rod;
        let nodes = rod.node_inertia().iter().zip(rod.mesh().nodes()).enumerate();
        let mut expected = vec![0.0; elements];
        for (i, (node, s)) in nodes {
            for tension in &mut expected[..i] {
                *tension += node.mass * spin * spin * (s - 0.5);
            }
        }
        let most = expected.iter().fold(0.0_f64, |most, tension| most.max(*tension));
        let wrenches = simulation.state().wrenches.iter().map(|wrench| wrench.linear.z);
        let apart = expected.iter().zip(wrenches).map(|(expected, got)| (got - expected).abs() / most);
        let worst = apart.fold(0.0, f64::max);
        assert!(worst < within, "{}: {worst:e}", integrator.name());
    }
}

#[test]
fn the_axis_of_a_free_top_goes_round_as_eulers_equations_say() {
    let mut simulation = simulated(top(Vec3::new(0.02, 0.02, 0.04), 20).unwrap(), Integrator::Bdf2, 2.5e-3);
    let rod = &simulation.assembly().strands[0].problem.rod;
    // Of the lumped inertia, which that of the rod comes to with more elements.
    let places = rod.mesh().nodes().iter().map(|s| s - 0.5);
    let nodes = rod.node_inertia().iter().zip(places);
    let [across, along] = nodes.fold([0.0, 0.0], |[across, along], (node, z)| {
        [across + node.mass * z * z + node.rotational.x, along + node.rotational.z]
    });
    let spin = Vec3::new(1.0, 0.0, 5.0);
    simulation.set_velocities(&turning(&simulation, spin, Vec3::Z * 0.5));
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    let now = simulation.state().velocities[10].angular;
    let expected = spin.z * (along - across) / across * simulation.state().time;
    let got = now.y.atan2(now.x);
    let apart = (got - expected + PI).rem_euclid(TAU) - PI;
    assert!(apart.abs() < 1e-4 * expected.abs() && (now.z - spin.z).abs() < 1e-4, "{apart:e}, {now:?}");
}

/// Of the two slowest modes of Beck's column: by how much their eigenvalues are real and apart, and the frequency in the middle.
fn two_slowest(thrust: f64, elements: usize) -> (f64, f64) {
    let mut vibration = Vibration::new(beck(thrust, elements).unwrap().into(), 1.0 / BECK.1).unwrap();
    let shape = |power: i32| -> Vec<Vec6> {
        let along = |i| (i as f64 / elements as f64).powi(power);
        (0..=elements).map(|i| Vec6::new(Vec3::ZERO, Vec3::X * along(i))).collect()
    };
    let mut basis = [shape(2), shape(4)];
    let mut matrix = [[0.0; 2]; 2];
    for _ in 0..14 {
        for k in 0..2 {
            if k == 1 {
                let along = vibration.product(&basis[0], &basis[1]);
                let [first, second] = &mut basis;
                second.iter_mut().zip(first).for_each(|(v, of)| *v -= *of * along);
            }
            let size = vibration.product(&basis[k], &basis[k]).sqrt();
            basis[k].iter_mut().for_each(|v| *v = *v * (1.0 / size));
        }
        let next = [0, 1].map(|k| vibration.response(&basis[k]).unwrap());
        matrix = [0, 1].map(|i| [0, 1].map(|j| vibration.product(&basis[i], &next[j])));
        basis = next;
    }
    let [[a, b], [c, d]] = matrix;
    let apart = 0.25 * (a - d) * (a - d) + b * c;
    (apart, vibration.square_of_frequency(0.5 * (a + d)).sqrt())
}

#[test]
fn becks_column_flutters() {
    let flutter = |elements: usize| {
        let (mut low, mut high) = (19.5, 20.5);
        let mut at = [low, high].map(|thrust| two_slowest(thrust, elements).0);
        assert!(at[0] > 0.0 && at[1] < 0.0, "{at:?}");
        // What is under the root is nearly a line.
        for _ in 0..4 {
            let next = low - at[0] * (high - low) / (at[1] - at[0]);
            (low, at[0]) = (high, at[1]);
            (high, at[1]) = (next, two_slowest(next, elements).0);
        }
        (high, two_slowest(high, elements).1)
    };
    let [(coarse, slow), (fine, fast)] = [50, 100].map(flutter);
    let beyond = [(4.0 * fine - coarse) / 3.0 / BECK.0 - 1.0, (4.0 * fast - slow) / 3.0 / BECK.1 - 1.0];
    assert!(beyond.iter().all(|error| error.abs() < 1e-5), "{beyond:?}");
}
