use super::*;
use strands::math::{Quat, Vec3};

fn suture() -> State {
    let scene = strands_scene::bundled_scene("suture").unwrap();
    State::open(scene.text, "suture.toml").unwrap()
}

#[test]
fn a_dragged_suture_follows_the_hand_and_stays_within_its_reach() {
    let mut state = suture();
    let start = state.hand;
    for i in 1..=60 {
        let a = f64::from(i) / 60.0;
        let turn = Quat::from_rotation_vector(Vec3::new(0.0, 0.0, 0.8 * a)).to_matrix();
        state.hand.position = start.position + Vec3::new(-0.03 * a, 0.02 * a, 0.02 * a);
        state.hand.rotation = start.rotation * turn;
        assert!(state.solve(0.0), "frame {i}: {}", state.report());
        assert!((tip(state.solution()).position - state.hand.position).norm() < 1e-9);
    }
    // Beyond its length the hand goes on, and the thread as far as it can.
    state.hand.position = Vec3::new(0.3, 0.2, 0.6);
    let away = |state: &State| (tip(state.solution()).position - state.hand.position).norm();
    let before = away(&state);
    go(&mut state);
    assert!((state.beyond() - (0.7 - 0.985 * 0.3)).abs() < 1e-12);
    assert!(away(&state) < before, "{}", state.report());
    assert!(tip(state.solution()).position.norm() < 0.3);
}

impl State {
    fn frames(&self) -> Vec<f64> {
        flat(&self.solution().poses)
    }
}

/// Solves and settles; gives how many bits of work it took.
fn go(state: &mut State) -> usize {
    if state.solve(0.0) {
        return 0;
    }
    (1..).find(|_| !state.settle()).unwrap_or(0)
}

#[test]
fn a_hand_that_one_search_does_not_reach_is_reached_in_bits() {
    let mut state = suture();
    state.hand.position += Vec3::new(-0.14, -0.05, 0.02);
    state.hand.rotation =
        state.hand.rotation * Quat::from_rotation_vector(Vec3::new(0.3, 0.0, 2.0)).to_matrix();
    let bits = go(&mut state);
    assert!(bits > 1, "{bits}");
    assert!(state.outcome.reason.is_none(), "{}", state.report());
    assert!((tip(state.solution()).position - state.hand.position).norm() < 1e-9);
}

#[test]
fn a_thread_that_was_let_go_comes_back_to_the_scene() {
    let mut state = suture();
    let opened = state.frames();
    for mode in [HandMode::Free, HandMode::Scene] {
        state.set_mode(mode).unwrap();
        assert!(state.solve(0.0), "{}", state.report());
        assert_eq!(state.solution().report.morse_index, Some(0), "{mode:?}");
    }
    assert!(apart(&state.frames(), &opened) < 1e-6);
}

#[test]
fn a_spring_takes_hold_without_moving_the_thread_and_then_pulls_it_along() {
    let mut state = suture();
    let held = state.frames();
    state.set_mode(HandMode::Coupling).unwrap();
    assert!(state.solve(1.0 / 60.0), "{}", state.report());
    assert!(apart(&state.frames(), &held) < 1e-6);
    let start = state.hand.position;
    for i in 1..=30 {
        state.hand.position = start + Vec3::new(-0.001 * f64::from(i), 0.0, 0.0);
        assert!(state.solve(1.0 / 60.0), "{i}: {}", state.report());
    }
    assert!((tip(state.solution()).position - state.hand.position).norm() < 1e-5);
    // A thread that is held more softly stays on its branch.
    let firm = state.frames();
    state.coupling.linear_stiffness = 0.05;
    assert_eq!(go(&mut state), 0, "{}", state.report());
    assert!(apart(&state.frames(), &firm) < 0.05);
}

