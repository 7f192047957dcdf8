//! The scenes of `examples`: each is read and sets off.

use std::path::Path;
use strands_scene::Scene;

#[test]
fn every_example_sets_off() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let name = path.display();
        let model = Scene::read(&path).unwrap_or_else(|error| panic!("{error}")).model;
        let mut simulation = model
            .simulation(model.motion(), model.start().unwrap())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        for step in 0..5 {
            simulation.step().unwrap_or_else(|failure| panic!("{name}, step {step}: {failure}"));
        }
        assert!(simulation.state().contacts.iter().all(|contact| contact.gap > 0.0), "{name}");
        read += 1;
    }
    assert!(read >= 4);
}
