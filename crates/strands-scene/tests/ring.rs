//! A thread that hangs over the wire of a ring, through which it slides or does not.

use core::f64::consts::PI;
use std::fmt::Write;
use strands::math::Vec3;
use strands_scene::{Model, Scene};

const FRICTION: f64 = 0.3;
const WIRE: f64 = 2e-3;
const THREAD: f64 = 1e-4;

/// The ring lies in the plane of x and z, a body that is held or an obstacle; both ends of the thread hang from its lowest place, 15 mm long, pulled by these
/// forces, N. It has the weight of what hangs from it.
fn hangs(pulled: [f64; 2], is_body: bool) -> Model {
    let (lowest, leg, away) = (-6e-3, 15e-3, WIRE + 1.25 * THREAD);
    let mut points = String::new();
    let mut point = |x: f64, y: f64| write!(points, "[{x}, {y}, 0.0], ").unwrap();
    for k in 0..6 {
        point(lowest - leg * (1.0 - f64::from(k) / 6.0), -away);
    }
    for k in 0..=12 {
        let (sin, cos) = (PI * f64::from(k) / 12.0).sin_cos();
        point(lowest + away * sin, -away * cos);
    }
    for k in 1..=6 {
        point(lowest - leg * f64::from(k) / 6.0, away);
    }
    let [one, other] = pulled;
    let turned = "orientation = [0.7071067811865476, 0.7071067811865476, 0.0, 0.0]";
    let ring = if is_body {
        format!(
            r#"
[[bodies]]
name = "ring"
shape = {{ shape = "ring", radius = 6e-3, wire_radius = {WIRE} }}
density = 7850.0
{turned}
support = {{ fix = ["position", "orientation"] }}"#
        )
    } else {
        format!("[[obstacles]]\nshape = \"ring\"\nradius = 6e-3\nwire_radius = {WIRE}\n{turned}")
    };
    let text = format!(
        r#"
format = 1
name = "ring"
[materials.silk]
youngs_modulus = 2e7
poisson_ratio = 0.4
density = 2e5
damping = 1e-3
[rods.thread]
material = "silk"
elements = 80
kinematics = "kirchhoff"
section = {{ shape = "circle", radius = {THREAD} }}
initial = {{ points = [{points}] }}
loads = [{{ at = "start", force = [-{one}, 0.0, 0.0] }}, {{ at = "end", force = [-{other}, 0.0, 0.0] }}]
[contact]
friction = {FRICTION}
{ring}
[dynamics]
start = "initial"
time_step = 5e-4
"#
    );
    Scene::parse(&text, "ring.toml", None).unwrap_or_else(|error| panic!("{error}")).model
}

#[test]
fn a_thread_sticks_in_a_ring_until_one_end_is_pulled_harder_by_the_friction_of_half_a_turn() {
    // The friction acts on the wire, and the tension in the axis of the thread, which is further out.
    let ratio = (FRICTION * PI * WIRE / (WIRE + THREAD)).exp();
    for (part, slides, is_body) in
        [(0.94, false, false), (1.06, true, false), (0.94, false, true), (1.06, true, true)]
    {
        let model = hangs([0.05, 0.05 * ratio * part], is_body);
        let mut simulation = model.simulation(model.motion(), model.start().unwrap()).unwrap();
        for step in 0..40 {
            simulation.step().unwrap_or_else(|failure| panic!("{part}, step {step}: {failure}"));
        }
        let state = simulation.state();
        let speed = -state.velocities[80].linear.x;
        assert!(if slides { speed > 0.2 } else { speed.abs() < 1e-4 }, "{part}, {is_body}: {speed} m/s");
        assert!(state.contacts.iter().all(|contact| contact.gap > 0.0));
        let rod = &model.rods[0].problem.rod;
        for (i, pair) in state.poses.windows(2).take(80).enumerate() {
            let strain = pair[0].between(&pair[1]).log().linear * (1.0 / rod.element_length(i));
            assert!((strain - Vec3::Z).max_abs() < 1e-6, "{part}, element {i}: {strain:?}");
        }
    }
}
