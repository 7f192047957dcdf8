//! What rods pass through.

use super::contact::{EULER, free, suture};
use super::rod;
use crate::assembly::{Assembly, Body, Member, Strand};
use crate::contact::{End, Eyelet, Hold, Obstacle, Shape, Surfaces, Through, Tissue};
use crate::dynamics::{Settings, Simulation, Start};
use crate::math::{Mat3, Pose, Vec3, Vec6, Wrench};
use crate::rod::{Kinematics, Material, NodeInertia};
use crate::statics::{Problem, Support};

const HOLD: Hold = Hold { stiffness: 200.0, friction: 0.0, grip: 0.01 };

fn simulation(assembly: Assembly, settings: Settings) -> Simulation {
    Simulation::new(assembly, settings, Start::Rest).unwrap()
}

/// A suture along z from the origin, in the middle of which is an eyelet, pulled along at its end.
fn threaded(hold: Hold, pull: f64) -> Simulation {
    let mut problem = free(suture(40), Pose::IDENTITY, Vec3::ZERO);
    problem.loads.world[40] += Wrench::new(Vec3::ZERO, Vec3::Z * pull);
    let strand = Strand { viscosity: 1e-3, ..problem.into() };
    let place = Vec3::Z * 0.05125;
    let assembly = Assembly {
        surfaces: Some(Surfaces { friction: 0.0 }),
        eyelets: vec![Eyelet { rod: 0, at: 0.05125, place, body: None, hold }],
        ..strand.into()
    };
    simulation(assembly, EULER)
}

#[test]
fn a_thread_sticks_in_an_eyelet_or_slides_through_it() {
    let mut sticks = threaded(HOLD, 0.009);
    for _ in 0..300 {
        sticks.step().unwrap();
    }
    let state = sticks.state();
    assert_eq!(state.passages[0].at, 0.05125);
    assert!((state.passages[0].force + Vec3::Z * 0.009).norm() < 1e-6, "{:?}", state.passages[0].force);
    let fastest = state.velocities.iter().map(|velocity| velocity.linear.norm()).fold(0.0, f64::max);
    assert!(fastest < 1e-6, "{fastest:e}");

    let mut slides = threaded(HOLD, 0.012);
    let mut was = 0.0;
    let (mut before, began) = (slides.energy().total(), slides.state().passages[0].at);
    for step in 0..20 {
        if step == 10 {
            let (momentum, _) = slides.momentum();
            was = momentum.z;
        }
        slides.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        let total = slides.energy().total();
        assert!(total < before + 1e-7, "step {step}: {total:e} after {before:e}");
        before = total;
    }
    let (momentum, _) = slides.momentum();
    let (gained, pushed) = (momentum.z - was, (0.012 - 0.01) * 0.01);
    assert!((gained / pushed - 1.0).abs() < 1e-3, "{gained} for {pushed}");
    let moved = slides.state().poses[20].position.z - 0.05;
    let slid = began - slides.state().passages[0].at;
    assert!((slid - moved).abs() < 1.1 * 0.01 / 200.0, "{slid} {moved}");
}

#[test]
fn a_thread_that_is_pulled_through_an_eyelet_slides_out_of_it() {
    let mut slides = threaded(HOLD, 0.03);
    for step in 0..60 {
        slides.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
    }
    assert!(slides.state().passages.is_empty());
}

/// Over an eyelet at a right angle a thread slides where `(T₂ − T₁) cos 45° > μ (T₂ + T₁) sin 45°`: with μ = 0.3 where one tension is 13/7 of the other.
#[test]
fn friction_in_an_eyelet_is_of_what_presses_to_its_side() {
    let (friction, light) = (0.3, 1e-3);
    let soft = Material::from_poisson(20e6, 0.4, 1300.0).unwrap();
    let thread = || rod(0.1, 0.1e-3, soft, Kinematics::Cosserat, 60);
    for (heavy, slides) in [(1.7e-3, false), (2.0e-3, true)] {
        let mut problem = free(thread(), Pose::IDENTITY, Vec3::ZERO);
        // It hangs over from the start's side to the end's.
        problem.loads.world[0] += Wrench::new(Vec3::ZERO, (Vec3::X - Vec3::Z) * (light / 2.0_f64.sqrt()));
        problem.loads.world[60] += Wrench::new(Vec3::ZERO, (Vec3::X + Vec3::Z) * (light / 2.0_f64.sqrt()));
        let strand = Strand { viscosity: 2e-3, ..problem.into() };
        let hold = Hold { stiffness: 20.0, friction, grip: 0.0 };
        let assembly = Assembly {
            surfaces: Some(Surfaces { friction: 0.0 }),
            eyelets: vec![Eyelet { rod: 0, at: 0.0508, place: Vec3::Z * 0.0508, body: None, hold }],
            ..strand.into()
        };
        let mut simulation = simulation(assembly, Settings { mass_damping: 500.0, ..EULER });
        for step in 0..1000 {
            if step == 400 {
                let load = Wrench::new(Vec3::ZERO, (Vec3::X + Vec3::Z) * (heavy / 2.0_f64.sqrt()));
                simulation.assembly_mut().strands[0].problem.loads.world[60] = load;
            }
            simulation.step().unwrap_or_else(|failure| panic!("{heavy}, step {step}: {failure}"));
            if simulation.state().passages.is_empty() {
                break;
            }
        }
        let has_slid = simulation.state().passages.is_empty();
        assert_eq!(has_slid, slides, "{heavy}: {:?}", simulation.state().passages);
    }
}

