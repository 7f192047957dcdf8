//! Obstacles of all shapes, and bodies that rods touch.

use super::contact::{EULER, RADIUS, free, held, steel, suture};
use crate::assembly::{Assembly, Body, Joint, JointKind, Member};
use crate::contact::{Mesh, Obstacle, Shape, Surfaces};
use crate::dynamics::{Simulation, Start};
use crate::math::{Mat3, Pose, Vec3};
use crate::rod::NodeInertia;
use crate::statics::Problem;
use std::sync::Arc;

/// The gap at which surfaces rest that bear little, over the radius.
const RESTS: f64 = 0.016;

fn touched(problem: Problem, shape: Shape) -> Assembly {
    let obstacle = Obstacle { shape, friction: None, body: None, tissue: None };
    Assembly { surfaces: Some(Surfaces { friction: 0.3 }), obstacles: vec![obstacle], ..problem.into() }
}

/// Where all is after so many steps of a millisecond.
fn after(assembly: Assembly, steps: usize) -> Simulation {
    let mut simulation = Simulation::new(assembly, EULER, Start::Rest).unwrap();
    for step in 0..steps {
        simulation.step().unwrap_or_else(|failure| panic!("step {step}: {failure}"));
    }
    simulation
}

/// A steel rod of 0.1 m that falls along x from a height over a place of the plane y, z, along z or across it.
fn falls(x: f64, is_across: bool) -> Problem {
    let base = if is_across {
        Pose { rotation: Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y), position: Vec3::new(x, -0.05, 0.05) }
    } else {
        Pose { position: Vec3::new(x, 0.0, 0.0), ..Pose::IDENTITY }
    };
    free(steel(), base, Vec3::X * -9.81)
}

#[test]
fn a_rod_rests_in_a_tube() {
    let bore = Shape::Bore { point: Vec3::X * 5e-3, axis: Vec3::Z, radius: 5e-3 };
    let simulation = after(touched(falls(2e-3, false), bore), 200);
    for pose in &simulation.state().poses {
        let lies = (pose.position.x - (1.0 + RESTS) * RADIUS).abs();
        assert!(lies < 1e-2 * RADIUS && pose.position.y.abs() < 1e-2 * RADIUS, "{pose:?}");
    }
}

#[test]
fn a_rod_rests_on_a_block_a_cylinder_and_a_mesh_as_on_a_plane() {
    let block = Shape::block(Vec3::X * -0.01, [0.01, 0.02, 0.2], [Vec3::X, Vec3::Y, Vec3::Z]);
    let corner = |y: f64, z: f64| Vec3::new(0.0, y, z);
    let corners = vec![corner(-0.3, -0.3), corner(0.3, -0.3), corner(0.3, 0.3), corner(-0.3, 0.3)];
    let floor = Shape::Mesh(Arc::new(Mesh::new(corners, vec![[0, 1, 2], [0, 3, 2]]).unwrap()));
    let drum =
        Shape::Cylinder { ends: [Vec3::new(-0.02, 0.0, -0.1), Vec3::new(-0.02, 0.0, 0.2)], radius: 0.02 };
    let upright = Shape::Cylinder { ends: [Vec3::X * -0.05, Vec3::ZERO], radius: 0.08 };
    let plane = Shape::Plane { point: Vec3::ZERO, normal: Vec3::X };
    for (name, shape) in [
        ("plane", plane),
        ("block", block),
        ("mesh", floor),
        ("cylinder", drum),
        ("end of a cylinder", upright),
    ] {
        for is_across in [false, true] {
            let simulation = after(touched(falls(1.2 * RADIUS, is_across), shape.clone()), 100);
            let middle = simulation.state().poses[5].position;
            assert!(
                (middle.x - (1.0 + RESTS) * RADIUS).abs() < 1e-2 * RADIUS,
                "{name}, across: {is_across}: {middle:?}"
            );
            let borne: Vec3 =
                simulation.state().contacts.iter().fold(Vec3::ZERO, |sum, contact| sum + contact.force);
            let weight = simulation.assembly().strands[0].problem.rod.mass() * 9.81;
            assert!((borne - Vec3::X * weight).norm() < 0.02 * weight, "{name}: {borne:?} of {weight}");
        }
    }
}

