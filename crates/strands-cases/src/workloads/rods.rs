//! The rods of the workloads: round, straight, along z from the origin, with gravity along x.

use crate::Setup;
use core::f64::consts::PI;
use strands::math::{Pose, Vec3};
use strands::rod::{Kinematics, Law, Profile, RestShape, RodDescription, Stiffness};

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

/// A polypropylene suture of size 3-0, 0.2 m.
pub(crate) fn suture() -> Setup {
    round(0.2, 1.25e-4, [2.5e9, 0.9e9], 900.0)
}

/// A steel rod of 2 mm, 0.5 m.
pub(crate) fn steel() -> Setup {
    round(0.5, 1e-3, [200e9, 80e9], 8000.0)
}

/// A round rod with the moduli `[E, G]`. Its shear stiffness is the full `GA`, as in the reference.
fn round(length: f64, radius: f64, [youngs, shear]: [f64; 2], density: f64) -> Setup {
    let area = PI * radius * radius;
    let second_moment = PI * radius.powi(4) / 4.0;
    let stiffness = Stiffness {
        bending: [youngs * second_moment; 2],
        torsion: shear * 2.0 * second_moment,
        axial: youngs * area,
        shear: [shear * area; 2],
    };
    let description = RodDescription {
        length,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: density * area,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [radius; 2],
        },
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    Setup::cantilever(description).with_weight(Vec3::X * (density * area * GRAVITY))
}
