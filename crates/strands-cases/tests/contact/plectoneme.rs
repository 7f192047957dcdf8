//! A thread that is pulled and twisted, and winds around itself.
//!
//! Clauvelin, Audoly and Neukirch (Biophys. J. 96:3716, 2009): where straight tails and a ply of two strands are beside each other, which touch along a line without friction, the angle `α` of strands to
//! the ply's axis follows from the tension, `T r²/B = sin⁴α (1/2 + 1/cos 2α)`, and so do the twisting moment, `M r/B = 2 sin³α cos α/cos 2α`, and how hard strands press each other on
//! their length, `p r³/B = sin⁴α/cos 2α`; a turn more makes it shorter by `4πr/sin 2α` and changes none of these.

use super::set_up::{EULER, Thread, at_rest, framed, free, least_distance};
use super::shapes::plectoneme;
use core::f64::consts::{PI, TAU};
use strands::assembly::{Assembly, Member};
use strands::contact::Surfaces;
use strands::dynamics::{Settings, Simulation, Start, State};
use strands::load::NodalLoads;
use strands::math::{Quat, Vec3};
use strands::statics::{Problem, Support};

const THREAD: Thread = Thread { radius: 1e-3, modulus: 2.55e9, poisson: 0.25, density: 1000.0 };

/// A thread that has wound around itself, in equilibrium: its twisting moment, N·m, the angle of its strands, how hard they press each other, N/m, and where its end is, m.
struct Wound {
    moment: f64,
    alpha: f64,
    pressure: f64,
    end: f64,
}

/// Where it rests under a tension, N, when the end of a thread that is wound already, but is not twisted, is turned by so many turns.
fn wound(alpha: f64, tension: f64, turns: f64) -> Wound {
    let (r, bending) = (THREAD.radius, THREAD.bending());
    let bent = (bending / tension).sqrt();
    let line = plectoneme(alpha, 4.0, 8.0 * bent, 0.7 * bent, r);
    let elements = (line.length() / (1.5 * r)).round() as usize;
    let place = |i: usize| line.at(line.length() * i as f64 / elements as f64);
    let poses = framed(&(0..=elements).map(place).collect::<Vec<Vec3>>(), Vec3::X);
    let rod = THREAD.rod(poses[0], &[(line.length(), elements)]);
    let mut loads = NodalLoads::none(&rod);
    loads.world[elements].linear += Vec3::Z * tension;
    let start = Support::clamped(poses[0]);
    let end = Support::clamped(poses[elements]).sliding_along(Vec3::Z);
    let mut assembly: Assembly = Problem { loads, start, end, ..free(rod) }.into();
    assembly.surfaces = Some(Surfaces { friction: 0.0 });
    let last = Member::Node { rod: 0, node: elements };
    let slow = bent * bent * (THREAD.density * PI * r * r / bending).sqrt();
    let mut state = at_rest(&assembly, poses);
    let mut moment = 0.0;
    // It is made smooth, turned, and comes to rest.
    for (step, steps, turned) in [
        (1e-5, 20, 0.0),
        (1e-4, 20, 0.0),
        (1e-3, 20, 0.0),
        (1e-2, 20, 0.0),
        (0.1, 20, 0.0),
        (0.2, 100, turns),
        (1.0, 80, 0.0),
        (10.0, 20, 0.0),
        (1e3, 10, 0.0),
    ] {
        let settings = Settings { time_step: step * slow, mass_damping: 0.1 / (step * slow), ..EULER };
        let start = Start::State(Box::new(State { time: 0.0, ..state }));
        let mut simulation = Simulation::new(assembly.clone(), settings, start).unwrap();
        for k in 0..steps {
            let turn = Vec3::Z * (TAU * turned / steps as f64);
            let pose = &mut simulation.support_mut(last).unwrap().pose;
            pose.rotation = Quat::from_rotation_vector(turn).to_matrix() * pose.rotation;
            simulation.step().unwrap_or_else(|failure| panic!("steps of {step}, {k}: {failure}"));
        }
        moment = simulation.reaction(last).angular.z;
        (assembly, state) = (simulation.assembly().clone(), simulation.state().clone());
    }
    let least = least_distance(&[&state.poses], 4) / r;
    assert!((2.0..2.02).contains(&least), "{least}");
    let aside = |place: Vec3| Vec3::new(place.x, place.y, 0.0);
    let tips = state.poses.iter().map(|pose| aside(pose.position));
    let tip = tips.max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap();
    let axis = tip.normalized().unwrap();
    // A part of it where neither end is near.
    let (from, to) = (0.3 * tip.norm(), 0.6 * tip.norm());
    let within = |place: Vec3| (from..to).contains(&place.dot(axis));
    // Of the axis, which shear turns against the sections by a tenth of this.
    let cosines: Vec<f64> = (state.poses.windows(2))
        .filter(|pair| within(pair[0].position))
        .map(|pair| (pair[1].position - pair[0].position).normalized().unwrap().dot(axis).abs())
        .collect();
    let cosine = cosines.iter().sum::<f64>() / cosines.len() as f64;
    let pressing = state.contacts.iter().filter(|contact| within(contact.point));
    let force: f64 = pressing.map(|contact| contact.force.norm()).sum();
    let end = state.poses[elements].position.z;
    Wound { moment, alpha: cosine.acos(), pressure: force * cosine / (to - from), end }
}

#[test]
fn a_twisted_thread_winds_around_itself_as_clauvelin_and_others_say() {
    let (r, bending) = (THREAD.radius, THREAD.bending());
    for degrees in [15.0_f64, 20.0] {
        let alpha = degrees.to_radians();
        let ((sin, cos), double) = (alpha.sin_cos(), (2.0 * alpha).cos());
        let tension = bending / (r * r) * sin.powi(4) * (0.5 + 1.0 / double);
        let moment = 2.0 * bending / r * sin.powi(3) * cos / double;
        let pressure = bending / r.powi(3) * sin.powi(4) / double;
        let shorter = 2.0 * TAU * r / (2.0 * alpha).sin();
        // The ply is such that these turns do not unwind it.
        let turns = [3.5, 5.0];
        let found = turns.map(|turns| wound(alpha, tension, -turns));
        let per_turn = (found[0].end - found[1].end) / (turns[1] - turns[0]);
        println!("{degrees}°: shorter by {:.4} for a turn", per_turn / shorter);
        assert!((per_turn / shorter - 1.0).abs() < 0.04, "{degrees}°: {per_turn} for {shorter}");
        for wound in found {
            let over = [-wound.moment / moment, wound.alpha / alpha, wound.pressure / pressure];
            println!("{degrees}°: {over:.4?} of moment, angle and pressure");
            assert!((over[0] - 1.0).abs() < 0.02, "{degrees}°: {over:?}");
            assert!((over[1] - 1.0).abs() < 0.03 && (over[2] - 1.0).abs() < 0.03, "{degrees}°: {over:?}");
        }
    }
}
