//! A drum that winds up a cord.

use std::path::Path;
use strands::assembly::Member;
use strands::math::Vec3;
use strands_scene::Scene;

/// The first of its turns, in longer steps, of a cord that does not stretch.
#[test]
fn a_cord_that_is_wound_up_keeps_its_length() {
    const END: f64 = 0.6;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/winch.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("time_step = 2e-3", "time_step = 5e-3").replace("\"cosserat\"", "\"kirchhoff\"");
    let model = Scene::parse(&text, "winch.toml", None).unwrap().model;
    let mut simulation = model.simulation(model.motion(), model.start().unwrap()).unwrap();
    let rod = &model.rods[0].problem.rod;
    let last = rod.elements();
    let began = simulation.state().poses[last].position;
    for step in 0..120 {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
    }
    let state = simulation.state();
    assert!((state.time - END).abs() < 1e-9);
    for (i, pair) in state.poses[..=last].windows(2).enumerate() {
        let strain = pair[0].between(&pair[1]).log().linear * (1.0 / rod.element_length(i));
        assert!((strain - Vec3::Z).max_abs() < 1e-6, "element {i}: {strain:?}");
    }
    // A turn around the axis of a cord that lies on the drum, less what its elements cut off of it.
    let wound = began.x - state.poses[last].position.x;
    let turn = core::f64::consts::TAU * 21e-3;
    assert!((wound / turn - 1.0).abs() < 0.03, "{wound} m of {turn} m");
    // What is wound up is on the drum, its nodes where the chords of its elements meet.
    assert!(state.contacts.iter().all(|contact| contact.gap > 0.0));
    let drum = simulation.assembly().frame(Member::Body(1)).unwrap();
    let middle = state.poses[drum].position;
    for pose in &state.poses[..10] {
        let away = pose.position - middle;
        let apart = away.x.hypot(away.z);
        assert!(apart > 20.9e-3 && apart < 22.2e-3, "{apart} m");
    }
}