#[test]
fn a_suture_hangs_over_the_edge_of_a_block_and_slides_off_a_ball() {
    // Held at one end, over an edge.
    let block = Shape::block(Vec3::new(-0.01, 0.0, 0.04), [0.01, 0.02, 0.01], [Vec3::X, Vec3::Y, Vec3::Z]);
    let base = Pose { position: Vec3::new(1e-3, 0.0, 0.0), ..Pose::IDENTITY };
    let mut problem = free(suture(40), base, Vec3::X * -9.81);
    problem.start = crate::statics::Support::clamped(base);
    let mut assembly = touched(problem, block);
    assembly.strands[0].viscosity = 5e-3;
    let simulation = after(assembly, 600);
    let state = simulation.state();
    for (node, pose) in state.poses.iter().enumerate() {
        let p = pose.position;
        let inside = p.x < 0.2e-3 && (0.0298..0.0502).contains(&p.z);
        assert!(!inside, "node {node}: {p:?}");
    }
    assert!(!state.contacts.is_empty());
    // It bends down beyond the edge.
    assert!(state.poses[40].position.x < -1e-3, "{:?}", state.poses[40].position);
}

#[test]
fn a_ball_falls_onto_two_rods_and_rests_between_them() {
    let radius = 4e-3;
    let rail = |y: f64| {
        let mut problem = held(steel(), 0.0);
        let shift = |pose: Pose| Pose { position: pose.position + Vec3::Y * y, ..pose };
        let mut description = problem.rod.description().clone();
        description.base = shift(description.base);
        problem.rod =
            crate::rod::Rod::with_elements(description, 10, &[], crate::rod::Order::Second).unwrap();
        problem.start.pose = shift(problem.start.pose);
        problem.end.pose = shift(problem.end.pose);
        problem
    };
    let mass = 2e-3;
    let moment = 0.4 * mass * radius * radius;
    let inertia = NodeInertia { mass, rotational: Vec3::new(moment, moment, moment) };
    let pose = Pose { position: Vec3::new(5e-3, 0.1e-3, 0.043), ..Pose::IDENTITY };
    let ball = Body::new(inertia, pose).with_gravity(Vec3::X * -9.81);
    let shape = Shape::Capsule { ends: [Vec3::ZERO; 2], radius };
    let mut strands: Vec<crate::assembly::Strand> = vec![rail(-3e-3).into(), rail(3e-3).into()];
    strands.iter_mut().for_each(|strand| strand.viscosity = 1e-4);
    let assembly = Assembly {
        strands,
        bodies: vec![ball],
        surfaces: Some(Surfaces { friction: 0.3 }),
        obstacles: vec![Obstacle { shape, friction: None, body: Some(0), tissue: None }],
        ..Assembly::default()
    };
    let simulation = after(assembly, 400);
    let state = simulation.state();
    let ball = state.poses[22].position;
    let height = ((radius + (1.0 + RESTS) * RADIUS).powi(2) - 9e-6).sqrt();
    // The rods sag by a few micrometres.
    assert!((ball.x - height).abs() < 2e-5 && ball.y.abs() < 2e-5, "{ball:?} for {height:e}");
    let borne: Vec3 = state.contacts.iter().fold(Vec3::ZERO, |sum, contact| sum + contact.force);
    assert!((borne.x + mass * 9.81).abs() < 1e-3 * mass * 9.81, "{borne:?}");
}

#[test]
fn rods_that_are_tied_touch_what_they_are_not_tied_to() {
    // Two pendulum rods on a ball joint, the second beside a post.
    let base = |z: f64| Pose { position: Vec3::new(0.0, 0.0, z), ..Pose::IDENTITY };
    let mut first = free(steel(), base(0.0), Vec3::X * -9.81);
    first.start = crate::statics::Support::clamped(base(0.0));
    let second = free(steel(), base(0.1), Vec3::X * -9.81);
    let mut assembly = Assembly {
        strands: vec![first.into(), second.into()],
        surfaces: Some(Surfaces { friction: 0.2 }),
        obstacles: vec![Obstacle {
            shape: Shape::Capsule {
                ends: [Vec3::new(-0.03, -0.05, 0.17), Vec3::new(-0.03, 0.05, 0.17)],
                radius: 5e-3,
            },
            friction: None,
            body: None,
            tissue: None,
        }],
        ..Assembly::default()
    };
    let node = |rod: usize, node: usize| Member::Node { rod, node };
    let joint =
        Joint::at_rest(&assembly, JointKind::Ball, [node(0, 10), node(1, 0)], None, Vec3::ZERO).unwrap();
    assembly.joints.push(joint);
    let simulation = after(assembly, 400);
    let state = simulation.state();
    let tied = (state.poses[10].position - state.poses[11].position).norm();
    assert!(tied < 1e-12, "{tied:e}");
    let touches = state.contacts.iter().map(|contact| contact.force.x).sum::<f64>();
    assert!(touches > 0.01, "{touches}");
    let least = state.contacts.iter().map(|contact| contact.gap).fold(f64::INFINITY, f64::min);
    assert!(least > 0.0, "{least:e}");
}
