use super::*;
use strands::math::Vec3;

fn opened(name: &str) -> Moving {
    let scene = strands_scene::bundled_scene(name).unwrap();
    Moving::open(scene.text, "scene.toml").unwrap()
}

/// A clock that stands still.
fn still() -> f64 {
    0.0
}

fn numbers(moving: &Moving) -> serde_json::Value {
    serde_json::from_str(&moving.report()).unwrap()
}

/// A rope that falls from where it lies along x.
const ROPE: &str = r#"
format = 1
name = "rope"
gravity = [0.0, 0.0, -9.81]

[rods.rope]
length = 0.5
elements = 20
kinematics = "kirchhoff"
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }
mass_per_length = 0.02
rotational_inertia_per_length = [1e-7, 1e-7, 2e-7]
orientation = [0.70710678118654752, 0.0, 0.70710678118654752, 0.0]
supports = [{ at = "start", fix = ["position"] }]

[dynamics]
start = "rest"
time_step = 2e-3
"#;

fn rope() -> Moving {
    Moving::open(ROPE, "rope.toml").unwrap()
}

fn at(moving: &Moving, node: usize) -> Vec3 {
    moving.rods.pose(0, node).position
}

#[test]
fn time_that_passes_makes_the_steps_that_it_holds_and_keeps_the_rest() {
    let mut moving = rope();
    assert!(moving.advance(0.005, f64::INFINITY, still));
    assert_eq!(numbers(&moving)["steps"], 2);
    // What is shown is halfway from the first step to the second.
    let [before, now] = [moving.rods.between(0.0), moving.rods.between(1.0)];
    let middle = (before[20].position + now[20].position) * 0.5;
    assert!((moving.shown()[20].position - middle).norm() < 1e-12);
    assert!(moving.advance(0.001, f64::INFINITY, still));
    assert_eq!(numbers(&moving)["steps"], 3);
    assert!(moving.advance_by_one(still));
    assert_eq!(numbers(&moving)["steps"], 4);
    assert_eq!(moving.shown()[20], moving.rods.pose(0, 20));
    assert!((numbers(&moving)["time"].as_f64().unwrap() - 0.008).abs() < 1e-15);
}