/// The largest difference of two shapes.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_spring_takes_up_a_thread_that_was_let_go() {
    let mut state = suture();
    state.set_mode(HandMode::Free).unwrap();
    assert!(state.solve(0.0), "{}", state.report());
    let hanging = state.frames();
    assert!(tip(state.solution()).position.z < -0.2, "it does not hang: {}", state.report());
    state.set_mode(HandMode::Coupling).unwrap();
    // The damper must not take the fall for a move of the hand.
    assert!(state.solve(1.0 / 60.0), "{}", state.report());
    assert!(apart(&state.frames(), &hanging) < 1e-6);
}

#[test]
fn a_snapshot_brings_back_scene_hand_and_shape() {
    let mut state = suture();
    let (text, before, shape) = (state.file().to_json(), state.snapshot(), state.frames());
    state.replace(&text.replace("0.3", "0.31"), "scene.json").unwrap();
    state.hand.position.z += 0.02;
    assert!(state.solve(0.0));
    state.restore(&text, HandMode::Pose, &before).unwrap();
    assert!(apart(&state.frames(), &shape) < 1e-7);
    assert!(state.restore(&text, HandMode::Pose, &before[1..]).is_err());
}

#[test]
fn the_coupling_gives_no_more_than_the_device_can() {
    let ruler = strands_scene::bundled_scene("cantilever").unwrap();
    let mut state = State::open(ruler.text, "cantilever.toml").unwrap();
    state.set_mode(HandMode::Coupling).unwrap();
    state.coupling.max_force = 0.05;
    let start = state.hand.position;
    for i in 1..=30 {
        state.hand.position = start + Vec3::new(0.0, 0.0, 0.001 * f64::from(i));
        go(&mut state);
        assert!(state.outcome.reason.is_none(), "{i}: {}", state.report());
    }
    assert!(state.outcome.saturated, "{}", state.report());
    assert!((state.solution().end_reaction().force.norm() - 0.05).abs() < 1e-9);
}

#[test]
fn an_edited_scene_starts_from_the_last_shape() {
    let mut state = suture();
    let text = state.file().to_toml().replace("poisson_ratio = 0.4", "poisson_ratio = 0.3");
    state.replace(&text, "suture.toml").unwrap();
    assert_eq!(state.outcome.report.path_steps, 1);
    assert!(state.replace("nonsense = 1", "suture.toml").unwrap_err().contains("nonsense"));
}

#[test]
fn a_coupling_that_no_scene_could_have_is_refused_and_the_last_good_one_stays() {
    let mut state = suture();
    let good = state.coupling();
    for (i, value, must) in [
        (0, 0.0, "linear_stiffness must be greater than zero, but is 0"),
        (1, -1.0, "angular_stiffness must be greater than zero, but is -1"),
        (2, -0.5, "linear_damping must not be negative, but is -0.5"),
        (3, f64::INFINITY, "angular_damping must be a finite number, but is inf"),
        (4, 0.0, "max_force must be greater than zero, but is 0"),
        (5, f64::NAN, "max_torque must be a finite number, but is NaN"),
    ] {
        let mut numbers = good;
        numbers[i] = value;
        assert_eq!(state.set_coupling(numbers).unwrap_err(), must);
        assert_eq!(state.coupling(), good);
    }
    let mut snapshot = state.snapshot();
    snapshot[30] = 0.0;
    let text = state.file().to_json();
    assert!(state.restore(&text, HandMode::Pose, &snapshot).unwrap_err().contains("linear_stiffness"));
    state.set_coupling([1.0, 1.0, 0.0, 0.0, f64::INFINITY, f64::INFINITY]).unwrap();
    assert_eq!(state.coupling()[4], f64::INFINITY);
}

#[test]
fn a_spring_too_soft_to_hold_the_thread_does_not_take_hold() {
    let mut state = suture();
    let hand = state.hand;
    state.set_coupling([1e-320, 1.0, 0.0, 0.0, f64::INFINITY, f64::INFINITY]).unwrap();
    assert!(state.set_mode(HandMode::Coupling).unwrap_err().contains("too soft"));
    assert_eq!((state.mode, state.hand), (HandMode::Pose, hand));
    assert!(state.solve(0.0), "{}", state.report());
}

