//! Rods with the consistent mass matrix.

use super::{ALL, BOTH, Drift, drift, rod, suture};
use crate::assembly::{MassMatrix, Strand};
use crate::dynamics::{Integrator, Settings, Simulation, Start};
use crate::math::{Pose, Vec3, Vec6};
use crate::rod::{
    Kinematics, Law, Material, Order, Profile, Rod, RodDescription, Section, Station, Stiffness,
};
use crate::statics::{Problem, Support};

/// Free, and with the consistent mass matrix.
fn free(rod: Rod) -> Strand {
    let start = Support::free(rod.description().base);
    let problem = Problem { start, ..Problem::cantilever(rod) };
    Strand { mass_matrix: MassMatrix::Consistent, ..problem.into() }
}

fn moving(strand: Strand, settings: Settings, velocity: impl Fn(f64) -> Vec6) -> Simulation {
    let elements = strand.problem.rod.elements();
    let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
    let velocities: Vec<Vec6> = (0..=elements).map(|i| velocity(i as f64 / elements as f64)).collect();
    simulation.set_velocities(&velocities);
    simulation
}

/// How a suture is thrown so that it tumbles, bends and vibrates.
fn thrown(s: f64) -> Vec6 {
    Vec6::new(Vec3::new(8.0, -5.0, 3.0), Vec3::new(0.8 - 6.0 * s * (1.0 - s), 0.9 * s - 0.44, 0.01))
}

#[test]
fn its_energy_is_that_of_velocities_linear_along_the_elements() {
    let strand = free(suture(7));
    let velocity = |s: f64| Vec6::new(Vec3::new(3.0 * s, 40.0, -200.0 * s), Vec3::new(1.0 - s, 2.0 * s, 0.5));
    let simulation = moving(strand.clone(), Settings::default(), velocity);
    // Over a rod as straight as this one these are linear from end to end, so an integral of squares is one in closed form.
    let square = |a: f64, b: f64| (a * a + a * b + b * b) / 3.0;
    let (a, b) = (velocity(0.0).to_array(), velocity(1.0).to_array());
    let node = strand.problem.rod.node_inertia()[3];
    let inertia = [node.rotational.x, node.rotational.y, node.rotational.z, node.mass, node.mass, node.mass];
    let energy: f64 = (0..6).map(|k| 0.5 * 7.0 * inertia[k] * square(a[k], b[k])).sum();
    let off = simulation.energy().kinetic / energy - 1.0;
    assert!(off.abs() < 1e-14, "{off:e}");
    // Sums of rows are those of the lumped matrix.
    let (momentum, _) = simulation.momentum();
    let mean = (Vec6::from(a) + Vec6::from(b)).linear * (0.5 * strand.problem.rod.mass());
    assert!((momentum - mean).norm() < 1e-14 * mean.norm(), "{momentum:?} {mean:?}");
}

#[test]
fn momentum_is_kept_in_free_flight() {
    for integrator in ALL {
        let settings = Settings { integrator, time_step: 1e-3, ..Settings::default() };
        let mut simulation = moving(free(suture(20)), settings, thrown);
        let Drift { momentum: lost, angular: lost_angular, .. } = drift(&mut simulation, 300);
        let kept = match integrator {
            Integrator::Midpoint => 1e-10,
            Integrator::ImplicitEuler => 0.05,
            // That of the lumped one is lost as well, in such a throw.
            _ => 1e-3,
        };
        assert!(lost < 1e-12 && lost_angular < kept, "{}: {lost:e} {lost_angular:e}", integrator.name());
    }
}

#[test]
fn the_midpoint_rule_keeps_energy_and_momentum() {
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 1e-3,
        tolerance: 1e-12,
        ..Settings::default()
    };
    let mut simulation = moving(free(suture(10)), settings, thrown);
    let Drift { energy: drift, momentum: lost, angular: lost_angular, elastic: most } =
        drift(&mut simulation, 10_000);
    assert!(most > 0.05, "it vibrates: {most}");
    assert!(drift < 1e-7 && lost < 1e-11 && lost_angular < 1e-11, "{drift:e} {lost:e} {lost_angular:e}");
}