/// A thread and a body with an eyelet on it, both free: what one gets the other loses.
#[test]
fn a_thread_that_slides_through_an_eyelet_of_a_body_gives_it_what_it_loses() {
    let strand = Strand { viscosity: 1e-3, ..free(suture(40), Pose::IDENTITY, Vec3::ZERO).into() };
    let mass = strand.problem.rod.mass();
    let inertia = NodeInertia { mass, rotational: Vec3::new(1e-9, 1e-9, 1e-9) };
    let beside = Pose { position: Vec3::new(2e-3, 0.0, 0.05), ..Pose::IDENTITY };
    let hold = Hold { stiffness: 50.0, friction: 0.3, grip: 2e-3 };
    let place = Vec3::new(-2e-3, 0.0, 0.0);
    let assembly = Assembly {
        bodies: vec![Body::new(inertia, beside)],
        surfaces: Some(Surfaces { friction: 0.0 }),
        eyelets: vec![Eyelet { rod: 0, at: 0.05, place, body: Some(0), hold }],
        ..strand.into()
    };
    let mut simulation = simulation(assembly, EULER);
    let velocities: Vec<Vec6> = (0..42)
        .map(|frame| Vec6::new(Vec3::ZERO, if frame < 41 { Vec3::new(0.05, 0.0, 0.3) } else { Vec3::ZERO }))
        .collect();
    simulation.set_velocities(&velocities);
    let (linear, _) = simulation.momentum();
    let mut energy = simulation.energy().total();
    for step in 0..60 {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        let (now, _) = simulation.momentum();
        assert!((now - linear).norm() < 1e-9 * linear.norm(), "step {step}: {now:?} {linear:?}");
        let total = simulation.energy().total();
        assert!(total < energy + 1e-9, "step {step}: {total:e} {energy:e}");
        energy = total;
    }
    // In the end both go on together.
    let state = simulation.state();
    let apart = state.velocities[41].linear.z - state.velocities[20].linear.z;
    assert!(apart.abs() < 0.05 && state.velocities[41].linear.z > 0.1, "{apart}");
}

/// A block of tissue 10 mm high whose top is at z = 0.
fn tissue(pierced_by: f64) -> Obstacle {
    Obstacle {
        shape: Shape::block(Vec3::Z * -5e-3, [0.02, 0.02, 5e-3], [Vec3::X, Vec3::Y, Vec3::Z]),
        friction: None,
        body: None,
        tissue: Some(Tissue { pierced_by, hold: HOLD }),
    }
}

/// A needle of steel that stands above it, its start up, which is pushed down there.
fn needle() -> (Problem, f64) {
    let steel = Material::from_poisson(200e9, 0.3, 7850.0).unwrap();
    let needle = rod(0.03, 0.25e-3, steel, Kinematics::Cosserat, 15);
    let down = Mat3::from_cols(Vec3::X, -Vec3::Y, -Vec3::Z);
    let base = Pose { rotation: down, position: Vec3::Z * (0.03 + 0.3e-3) };
    let problem = free(needle, base, Vec3::ZERO);
    let guide = Support::clamped(base).sliding_along(Vec3::Z);
    (Problem { start: guide, ..problem }, 0.25e-3)
}

