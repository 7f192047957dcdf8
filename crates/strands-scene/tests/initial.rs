//! Motion that starts from a shape of its own.

use std::fmt::Write;
use strands::dynamics::Simulation;
use strands::math::{Pose, Strain, Vec3};
use strands_scene::{Model, Scene};

const RADIUS: f64 = 0.05;

fn model(kinematics: &str, length: &str, initial: &str) -> Model {
    let text = format!(
        r#"
format = 1
name = "bent"
[materials.nylon]
youngs_modulus = 750e6
poisson_ratio = 0.4
density = 1300.0
[rods.thread]
material = "nylon"
{length}
elements = 60
kinematics = "{kinematics}"
section = {{ shape = "circle", radius = 0.2e-3 }}
initial = {initial}
supports = [{{ at = "start", fix = ["position", "orientation"] }}, {{ at = "end", fix = ["position"] }}]
[dynamics]
start = "initial"
"#
    );
    Scene::parse(&text, "bent.toml", None).unwrap_or_else(|error| panic!("{error}")).model
}

fn started(model: &Model) -> Simulation {
    model.simulation(model.motion(), model.start().unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

/// Points on a quarter of a circle in the plane of y and z.
fn quarter() -> String {
    let mut points = String::new();
    for k in 0..=500 {
        let (sin, cos) = (core::f64::consts::FRAC_PI_2 * f64::from(k) / 500.0).sin_cos();
        write!(points, "[0, {}, {}], ", RADIUS * (1.0 - cos), RADIUS * sin).unwrap();
    }
    points
}

#[test]
fn a_straight_rod_that_starts_along_an_arc_is_bent_and_twisted_as_the_arc_says() {
    for kinematics in ["kirchhoff", "cosserat"] {
        let model = model(kinematics, "", &format!("{{ points = [{}], twist = 30.0 }}", quarter()));
        let simulation = started(&model);
        let (rod, poses) = (&model.rods[0].problem.rod, &simulation.state().poses);
        assert!((rod.length() / (core::f64::consts::FRAC_PI_2 * RADIUS) - 1.0).abs() < 1e-5);
        for (i, pair) in poses.windows(2).enumerate() {
            let strain = pair[0].between(&pair[1]).log() * (1.0 / rod.element_length(i));
            let bend = strain.angular.x.hypot(strain.angular.y);
            assert!((bend * RADIUS - 1.0).abs() < 0.01, "{i}: {bend}");
            assert!((strain.angular.z - 30.0).abs() < 1e-9, "{i}: {strain:?}");
            // It neither stretches nor shears.
            assert!((strain.linear - Vec3::Z).max_abs() < 1e-12, "{i}: {strain:?}");
        }
        for pose in poses {
            let off = (pose.position - Vec3::new(0.0, RADIUS, 0.0)).norm() - RADIUS;
            assert!(off.abs() < 2e-4 * RADIUS, "{off:e}");
        }
        assert!((poses[0].rotation.cols[0] - Vec3::X).max_abs() < 1e-12);
        // It sets off with the energy of that, and goes back.
        let energy = simulation.energy();
        let (bending, torsion) = (1.0 / RADIUS, 30.0);
        let inertia = core::f64::consts::PI * 0.2e-3_f64.powi(4) / 4.0;
        let expected = 0.5 * rod.length() * 750e6 * inertia * (bending * bending + torsion * torsion / 1.4);
        assert!((energy.elastic / expected - 1.0).abs() < 0.02, "{} for {expected}", energy.elastic);
        assert!(energy.kinetic == 0.0);
    }
}

#[test]
fn supports_hold_a_rod_where_it_starts() {
    let model = model("kirchhoff", "", &format!("{{ points = [{}] }}", quarter()));
    let mut simulation = started(&model);
    let began: Vec<Pose> = simulation.state().poses.clone();
    for step in 0..20 {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
    }
    let poses = &simulation.state().poses;
    let moved = |i: usize| (poses[i].position - began[i].position).norm();
    assert!(moved(0) < 1e-12 && moved(60) < 1e-9, "{:e} {:e}", moved(0), moved(60));
    assert!(moved(30) > 5e-4, "{:e}", moved(30));
}

#[test]
fn a_helix_starts_where_the_rod_does() {
    let initial = "{ helix = { radius = 5e-3, pitch = 4e-3 } }";
    let model = model("cosserat", "length = 0.1\nposition = [0.1, 0.2, 0.3]", initial);
    let poses = started(&model).state().poses.clone();
    let rise = 4e-3 / core::f64::consts::TAU;
    let curvature = 5e-3 / (5e-3 * 5e-3 + rise * rise);
    let rest = strands::rod::RestShape::helix(5e-3, 4e-3).unwrap().curvature(0.0, 0.0);
    let exact = |s: f64| poses[0].compose(&Pose::exp(Strain { angular: rest, linear: Vec3::Z } * s));
    for (i, pair) in poses.windows(2).enumerate() {
        let strain = pair[0].between(&pair[1]).log() * (60.0 / 0.1);
        let bend = strain.angular.x.hypot(strain.angular.y);
        assert!((bend / curvature - 1.0).abs() < 0.02, "{i}: {bend}");
        let off = (pair[1].position - exact(0.1 * (i + 1) as f64 / 60.0).position).norm();
        assert!(off < 0.02 * 5e-3, "{i}: {off:e}");
    }
    assert!((poses[0].position - Vec3::new(0.1, 0.2, 0.3)).norm() < 1e-12);
}
