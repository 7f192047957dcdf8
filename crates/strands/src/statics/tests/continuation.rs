//! Paths of equilibria, against closed forms.

use super::*;
use core::f64::consts::PI;

/// A straight rod along x, softer in bending about its `d1`, under a force at its end along x.
fn column(order: Order, elements: usize, force: f64) -> Problem {
    let turned = Quat::from_rotation_vector(Vec3::new(0.0, 0.5 * PI, 0.0));
    let description = RodDescription {
        base: Pose::from_parts(Vec3::ZERO, turned),
        ..description(Kinematics::Kirchhoff, RestShape::default())
    };
    let rod = Rod::with_elements(description, elements, &[], order).unwrap();
    let load = PointLoad { at: 0.8, wrench: Wrench::new(Vec3::ZERO, Vec3::X * force), frame: Frame::World };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

/// The complete elliptic integral of the first kind, by the arithmetic–geometric mean.
fn elliptic_k(modulus: f64) -> f64 {
    let (mut a, mut g) = (1.0_f64, (1.0 - modulus * modulus).sqrt());
    while (a - g).abs() > 1e-15 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    0.5 * PI / a
}

const CRITICAL: f64 = 0.25 * PI * PI * 0.05 / 0.64;

fn path(problem: impl Fn(f64) -> Problem, settings: &PathSettings) -> Path {
    let family = |at: f64| Ok::<Problem, std::convert::Infallible>(problem(at));
    follow_path(family, settings, &mut Workspace::default()).unwrap()
}

/// A thin thread, clamped and held upright, in gravity.
fn thread(kinematics: Kinematics, order: Order, end: Vec3) -> Problem {
    let nylon = Material::from_poisson(2e9, 0.39, 1140.0).unwrap();
    let description = RodDescription {
        length: 0.3,
        kinematics,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 150e-6 },
            material: nylon,
        }]),
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 60, &[], order).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.0, -9.81));
    let turned = Quat::from_rotation_vector(Vec3::new(0.0, 0.5 * PI, 0.0));
    Problem { loads, end: Support::clamped(Pose::from_parts(end, turned)), ..Problem::cantilever(rod) }
}

#[test]
fn a_rod_that_is_stiff_against_stretching_is_followed_in_few_steps() {
    let (stretching, not) = (Kinematics::Cosserat, Kinematics::Kirchhoff);
    for (kinematics, order) in
        [(stretching, Order::Second), (not, Order::Second), (stretching, Order::Fourth), (not, Order::Fourth)]
    {
        let end = |at: f64| Vec3::new(0.1 - 0.05 * at, 0.0, 0.2 - 0.1 * at);
        let path = path(|at| thread(kinematics, order, end(at)), &PathSettings::default());
        assert_eq!(path.end, PathEnd::Reached, "{kinematics:?} {order:?}");
        assert!(path.points.len() < 60, "{kinematics:?} {order:?}: {} points", path.points.len());
    }
}

#[test]
fn a_path_out_of_reach_ends_where_the_rod_is_straight() {
    let end = |at: f64| Vec3::new(0.1 + 0.3 * at, 0.0, 0.2);
    let path = path(|at| thread(Kinematics::Kirchhoff, Order::Second, end(at)), &PathSettings::default());
    let PathEnd::Stuck { why } = &path.end else { panic!("{:?}", path.end) };
    assert!(why.contains("pulled straight"), "{why}");
    let last = path.points.last().unwrap().at;
    assert!(end(last).norm() <= 0.3 && end(last).norm() > 0.299, "{}", end(last).norm());
    assert!(path.points.len() < 400, "{} points", path.points.len());
}

#[test]
fn a_column_branches_at_eulers_loads() {
    let settings = PathSettings::default();
    let path = path(|at| column(Order::Fourth, 32, -at * 10.0 * CRITICAL), &settings);
    assert_eq!(path.end, PathEnd::Reached);
    assert!((path.points.last().unwrap().at - 1.0).abs() < 1e-12);
    // About d1 (EI = 0.05) at 1 and 9 times, about d2 (EI = 0.08) at 1.6 times.
    let expected = [0.1, 0.16, 0.9];
    assert_eq!(path.events.len(), expected.len(), "{:?}", path.events);
    for (i, (event, at)) in path.events.iter().zip(expected).enumerate() {
        assert_eq!(event.kind, EventKind::Bifurcation);
        assert_eq!(event.morse_index, [Some(i), Some(i + 1)]);
        assert!((event.at / at - 1.0).abs() < 1e-4, "{} of {at}", event.at);
    }
}

#[test]
fn the_branch_on_request_is_the_elastica() {
    let settings = PathSettings { switch_at: Some(0), ..PathSettings::default() };
    let path = path(|at| column(Order::Fourth, 40, -at * 2.0 * CRITICAL), &settings);
    assert_eq!(path.end, PathEnd::Reached);
    let last = &path.points.last().unwrap().solution;
    assert_eq!(last.report.morse_index, Some(0));
    // P/P_cr = (2 K(sin α/2)/π)², with α the angle of the tip (Timoshenko & Gere 1961, art. 2.7).
    let tangent = last.poses[40].rotation.cols[2];
    let angle = tangent.y.hypot(tangent.z).atan2(tangent.x);
    let load = (2.0 * elliptic_k((0.5 * angle).sin()) / PI).powi(2);
    assert!((load / 2.0 - 1.0).abs() < 1e-5, "{load}");
    // It bends about the softer axis.
    assert!(tangent.dot(column(Order::Second, 4, 0.0).rod.description().base.rotation.cols[1]).abs() > 0.5);
}

#[test]
fn a_path_goes_round_folds() {
    // A shallow clamped arch pressed at its middle snaps through. Its path turns back where it snaps down, and again where it would snap up.
    let problem = |at: f64| {
        let rest = RestShape::Constant(Vec3::new(1.0, 0.0, 0.0));
        let rod =
            Rod::with_elements(description(Kinematics::Cosserat, rest), 60, &[], Order::Second).unwrap();
        let poses = rod.rest_poses();
        let outwards =
            (poses[30].position - (poses[0].position + poses[60].position) * 0.5).normalized().unwrap();
        let load = PointLoad {
            at: 0.4,
            wrench: Wrench::new(Vec3::ZERO, outwards * (-6.0 * at)),
            frame: Frame::World,
        };
        let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
        Problem { loads, end: Support::clamped(poses[60]), ..Problem::cantilever(rod) }
    };
    let path = path(problem, &PathSettings::default());
    let folds: Vec<&Event> = path.events.iter().filter(|event| event.kind == EventKind::Fold).collect();

    println!("{:?} {:?} {}", path.end, path.events, path.points.len());
    assert_eq!(path.end, PathEnd::Reached);
    assert!(folds.len() >= 2);
    for fold in &folds {
        // The parameter is at its extreme there.
        let (before, after) = (&path.points[fold.after_points - 1], &path.points[fold.after_points]);
        let sign = (fold.at - before.at).signum();
        assert!(sign * (fold.at - after.at) >= 0.0, "{fold:?} {} {}", before.at, after.at);
    }
    for point in path.points.iter().step_by(7) {
        assert!(point.solution.imbalance(&problem(point.at)) < 1e-9);
        assert!(point.solution.report.residual < 1e-9);
    }
}
