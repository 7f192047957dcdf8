//! What motion costs.

use std::hint::black_box;
use std::time::Instant;

use strands::assembly::Assembly;
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands_cases::swinging::{FINE_WIRE, LONG_WIRE, LONG_WIRE_TIP, SUTURE, Swinging, TUBE};
use strands_cases::{falling, net};
use strands_scene::Scene;

use super::{BenchError, ELEMENTS, Figure, clock, figure};

/// All of it.
pub(super) fn motion() -> Result<Vec<Figure>, BenchError> {
    let mut figures = falls()?;
    figures.extend(swings()?);
    figures.extend(bounded()?);
    figures.extend(comes_to_rest()?);
    figures.extend(networks()?);
    Ok(figures)
}

/// The wire falls: the workload W-F of the peers.
fn falls() -> Result<Vec<Figure>, BenchError> {
    let fall = |integrator, elements, time_step| -> Result<Simulation, BenchError> {
        let settings = Settings { integrator, time_step, ..Settings::default() };
        Ok(Simulation::new(falling::problem(elements)?, settings, Start::Rest)?)
    };
    let mut figures = Vec::new();
    for integrator in [Integrator::Bdf2, Integrator::Midpoint, Integrator::Sdirk4] {
        let mut simulation = fall(integrator, ELEMENTS, 2e-3)?;
        let (mut times, mut squares) = (Vec::new(), 0.0);
        while times.len() < 500 {
            let start = Instant::now();
            let step = black_box(simulation.step()?);
            times.push(start.elapsed().as_secs_f64());
            let tip = simulation.state().poses[ELEMENTS].position.x;
            squares += (tip / falling::sag() - falling::sunk(step.time)).powi(2);
        }
        let error = (squares / times.len() as f64).sqrt();
        let name = format!("motion.{}", integrator.name());
        figures.push(figure(name.clone(), clock::quantile(&mut times, 0.5) * 1e6, "µs"));
        figures.push(figure(format!("{name}.error"), error * 100.0, "%"));
    }
    for (elements, steps) in [(100, 500), (1_000, 50), (10_000, 5)] {
        let mut simulation = fall(Integrator::Bdf2, elements, 1e-3)?;
        simulation.step()?;
        let (start, mut iterations) = (Instant::now(), 0);
        for _ in 0..steps {
            iterations += black_box(simulation.step()?).iterations;
        }
        let scalars = iterations as f64 * 6.0 * (elements + 1) as f64;
        let time = start.elapsed().as_secs_f64() * 1e9 / scalars;
        figures.push(figure(format!("motion.iteration.{elements}"), time, "ns"));
    }
    Ok(figures)
}

/// Thin rods swing, undamped.
fn swings() -> Result<Vec<Figure>, BenchError> {
    let rods: [(&Swinging, usize, &str); 6] = [
        (&SUTURE, 25, "25"),
        (&SUTURE, 50, "50"),
        (&SUTURE, 100, "100"),
        (&SUTURE, 200, "200"),
        (&FINE_WIRE, 100, "fine_wire"),
        (&TUBE, 100, "tube"),
    ];
    let mut figures = Vec::new();
    for (rod, elements, name) in rods {
        let mut simulation = Simulation::new(rod.problem(elements)?, Settings::default(), Start::Rest)?;
        let start = Instant::now();
        black_box(simulation.advance(1.0)?);
        figures.push(figure(
            format!("motion.swing.{name}"),
            simulation.state().time / start.elapsed().as_secs_f64(),
            "times real time",
        ));
    }
    Ok(figures)
}

/// Steps of bounded cost.
fn bounded() -> Result<Vec<Figure>, BenchError> {
    let settings = Settings { bounded: true, max_iterations: 2, ..Settings::default() };
    let mut simulation = Simulation::new(SUTURE.problem(200)?, settings, Start::Rest)?;
    let mut times = Vec::with_capacity(60_000);
    for _ in 0..60_000 {
        let start = Instant::now();
        black_box(simulation.step()?);
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let parts = [("median", 0.5), ("p999", 0.999), ("worst", 1.0)];
    let of = |(name, part)| figure(format!("motion.bounded.{name}"), clock::quantile(&mut times, part), "ms");
    Ok(parts.map(of).into())
}

/// A long wire comes to rest in steps as long as its motion lets them be.
fn comes_to_rest() -> Result<Vec<Figure>, BenchError> {
    let mass_damping = 2.0 * LONG_WIRE.first_frequency();
    let settings = Settings { time_step: 0.05, mass_damping, ..Settings::default() };
    let mut simulation = Simulation::new(LONG_WIRE.problem(ELEMENTS)?, settings, Start::Rest)?;
    let (start, mut rests_since, mut error) = (Instant::now(), None, 1.0);
    while simulation.state().time < 6.0 {
        simulation.step()?;
        let tip = simulation.state().poses[ELEMENTS].position;
        error = (tip.z - LONG_WIRE_TIP[0]).hypot(tip.x - LONG_WIRE_TIP[1]) / LONG_WIRE_TIP[1];
        if error > 1e-3 {
            rests_since = None;
        } else if rests_since.is_none() {
            rests_since = Some(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    let rest = rests_since.unwrap_or(f64::NAN);
    Ok(vec![figure("motion.rest", rest, "ms"), figure("motion.rest.error", error, "")])
}

/// Rods that are tied.
fn networks() -> Result<Vec<Figure>, BenchError> {
    let willow = Scene::parse(include_str!("../../../../scenes/willow.toml"), "willow.toml", None)?.model;
    let step = |name: &str, assembly: Assembly, settings: Settings| -> Result<Figure, BenchError> {
        let mut simulation = Simulation::new(assembly, settings, Start::Rest)?;
        let mut times = Vec::new();
        for _ in 0..50 {
            let start = Instant::now();
            black_box(simulation.step()?);
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        Ok(figure(name, clock::quantile(&mut times, 0.5), "ms"))
    };
    Ok(vec![
        step("motion.tree", willow.assembly(), willow.motion())?,
        step("motion.net", net::net(20, 2)?, Settings { time_step: 2e-3, ..Settings::default() })?,
    ])
}