#[test]
fn a_budget_that_is_spent_gives_the_rest_of_the_time_up_and_says_how_much() {
    let mut moving = rope();
    let ticks = std::cell::Cell::new(0.0);
    // Every look at the clock takes 3 ms.
    let clock = || {
        ticks.set(ticks.get() + 3.0);
        ticks.get()
    };
    assert!(moving.advance(0.1, 8.0, clock));
    let report = numbers(&moving);
    assert_eq!(report["steps"], 3);
    assert!((report["behind"].as_f64().unwrap() - 0.094).abs() < 1e-12, "{report}");
    assert!(report["step_ms"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_start_is_gone_back_to_to_the_same_bits() {
    let mut moving = rope();
    let start = moving.shown();
    assert!(moving.advance(0.1, f64::INFINITY, still));
    let later = moving.shown();
    assert!(start[20].position.z - later[20].position.z > 0.02);
    moving.grab(0, 10);
    moving.rewind();
    assert_eq!(moving.shown(), start);
    assert_eq!(numbers(&moving)["time"], 0.0);
    assert!(moving.advance(0.1, f64::INFINITY, still));
    assert_eq!(moving.shown(), later);
}

#[test]
fn what_is_grabbed_follows_the_hand_and_flies_on_when_it_is_let_go() {
    let mut moving = rope();
    moving.grab(0, 12);
    let start = at(&moving, 12);
    let turn = moving.rods.pose(0, 12).rotation;
    let aim = start + Vec3::new(-0.05, 0.1, 0.05);
    for i in 1..=60 {
        let part = f64::from(i) / 60.0;
        moving.pull(Pose { rotation: turn, position: start + (aim - start) * part });
        assert!(moving.advance(1.0 / 60.0, f64::INFINITY, still), "{}", moving.report());
    }
    // It lags a little behind a hand that moves, and hangs a little below.
    assert!((at(&moving, 12) - aim).norm() < 0.01, "{:?} {aim:?}", at(&moving, 12));
    let force = numbers(&moving)["grabbed"]["force"][2].as_f64().unwrap();
    assert!(force > 0.02, "{force} N lift a rope of 0.1 N");
    moving.release();
    assert!(numbers(&moving)["grabbed"].is_null());
    let released = at(&moving, 12);
    assert!(moving.advance(0.05, f64::INFINITY, still));
    let flown = at(&moving, 12) - released;
    assert!(flown.y > 0.0 && flown.norm() > 0.002, "{flown:?}");
    // Nothing of the hand is left.
    assert_eq!(moving.rods.problem(0).unwrap().between.len(), 0);
}

#[test]
fn a_hand_out_of_reach_pulls_no_harder_than_its_spring_and_no_step_fails() {
    let mut moving = rope();
    moving.grab(0, 20);
    let turn = moving.rods.pose(0, 20).rotation;
    moving.pull(Pose { rotation: turn, position: Vec3::new(3.0, 1.0, 2.0) });
    assert!(moving.advance(1.0, f64::INFINITY, still), "{}", moving.report());
    assert!(at(&moving, 20).norm() < 0.5 + 1e-6);
    moving.release();
    assert!(moving.advance(1.0, f64::INFINITY, still), "{}", moving.report());
}

#[test]
fn a_support_that_is_grabbed_moves_along_and_stays_where_it_is_brought() {
    let mut moving = opened("suture");
    let last = moving.rods.problem(0).unwrap().rod.elements();
    let start = moving.rods.pose(0, last);
    moving.grab(0, last);
    let aim = Pose { position: start.position + Vec3::new(-0.02, 0.01, 0.01), ..start };
    moving.pull(aim);
    assert!(moving.advance(0.5, f64::INFINITY, still), "{}", moving.report());
    moving.release();
    let brought = moving.rods.pose(0, last);
    assert!((brought.position - aim.position).norm() < 3e-4, "{brought:?}");
    assert!(brought.rotation.turn_to(&aim.rotation).norm() < 0.02);
    assert!(moving.advance(0.1, f64::INFINITY, still));
    assert_eq!(moving.rods.pose(0, last), brought);
}

#[test]
fn every_bundled_scene_moves() {
    for scene in strands_scene::bundled() {
        let mut moving =
            Moving::open(scene.text, "scene.toml").unwrap_or_else(|why| panic!("{}: {why}", scene.name));
        assert!(moving.advance(0.05, f64::INFINITY, still), "{}: {}", scene.name, moving.report());
        let nodes = moving.shown().len();
        assert_eq!(moving.rods.half_extent().len(), 2 * nodes);
        let borne = moving.rods.borne();
        let elements = 6 * borne.energy_density.len();
        assert_eq!((borne.strain.len(), borne.stress.len()), (elements, elements));
    }
}

#[test]
fn a_knot_is_pulled_tight_by_one_of_its_ends() {
    let mut knot = opened("overhand_knot");
    assert!(knot.advance(0.1, f64::INFINITY, still), "{}", knot.report());
    let (last, began) = (100, knot.rods.pose(0, 100));
    knot.grab(0, last);
    for millimetre in 1..=40 {
        let position = began.position + Vec3::new(1e-3 * f64::from(millimetre), 0.0, 0.0);
        knot.pull(Pose { position, ..began });
        assert!(knot.advance(0.02, f64::INFINITY, still), "{millimetre} mm: {}", knot.report());
    }
    // It has come along nearly all the way, and what is left of the loop is tight.
    let came = knot.rods.pose(0, last).position.x - began.position.x;
    assert!(came > 0.035, "{came}");
    assert!(knot.rods.contacts().len() > 3);
    assert!(knot.rods.contacts().iter().all(|contact| contact.gap > 0.0));
}

#[test]
fn the_scenes_that_open_in_motion_move_for_seconds() {
    for name in ["swinging_rope", "whip", "hair_tuft", "needle_and_thread"] {
        let mut moving = opened(name);
        let first = moving.shown();
        assert!(moving.advance(3.0, f64::INFINITY, still), "{name}: {}", moving.report());
        let last = moving.shown();
        let moved = last.iter().zip(&first).map(|(a, b)| (a.position - b.position).norm());
        assert!(moved.fold(0.0, f64::max) > 0.04, "{name}");
    }
}

#[test]
fn a_step_that_cannot_be_made_leaves_the_state_and_is_said() {
    let short = ROPE.replace("time_step = 2e-3", "time_step = 1e-13");
    let mut moving = Moving::open(&short, "rope.toml").unwrap();
    let start = moving.shown();
    assert!(!moving.advance(1e-12, f64::INFINITY, still));
    let report = numbers(&moving);
    assert!(report["failure"].as_str().unwrap().starts_with("at 0.0 s"), "{report}");
    assert_eq!((&report["steps"], moving.rods.between(1.0)), (&0.into(), start));
}

#[test]
fn what_a_scene_asks_for_and_there_is_not_is_said() {
    let said =
        |change: &str| Moving::open(&ROPE.replace("start = \"rest\"", change), "rope.toml").err().unwrap();
    assert!(said("start = \"tomorrow\"").contains("the page cannot read tomorrow"));
    let massless = ROPE.replace("mass_per_length = 0.02", "mass_per_length = 0.0");
    assert!(Moving::open(&massless, "rope.toml").err().unwrap().contains("mass"));
}

#[test]
fn bodies_have_shapes_and_move_with_what_ties_them() {
    let mut web = opened("spiders_ring");
    assert_eq!(web.bodies[0]["name"], "spider");
    assert_eq!(web.bodies[0]["shape"], serde_json::json!({ "kind": "ball", "radius": 6e-3 }));
    let start = web.shown_bodies()[0].position;
    assert!(web.advance(0.2, f64::INFINITY, still), "{}", web.report());
    let hangs = web.shown_bodies()[0].position;
    assert!(hangs.z < start.z - 1e-4, "{start:?} {hangs:?}");
    // Its spokes end where it is.
    let ends = web.rods.problem(1).unwrap().rod.elements();
    assert!((web.rods.pose(1, ends).position - hangs).norm() < 1e-2);

    // A ball of the needle's mass stands for the needle.
    let needle = opened("needle_and_thread");
    let radius = needle.bodies[0]["shape"]["radius"].as_f64().unwrap();
    assert!((4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 2000.0 - 57.708e-6).abs() < 1e-12);
}

#[test]
fn a_knot_of_a_net_is_grabbed_and_pulled_up() {
    let mut net = opened("hanging_net");
    // Where the second ropes of both directions cross: a joint holds the node of the one at that of the other.
    let (along, across) = ((1, 4), (5, 4));
    let knot = |net: &Moving, (rod, node): (usize, usize)| net.rods.pose(rod, node).position;
    assert!((knot(&net, along) - knot(&net, across)).norm() < 1e-9);
    for (rod, node) in [along, across] {
        net.rewind();
        let start = net.rods.pose(rod, node);
        net.grab(rod, node);
        net.pull(Pose { position: start.position + Vec3::new(0.0, 0.0, 0.03), ..start });
        assert!(net.advance(0.5, f64::INFINITY, still), "{}", net.report());
        let lifted = knot(&net, (rod, node)).z - start.position.z;
        assert!(lifted > 0.02, "rod {rod}: lifted by {lifted} m");
        assert!((knot(&net, along) - knot(&net, across)).norm() < 1e-6);
        net.release();
        assert!(net.advance(0.1, f64::INFINITY, still), "{}", net.report());
    }
}

#[test]
fn what_falls_on_a_floor_is_borne_by_its_contacts() {
    let scene = include_str!("../../../../examples/strands_on_a_floor.toml");
    let mut falling = Moving::open(scene, "strands_on_a_floor.toml").unwrap();
    let floor = serde_json::json!({ "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0] });
    assert_eq!(falling.obstacles, serde_json::json!([floor]));
    assert!(falling.rods.contacts().is_empty());
    assert!(falling.advance(0.3, f64::INFINITY, still), "{}", falling.report());
    let numbers = obstacles::flat(falling.rods.contacts());
    assert_eq!(numbers.len(), 9 * falling.rods.contacts().len());
    // The floor bears the weight of both; what they exert on each other is further up.
    let on_floor = |contact: &&[f64]| contact[2].abs() < 1e-4;
    let lift: f64 = numbers.chunks(9).filter(on_floor).map(|contact| contact[8]).sum();
    let weight = 9.81 * (0..2).map(|rod| falling.rods.problem(rod).unwrap().rod.mass()).sum::<f64>();
    assert!((lift / weight - 1.0).abs() < 0.2, "{lift} N bear {weight} N");
    falling.rewind();
    assert!(falling.rods.contacts().is_empty());
}

#[test]
fn obstacles_of_all_shapes_are_described() {
    let obstacles = r#"
[contact]

[[obstacles]]
shape = "sphere"
position = [0.0, 0.3, 0.0]
radius = 0.1

[[obstacles]]
shape = "cylinder"
position = [0.0, 0.0, -1.0]
radius = 0.1
length = 0.4

[[obstacles]]
shape = "tube"
radius = 2.0

[[obstacles]]
shape = "box"
position = [0.0, 0.0, -2.0]
size = [0.1, 0.2, 0.4]

[[obstacles]]
shape = "ring"
position = [0.0, 0.0, -3.0]
radius = 0.2
wire_radius = 0.05
"#;
    let moving = Moving::open(&format!("{ROPE}{obstacles}"), "rope.toml").unwrap();
    let [ball, cylinder, tube, block, ring] = moving.obstacles.as_array().unwrap().as_slice() else {
        panic!()
    };
    let ends = [[0.0, 0.3, 0.0], [0.0, 0.3, 0.0]];
    assert_eq!(*ball, serde_json::json!({ "kind": "capsule", "ends": ends, "radius": 0.1 }));
    assert_eq!(cylinder["kind"], "cylinder");
    assert_eq!(cylinder["ends"], serde_json::json!([[0.0, 0.0, -1.2], [0.0, 0.0, -0.8]]));
    assert_eq!((&tube["kind"], &tube["axis"]), (&"tube".into(), &serde_json::json!([0.0, 0.0, 1.0])));
    let [middle, axis] = [[0.0, 0.0, -3.0], [0.0, 0.0, 1.0]];
    let torus = serde_json::json!({ "kind": "ring", "point": middle, "axis": axis, "radius": 0.2, "wire_radius": 0.05 });
    assert_eq!(*ring, torus);
    assert_eq!(block["kind"], "mesh");
    assert_eq!(block["corners"].as_array().unwrap().len(), 3 * 8);
    assert_eq!(block["triangles"].as_array().unwrap().len(), 3 * 12);
}

#[test]
fn a_ring_is_drawn_where_an_eyelet_has_given_way() {
    let eyelet = "\n[contact]\n\n[[eyelets]]\nrod = \"rope\"\nat = 0.25\nstiffness = 50.0\n";
    let mut hung = Moving::open(&format!("{ROPE}{eyelet}"), "rope.toml").unwrap();
    assert_eq!(hung.shown_passages()[..3], at(&hung, 10).to_array());
    assert!(hung.advance(0.3, f64::INFINITY, still), "{}", hung.report());
    hung.pace.stop();
    let ring = hung.shown_passages();
    let [point, direction, force] = [0, 3, 6].map(|i| Vec3::new(ring[i], ring[i + 1], ring[i + 2]));
    assert_eq!(ring.len(), 9);
    assert!((direction.norm() - 1.0).abs() < 1e-12);
    assert!(force.z > 0.05, "{force:?} N bear a rope of 0.1 N");
    let eyelet = point + force * (1.0 / 50.0);
    assert!((eyelet - Vec3::new(0.25, 0.0, 0.0)).norm() < 1e-6, "{eyelet:?}");
}
