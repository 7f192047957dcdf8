//! The scene of a stitch, from the first pass to where it holds.

use strands::contact::Through;
use strands::dynamics::Start;
use strands_scene::{Scene, bundled_scene};

#[test]
fn a_stitch_of_three_passes_is_pulled_closed_and_holds() {
    let model = Scene::parse(bundled_scene("stitch").unwrap().text, "stitch.toml", None).unwrap().model;
    let mut simulation = model.simulation(model.motion(), Start::Rest).unwrap();
    let first = simulation.assembly().first_body();
    let apart = |poses: &[strands::math::Pose]| poses[first + 1].position.x - poses[first].position.x;
    let gap = |poses: &[strands::math::Pose]| apart(poses) - 0.010;
    assert!((gap(&simulation.state().poses) - 2e-3).abs() < 1e-9);
    while !simulation.has_come_to(3.5) {
        simulation.step().unwrap();
    }
    // In at the top and out at the side of the one edge, in at the side and out at the top of the other, three times.
    let passages = simulation.state().passages.clone();
    let ways: Vec<(usize, bool)> = passages
        .iter()
        .map(|passage| match passage.through {
            Through::Into { obstacle, .. } => (obstacle, true),
            Through::OutOf { obstacle, .. } => (obstacle, false),
            Through::Eyelet(_) => panic!("there is no eyelet"),
        })
        .collect();
    assert_eq!(ways, [(0, true), (0, false), (1, true), (1, false)].repeat(3));
    // The last hole is the one nearest to the thread's start.
    assert!(passages.windows(2).all(|pair| pair[1].at < pair[0].at));
    let closed = gap(&simulation.state().poses);
    assert!((0.0..6e-4).contains(&closed), "{closed:e}");
    while !simulation.has_come_to(4.0) {
        simulation.step().unwrap();
    }
    for (now, before) in simulation.state().passages.iter().zip(&passages) {
        assert!((now.at - before.at).abs() < 1e-6, "{} {}", now.at, before.at);
    }
    let held = gap(&simulation.state().poses);
    assert!((held - closed).abs() < 1e-5, "{held:e} {closed:e}");
}