/// Two rods without weight, the second of them in the hand, its end held at its length in metres.
const TWO: &str = r#"
format = 1
name = "two"

[rods.still]
length = 0.2
elements = 10
kinematics = "kirchhoff"
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }
position = [0.1, 0.0, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]

[rods.held]
length = 0.3
elements = 20
kinematics = "kirchhoff"
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }
supports = [
    { at = 0, fix = ["position", "orientation"] },
    { at = 0.3, fix = ["position", "orientation"], position = [0.05, 0.0, 0.25] },
]

[coupling.hand]
rod = "held"
at = 0.3
linear_stiffness = 50.0
angular_stiffness = 0.5
"#;

#[test]
fn a_saved_scene_opens_where_the_hand_has_brought_it_with_the_spring_as_it_was_set() {
    let mut state = State::open(TWO, "two.toml").unwrap();
    assert_eq!(state.rod().name, "held");
    state.hand.position += Vec3::new(0.01, 0.02, 0.0);
    assert!(state.solve(0.0), "{}", state.report());
    let numbers = [70.0, 0.7, 0.0, 0.01, 2.0, f64::INFINITY];
    state.set_coupling(numbers).unwrap();
    let saved = state.file_with_hand().to_toml();
    let opened = State::open(&saved, "saved.toml").unwrap_or_else(|error| panic!("{error}\n{saved}"));
    assert_eq!(opened.file().rods["held"].supports.len(), 2);
    assert!((opened.hand.position - state.hand.position).norm() < 1e-12);
    assert_eq!(opened.coupling(), numbers);
    // An edit of the scene keeps it.
    state.replace(&state.file().to_json(), "scene.json").unwrap();
    assert_eq!(State::open(&state.file().to_json(), "scene.json").unwrap().coupling(), numbers);
}

#[test]
fn a_spring_that_nobody_has_set_is_not_written() {
    let ruler = strands_scene::bundled_scene("cantilever").unwrap();
    let mut state = State::open(ruler.text, "cantilever.toml").unwrap();
    let (text, snapshot) = (state.file().to_json(), state.snapshot());
    assert!(state.file().coupling.is_none());
    state.set_mode(HandMode::Coupling).unwrap();
    assert!(state.file_with_hand().coupling.is_none());
    let usual = state.coupling();
    state.set_coupling([2.0, 2.0, 0.0, 0.0, 2.0, 2.0]).unwrap();
    assert!(state.file_with_hand().coupling.is_some());
    state.restore(&text, HandMode::Free, &snapshot).unwrap();
    assert_eq!(state.coupling(), usual);
    assert!(state.file_with_hand().coupling.is_none());
}

