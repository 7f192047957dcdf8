mod consistent;
mod contact;
mod held;
mod network;
mod passages;
mod surfaces;

use super::{Integrator, Settings, Simulation, Start};
use crate::assembly::{MassMatrix, Strand};
use crate::load::{Frame, NodalLoads, PointLoad};
use crate::math::{Pose, Vec3, Vec6, Wrench};
use crate::rod::{
    Kinematics, Law, Material, Order, Profile, Rod, RodDescription, Section, Station, Stiffness,
};
use crate::statics::{Problem, Support};

const G: Vec3 = Vec3::new(9.81, 0.0, 0.0);

/// A round rod along z.
fn rod(length: f64, radius: f64, material: Material, kinematics: Kinematics, elements: usize) -> Rod {
    let description = RodDescription {
        length,
        kinematics,
        profile: Profile::Stations(vec![Station { s: 0.0, section: Section::Circle { radius }, material }]),
        rest: Default::default(),
        base: Pose::IDENTITY,
    };
    Rod::with_elements(description, elements, &[], Order::Second).unwrap()
}

fn suture(elements: usize) -> Rod {
    let suture = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    rod(0.1, 0.2e-3, suture, Kinematics::Cosserat, elements)
}

fn heavy(rod: Rod) -> Problem {
    let loads = NodalLoads::none(&rod).with_gravity(&rod, G);
    Problem { loads, ..Problem::cantilever(rod) }
}

fn simulated(problem: Problem, integrator: Integrator, time_step: f64, start: Start) -> Simulation {
    Simulation::new(problem, Settings { integrator, time_step, ..Settings::default() }, start).unwrap()
}

const ALPHA: Integrator = Integrator::GeneralizedAlpha { spectral_radius: 0.8 };
const ALL: [Integrator; 6] = [
    Integrator::ImplicitEuler,
    Integrator::Bdf2,
    ALPHA,
    Integrator::Midpoint,
    Integrator::Sdirk4,
    Integrator::TrBdf2,
];

/// Of either mass matrix.
const BOTH: [MassMatrix; 2] = [MassMatrix::Lumped, MassMatrix::Consistent];

/// How a simulation drifts: its energy and both its momenta at most, or at the end, over what they were; and what part of the energy is elastic at most.
struct Drift {
    energy: f64,
    momentum: f64,
    angular: f64,
    elastic: f64,
}

fn drift(simulation: &mut Simulation, steps: usize) -> Drift {
    let began = simulation.energy().total();
    let (momentum, angular) = simulation.momentum();
    let (mut energy, mut elastic): (f64, f64) = (0.0, 0.0);
    for _ in 0..steps {
        simulation.step().unwrap();
        let budget = simulation.energy();
        elastic = elastic.max(budget.elastic / began);
        energy = energy.max((budget.total() / began - 1.0).abs());
    }
    let (later, turned) = simulation.momentum();
    Drift {
        energy,
        momentum: (later - momentum).norm() / momentum.norm(),
        angular: (turned - angular).norm() / angular.norm(),
        elastic,
    }
}

#[test]
fn integrators_have_their_order() {
    // So soft that no motion is faster than the steps.
    let stiffness = Stiffness { bending: [0.1, 0.15], torsion: 0.08, axial: 5.0, shear: [4.0, 5.0] };
    let description = RodDescription {
        length: 1.0,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: 1.0,
            rotational_inertia_per_length: Vec3::new(0.05, 0.04, 0.09),
            half_extent: [0.1; 2],
        },
        rest: Default::default(),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 4, &[], Order::Second).unwrap();
    let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(2.0, 1.0, 0.5));
    let problem = Problem { loads, ..Problem::cantilever(rod) };
    for viscous in [0.0, 0.02] {
        let after = |integrator: Integrator, steps: usize| {
            let settings = Settings {
                integrator,
                time_step: 0.8 / steps as f64,
                tolerance: 1e-10,
                mass_damping: 0.1,
                ..Settings::default()
            };
            let strand = Strand { viscosity: viscous, ..problem.clone().into() };
            let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
            for _ in 0..steps {
                simulation.step().unwrap();
            }
            let tip = simulation.state().poses[4];
            assert!(tip.position.x.hypot(tip.position.y) > 0.2, "it moves far: {tip:?}");
            tip
        };
        let exact = after(Integrator::Sdirk4, 640);
        for (integrator, order, steps) in [
            (Integrator::ImplicitEuler, 1.0, 80),
            (Integrator::Bdf2, 2.0, 40),
            (ALPHA, 2.0, 40),
            (Integrator::Midpoint, 2.0, 40),
            (Integrator::TrBdf2, 2.0, 40),
            // The rates of strains are differences of places within a step, which cost a method of order 4 up to one of them.
            (Integrator::Sdirk4, if viscous > 0.0 { 3.5 } else { 4.0 }, 12),
        ] {
            let error = |steps: usize| after(integrator, steps).between(&exact).log().max_abs();
            let measured = (error(steps) / error(4 * steps)).log2() / 2.0;
            assert!(
                measured > order - 0.2 && measured < order + 0.4,
                "{}, {viscous} s: {measured}",
                integrator.name()
            );
        }
    }
}

