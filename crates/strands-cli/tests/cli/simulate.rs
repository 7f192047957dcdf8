//! `strands simulate`.

use crate::common::{folder, strands};
use serde_json::Value;

const FALL: [&str; 4] = ["simulate", "cantilever.toml", "--set", "dynamics.start=\"rest\""];

#[test]
fn frames_are_what_was_promised() {
    let run = strands(&[FALL.as_slice(), &["--seconds", "0.1", "--every", "0.025", "--json"]].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value and nothing else");
    assert_eq!(answer["status"], "finished");
    assert_eq!(answer["steps"], 100);
    assert!(answer["real_time_factor"].as_f64().unwrap() > 0.0);
    let frames = answer["frames"].as_array().unwrap();
    let times: Vec<f64> = frames.iter().map(|frame| frame["t"].as_f64().unwrap()).collect();
    for (time, expected) in times.iter().zip([0.0, 0.025, 0.05, 0.075, 0.1]) {
        assert!((time - expected).abs() < 1e-9, "{times:?}");
    }
    assert_eq!(times.len(), 5);
    let last = &frames[4];
    let energy = |key: &str| last["energy"][key].as_f64().unwrap();
    assert!(energy("kinetic") > 0.0 && energy("elastic") > 0.0 && energy("gravity") < 0.0);
    assert_eq!(energy("dissipated"), 0.0);
    assert!(last["newton_iterations"].as_u64().unwrap() >= 25);
    // What a stage is solved at.
    assert!(last["residual"].as_f64().unwrap() <= 1e-7);
    let beam = &last["rods"]["beam"];
    for key in ["s", "position", "orientation", "velocity", "angular_velocity"] {
        assert_eq!(beam[key].as_array().unwrap().len(), 41, "{key}");
    }
    for key in ["strain", "stress"] {
        assert_eq!(beam[key].as_array().unwrap().len(), 40, "{key}");
    }
    assert!(beam["velocity"][40][2].as_f64().unwrap() < -0.1, "it falls");
}

#[test]
fn a_rod_starts_in_equilibrium_and_stays() {
    let run = strands(&["simulate", "cantilever.toml", "--seconds", "0.05", "--json"]);
    let answer: Value = serde_json::from_str(&run.out).unwrap();
    let frames = answer["frames"].as_array().unwrap();
    let end = |frame: &Value| frame["rods"]["beam"]["position"][40][2].as_f64().unwrap();
    assert!((end(&frames[0]) - end(frames.last().unwrap())).abs() < 1e-9);
}

#[test]
fn a_rod_in_equilibrium_bears_what_a_solve_says() {
    for kinematics in ["cosserat", "kirchhoff"] {
        let kinematics = format!("rods.beam.kinematics=\"{kinematics}\"");
        let scene = ["cantilever.toml", "--set", &kinematics, "--json"];
        let answer = |run: crate::common::Run| serde_json::from_str::<Value>(&run.out).unwrap();
        let solved = answer(strands(&[["solve"].as_slice(), &scene].concat()));
        let moved = answer(strands(&[["simulate", "--seconds", "0.001"].as_slice(), &scene].concat()));
        for (key, scale) in [("strain", 1.0), ("stress", 1e-2)] {
            let [solved, moved] = [&solved, &moved["frames"][0]].map(|at| numbers(&at["rods"]["beam"][key]));
            assert_eq!(solved.len(), 6 * 40);
            for (solved, moved) in solved.iter().zip(&moved) {
                assert!((solved - moved).abs() < 1e-7 * scale, "{kinematics}, {key}: {solved} {moved}");
            }
        }
    }
}

/// All numbers of nested arrays.
fn numbers(value: &Value) -> Vec<f64> {
    match value.as_array() {
        Some(array) => array.iter().flat_map(numbers).collect(),
        None => vec![value.as_f64().unwrap()],
    }
}

#[test]
fn a_table_says_how_it_went_and_files_are_written() {
    let file = folder("simulate").join("fall.csv");
    let output = ["--seconds", "0.05", "-o", file.to_str().unwrap()];
    let run = strands(&[FALL.as_slice(), &output].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.contains("50 steps of 1.000 ms by bdf2"), "{}", run.out);
    assert!(run.out.contains("times as fast as real time"), "{}", run.out);
    let csv = std::fs::read_to_string(&file).unwrap();
    let columns = "t,rod,s,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,kappa1,kappa2,tau,v1,v2,v3,m1,m2,m3,n1,n2,n3";
    assert!(csv.starts_with(&format!("{columns}\n0.0,beam,0.0,")), "{csv:.200}");
    assert_eq!((csv.lines().count() - 1) % 41, 0);
    assert!(csv.lines().nth(41).unwrap().ends_with(",,,,,,,,,,,,"), "the last node begins no element");
}

#[test]
fn what_cannot_be_simulated_is_said() {
    for (set, said) in [
        (
            "dynamics.start=\"there\"",
            "give \"equilibrium\", \"rest\", \"initial\" or the file of a saved state",
        ),
        ("dynamics.start=\"cantilever.toml\"", "not the state of a simulation"),
        (
            "dynamics={integrator=\"bdf2\", tolerance=1e-3}",
            "with \"sdirk4\" and \"tr_bdf2\" only, not with \"bdf2\"",
        ),
        ("solver.order=4", "rod `beam`: only rods of order 2"),
        ("materials.rubber.density=0.0", "rod `beam` has no mass"),
    ] {
        let run = strands(&["simulate", "cantilever.toml", "--set", set]);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{set}");
        assert!(run.err.contains(said), "{}", run.err);
    }
    let scene = folder("simulate-over").join("scene.json");
    let scene = scene.to_str().unwrap();
    std::fs::write(scene, strands(&["new", "cantilever"]).out).unwrap();
    for over in
        [["--save", scene, "-o", "a.csv"], ["-o", scene, "-o", "a.csv"], ["-o", "a.csv", "-o", "a.csv"]]
    {
        let run = strands(&[["simulate", scene].as_slice(), &over].concat());
        assert!(run.code == 1 && run.err.contains("written over the scene, or twice"), "{}", run.err);
    }
    let run = strands(&["simulate", "cantilever.toml", "-o", "fall.vtp"]);
    assert!(run.code == 1 && run.err.contains(".json .csv .npz .pvd .usda .glb"), "{}", run.err);
}

#[test]
fn a_collection_has_its_files_in_a_folder_beside_it() {
    let folder = folder("simulate-pvd");
    let file = folder.join("fall.of.beam.pvd");
    let output = ["--seconds", "0.05", "--every", "0.025", "-o", file.to_str().unwrap()];
    let run = strands(&[FALL.as_slice(), &output].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let collection = std::fs::read_to_string(&file).unwrap();
    let parts: Vec<&str> =
        collection.split("file=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert_eq!(parts, [0, 1, 2].map(|frame| format!("fall.of.beam/beam_{frame}.vtp")));
    for part in parts {
        assert!(std::fs::read_to_string(folder.join(part)).unwrap().contains("\"velocity\""));
    }
}

/// Where the test can see that Ctrl-C is caught.
#[cfg(target_os = "linux")]
#[test]
fn what_was_simulated_until_someone_ends_it_is_written() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let file = folder("simulate-interrupted").join("fall.json");
    let endless = ["--seconds", "1e6", "--every", "0.001", "-o", file.to_str().unwrap()];
    let mut command = crate::common::command();
    let command = command.args([FALL.as_slice(), &endless].concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while !catches_interrupts(child.id()) {
        assert!(began.elapsed() < Duration::from_secs(60), "it does not begin");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(130), b"".as_slice()));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("interrupted: the frames until then are kept"), "{said}");
    let answer: Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert_eq!(answer["status"], "interrupted");
    let frames = answer["frames"].as_array().unwrap();
    assert_eq!(frames.len() as u64, answer["steps"].as_u64().unwrap() + 1);
    assert!(frames.len() > 1);
}

/// Whether a process has a handler for SIGINT (2): the second bit of its mask of caught signals.
#[cfg(target_os = "linux")]
fn catches_interrupts(process: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap().trim();
    u64::from_str_radix(caught, 16).unwrap() & 2 != 0
}

#[test]
fn a_saved_state_goes_on_to_the_same_bits() {
    let folder = folder("simulate-state");
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let start = format!("dynamics.start=\"{}\"", path("half.json"));
    // Steps that are all alike, and such as their error chooses.
    for steps in ["dynamics.time_step=1e-3", "dynamics.tolerance=1e-4"] {
        let run = |seconds: &str, save: &str, start: &str| {
            let rest = ["--set", steps, "--set", start, "--seconds", seconds, "--every", "0.01"];
            let run = strands(&[FALL.as_slice(), &rest, &["--save", &path(save)]].concat());
            assert_eq!((run.code, run.err.as_str()), (0, ""), "{steps}");
        };
        run("0.06", "whole.json", "dynamics.start=\"rest\"");
        run("0.03", "half.json", "dynamics.start=\"rest\"");
        run("0.03", "rest.json", &start);
        assert_eq!(read("rest.json"), read("whole.json"), "{steps}");
    }
    let half = read("half.json");
    for (state, said) in [
        ("{}".to_owned(), "not the state of a simulation"),
        (half.replace("\"next_step\":", "\"next_step\":-"), "a next step that is not longer than nothing"),
        (half.replacen("\"wrenches\":[", "\"wrenches\":[[0,0,0,0,0,0],", 1), "give a state of the same rods"),
        (half.replacen("\"length\":", "\"length\":2", 1), "give a state of the same rods"),
        (
            half.replacen("\"elements\":", "\"consistent\":true,\"elements\":", 1),
            "kg with a consistent mass matrix",
        ),
    ] {
        std::fs::write(folder.join("half.json"), state).unwrap();
        let refused = strands(&[FALL.as_slice(), &["--set", &start]].concat());
        assert_eq!(refused.code, 1);
        assert!(refused.err.contains(said) && refused.err.contains("half.json"), "{}", refused.err);
    }
}

#[test]
fn a_run_that_does_not_end_when_it_was_asked_to_says_so() {
    let run =
        strands(&[FALL.as_slice(), &["--set", "dynamics.time_step=3e-3", "--seconds", "0.01"]].concat());
    assert_eq!(
        (run.code, run.err.trim_end()),
        (0, "note: whole steps of 3.000 ms make 9.000 ms, not 10.00 ms")
    );
}

#[test]
fn steps_that_are_chosen_end_where_frames_are_due() {
    let choose = ["--set", "dynamics.tolerance=1e-4", "--seconds", "0.1", "--every", "0.02", "--json"];
    let run = strands(&[FALL.as_slice(), &choose].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).unwrap();
    for (k, frame) in answer["frames"].as_array().unwrap().iter().enumerate() {
        assert!((frame["t"].as_f64().unwrap() - 0.02 * k as f64).abs() < 1e-6, "{}", frame["t"]);
    }
    assert_eq!(answer["frames"].as_array().unwrap().len(), 6);
}

#[test]
fn tied_rods_and_bodies_move_as_one() {
    let run =
        strands(&["simulate", "../../../../scenes/needle_and_thread.toml", "--seconds", "0.05", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).unwrap();
    let frames = answer["frames"].as_array().unwrap();
    assert!(frames[0]["bodies"].is_object() || frames[0]["bodies"].is_array(), "{}", frames[0]);
    let run = strands(&["simulate", "../../../../scenes/hanging_net.toml", "--seconds", "0.02", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
}

#[test]
fn the_last_frame_is_where_the_run_ends() {
    // Three times 0.035 is more than 0.105.
    let asked = ["--set", "dynamics.time_step=0.01", "--seconds", "0.105", "--every", "0.035", "--json"];
    let answer: Value = serde_json::from_str(&strands(&[FALL.as_slice(), &asked].concat()).out).unwrap();
    let frames = answer["frames"].as_array().unwrap();
    let last = frames[frames.len() - 1]["t"].as_f64().unwrap();
    assert!((last - 0.01 * answer["steps"].as_f64().unwrap()).abs() < 1e-9, "{last}");
}

#[test]
fn a_rod_may_have_the_consistent_mass_matrix() {
    // A beam of few elements that falls from its rest shape.
    let falls = |set: &[&str]| {
        let coarse = ["--set", "rods.beam.elements=10", "--set", "dynamics.start=\"rest\""];
        let run = strands(&[FALL.as_slice(), &coarse, set, &["--seconds", "0.05", "--json"]].concat());
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        let answer: Value = serde_json::from_str(&run.out).unwrap();
        let last = answer["frames"].as_array().unwrap().last().unwrap().clone();
        (last["energy"]["kinetic"].as_f64().unwrap(), last["rods"].clone())
    };
    let [lumped, consistent] = ["lumped", "consistent"]
        .map(|matrix| falls(&["--set", &format!("rods.beam.mass_matrix=\"{matrix}\"")]));
    assert_eq!(lumped, falls(&[]));
    assert_ne!(lumped.1, consistent.1);
    assert!(consistent.0 > 0.0 && (consistent.0 / lumped.0 - 1.0).abs() < 0.1, "{lumped:?} {consistent:?}");
}

#[test]
fn strands_that_fall_on_a_floor_touch_it_and_each_other() {
    const SCENE: &str = "../../../../examples/strands_on_a_floor.toml";
    let run = strands(&["simulate", SCENE, "--seconds", "0.2", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).unwrap();
    let frames = answer["frames"].as_array().unwrap();
    assert!(frames[0].get("contacts").is_none(), "it falls at first");
    let contacts = frames.last().unwrap()["contacts"].as_array().unwrap();
    let between = |first: &str, second: &str| {
        let of = |contact: &&Value| {
            contact["between"][0]["rod"] == first
                && (contact["between"][1]["rod"] == second || contact["between"][1].get(second).is_some())
        };
        contacts.iter().filter(of).count()
    };
    assert!(between("first", "obstacle") > 10 && between("first", "second") > 0, "{contacts:?}");
    let up: f64 = contacts
        .iter()
        .filter(|contact| contact["between"][1].get("obstacle").is_some())
        .map(|contact| contact["force"][2].as_f64().unwrap())
        .sum();
    let weight = 2.0 * 1300.0 * std::f64::consts::PI * 0.5e-3_f64.powi(2) * 0.1 * 9.81;
    assert!((up / weight - 1.0).abs() < 1e-3, "{up:e} of {weight:e}");
    for contact in contacts {
        assert!(contact["gap"].as_f64().unwrap() > 0.0, "{contact}");
    }
    let low = strands(&["simulate", SCENE, "--set", "rods.second.position=[0.05, -0.05, 0.01]"]);
    let said =
        "where all starts element 24 of rod `first` passes into element 24 of rod `second`: put them apart";
    assert!(low.code == 1 && low.err.contains(said), "{} {}", low.code, low.err);
    // Where they rest is found too, and they stay there.
    let rests = strands(&[
        "simulate",
        SCENE,
        "--set",
        "dynamics.start=\"equilibrium\"",
        "--seconds",
        "0.01",
        "--json",
    ]);
    let answer: Value = serde_json::from_str(&rests.out).unwrap();
    let kinetic = answer["frames"].as_array().unwrap().last().unwrap()["energy"]["kinetic"].as_f64().unwrap();
    assert!(rests.code == 0 && kinetic < 1e-12, "{kinetic:e}");
    let solved = strands(&["solve", SCENE]);
    assert!(solved.code != 0 && solved.err.contains("nothing holds them"), "{} {}", solved.code, solved.err);
    let by = strands(&["simulate", SCENE, "--set", "dynamics.integrator=\"bdf2\""]);
    assert!(by.code == 1 && by.err.contains("implicit_euler"), "{}", by.err);
}

#[test]
fn the_method_of_order_4_is_warned_of_where_a_rod_does_not_stretch() {
    let sets = ["--set", "rods.beam.kinematics=\"kirchhoff\"", "--set", "dynamics.integrator=\"sdirk4\""];
    let run = strands(&[FALL.as_slice(), &sets, &["--seconds", "0.01"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let note =
        "note: sdirk4 gains energy where rods that do not stretch, as `beam`, turn; tr_bdf2 and bdf2 do not";
    assert_eq!(run.err.trim_end(), note);
}

#[test]
fn states_of_an_older_format_are_told_from_what_is_none() {
    let folder = folder("simulate-old-state");
    std::fs::write(folder.join("old.json"), "{\"format\":1,\"time\":0.5}").unwrap();
    let start = format!("dynamics.start=\"{}\"", folder.join("old.json").to_str().unwrap());
    let run = strands(&["simulate", "cantilever.toml", "--set", &start]);
    assert_eq!(run.code, 1);
    assert!(run.err.contains("a state of format 1, and this program reads format 4"), "{}", run.err);
}

#[test]
fn supports_that_go_beyond_an_inextensible_rod_are_named() {
    let folder = folder("beyond");
    let scene = r#"
format = 1
name = "taut"
[materials.nylon]
youngs_modulus = 2e9
poisson_ratio = 0.4
density = 1140.0
[rods.thread]
material = "nylon"
length = 0.3
elements = 10
kinematics = "kirchhoff"
section = { shape = "circle", radius = 3e-4 }
supports = [
    { at = "start", fix = ["position"] },
    { at = "end", fix = ["position"], motion = [{ t = 0.0 }, { t = 0.01, position = [0.0, 0.0, 0.4] }] },
]
[dynamics]
start = "rest"
"#;
    let path = folder.join("taut.toml");
    std::fs::write(&path, scene).unwrap();
    for steps in ["dynamics.time_step=1e-3", "dynamics.tolerance=1e-4"] {
        let run = strands(&["simulate", path.to_str().unwrap(), "--seconds", "0.05", "--set", steps]);
        assert_eq!(run.code, 2, "{} {}", run.out, run.err);
        let mend = "the rod between them is 300.0 mm long and does not stretch: move them less far";
        assert!(run.out.contains(mend), "{}", run.out);
    }
}
