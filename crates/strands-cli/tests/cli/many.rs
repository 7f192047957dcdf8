//! `--all` and `--path`.

use crate::common::{folder, strands};
use serde_json::Value;

const LOAD: &str = "rods.column.loads[0].force=[0,0,0]..[0,0,-0.5]";

fn json(arguments: &[&str]) -> Value {
    let run = strands(arguments);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn all_lists_equilibria_by_energy() {
    let load = "rods.column.loads[0].force=[0,0,-1]";
    let arguments = ["solve", "column.toml", "--set", load, "--all", "--effort", "0.1"];
    let answer = json(&[arguments.as_slice(), &["--json"]].concat());
    let all = answer["equilibria"].as_array().unwrap();
    // P L²/EI1 = 12.8 and P L²/EI2 = 8: beyond the first critical load (π²/4) about either axis.
    let indices: Vec<u64> = all.iter().map(|one| one["morse_index"].as_u64().unwrap()).collect();
    assert_eq!(indices, [0, 0, 1, 1, 2]);
    assert!(all.windows(2).all(|pair| pair[0]["energy"].as_f64() <= pair[1]["energy"].as_f64()));
    assert_eq!(all[0]["rods"]["column"]["position"].as_array().unwrap().len(), 61);
    for (one, index) in all.iter().zip(indices) {
        let mode = &one["rods"]["column"]["unstable_mode"];
        assert_eq!(mode.is_null(), index == 0);
        if index > 0 {
            assert!(mode["curvature"].as_f64().unwrap() < 0.0);
            assert_eq!(mode["displacement"].as_array().unwrap().len(), 61);
            let clamped = mode["rotation"][0].as_array().unwrap();
            assert!(clamped.iter().all(|turn| turn.as_f64() == Some(0.0)), "{clamped:?}");
        }
    }
    let file = folder("all").join("all.vtp");
    let run = strands(&[arguments.as_slice(), &["-o", file.to_str().unwrap()]].concat());
    assert!(run.out.contains("5 equilibria found, 2 of them stable"), "{}", run.out);
    assert!(run.out.contains("unstable, Morse index 2"), "{}", run.out);
    assert!(std::fs::read_to_string(&file).unwrap().contains("mode_displacement"));
}

#[test]
fn an_unstable_equilibrium_is_told_how_it_falls() {
    let run = strands(&[
        "solve",
        "column.toml",
        "--set",
        "rods.column.loads[0].force=[0,0,-0.3]",
        "--set",
        "solver.method=multiple_shooting",
    ]);
    assert!(run.out.contains("UNSTABLE equilibrium: one way to fall"), "{}", run.out);
    // Its section is softest about x.
    assert!(run.out.contains("moves along ±(0.00, 1.00, 0.00), most at s = 800.0 mm"), "{}", run.out);
}

#[test]
fn a_path_tells_where_the_column_buckles_and_goes_over_on_request() {
    let critical = 0.25 * std::f64::consts::PI.powi(2) * 0.05 / 0.64;
    let straight = json(&["solve", "column.toml", "--path", LOAD, "--json"]);
    assert_eq!(straight["end"], "reached");
    assert_eq!(straight["key"], "rods.column.loads[0].force");
    let events = straight["events"].as_array().unwrap();
    assert_eq!(events.len(), 2);
    assert_eq!(events[0]["kind"], "bifurcation");
    let at = -events[0]["value"][2].as_f64().unwrap();
    assert!((at / critical - 1.0).abs() < 1e-3, "{at}");
    let last = |path: &Value| path["points"].as_array().unwrap().last().unwrap().clone();
    assert_eq!(last(&straight)["stable"], false);
    assert_eq!(last(&straight)["value"][2], -0.5);
    let file = folder("path").join("path.csv");
    let name = file.to_str().unwrap();
    let buckled = json(&["solve", "column.toml", "--path", LOAD, "--switch", "1", "--json", "-o", name]);
    assert_eq!(last(&buckled)["stable"], true);
    let rows = std::fs::read_to_string(&file).unwrap().lines().count();
    assert_eq!(rows, 1 + 61 * buckled["points"].as_array().unwrap().len());
    let run = strands(&["solve", "column.toml", "--path", LOAD]);
    assert!(run.out.contains("bifurcation") && run.out.contains("the path reaches its end"), "{}", run.out);
}

#[test]
fn bad_paths_say_what_is_wrong() {
    let cases = [
        ("rods.column.length", "there is no `=` after a key"),
        ("rods.column.length=0.5", "there is no value to go to"),
        ("rods.column.length=0.5..long", "neither a number nor a list of numbers"),
        ("rods.column.loads[0].force=[0,0,0]..[0,0]", "not of one kind"),
        ("rods.column.lenth=0.5..0.6", "did you mean `length`"),
        ("rods.column.length=0.5..-0.6", "must be greater than zero"),
    ];
    for (path, said) in cases {
        let run = strands(&["solve", "column.toml", "--path", path]);
        assert_eq!(run.code, 1, "{path}: {}", run.out);
        assert!(run.err.contains(said), "{path}: {}", run.err);
    }
    let run = strands(&["solve", "column.toml", "--all", "--rod", "beam"]);
    assert!(run.code == 1 && run.err.contains("the scene has column"), "{}", run.err);
}

#[test]
fn rods_that_are_tied_are_not_solved_one_by_one() {
    let scene = "../../../../scenes/needle_and_thread.toml";
    let ways: [&[&str]; 3] = [&[], &["--all"], &["--path", "gravity=[0,0,-9.81]..[0,0,-5]"]];
    for way in ways {
        let run = strands(&[&["solve", scene], way].concat());
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{way:?}");
        assert!(run.err.contains("come to rest with `strands simulate`"), "{way:?}: {}", run.err);
    }
}
