//! Friction where it is known: a rope around a post.

use core::f64::consts::PI;
use strands::assembly::{Assembly, Member};
use strands::contact::{Obstacle, Shape, Surfaces};
use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands::load::NodalLoads;
use strands::math::{Mat3, Pose, Vec3, Wrench};
use strands::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};
use strands::statics::{Problem, Support};

const POST: f64 = 0.04;
const RADIUS: f64 = 5e-5;
const PITCH: f64 = 2e-3;
/// What pulls at the end that gives way, N.
const PULL: f64 = 0.01;
const STEP: f64 = 1e-3;

/// The tension at the end that is drawn over the one at the other, where a rope slides around a post over some angle.
fn ratio(friction: f64, angle: f64, elements: usize) -> f64 {
    // Chords are outside of the post.
    let sagitta = (POST * angle / elements as f64).powi(2) / (8.0 * POST);
    let radius = POST + 1.03 * RADIUS + 1.02 * sagitta;
    let rise = PITCH / (2.0 * PI);
    let along = |a: f64| Vec3::new(-radius * a.sin(), radius * a.cos(), rise).normalized().unwrap();
    let (inwards, tangent) = (-Vec3::X, along(0.0));
    let base = Pose {
        rotation: Mat3::from_cols(inwards, tangent.cross(inwards), tangent),
        position: Vec3::X * radius,
    };
    let material = Material::from_poisson(1.6e10, 0.4, 1200.0).unwrap();
    let section = Section::Circle { radius: RADIUS };
    let rod = Rod::with_elements(
        RodDescription {
            length: radius.hypot(rise) * angle,
            kinematics: Kinematics::Cosserat,
            profile: Profile::Stations(vec![Station { s: 0.0, section, material }]),
            rest: RestShape::helix(radius, PITCH).unwrap(),
            base,
        },
        elements,
        &[],
        Order::Second,
    )
    .unwrap();
    let end = rod.rest_poses()[elements];
    let mut loads = NodalLoads::none(&rod);
    loads.world[0] += Wrench::new(Vec3::ZERO, tangent * -PULL);
    let problem =
        Problem { loads, end: Support::pinned(end), start: Support::free(base), ..Problem::cantilever(rod) };
    let middle = Vec3::Z * (0.5 * rise * angle);
    let half = Vec3::Z * (0.5 * rise * angle + 0.01);
    let mut assembly: Assembly = problem.into();
    assembly.strands[0].viscosity = 1e-3;
    assembly.surfaces = Some(Surfaces { friction });
    assembly.obstacles = vec![Obstacle {
        shape: Shape::Cylinder { ends: [middle - half, middle + half], radius: POST },
        friction: None,
        body: None,
        tissue: None,
    }];
    let settings = Settings {
        integrator: Integrator::ImplicitEuler,
        time_step: STEP,
        max_iterations: 60,
        mass_damping: 20.0,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(assembly, settings, Start::Rest).unwrap();
    let last = Member::Node { rod: 0, node: elements };
    // Drawn until all of it slides.
    let mut before = 0.0;
    for step in 1..3000 {
        simulation.support_mut(last).unwrap().pose.position += along(angle) * (8e-3 * STEP);
        simulation.step().unwrap_or_else(|failure| panic!("μ {friction}, {angle}: {failure}"));
        if step % 50 == 0 {
            let tension = simulation.reaction(last).linear.norm();
            if step > 150 && (tension - before).abs() < 1e-3 * tension {
                return tension / PULL;
            }
            before = tension;
        }
    }
    panic!("μ {friction}, {angle}: the tension still changes, {} times the pull", before / PULL);
}

/// Euler 1769, Eytelwein 1808: `e^{μφ}`, for a thin rope. Of this one friction acts an eighth of a hundredth nearer to the post's axis than tension does, and it touches over about an element less
/// than the angle.
#[test]
fn a_rope_slides_around_a_post_as_eytelwein_says() {
    for friction in [0.1, 0.2, 0.3, 0.5] {
        for (turns, elements) in [(0.25, 40), (0.5, 60), (1.0, 120), (2.0, 240)] {
            let angle = 2.0 * PI * turns;
            let (found, expected) = (ratio(friction, angle, elements), (friction * angle).exp());
            println!("μ {friction}, {turns} turns: {found:.4} for {expected:.4}");
            assert!(
                (found / expected - 1.0).abs() < 0.015,
                "μ {friction}, {turns} turns: {found} for {expected}"
            );
        }
    }
}