#[test]
fn a_rod_in_free_flight_keeps_its_momentum() {
    let rod = suture(20);
    let base = rod.description().base;
    for integrator in ALL {
        let free = Problem { start: Support::free(base), ..Problem::cantilever(rod.clone()) };
        let mut simulation = simulated(free, integrator, 1e-3, Start::Rest);
        // It tumbles, and bends as it does.
        let velocity = |i: usize| {
            let s = i as f64 / 20.0;
            Vec6::new(Vec3::new(8.0, -5.0, 3.0), Vec3::new(0.4 * s - 0.3 * s * s, 0.9 * s, 0.2))
        };
        simulation.set_velocities(&(0..=20).map(velocity).collect::<Vec<_>>());
        let Drift { momentum: lost, angular: lost_angular, .. } = drift(&mut simulation, 1000);
        // Only the midpoint rule keeps the latter by itself.
        let kept = match integrator {
            Integrator::Midpoint => 1e-10,
            Integrator::ImplicitEuler => 0.05,
            _ => 1e-5,
        };
        assert!(lost < 1e-12 && lost_angular < kept, "{}: {lost:e} {lost_angular:e}", integrator.name());
    }
}

#[test]
fn a_viscous_rod_comes_to_rest_where_statics_says() {
    let problem = heavy(suture(40));
    let settings = Settings { integrator: Integrator::Bdf2, time_step: 1e-3, ..Settings::default() };
    let strand = Strand { viscosity: 0.05, ..problem.clone().into() };
    let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
    let began = simulation.energy().total();
    for _ in 0..3000 {
        simulation.step().unwrap();
    }
    let rest = Simulation::new(problem, settings, Start::Equilibrium).unwrap();
    for (now, rest) in simulation.state().poses.iter().zip(&rest.state().poses) {
        let away = (now.position - rest.position).norm();
        assert!(away < 1e-8 * 0.1, "{away:e}");
    }
    // What is gone is what the damping took, to the error in time.
    let energy = simulation.energy();
    assert!((energy.total() - began).abs() < 0.03 * energy.dissipated, "{energy:?} from {began}");
}

#[test]
fn drag_on_mass_takes_speed_as_it_says() {
    let rod = suture(10);
    let base = rod.description().base;
    let free = Problem { start: Support::free(base), ..Problem::cantilever(rod) };
    let settings = Settings {
        integrator: Integrator::Sdirk4,
        time_step: 0.01,
        mass_damping: 2.0,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(free, settings, Start::Rest).unwrap();
    simulation.set_velocities(&[Vec6::new(Vec3::ZERO, Vec3::new(0.3, 0.1, -0.2)); 11]);
    let (before, _) = simulation.momentum();
    for _ in 0..50 {
        simulation.step().unwrap();
    }
    let (after, _) = simulation.momentum();
    assert!((after - before * (-1.0_f64).exp()).norm() < 1e-8 * before.norm(), "{after:?}");
}

#[test]
fn a_beam_vibrates_at_its_frequency_in_both_planes() {
    let steel = Material::from_poisson(200e9, 0.3, 8000.0).unwrap();
    let section = Section::Rectangle { width: 2e-3, height: 1e-3 };
    let description = RodDescription {
        length: 0.5,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![Station { s: 0.0, section, material: steel }]),
        rest: Default::default(),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 100, &[], Order::Second).unwrap();
    let [about_1, about_2] = section.second_moments();
    for (direction, second_moment) in [(Vec3::Y, about_1), (Vec3::X, about_2)] {
        // Released where a small force holds its tip, which is nearly the first mode.
        let loads = NodalLoads::none(&rod);
        let load =
            PointLoad { at: 0.5, wrench: Wrench::new(Vec3::ZERO, direction * 1e-3), frame: Frame::World };
        let held = Problem {
            loads: loads.clone().with_point(&rod, &load).unwrap(),
            ..Problem::cantilever(rod.clone())
        };
        let expected = 1.875_104_068_711_961_f64.powi(2)
            * (200e9 * second_moment / (8000.0 * section.area())).sqrt()
            / 0.25
            / (2.0 * std::f64::consts::PI);
        let time_step = 1.0 / (100.0 * expected);
        let mut simulation = simulated(held, Integrator::Sdirk4, time_step, Start::Equilibrium);
        simulation.assembly_mut().strands[0].problem.loads = loads;
        let (mut crossings, mut last) = (Vec::new(), 1.0);
        while crossings.len() < 9 {
            let time = simulation.step().unwrap().time;
            let tip = simulation.state().poses[100].position.dot(direction);
            if tip * last < 0.0 {
                crossings.push(time - time_step * tip / (tip - last));
            }
            last = tip;
        }
        let measured = 4.0 / (crossings[8] - crossings[0]);
        assert!((measured / expected - 1.0).abs() < 5e-3, "{measured} Hz, {expected} expected");
    }
}