#[test]
fn the_rod_in_the_hand_stays_the_one_that_it_is_when_an_edited_scene_has_the_rods_in_another_order() {
    let mut state = State::open(TWO, "two.toml").unwrap();
    let names = |state: &State| state.others().map(|(rod, _)| rod.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&state), ["still"]);
    let mut file = state.file().clone();
    file.rods.reverse();
    file.rods["held"].elements = Some(30);
    state.replace(&file.to_json(), "scene.json").unwrap();
    assert_eq!((state.rod().name.as_str(), state.solution().strain.len()), ("held", 30));
    assert_eq!(names(&state), ["still"]);
    assert!(state.report().contains(r#""rod":"held""#), "{}", state.report());
}

#[test]
fn a_hand_that_jumped_out_of_reach_is_given_up_without_a_start_from_rest_which_is_kept_for_one_within() {
    let mut state = suture();
    state.hand.position = Vec3::new(0.9, 0.0, 0.06);
    go(&mut state);
    assert!(state.beyond() > 0.5 && state.outcome.reason.is_some(), "{}", state.report());
    assert!(!state.stuck);
    state.hand.position = Vec3::new(0.1, 0.0, 0.06);
    go(&mut state);
    assert!(state.outcome.reason.is_none(), "{}", state.report());
}

/// A strip clamped at both ends, which are so near to each other that it is an arch.
const ARCH: &str = include_str!("arch.toml");

#[test]
fn an_arch_whose_end_is_turned_snaps_to_the_other_side_once_and_says_so() {
    let mut state = State::open(ARCH, "arch.toml").unwrap();
    state.set_mode(HandMode::Pose).unwrap();
    let rise = |state: &State| state.solution().poses[50].position.y;
    let side = rise(&state).signum();
    assert!(rise(&state).abs() > 0.02, "{}", rise(&state));
    let start = state.hand.rotation;
    let mut snaps = 0;
    for i in 1..=100 {
        let turn = Vec3::new(-0.02 * side * f64::from(i), 0.0, 0.0);
        state.hand.rotation = start * Quat::from_rotation_vector(turn).to_matrix();
        let before = rise(&state);
        assert!(state.solve(0.0), "frame {i}: {}", state.report());
        let report: serde_json::Value = serde_json::from_str(&state.report()).unwrap();
        assert_eq!(report["morse_index"], 0, "frame {i}");
        assert!(report["residual"].as_f64().unwrap() <= 1e-9, "frame {i}: {report}");
        if report["snapped"] == true {
            snaps += 1;
            assert!(
                before * side > 0.0 && rise(&state) * side < 0.0,
                "frame {i}: from {before} to {}",
                rise(&state)
            );
        }
    }
    assert_eq!(snaps, 1, "rise {} of side {side}", rise(&state));
    assert!(rise(&state) * side < 0.0);
}

#[test]
fn the_end_of_a_cable_that_is_held_between_can_be_dragged() {
    let scene = strands_scene::bundled_scene("clipped_cable").unwrap();
    let mut state = State::open(scene.text, "clipped_cable.toml").unwrap();
    state.set_mode(HandMode::Pose).unwrap();
    let start = state.hand.position;
    for i in 1..=20 {
        state.hand.position = start + Vec3::new(-0.002, 0.0, 0.003) * f64::from(i);
        assert!(state.solve(0.0), "frame {i}: {}", state.report());
        assert!(!state.snapped, "frame {i}");
        assert_eq!(state.solution().report.path_steps, 1, "frame {i}: from rest");
    }
    let report: serde_json::Value = serde_json::from_str(&state.report()).unwrap();
    assert_eq!(report["between"].as_array().unwrap().len(), 5);
    assert_eq!(report["between"][0]["node"], 35);
}

#[test]
fn rods_that_are_tied_are_shown_where_they_start_to_move() {
    for name in ["willow", "hanging_net", "spiders_ring", "needle_and_thread"] {
        let scene = strands_scene::bundled_scene(name).unwrap();
        let mut state = State::open(scene.text, "scene.toml").unwrap();
        assert!(state.moves_only());
        let report: serde_json::Value = serde_json::from_str(&state.report()).unwrap();
        assert_eq!((&report["moves_only"], &report["status"]), (&true.into(), &"converged".into()), "{name}");
        let opened = state.frames();
        // A hand has nothing to hold there.
        state.hand.position += Vec3::new(0.1, 0.0, 0.0);
        assert!(state.solve(0.0) && !state.settle());
        assert!(state.set_mode(HandMode::Pose).unwrap_err().contains("let it move"));
        assert_eq!(state.frames(), opened);
        // Through the page and back.
        let json = state.file().to_json();
        state.replace(&json, "scene.json").unwrap();
        assert_eq!(state.frames(), opened, "{name}");
        let snapshot = state.snapshot();
        state.restore(&json, HandMode::Scene, &snapshot).unwrap();
        assert_eq!(state.frames(), opened, "{name}");
    }
    assert!(!suture().moves_only());
}
