//! A steel wire, clamped and straight, on which its weight begins to act: it swings, as its modes say. The workload on which other programs' motion was
//! measured.

use core::f64::consts::PI;

use crate::swinging::{GRAVITY, Swinging};
use strands::rod::{RodError, Section};
use strands::statics::Problem;

const RADIUS: f64 = 1e-3;
const WIRE: Swinging = Swinging {
    name: "steel wire",
    length: 0.5,
    section: Section::Circle { radius: RADIUS },
    youngs_modulus: 200e9,
    shear_modulus: 80e9,
    density: 8000.0,
};
/// Its `EI` over its mass per length, m⁴/s².
const STIFFNESS_OVER_MASS: f64 = WIRE.youngs_modulus * RADIUS * RADIUS / (4.0 * WIRE.density);

/// The wire along z, its weight along x.
///
/// # Errors
/// Where there are no elements.
pub fn problem(elements: usize) -> Result<Problem, RodError> {
    WIRE.problem(elements)
}

/// How far its tip sinks at rest, as a beam of Euler's and Bernoulli's, m.
pub fn sag() -> f64 {
    GRAVITY * WIRE.length.powi(4) / (8.0 * STIFFNESS_OVER_MASS)
}

/// How far it has sunk after a time (s), over that, by the first twelve modes of such a beam.
pub fn sunk(time: f64) -> f64 {
    let modes = (1..=12).map(|mode| {
        // A root of cos x cosh x = −1.
        let mut x = if mode == 1 { 1.875_104_068_711_961 } else { (f64::from(mode) - 0.5) * PI };
        for _ in 0..3 {
            x -= (x.cos() + 1.0 / x.cosh()) / (-x.sin() - x.tanh() / x.cosh());
        }
        let mean = 2.0 * (x.cosh() + x.cos()) / (x.sinh() + x.sin()) / x;
        let tip = if mode % 2 == 1 { 2.0 } else { -2.0 };
        let omega = STIFFNESS_OVER_MASS.sqrt() * (x / WIRE.length).powi(2);
        8.0 * tip * mean / x.powi(4) * (1.0 - (omega * time).cos())
    });
    modes.sum()
}