#[test]
fn a_suture_without_damping_keeps_swinging() {
    for (elements, integrator) in [(25, Integrator::Bdf2), (100, Integrator::Bdf2), (100, ALPHA)] {
        let mut simulation = simulated(heavy(suture(elements)), integrator, 1e-3, Start::Rest);
        let began = simulation.energy().total();
        let mut most: f64 = 0.0;
        for _ in 0..2000 {
            simulation.step().unwrap();
            most = most.max(simulation.energy().elastic);
        }
        let lost = (began - simulation.energy().total()) / most;
        assert!((0.0..0.01).contains(&lost), "{elements}: {lost}");
    }
}

#[test]
fn a_pulled_suture_gains_no_energy_where_it_moves_by_elements_in_a_step() {
    let stuff = Material::from_poisson(1.5e9, 0.4, 910.0).unwrap();
    let suture = rod(0.2, 85e-6, stuff, Kinematics::Cosserat, 40);
    let pull = PointLoad { at: 0.2, wrench: Wrench::new(Vec3::ZERO, Vec3::Y * 1e-3), frame: Frame::World };
    let held = heavy(suture.clone());
    let loads = held.loads.clone().with_point(&suture, &pull).unwrap();
    let held = Problem { loads, ..held };
    for integrator in [Integrator::ImplicitEuler, Integrator::Bdf2, ALPHA, Integrator::Sdirk4] {
        let mut simulation = simulated(held.clone(), integrator, 1e-3, Start::Rest);
        let (mut least, mut gained) = (simulation.energy().total(), 0.0_f64);
        for _ in 0..100 {
            simulation.step().unwrap();
            let now = simulation.energy();
            least = least.min(now.total());
            gained = gained.max((now.total() - least) / (now.kinetic + now.elastic));
        }
        assert!(gained < 0.05, "{}: {gained:e}", integrator.name());
    }
}

#[test]
fn a_rod_in_equilibrium_stays_there() {
    for integrator in ALL {
        let mut simulation = simulated(heavy(suture(50)), integrator, 1e-3, Start::Equilibrium);
        let began = simulation.state().poses.clone();
        for _ in 0..100 {
            simulation.step().unwrap();
        }
        for (a, b) in simulation.state().poses.iter().zip(&began) {
            assert!((a.position - b.position).norm() < 1e-9, "{}", integrator.name());
        }
    }
}

#[test]
fn from_a_state_it_goes_on_to_the_same_bits() {
    for integrator in ALL {
        let mut simulation = simulated(heavy(suture(20)), integrator, 1e-3, Start::Rest);
        for _ in 0..5 {
            simulation.step().unwrap();
        }
        let kept = Start::State(Box::new(simulation.state().clone()));
        let mut other = simulated(heavy(suture(20)), integrator, 1e-3, kept);
        for _ in 0..5 {
            assert_eq!(simulation.step(), other.step());
        }
        assert_eq!(simulation.state(), other.state());
    }
}

#[test]
fn what_cannot_move_is_refused_and_what_fails_leaves_the_state() {
    let settings = Settings::default();
    let refused =
        |problem, settings| Simulation::new(problem, settings, Start::Rest).unwrap_err().to_string();
    let rod = suture(10);
    let fine = Rod::with_elements(rod.description().clone(), 10, &[], Order::Fourth).unwrap();
    assert!(refused(Problem::cantilever(fine), settings).contains("order 2"));
    let bad = Settings { time_step: 0.0, ..settings };
    assert_eq!(
        refused(Problem::cantilever(rod.clone()), bad),
        "the time step is 0, and must be greater than 0"
    );
    let hurried = Settings { max_iterations: 0, ..settings };
    let mut simulation = Simulation::new(heavy(rod), hurried, Start::Rest).unwrap();
    let before = simulation.state().clone();
    let failure = simulation.step().unwrap_err();
    assert!(matches!(failure, super::StepFailure::NotConverged { .. }), "{failure}");
    assert_eq!(simulation.state(), &before);
    let mut lost = before.clone();
    lost.momenta[3].linear.x = f64::NAN;
    let refusal = simulation.restore(lost).unwrap_err();
    assert!(matches!(refusal, super::SimulationError::NotFinite), "{refusal}");
    assert_eq!(simulation.state(), &before);
}

