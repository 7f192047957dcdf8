//! What the command prints, and how it ends.

mod check;
mod common;
mod many;
mod readme;
mod simulate;
mod validate;
mod view;

use common::{command, folder, scenes, strands, strands_with};
use serde_json::Value;

/// Snapshots without what differs from machine to machine and from run to run.
fn assert_golden(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.add_filter(r"\d+ iterations, residual [^,]+, [\d.]+ .?s", "[effort]");
    settings.add_filter(r"strands\.exe", "strands");
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn help_says_what_there_is() {
    for command in
        ["", "solve", "simulate", "check", "view", "new", "schema", "validate", "bench", "completions"]
    {
        let arguments: Vec<&str> = command.split_whitespace().chain(["--help"]).collect();
        let run = strands(&arguments);
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        assert_golden(&format!("help_{}", if command.is_empty() { "strands" } else { command }), &run.out);
    }
}

#[test]
fn a_solve_is_summed_up_for_people() {
    let run = strands(&["solve", "cantilever.toml"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_golden("summary", &run.out);
}

#[test]
fn what_is_below_round_off_is_printed_as_zero() {
    // Straight down, but for the last bits of half a turn.
    let run = strands(&["solve", "vertical.toml"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let line = |word: &str| {
        let line = run.out.lines().find(|line| line.contains(word)).unwrap_or_default();
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(line(" wide"), "0 m wide, 300.0 mm high");
    assert_eq!(line("moment"), "moment 0 N·m (0, 0, 0) N·m");
    assert_eq!(line("energy"), "energy 0 J elastic, -96.10 mJ of the loads");
}

#[test]
fn json_is_one_object_with_what_was_promised() {
    let run = strands(&["solve", "cantilever.toml", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value and nothing else");
    assert_eq!(answer["scene"], "cantilever");
    assert_eq!(answer["status"], "converged");
    assert_eq!(answer["stable"], true);
    assert_eq!(answer["morse_index"], 0);
    for number in ["iterations", "residual", "energy", "solve_seconds"] {
        assert!(answer[number].is_number(), "{number}");
    }
    let rod = &answer["rods"]["beam"];
    let lengths =
        ["s", "position", "orientation", "strain", "stress"].map(|key| rod[key].as_array().map(Vec::len));
    assert_eq!(lengths, [41, 41, 41, 40, 40].map(Some));
    assert!(rod["reactions"][0]["force"][2].as_f64().is_some_and(|force| (force - 0.154_095).abs() < 1e-5));
}

#[test]
fn no_equilibrium_is_status_two_and_still_an_answer() {
    let run = strands(&["solve", "out_of_reach.toml", "--json"]);
    assert_eq!(run.code, 2);
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value");
    assert_eq!(answer["status"], "failed");
    assert!(answer["reason"].as_str().is_some_and(|reason| reason.contains("0.310000 m apart")), "{answer}");
    assert!(answer["residual_history"].is_array());
    let run = strands(&["solve", "out_of_reach.toml"]);
    assert_eq!(run.code, 2);
    assert!(run.out.contains("failed: out of reach"), "{}", run.out);
}

#[test]
fn a_tolerance_that_no_mesh_meets_is_status_two_and_keeps_what_was_solved() {
    let run = strands(&["solve", "too_fine.toml", "--json"]);
    assert_eq!(run.code, 2, "{}", run.err);
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value");
    assert_eq!((&answer["status"], &answer["rod"]), (&"failed".into(), &"fine".into()));
    assert!(answer["reason"].as_str().is_some_and(|reason| reason.contains("ask for less")), "{answer}");
    assert!(answer["residual_history"].is_array());
    let solved: Vec<&String> = answer["rods"].as_object().expect("rods").keys().collect();
    assert_eq!(solved, ["coarse"]);
    assert_eq!(answer["rods"]["coarse"]["s"].as_array().map(Vec::len), Some(11));
    let run = strands(&["solve", "too_fine.toml"]);
    assert_eq!(run.code, 2);
    assert!(run.out.contains("10 elements") && run.out.contains("failed: an error of"), "{}", run.out);
}

#[test]
fn a_bad_scene_is_status_one_and_points_at_the_line() {
    let run = strands(&["solve", "misspelt.toml", "--json"]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert_golden("misspelt", &run.err);
}

#[test]
fn bad_arguments_are_status_one_and_say_what_to_do() {
    for (arguments, said) in [
        (vec!["solve", "cantilever.toml", "-o", "a.xyz"], ".csv"),
        (vec!["solve", "cantilever.toml", "--order", "3"], "possible values: 1, 2, 4"),
        (vec!["solve", "cantilever.toml", "--set", "nothing"], "KEY=VALUE"),
        (vec!["solve", "absent.toml"], "absent.toml"),
        (vec!["solve", "sutur"], "did you mean `suture`?"),
        (vec!["solve", "sutur"], "Bundled scenes: "),
        (vec!["sovle"], "solve"),
        (vec!["validate", "bend-54"], "the nearest are `bend-45`"),
        (vec!["validate", "-o", "a.pdf"], "name it .html"),
        (vec![], "Usage"),
    ] {
        let run = strands(&arguments);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{arguments:?}");
        assert!(run.err.contains(said), "{arguments:?}: {}", run.err);
    }
}

#[test]
fn every_bundled_scene_is_solved_or_simulated_where_its_rods_are_tied_or_touch() {
    for scene in strands_scene::bundled() {
        let read = strands_scene::Scene::parse(scene.text, scene.name, None).expect("a scene");
        let run = if read.model.moves_only() {
            strands(&["simulate", scene.name, "--seconds", "0.02", "--json"])
        } else {
            strands(&["solve", scene.name, "--json"])
        };
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", scene.name);
    }
}

#[test]
fn a_scene_is_read_from_standard_input() {
    let text = std::fs::read_to_string(scenes().join("cantilever.toml")).expect("the scene");
    let from_file = strands(&["solve", "cantilever.toml", "-o", "/dev/null", "--json"]);
    assert_eq!(from_file.code, 1, "an ending is needed");
    let piped = strands_with(&["solve", "-", "--json"], &text);
    assert_eq!((piped.code, piped.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&piped.out).expect("JSON");
    assert_eq!(answer["scene"], "cantilever");
}

#[test]
fn flags_override_the_scene() {
    let answer = |arguments: &[&str]| -> Value {
        let run = strands(&[&["solve", "cantilever.toml", "--json"], arguments].concat());
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments:?}");
        serde_json::from_str(&run.out).expect("JSON")
    };
    let nodes = |answer: &Value| answer["rods"]["beam"]["s"].as_array().map_or(0, Vec::len);
    assert_eq!(nodes(&answer(&["--elements", "10"])), 11);
    assert_eq!(nodes(&answer(&["--set", "rods.beam.elements=12"])), 13);
    assert_eq!(answer(&["--method", "shooting"])["method"], "shooting");
    let drop = |answer: &Value| {
        answer["rods"]["beam"]["position"][nodes(answer) - 1][2].as_f64().unwrap_or(f64::NAN)
    };
    let (weak, strong) = (
        answer(&["--order", "4"]),
        answer(&["--order", "4", "--set", "materials.rubber.youngs_modulus=1e7"]),
    );
    assert!(drop(&weak) < 3.0 * drop(&strong), "{} {}", drop(&weak), drop(&strong));
    let wrong = strands(&["solve", "cantilever.toml", "--set", "rods.beam.lenght=1"]);
    assert_eq!(wrong.code, 1);
    assert!(wrong.err.contains("length"), "{}", wrong.err);
}

#[test]
fn a_result_is_written_by_its_ending() {
    let folder = folder("outputs");
    let files = ["a.json", "a.csv", "a.vtp", "a.glb", "a.svg"].map(|name| folder.join(name));
    let mut arguments = vec!["solve".to_owned(), "cantilever.toml".to_owned()];
    for file in &files {
        arguments.extend(["-o".to_owned(), file.display().to_string()]);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let run = strands(&arguments);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let begins = [b"{".as_slice(), b"", b"<?xml", b"glTF", b"<"];
    for (file, begin) in files.iter().zip(begins) {
        let bytes = std::fs::read(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(bytes.len() > 100 && bytes.starts_with(begin), "{}", file.display());
    }
}

#[test]
fn a_new_scene_is_written_once_and_can_be_solved() {
    let folder = folder("new");
    let run = |arguments: &[&str]| {
        command().current_dir(&folder).args(arguments).output().expect("the command runs")
    };
    assert!(run(&["new", "mine"]).status.success());
    let text = std::fs::read_to_string(folder.join("mine.toml")).expect("the scene");
    assert!(text.contains("name = \"mine\"") && text.contains('#'), "{text}");
    assert!(run(&["solve", "mine.toml"]).status.success());
    assert_eq!(run(&["new", "mine"]).status.code(), Some(1), "what is there is not overwritten");
    assert_eq!(run(&["new", "../mine"]).status.code(), Some(1));
    assert_eq!(run(&["new", "other", "--template", "nonsense"]).status.code(), Some(1));
}

#[test]
fn the_schema_is_json() {
    let schema: Value = serde_json::from_str(&strands(&["schema"]).out).expect("JSON");
    assert!(schema["properties"]["rods"].is_object());
}

#[test]
fn completions_name_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = strands(&["completions", shell]);
        assert!(run.code == 0 && run.out.contains("solve"), "{shell}");
    }
}

#[test]
fn elements_too_long_for_the_tension_are_told_of_and_as_many_as_advised_do() {
    let taut = ["solve", "suture", "--set", "rods.thread.supports[1].position=[0.1, 0.0, 0.28]", "--set"];
    let run = strands(&[taut.as_slice(), &["rods.thread.elements=40"]].concat());
    assert_eq!(run.code, 2, "{}", run.out);
    assert!(run.out.contains("shorter elements may bear less: use 160 or more"), "{}", run.out);
    let run = strands(&[taut.as_slice(), &["rods.thread.elements=160"]].concat());
    assert!(run.out.contains("stable equilibrium"), "{}", run.out);
}

#[test]
fn an_inextensible_rod_in_twelve_clips_is_found_from_where_one_that_stretches_rests() {
    // Turned by half a turn from one clip to the next, with a hundredth to spare.
    let run = strands(&["solve", "twelve_clips.json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.contains("stable equilibrium"), "{}", run.out);
}
