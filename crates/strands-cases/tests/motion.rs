//! Rods that move, against what is known of their motion.

use strands::dynamics::{Integrator, Settings, Simulation, Start, Step, StepFailure};
use strands::math::Pose;
use strands::statics::{Problem, Support};
use strands_cases::falling;
use strands_cases::swinging::{FINE_WIRE, LONG_HAIR, LONG_WIRE, LONG_WIRE_TIP, SUTURE, Swinging, TUBE};

#[test]
fn a_straight_rod_that_weight_begins_to_act_on_swings_as_its_modes_do() {
    // 0.2 % are the rod's own, which bends by a twentieth of its length.
    for (time_step, integrator) in [
        (2e-3, Integrator::Sdirk4),
        (1e-3, Integrator::Sdirk4),
        (5e-4, Integrator::Sdirk4),
        (1e-4, Integrator::Bdf2),
    ] {
        let settings = Settings { integrator, time_step, ..Settings::default() };
        let mut simulation = Simulation::new(falling::problem(100).unwrap(), settings, Start::Rest).unwrap();
        let (mut sum, mut steps) = (0.0, 0);
        while simulation.state().time < 0.9995 {
            let time = simulation.step().unwrap().time;
            let tip = simulation.state().poses[100].position.x / falling::sag();
            sum += (tip - falling::sunk(time)).powi(2);
            steps += 1;
        }
        let error = (sum / f64::from(steps)).sqrt();
        assert!(error < 5e-3, "{} at {time_step}: {error}", integrator.name());
    }
}

/// Swings for ten seconds at a millisecond a step, undamped; gives the part of its amplitude that is left.
fn amplitude_left(rod: &Swinging, elements: usize, integrator: Integrator) -> f64 {
    let settings = Settings { integrator, time_step: 1e-3, ..Settings::default() };
    let problem = rod.problem(elements).unwrap();
    let rest = Simulation::new(problem.clone(), settings, Start::Equilibrium).unwrap().energy().total();
    let mut simulation = Simulation::new(problem, settings, Start::Rest).unwrap();
    let began = simulation.energy().total() - rest;
    while simulation.state().time < 9.9995 {
        assert_eq!(simulation.step().unwrap().pieces, 1);
        let moved = simulation.state().poses.iter().all(|pose| pose.position.norm() < 1.001 * rod.length);
        assert!(moved, "{} grows", rod.name);
    }
    ((simulation.energy().total() - rest) / began).sqrt()
}

#[test]
fn thin_rods_swing_for_ten_seconds_and_keep_their_amplitude() {
    for (rod, elements) in
        [(&SUTURE, 25), (&SUTURE, 50), (&SUTURE, 100), (&SUTURE, 200), (&FINE_WIRE, 100), (&TUBE, 100)]
    {
        let left = amplitude_left(rod, elements, Integrator::Midpoint);
        assert!((left - 1.0).abs() < 1e-6, "{} of {elements} elements: {left}", rod.name);
    }
    // The others lose what is faster than their steps, and gain nothing but SDIRK4's own error, of either sign.
    for (rod, integrator, least, most) in [
        (&SUTURE, Integrator::Sdirk4, 0.9999, 1.000_01),
        (&FINE_WIRE, Integrator::Sdirk4, 0.9999, 1.000_01),
        (&SUTURE, Integrator::Bdf2, 0.99, 1.0),
        (&FINE_WIRE, Integrator::Bdf2, 0.98, 1.0),
        (&FINE_WIRE, Integrator::GeneralizedAlpha { spectral_radius: 0.5 }, 0.99, 1.0),
        (&TUBE, Integrator::Bdf2, 0.99, 1.0),
    ] {
        let left = amplitude_left(rod, 50, integrator);
        assert!((least..=most).contains(&left), "{}, {}: {left}", rod.name, integrator.name());
    }
}

#[test]
fn a_long_wire_comes_to_rest_where_it_should() {
    let settings = Settings {
        integrator: Integrator::Bdf2,
        time_step: 0.05,
        mass_damping: 2.0 * LONG_WIRE.first_frequency(),
        ..Settings::default()
    };
    let mut simulation = Simulation::new(LONG_WIRE.problem(100).unwrap(), settings, Start::Rest).unwrap();
    simulation.advance(6.0).unwrap();
    let tip = simulation.state().poses[100].position;
    let error = (tip.z - LONG_WIRE_TIP[0]).hypot(tip.x - LONG_WIRE_TIP[1]) / LONG_WIRE_TIP[1];
    assert!(error < 1e-4, "{error:e}: {tip:?}");
}

/// Lets a hair fall for a second, in which its end comes round; gives the most energy that it ever gains, over its weight times its length, and how the last
/// step went.
fn falls(hair: &Problem, start: Support, settings: Settings) -> (f64, Result<Step, StepFailure>) {
    let problem = Problem { start, ..hair.clone() };
    let fall = 9.81 * problem.rod.mass() * LONG_HAIR.length;
    let mut simulation = Simulation::new(problem, settings, Start::Rest).unwrap();
    let began = simulation.energy().total();
    let mut gained = 0.0_f64;
    loop {
        let step = simulation.step();
        gained = gained.max((simulation.energy().total() - began) / fall);
        match step {
            Ok(step) if step.time < 1.0 => {}
            last => return (gained, last),
        }
    }
}

#[test]
fn a_long_hair_that_cracks_as_a_whip_stays_whole() {
    for start in [Support::clamped(Pose::IDENTITY), Support::pinned(Pose::IDENTITY)] {
        let hair = LONG_HAIR.problem(100).unwrap();
        let (gained, last) = falls(&hair, start.clone(), Settings::default());
        assert!(gained < 0.02 && last.is_ok(), "{gained:e}, {last:?}");
        // Where a step may not cost more it fails before it goes astray.
        let settings = Settings { max_iterations: 4, bounded: true, ..Settings::default() };
        let (gained, last) = falls(&hair, start.clone(), settings);
        assert!(gained < 0.1, "{gained:e}, {last:?}");
        // One that does not stretch: against a turn about its own axis it has next to nothing.
        let hair = LONG_HAIR.inextensible(400).unwrap();
        for integrator in [Integrator::Bdf2, Integrator::Sdirk4] {
            let settings = Settings { integrator, ..Settings::default() };
            let (gained, last) = falls(&hair, start.clone(), settings);
            assert!(gained < 0.02 && last.is_ok(), "{}: {gained:e}, {last:?}", integrator.name());
        }
    }
}
