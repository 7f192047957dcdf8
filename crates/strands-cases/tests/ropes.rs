//! Ropes that hardly bend, against what is known of strings.

use std::f64::consts::TAU;
use strands::assembly::Member;
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::load::NodalLoads;
use strands::math::{Vec3, Vec6};
use strands::statics::Support;
use strands_cases::ropes::{OF_FREE_FALL, SKIPPED, folded, skipped, speed_of_end};

#[test]
fn a_skipping_rope_turns_without_change() {
    for [length, away, tension] in SKIPPED {
        let settings =
            Settings { integrator: Integrator::Sdirk4, time_step: TAU / 400.0, ..Settings::default() };
        let mut simulation =
            Simulation::new(skipped(length, 100).unwrap(), settings, Start::Equilibrium).unwrap();
        let poses = simulation.state().poses.iter();
        let turning =
            poses.map(|pose| Vec6::new(pose.rotation.transpose_mul(Vec3::Z), Vec3::Z.cross(pose.position)));
        simulation.set_velocities(&turning.collect::<Vec<_>>());
        let problem = &mut simulation.assembly_mut().strands[0].problem;
        problem.loads = NodalLoads::none(&problem.rod);
        for _ in 0..400 {
            simulation.step().unwrap();
            let middle = simulation.state().poses[50].position;
            let now = middle.x.hypot(middle.y);
            assert!((now / away - 1.0).abs() < 0.01, "length {length}: {now} from the axis, not {away}");
        }
        let held = simulation.reaction(Member::Node { rod: 0, node: 0 }).linear.norm();
        assert!((held / tension - 1.0).abs() < 0.01, "length {length}: {held} N, not {tension}");
        let middle = simulation.state().poses[50].position;
        assert!(middle.x > 0.0 && middle.y.abs() < 0.01, "length {length}: {middle:?} after a turn");
    }
}

#[test]
fn a_folded_rope_falls_faster_than_freely() {
    let settings = Settings { integrator: Integrator::Sdirk4, time_step: 2e-3, ..Settings::default() };
    let mut simulation = Simulation::new(folded(200).unwrap(), settings, Start::Equilibrium).unwrap();
    let top = simulation.state().poses[200];
    simulation.assembly_mut().strands[0].problem.end = Support::free(top);
    let mut worst: f64 = 0.0;
    let time = loop {
        let time = simulation.step().unwrap().time;
        let (fallen, speed) =
            (simulation.state().poses[200].position.z, simulation.state().velocities[200].linear.z);
        if (0.1..0.9).contains(&fallen) {
            worst = worst.max((speed / speed_of_end(fallen) - 1.0).abs());
        }
        if fallen > 0.95 {
            break time;
        }
    };
    assert!(worst < 0.03, "{worst}");
    let part = time / 2.0_f64.sqrt() / OF_FREE_FALL;
    assert!((part - 1.0).abs() < 0.03, "{part}");
}