#[test]
fn a_needle_pierces_tissue_with_enough_force_and_comes_out_on_the_other_side() {
    let (problem, radius) = needle();
    let pushed = |force: f64| {
        let mut problem = problem.clone();
        problem.loads.world[0] += Wrench::new(Vec3::ZERO, Vec3::Z * -force);
        let assembly = Assembly {
            surfaces: Some(Surfaces { friction: 0.2 }),
            obstacles: vec![tissue(0.5)],
            ..problem.into()
        };
        simulation(assembly, Settings { mass_damping: 300.0, ..EULER })
    };
    let tip = |simulation: &Simulation| simulation.state().poses[15].position.z;
    let mut rests = pushed(0.4);
    for _ in 0..200 {
        rests.step().unwrap();
    }
    assert!(rests.state().passages.is_empty() && tip(&rests) > radius, "{}", tip(&rests));

    let mut pierces = pushed(0.6);
    for step in 0..400 {
        pierces.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        if tip(&pierces) < -0.012 {
            break;
        }
    }
    let passages = &pierces.state().passages;
    let [into, out] = &passages[..] else { panic!("{passages:?}, tip {}", tip(&pierces)) };
    assert_eq!(into.through, Through::Into { obstacle: 0, end: End::End, been_inside: true });
    assert_eq!(out.through, Through::OutOf { obstacle: 0, end: End::End });
    assert!((into.place.z - radius).abs() < 0.02 * radius, "{:?}", into.place);
    assert!((out.place.z + 0.01).abs() < 1e-9, "{:?}", out.place);
    // Between the holes is as much of the needle as the block is high.
    let between = out.at - into.at;
    assert!((between - 0.01 - radius).abs() < 2.0 * 0.01 / 200.0, "{between}");
}

#[test]
fn a_needle_is_drawn_right_through_tissue() {
    let (problem, _) = needle();
    let end = Support::pinned(problem.rod.rest_poses()[15]);
    let problem = Problem { start: Support::free(problem.rod.rest_poses()[0]), end, ..problem };
    let assembly = Assembly {
        surfaces: Some(Surfaces { friction: 0.2 }),
        obstacles: vec![tissue(5.0)],
        ..problem.into()
    };
    let mut simulation = simulation(assembly, Settings { mass_damping: 50.0, ..EULER });
    let held = Member::Node { rod: 0, node: 15 };
    let mut most = 0;
    for step in 0..600 {
        simulation.support_mut(held).unwrap().pose.position.z -= 0.1e-3;
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        most = most.max(simulation.state().passages.len());
    }
    let left = &simulation.state().passages;
    assert!(most == 2 && left.is_empty(), "{most}, {left:?}");
    assert!(simulation.state().poses.iter().all(|pose| pose.position.z < -0.01));
}

#[test]
fn a_thread_that_is_led_through_tissue_stays_there_and_is_drawn_out_again() {
    // Its end is led down through the block, and back up.
    let down = Mat3::from_cols(Vec3::X, -Vec3::Y, -Vec3::Z);
    let base = Pose { rotation: down, position: Vec3::Z * 0.1005 };
    let problem = free(suture(50), base, Vec3::ZERO);
    let end = Support::pinned(problem.rod.rest_poses()[50]);
    let strand = Strand { viscosity: 1e-3, ..Problem { end, ..problem }.into() };
    let assembly = Assembly {
        surfaces: Some(Surfaces { friction: 0.2 }),
        obstacles: vec![tissue(5.0)],
        ..strand.into()
    };
    let mut simulation = simulation(assembly, Settings { mass_damping: 50.0, ..EULER });
    let held = Member::Node { rod: 0, node: 50 };
    let lead = |simulation: &mut Simulation, by: f64, steps: usize| {
        for step in 0..steps {
            simulation.support_mut(held).unwrap().pose.position.z += by;
            simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
        }
    };
    lead(&mut simulation, -0.1e-3, 200);
    let passages = simulation.state().passages.clone();
    assert_eq!(passages.len(), 2, "{passages:?}");
    // Both holes grip it.
    let pull = simulation.reaction(held).linear.z;
    assert!((pull + 0.02).abs() < 2e-4, "{pull}");
    // Let go, it stays.
    lead(&mut simulation, 0.0, 100);
    let stays: Vec<f64> = simulation.state().passages.iter().map(|passage| passage.at).collect();
    lead(&mut simulation, 0.0, 300);
    for (passage, before) in simulation.state().passages.iter().zip(&stays) {
        assert!((passage.at - before).abs() < 1e-9, "{} {before}", passage.at);
    }
    // Its start draws it out again.
    let free = Support::free(simulation.state().poses[50]);
    *simulation.support_mut(held).unwrap() = free;
    simulation.assembly_mut().strands[0].problem.loads.world[0] += Wrench::new(Vec3::ZERO, Vec3::Z * 0.06);
    for step in 0..400 {
        simulation.step().unwrap_or_else(|failure| panic!("drawn, step {step}: {failure}"));
        if simulation.state().passages.is_empty() {
            return;
        }
    }
    panic!("{:?}", simulation.state().passages);
}
