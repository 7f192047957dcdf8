//! The bundled scenes: each is read, solved from cold, and stands.

use strands::statics::{Workspace, solve};
use strands_scene::{Scene, bundled};

#[test]
fn every_bundled_scene_converges_to_a_stable_equilibrium_from_cold() {
    for scene in bundled() {
        let Scene { model, .. } = Scene::parse(scene.text, scene.name, None).unwrap();
        assert_eq!(model.name, scene.name);
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
