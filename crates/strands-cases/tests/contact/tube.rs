//! A heavy rod in a horizontal tube that is pressed together: it snakes along the bottom, and coils.

use super::set_up::{EULER, Thread, at_rest, framed, free};
use core::f64::consts::PI;
use strands::assembly::Assembly;
use strands::contact::{Obstacle, Shape, Surfaces};
use strands::dynamics::{Settings, Simulation, Start, State};
use strands::load::NodalLoads;
use strands::math::Vec3;
use strands::statics::{Problem, Support};

/// Its stiffness against bending is 1 N·m², its weight 2 N/m, and it may go aside by 10 mm.
const ROD: Thread = Thread { radius: 2e-3, modulus: 1.0 / (PI * 4e-12), poisson: 0.3, density: 8000.0 };
const WEIGHT: f64 = 2.0;
const CLEARANCE: f64 = 0.01;

/// Where it comes to rest under a load, N, from where it has such an angle about the tube's axis from the bottom along it. Its ends are held at the bottom, and one slides.
fn pressed(load: f64, length: f64, elements: usize, angle: impl Fn(f64) -> f64) -> Simulation {
    let place = |i: usize| {
        let z = length * i as f64 / elements as f64;
        let (sin, cos) = angle(z).sin_cos();
        Vec3::new(-CLEARANCE * cos, CLEARANCE * sin, z)
    };
    let poses = framed(&(0..=elements).map(place).collect::<Vec<Vec3>>(), Vec3::X);
    let rod = ROD.rod(poses[0], &[(length, elements)]);
    let gravity = Vec3::X * (-WEIGHT * length / rod.mass());
    let mut loads = NodalLoads::none(&rod).with_gravity(&rod, gravity);
    loads.world[elements].linear += Vec3::Z * -load;
    let start = Support::pinned(poses[0]);
    let end = Support::pinned(poses[elements]).sliding_along(Vec3::Z);
    let mut assembly: Assembly = Problem { loads, start, end, ..free(rod) }.into();
    assembly.surfaces = Some(Surfaces { friction: 0.0 });
    let shape = Shape::Bore { point: Vec3::ZERO, axis: Vec3::Z, radius: CLEARANCE + 1.012 * ROD.radius };
    assembly.obstacles = vec![Obstacle { shape, friction: None, body: None, tissue: None }];
    let mut state = at_rest(&assembly, poses);
    // What swings across the bottom takes 0.2 s, bending less.
    for (time_step, steps) in [(1e-4, 10), (1e-3, 10), (1e-2, 20), (0.1, 40), (1.0, 40), (10.0, 20)] {
        let settings = Settings { time_step, mass_damping: 0.1 / time_step, ..EULER };
        let start = Start::State(Box::new(State { time: 0.0, ..state }));
        let mut simulation = Simulation::new(assembly.clone(), settings, start).unwrap();
        for k in 0..steps {
            simulation.step().unwrap_or_else(|failure| panic!("steps of {time_step} s, {k}: {failure}"));
        }
        state = simulation.state().clone();
    }
    let rests = Start::State(Box::new(state));
    Simulation::new(assembly, EULER, rests).unwrap()
}

/// `2 √(EI w/c)`.
fn critical() -> f64 {
    2.0 * (WEIGHT / CLEARANCE).sqrt()
}

/// Dawson and Paslay 1984: `F = EI k² + w/(c k²)` keeps a wave of a wave number `k` in equilibrium; the least is at `k⁴ = w/(EI c)`.
#[test]
fn a_heavy_rod_in_a_tube_snakes_from_a_load_on() {
    let wave = (CLEARANCE / WEIGHT).powf(0.25);
    for (over, snakes) in [(0.98, false), (1.02, true)] {
        // Its ends are where the wave is at the bottom.
        let simulation = pressed(over * critical(), 6.0 * PI * wave, 72, |z| 0.05 * (z / wave).sin());
        let aside = simulation.state().poses.iter().map(|pose| pose.position.y.abs());
        let aside = aside.fold(0.0, f64::max) / CLEARANCE;
        println!("{over}: {aside:.4} aside");
        assert!(if snakes { aside > 0.1 } else { aside < 1e-3 }, "{over}: {aside}");
    }
}

/// Chen, Lin and Cheatham 1990: from `2 √2 √(EI w/c)` on a long rod has less energy coiled, with `k² = F/2EI`, than straight. What the ends add goes with two lengths.
#[test]
fn a_heavy_rod_in_a_tube_coils_from_a_load_on() {
    let energy = |load: f64, turns: usize| {
        let k = (0.5 * load).sqrt();
        let (length, elements) = (2.0 * PI * turns as f64 / k, 24 * turns);
        let of = |simulation: Simulation| simulation.energy().elastic + simulation.energy().load;
        let coiled = pressed(load, length, elements, |z| k * z);
        let highest = coiled.state().poses.iter().map(|pose| pose.position.x).fold(-1.0, f64::max);
        assert!(highest > 0.98 * CLEARANCE, "{load} N, {turns} turns: {highest}");
        (of(coiled) - of(pressed(load, length, elements, |_| 0.0)), length)
    };
    let [less, more] = [0.95, 1.05].map(|over| {
        let load = over * 2.0_f64.sqrt() * critical();
        let [(short, a), (long, b)] = [6, 12].map(|turns| energy(load, turns));
        (long - short) / (b - a) / (WEIGHT * CLEARANCE)
    });
    let from = 0.95 + 0.1 * less / (less - more);
    println!("it coils from {from:.4} of the load; there it has {less:.4} and {more:.4} of `w c`");
    assert!((from - 1.0).abs() < 0.04, "{from}");
}