/// It carries 1e9 times what would bend it: what round-off leaves beside that of bending is nothing beside that of its weight.
#[test]
fn a_line_of_a_hundred_metres_falls_into_its_support_without_gaining_energy() {
    let nylon = Material::from_poisson(2e9, 0.4, 1140.0).unwrap();
    for time_step in [1e-3, 1e-4] {
        for integrator in [Integrator::Bdf2, Integrator::TrBdf2] {
            let rod = rod(100.0, 0.15e-3, nylon, Kinematics::Cosserat, 200);
            let loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::Z * 9.81);
            let hung = Problem { loads, ..Problem::cantilever(rod) };
            let mut simulation = simulated(hung, integrator, time_step, Start::Rest);
            let began = simulation.energy().total();
            simulation.advance(0.05).unwrap();
            let energy = simulation.energy();
            let fallen = simulation.state().poses[200].position.z - 100.0;
            assert!((fallen / (0.5 * 9.81 * 0.05 * 0.05) - 1.0).abs() < 1e-2, "{fallen}");
            let gained = (energy.total() - began) / energy.kinetic;
            assert!((-1e-2..1e-6).contains(&gained), "{} {time_step}: {gained:e}", integrator.name());
        }
    }
}

#[test]
fn a_step_that_is_too_short_for_round_off_is_refused() {
    for integrator in [Integrator::Bdf2, Integrator::TrBdf2, Integrator::ImplicitEuler] {
        let mut simulation = simulated(heavy(suture(20)), integrator, 1e-12, Start::Rest);
        let failure = simulation.step().unwrap_err();
        assert!(matches!(failure, super::StepFailure::TooShort { .. }), "{failure}");
        assert!(failure.to_string().starts_with("at 0.0 s a step of 1e-12 s is too short"), "{failure}");
        assert_eq!(simulation.state().time, 0.0);
    }
}

#[test]
fn an_inextensible_rod_swings_as_one_that_hardly_stretches() {
    let material = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    let tip = |kinematics| {
        let rod = rod(0.1, 0.2e-3, material, kinematics, 40);
        let mut simulation = simulated(heavy(rod), Integrator::Sdirk4, 1e-3, Start::Rest);
        for _ in 0..100 {
            simulation.step().unwrap();
        }
        let stretched = simulation
            .state()
            .poses
            .windows(2)
            .map(|pair| ((pair[1].position - pair[0].position).norm() / 0.0025 - 1.0).abs())
            .fold(0.0, f64::max);
        (simulation.state().poses[40].position, stretched)
    };
    let ((free, _), (rigid, stretched)) = (tip(Kinematics::Cosserat), tip(Kinematics::Kirchhoff));
    assert!(rigid.x > 0.02 && (free - rigid).norm() < 2e-5, "{free:?} {rigid:?}");
    // A chord is shorter than its arc, by (κh)²/24.
    assert!(stretched < 2e-4, "{stretched:e}");
}

#[test]
fn at_rest_a_rod_must_be_where_it_is_held() {
    let mut problem = heavy(suture(10));
    problem.end = Support::pinned(Pose { position: Vec3::new(0.02, 0.0, 0.09), ..Pose::IDENTITY });
    let refused = Simulation::new(problem, Settings::default(), Start::Rest).unwrap_err();
    assert!(refused.to_string().contains("not where it is held at s = 0.1 m"), "{refused}");
}

#[test]
fn the_midpoint_rule_keeps_energy_and_momentum() {
    // A suture that tumbles, bends and vibrates; no step is as short as its motions are.
    let rod = suture(10);
    let base = rod.description().base;
    let free = Problem { start: Support::free(base), ..Problem::cantilever(rod) };
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 1e-3,
        tolerance: 1e-12,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(free, settings, Start::Rest).unwrap();
    let velocity = |i: usize| {
        let s = f64::from(i as u8) / 10.0;
        Vec6::new(Vec3::new(8.0, -5.0, 3.0), Vec3::new(0.8 - 6.0 * s * (1.0 - s), 0.9 * s - 0.44, 0.01))
    };
    simulation.set_velocities(&(0..=10).map(velocity).collect::<Vec<_>>());
    let Drift { energy: drift, momentum: lost, angular: lost_angular, elastic: most } =
        drift(&mut simulation, 100_000);
    assert!(most > 0.05, "it vibrates: {most}");
    assert!(drift < 1e-6 && lost < 1e-10 && lost_angular < 1e-10, "{drift:e} {lost:e} {lost_angular:e}");
}
