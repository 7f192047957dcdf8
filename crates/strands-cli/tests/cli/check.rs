//! `strands check`, and what `strands solve` says of it.

use crate::assert_golden;
use crate::common::strands;
use serde_json::Value;

#[test]
fn slips_are_shown_at_their_lines_with_a_mend() {
    let run = strands(&["check", "slips.toml"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_golden("check_slips", &run.out);
}

#[test]
fn a_sound_scene_is_a_few_lines() {
    let run = strands(&["check", "suture"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_golden("check_suture", &run.out);
}

#[test]
fn a_check_is_one_json_object() {
    let run = strands(&["check", "slips.toml", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value and nothing else");
    assert_eq!(answer["scene"], "slips");
    let remarks = answer["remarks"].as_array().expect("remarks");
    let warnings = remarks.iter().filter(|remark| remark["level"] == "warning").count();
    assert_eq!(answer["warnings"], warnings);
    assert_eq!(
        (&remarks[0]["key"], &remarks[0]["line"]),
        (&"materials.steel.youngs_modulus".into(), &7.into())
    );
    let rod = &answer["rods"]["wire"];
    assert_eq!(
        (&rod["method"], &rod["elements"], &rod["length"]),
        (&"sweep".into(), &40.into(), &0.3.into())
    );
}

#[test]
fn overrides_are_checked_too() {
    let run = strands(&["check", "cantilever", "--set", "gravity=[0.0, 0.0, -9810.0]"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.contains("warning: gravity is 9810 m/s²"), "{}", run.out);
    assert!(strands(&["check", "cantilever", "--elements", "30"]).out.contains("30 elements"));
}

#[test]
fn a_scene_that_cannot_be_read_is_status_one() {
    let run = strands(&["check", "misspelt.toml"]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert!(run.err.contains("unknown key `lenght`"), "{}", run.err);
}

#[test]
fn a_solve_says_the_warnings_but_not_the_notes_on_standard_error() {
    let run = strands(&["solve", "slips.toml", "--json"]);
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value and nothing else");
    assert_eq!(answer["scene"], "slips");
    assert!(
        run.err.contains("warning: slips.toml:15: rods.wire.section.radius: the rod is 1 m thick"),
        "{}",
        run.err
    );
    assert!(run.err.lines().all(|line| line.starts_with("warning: slips.toml:")), "{}", run.err);
}
