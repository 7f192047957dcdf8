//! Tables that lie beside a scene.

use std::path::Path;
use strands_scene::{Scene, SceneFile};

const SCENE: &str = r#"
format = 1
name = "tables"

[rods.arc]
rest = { csv = "points.csv" }
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4, axial = 1e3, shear = [1e3, 1e3] }
supports = [{ at = "start", fix = ["position", "orientation"] }]

[rods.hook]
length = 0.2
rest = { csv = "samples.csv" }
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4, axial = 1e3, shear = [1e3, 1e3] }
supports = [{ at = "start", fix = ["position", "orientation"] }]
"#;

#[test]
fn a_scene_with_its_tables_written_in_is_the_same_scene_without_its_folder() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tables");
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("points.csv"), "x,y,z\n0,0,0\n0,0.01,0.1\n0,0.04,0.2\n").expect("a table");
    std::fs::write(folder.join("samples.csv"), "s,kappa1,kappa2,tau\n0,0,0,0\n0.1,0,5,0.3\n")
        .expect("a table");
    let meant = Scene::parse(SCENE, "tables.toml", Some(&folder)).expect("a scene");
    let whole = SceneFile::parse_with_tables(SCENE, "tables.toml", Some(&folder)).expect("a scene");
    assert!(Scene::parse(SCENE, "tables.toml", None).is_err());
    for (text, name) in [(whole.to_toml(), "tables.toml"), (whole.to_json(), "tables.json")] {
        let opened = Scene::parse(&text, name, None).expect("a scene that needs no folder");
        let rods = |scene: &Scene| {
            let rods = scene.model.rods.iter().map(|rod| format!("{:?}", rod.problem.rod.description()));
            rods.collect::<Vec<_>>()
        };
        assert_eq!(rods(&opened), rods(&meant), "{name}");
    }
    let missing = SceneFile::parse_with_tables(SCENE, "tables.toml", None).unwrap_err();
    assert_eq!(missing.key(), "rods.arc.rest.csv");
}
