//! The bundled scenes: each is read, solved from cold, and stands; those whose rods are tied come to rest together, and move.

use strands::dynamics::{Simulation, Start};
use strands::statics::{Workspace, solve};
use strands_scene::{Scene, bundled, bundled_scene};

#[test]
fn every_bundled_scene_converges_to_a_stable_equilibrium_from_cold() {
    for scene in bundled() {
        let Scene { model, .. } = Scene::parse(scene.text, scene.name, None).unwrap();
        assert_eq!(model.name, scene.name);
        if model.moves_only() {
            continue;
        }
        for rod in &model.rods {
            let solution = solve(&rod.problem, &model.settings, None, &mut Workspace::default());
            let solution = solution.unwrap_or_else(|failure| panic!("{}: {failure}", scene.name));
            println!(
                "{}: {} iterations, {} steps, morse {:?}, end {:?}",
                scene.name,
                solution.report.iterations,
                solution.report.path_steps,
                solution.report.morse_index,
                solution.guess.pose.position
            );
            assert!(solution.report.morse_index.is_none_or(|index| index == 0), "{} is unstable", scene.name);
            assert!(solution.imbalance(&rod.problem) < 1e-8, "{} is out of balance", scene.name);
        }
    }
}

#[test]
fn every_bundled_scene_of_tied_rods_comes_to_rest_and_moves_from_there() {
    let mut tied = 0;
    for scene in bundled() {
        let Scene { model, .. } = Scene::parse(scene.text, scene.name, None).unwrap();
        if model.each_alone().is_ok() || model.surfaces.is_some() {
            continue;
        }
        tied += 1;
        let mut simulation = Simulation::new(model.assembly(), model.motion(), Start::Equilibrium)
            .unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        for _ in 0..5 {
            simulation.step().unwrap_or_else(|failure| panic!("{}: {failure}", scene.name));
        }
        // Nothing has disturbed it yet.
        let kinetic = simulation.energy().kinetic;
        assert!(kinetic < 1e-9, "{}: {kinetic} J", scene.name);
    }
    assert_eq!(tied, 4);
}

#[test]
fn every_bundled_scene_of_what_touches_sets_off() {
    for scene in bundled() {
        let Scene { model, .. } = Scene::parse(scene.text, scene.name, None).unwrap();
        if model.surfaces.is_none() {
            continue;
        }
        let start = model.start().unwrap();
        let mut simulation =
            model.simulation(model.motion(), start).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        for _ in 0..5 {
            simulation.step().unwrap_or_else(|failure| panic!("{}: {failure}", scene.name));
        }
        assert!(simulation.state().contacts.iter().all(|contact| contact.gap > 0.0), "{}", scene.name);
    }
}

#[test]
fn a_rod_with_a_tolerance_is_solved_more_precisely_than_that() {
    let text = bundled_scene("cantilever").unwrap().text;
    let changed =
        text.lines().map(|line| if line.starts_with("elements") { "tolerance = 1e-6" } else { line });
    let text = changed.collect::<Vec<_>>().join("\n") + "\n[solver]\ntolerance = 1e-3\n";
    let model = Scene::parse(&text, "cantilever.toml", None).unwrap().model;
    assert_eq!(model.settings.tolerance, 1e-3);
    assert_eq!(model.refined().unwrap().settings.tolerance, 1e-8);
}
