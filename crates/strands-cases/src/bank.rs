//! Rods drawn at random, always the same ones: clamped at the base, the tip held at a pose drawn at random.
//!
//! Half of them are Kirchhoff rods and half of them Cosserat, half bear gravity. All are one long, with `EI1 = 1`: the ratios `EI2/EI1` and
//! `GJ/EI1` from 0.2 to 5, rest curvature and twist together up to one turn about any axis, `EA/EI1` from 300 to 10,000, weight up to 30
//! `EI1/L²`; the tip anywhere within 0.95 of the length from the base, and turned in any way.

use core::f64::consts::TAU;
use fastrand::Rng;
use strands::load::NodalLoads;
use strands::math::{Pose, Quat, Vec3};
use strands::rod::{Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, RodError, Stiffness};
use strands::statics::{Problem, Support};

/// How many there are.
pub const RODS: u64 = 10_000;

/// The rod of that number, from zero.
///
/// # Errors
/// Where there are no elements.
pub fn problem(number: u64, elements: usize, order: Order) -> Result<Problem, RodError> {
    // Neighbouring seeds give unlike numbers only after some are thrown away.
    let mut random = Rng::with_seed(number);
    (0..8).for_each(|_| _ = random.f64());
    let mut between = |low: f64, high: f64| low + (high - low) * random.f64();
    let [second_bending, torsion] = [between(-1.0, 1.0), between(-1.0, 1.0)].map(|power| 5_f64.powf(power));
    let kinematics = if between(0.0, 1.0) < 0.5 { Kinematics::Kirchhoff } else { Kinematics::Cosserat };
    let axial = 10_f64.powf(between(2.5, 4.0));
    let curvature = direction(&mut between) * between(0.0, TAU);
    let reach = 0.95 * between(0.0, 1.0).cbrt();
    let tip = Pose::from_parts(direction(&mut between) * reach, orientation(&mut between));
    let weight = if between(0.0, 1.0) < 0.5 { 0.0 } else { between(0.0, 30.0) };
    let gravity = direction(&mut between) * weight;
    let description = RodDescription {
        length: 1.0,
        kinematics,
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness {
                bending: [1.0, second_bending],
                torsion,
                axial,
                shear: [0.4 * axial; 2],
            }),
            mass_per_length: 1.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.01; 2],
        },
        rest: RestShape::Constant(curvature),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, elements, &[], order)?;
    let loads = NodalLoads::none(&rod).with_gravity(&rod, gravity);
    Ok(Problem { loads, end: Support::clamped(tip), ..Problem::cantilever(rod) })
}

/// A direction, all alike.
fn direction(between: &mut impl FnMut(f64, f64) -> f64) -> Vec3 {
    loop {
        let v = Vec3::new(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
        let size = v.norm();
        if (0.1..=1.0).contains(&size) {
            return v * (1.0 / size);
        }
    }
}

/// An orientation, all alike.
fn orientation(between: &mut impl FnMut(f64, f64) -> f64) -> Quat {
    loop {
        let q: [f64; 4] = core::array::from_fn(|_| between(-1.0, 1.0));
        let size: f64 = q.iter().map(|x| x * x).sum();
        if let (true, Some(q)) = ((0.01..=1.0).contains(&size), Quat::from_wxyz(q)) {
            return q;
        }
    }
}
