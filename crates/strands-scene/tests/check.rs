//! What looks wrong with a scene, and what does not.

use strands::statics::{Method, Workspace, plan, solve};
use strands_scene::Scene;
use strands_scene::check::{Level, Remark, Trial};

/// A steel wire that hangs from its clamp, a force at its end.
const WIRE: &str = r#"
format = 1
name = "wire"
gravity = [0.0, 0.0, -9.81]

[materials.steel]
youngs_modulus = 200e9
poisson_ratio = 0.3
density = 7850.0

[rods.wire]
material = "steel"
length = 0.5
elements = 50
section = { shape = "circle", radius = 0.5e-3 }
orientation = [0.0, 1.0, 0.0, 0.0]

[[rods.wire.supports]]
at = "start"
fix = ["position", "orientation"]

[[rods.wire.loads]]
at = "end"
force = [0.0, 0.05, 0.0]
"#;

const UP: (&str, &str) = ("orientation = [0.0, 1.0, 0.0, 0.0]", "orientation = [1.0, 0.0, 0.0, 0.0]");
const NO_FORCE: (&str, &str) = ("force = [0.0, 0.05, 0.0]", "force = [0.0, 0.0, 0.0]");

fn scene(changes: &[(&str, &str)]) -> Scene {
    let text = changes.iter().fold(WIRE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    Scene::parse(&text, "wire.toml", None).unwrap_or_else(|error| panic!("{error}"))
}

fn warnings(remarks: &[Remark]) -> Vec<(&str, &str)> {
    let warnings = remarks.iter().filter(|remark| remark.level == Level::Warning);
    warnings.map(|remark| (remark.said.key(), remark.said.message())).collect()
}

/// The one warning of a scene, found without a solve.
fn the_warning(changes: &[(&str, &str)], key: &str, words: &str) {
    let remarks = scene(changes).remarks();
    let found = warnings(&remarks);
    assert_eq!(found.iter().map(|(key, _)| *key).collect::<Vec<_>>(), [key], "{changes:?}: {found:?}");
    assert!(found[0].1.contains(words), "{changes:?}: {found:?}");
    assert!(remarks[0].render(false).contains("wire.toml:"), "{}", remarks[0].render(false));
    assert!(!remarks[0].said.mends().is_empty());
}

#[test]
fn a_scene_without_slips_gives_no_remark() {
    let check = scene(&[]).check();
    assert!(check.remarks.is_empty(), "{:?}", check.remarks);
    let Trial::Solved { estimated_error: Some(error), .. } = check.rods[0].trial else { panic!("{check:?}") };
    assert!((1e-6..1e-3).contains(&error), "{error}");
}

#[test]
fn bundled_scenes_give_no_warning() {
    for bundled in strands_scene::bundled() {
        let scene = Scene::parse(bundled.text, bundled.name, None).expect("a scene");
        let check = scene.check();
        assert!(warnings(&check.remarks).is_empty(), "{}: {:?}", bundled.name, check.remarks);
    }
}

#[test]
fn slips_of_a_thousand_are_found_at_their_key() {
    let radius = "rods.wire.section.radius";
    the_warning(&[("radius = 0.5e-3", "radius = 0.5")], radius, "that is no rod");
    the_warning(&[("length = 0.5", "length = 500.0")], "rods.wire.length", "1e6 of its radii");
    the_warning(&[("density = 7850.0", "density = 7.85")], "materials.steel.density", "no solid");
    the_warning(&[("density = 7850.0", "density = 7850000.0")], "materials.steel.density", "no solid");
    let modulus = "materials.steel.youngs_modulus";
    for (written, words) in [("200.0", "200 Pa"), ("200000.0", "a metal's"), ("200e18", "2e20 Pa")] {
        let remarks = scene(&[("youngs_modulus = 200e9", &format!("youngs_modulus = {written}"))]).remarks();
        let found = warnings(&remarks);
        assert!(found.iter().any(|(key, said)| *key == modulus && said.contains(words)), "{found:?}");
    }
    the_warning(&[("-9.81", "-9810.0")], "gravity", "mm/s²");
    the_warning(&[("-9.81", "-9.81e-3")], "gravity", "km/s²");
}

#[test]
fn a_wire_that_stands_up_buckles_where_greenhill_and_euler_say() {
    // w L³/EI = 7.837 at L = 1.083 m.
    let long =
        |length: &str| scene(&[UP, NO_FORCE, ("length = 0.5", &format!("length = {length}"))]).remarks();
    assert!(warnings(&long("1.07")).is_empty());
    let longer = long("1.10");
    assert!(warnings(&longer)[0].1.contains("its own weight: w L³/EI = 8."), "{:?}", warnings(&longer));
    // π²/4 EI/L² = 0.0969 N, of which the weight takes a part.
    let pushed = |force: &str| {
        scene(&[UP, ("gravity = [0.0, 0.0, -9.81]", ""), ("[0.0, 0.05, 0.0]", force)]).remarks()
    };
    assert!(warnings(&pushed("[0.0, 0.0, -0.0968]")).is_empty());
    assert!(warnings(&pushed("[0.0, 0.0, -0.0970]"))[0].1.contains("the force at its head"));
    // A force to the side bends it anyway, and one upwards holds it.
    assert!(warnings(&pushed("[0.0, 0.01, -0.2]")).is_empty());
    assert!(warnings(&pushed("[0.0, 0.0, 0.2]")).is_empty());
}

#[test]
fn a_guided_head_bears_more() {
    let guided = |force: f64, fix: &str| {
        let support = format!("[[rods.wire.supports]]\nat = \"end\"\nfix = {fix}\n\n[[rods.wire.loads]]");
        let force = format!("[0.0, 0.0, {force}]");
        scene(&[
            UP,
            ("gravity = [0.0, 0.0, -9.81]", ""),
            ("[0.0, 0.05, 0.0]", &force),
            ("[[rods.wire.loads]]", &support),
        ])
        .remarks()
    };
    // EI/L² = 0.03927 N.
    for (fix, bears) in
        [("[\"x\", \"y\"]", 20.19 * 0.03927), ("[\"x\", \"y\", \"orientation\"]", 39.48 * 0.03927)]
    {
        assert!(warnings(&guided(-0.99 * bears, fix)).is_empty(), "{fix}");
        assert_eq!(warnings(&guided(-1.01 * bears, fix)).len(), 1, "{fix}");
    }
}

#[test]
fn supports_out_of_reach_are_told_of_at_the_support() {
    let held = "fix = [\"position\", \"orientation\"]\n\n[[rods.wire.supports]]\nat = \"end\"\nfix = [\"position\"]\nposition = [0.0, 0.0, -0.55]\n\n[[rods.wire.loads]]";
    let apart = ("fix = [\"position\", \"orientation\"]\n\n[[rods.wire.loads]]", held);
    let position = "rods.wire.supports[1].position";
    the_warning(&[apart], position, "stretched by 10.0 %");
    the_warning(
        &[apart, ("elements = 50", "elements = 50\nkinematics = \"kirchhoff\"")],
        position,
        "no equilibrium",
    );
}

#[test]
fn loads_beyond_the_law_are_told_of() {
    the_warning(
        &[("[0.0, 0.05, 0.0]", "[0.0, 50e3, 0.0]")],
        "rods.wire.loads[0].force",
        "would strain it by",
    );
    // Rubber, bent to more than it bears: the solve tells.
    let check = scene(&[
        ("youngs_modulus = 200e9", "youngs_modulus = 5e6"),
        ("density = 7850.0", "density = 1100.0"),
        ("radius = 0.5e-3", "radius = 5e-3"),
        ("[0.0, 0.05, 0.0]", "[0.0, 20.0, 0.0]"),
    ])
    .check();
    let found = warnings(&check.remarks);
    assert!(found.iter().any(|(_, said)| said.contains("the material is strained by")), "{found:?}");
}

#[test]
fn a_mesh_too_coarse_is_told_of() {
    let curled = ("elements = 50", "elements = 50\nrest = { curvature = [0.0, 150.0, 0.0] }");
    the_warning(&[curled], "rods.wire.elements", "is curved there to a radius of 6.67 mm");
    let check = scene(&[("elements = 50", "elements = 2"), ("[0.0, 0.05, 0.0]", "[0.0, 0.1, 0.0]")]).check();
    assert!(
        warnings(&check.remarks)[0].1.contains("2 elements of order 2 are too few"),
        "{:?}",
        check.remarks
    );
}

#[test]
fn what_has_no_effect_is_a_note() {
    let notes = |changes: &[(&str, &str)]| -> Vec<String> {
        let remarks = scene(changes).remarks();
        assert!(warnings(&remarks).is_empty(), "{remarks:?}");
        remarks.iter().map(|remark| remark.said.key().to_owned()).collect()
    };
    assert_eq!(notes(&[("gravity = [0.0, 0.0, -9.81]", ""), NO_FORCE]), ["rods.wire"]);
    assert_eq!(notes(&[("at = \"end\"", "at = \"start\"")]), ["rods.wire.loads[0].at"]);
}

#[test]
fn a_plan_is_what_a_solve_does() {
    for bundled in strands_scene::bundled() {
        let model = Scene::parse(bundled.text, bundled.name, None).expect("a scene").model;
        if model.moves_only() {
            continue;
        }
        for rod in &model.rods {
            for method in [Method::Auto, Method::Equilibrium] {
                let settings = strands::statics::Settings { method, ..model.settings };
                let planned = plan(&rod.problem, &settings, None).method;
                let solution = solve(&rod.problem, &settings, None, &mut Workspace::default());
                let solution = solution.unwrap_or_else(|error| panic!("{}: {error}", bundled.name));
                assert_eq!(solution.report.method, planned, "{}", bundled.name);
                let again = plan(&rod.problem, &settings, Some(&solution.guess)).method;
                let solution =
                    solve(&rod.problem, &settings, Some(&solution.guess), &mut Workspace::default());
                assert_eq!(
                    solution.map(|solution| solution.report.method).ok(),
                    Some(again),
                    "{}",
                    bundled.name
                );
            }
        }
    }
}
