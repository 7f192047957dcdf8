//! A rod that nothing pulls at bears nothing, however it is held and cut.

use strands::statics::{Workspace, solve};
use strands_scene::Scene;

const CURVED: &str = r#"
format = 1
name = "curved"

[materials.rubber]
youngs_modulus = 5e6
poisson_ratio = 0.4
density = 1100.0

[rods.curved]
material = "rubber"
length = 0.4
MESH
section = { shape = "circle", radius = 2e-3 }
kinematics = "KINEMATICS"
rest = { samples = [{ s = 0.0, curvature = [2.0, -6.0, 3.0] }, { s = 0.4, curvature = [-5.0, 4.0, 8.0] }] }
position = [0.1, 0.2, 0.3]
orientation = [0.5, 0.5, -0.5, 0.5]

[[rods.curved.supports]]
at = "start"
fix = ["position", "orientation"]

[[rods.curved.supports]]
at = "end"
fix = ["position", "orientation"]

[solver]
order = ORDER
tolerance = 1e-12
"#;

#[test]
fn an_unloaded_rod_held_where_it_rests_has_no_reactions() {
    for kinematics in ["kirchhoff", "cosserat"] {
        for order in ["1", "2", "4"] {
            for mesh in ["elements = 7", "elements = 60", "tolerance = 2e-2"] {
                let what = format!("{kinematics}, order {order}, {mesh}");
                let text =
                    CURVED.replace("KINEMATICS", kinematics).replace("ORDER", order).replace("MESH", mesh);
                let model = Scene::parse(&text, "curved.toml", None).unwrap().model;
                let model = model.refined().unwrap_or_else(|error| panic!("{what}: {error}"));
                let problem = &model.rods[0].problem;
                let solution = solve(problem, &model.settings, None, &mut Workspace::default());
                let solution = solution.unwrap_or_else(|failure| panic!("{what}: {failure}"));
                let scale = problem.rod.scale();
                for reaction in &solution.reactions {
                    let (force, moment) =
                        (reaction.force.norm() / scale.force, reaction.moment.norm() / scale.moment);
                    assert!(force.max(moment) < 1e-9, "{what}: {force:e} {moment:e} at {}", reaction.s);
                }
            }
        }
    }
}