/// A thick short rod, so soft that what its inertia exerts, turns too, outweighs all else.
fn soft() -> Rod {
    let stiffness = Stiffness { bending: [1e-3, 1.5e-3], torsion: 8e-4, axial: 0.05, shear: [0.04, 0.05] };
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
    Rod::with_elements(description, 4, &[], Order::Second).unwrap()
}

#[test]
fn newton_is_fast_where_inertia_outweighs_all_else() {
    let settings = Settings {
        integrator: Integrator::ImplicitEuler,
        time_step: 0.05,
        tolerance: 1e-9,
        ..Settings::default()
    };
    let turning =
        |s: f64| Vec6::new(Vec3::new(2.0, 3.0 * s, 6.0 * s - 2.0), Vec3::new(0.3 * s, s * s, 0.1 * s));
    let mut simulation = moving(free(soft()), settings, turning);
    let mut fell = 0;
    for _ in 0..30 {
        simulation.step().unwrap();
        let history = &simulation.work.history;
        // Slopes are kept after the first iteration, so it is not quadratic.
        for two in history.windows(2).filter(|two| two[0] < 0.1 && two[0] > 1e-7) {
            assert!(two[1] < 1e-3 * two[0], "{history:?}");
            fell += 1;
        }
    }
    assert!(fell > 30, "{fell}");
}

#[test]
fn an_inextensible_thread_swings_with_either_mass_matrix() {
    // Both are of second order, so they part by little.
    let material = Material::from_poisson(750e6, 0.4, 1300.0).unwrap();
    let end = |mass_matrix: MassMatrix| {
        let strand = Strand {
            mass_matrix,
            ..super::heavy(rod(0.1, 0.2e-3, material, Kinematics::Kirchhoff, 100)).into()
        };
        let settings = Settings { time_step: 1e-3, ..Settings::default() };
        let mut simulation = Simulation::new(strand, settings, Start::Rest).unwrap();
        let mut iterations = 0;
        for _ in 0..300 {
            iterations += simulation.step().unwrap().iterations;
        }
        (simulation.state().poses[100].position, iterations)
    };
    let [(lumped, few), (consistent, many)] = BOTH.map(end);
    let apart = (lumped - consistent).norm();
    assert!(apart > 1e-8 && apart < 1e-4, "{apart:e}");
    assert!(many <= few + few / 5, "{many} iterations, and {few} where it is lumped");
}

#[test]
fn what_mass_damping_takes_is_in_the_budget() {
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 1e-3,
        tolerance: 1e-12,
        mass_damping: 3.0,
        ..Settings::default()
    };
    let mut simulation = moving(free(suture(10)), settings, thrown);
    let began = simulation.energy().total();
    for _ in 0..200 {
        simulation.step().unwrap();
    }
    let energy = simulation.energy();
    assert!(energy.dissipated > 0.5 * began, "{energy:?}");
    assert!((energy.total() / began - 1.0).abs() < 1e-9, "{energy:?} of {began:e}");
}

#[test]
fn a_needle_as_pointed_as_it_may_be_keeps_its_energy() {
    let material = Material::from_poisson(2e9, 0.4, 1300.0).unwrap();
    let station = |s: f64, radius: f64| Station { s, section: Section::Circle { radius }, material };
    let description = RodDescription {
        length: 0.1,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![station(0.0, 1e-3), station(0.1, 1e-3 / 40.0)]),
        rest: Default::default(),
        base: Pose::IDENTITY,
    };
    let needle = Rod::with_elements(description, 10, &[], Order::Second).unwrap();
    let settings = Settings {
        integrator: Integrator::Midpoint,
        time_step: 1e-3,
        tolerance: 1e-11,
        ..Settings::default()
    };
    let mut simulation = moving(free(needle), settings, thrown);
    let began = simulation.energy();
    assert!(began.kinetic > 0.0, "{began:?}");
    for _ in 0..300 {
        simulation.step().unwrap();
        let energy = simulation.energy();
        let drift = (energy.total() / began.total() - 1.0).abs();
        assert!(energy.kinetic > 0.0 && drift < 1e-7, "{drift:e}: {energy:?}");
    }
}
