//! The shape of a cross-section and what follows from it: area, second moments, torsion constant, shear factors.

use super::{Material, RodError, Stiffness};
use core::f64::consts::PI;

/// A cross-section, its axes along the directors `d1` and `d2`. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// A full circle.
    Circle {
        /// Radius, m.
        radius: f64,
    },
    /// A tube.
    Annulus {
        /// Outer radius, m.
        outer_radius: f64,
        /// Inner radius, m; less than the outer.
        inner_radius: f64,
    },
    /// A full ellipse.
    Ellipse {
        /// Half axis along `d1`, m.
        a: f64,
        /// Half axis along `d2`, m.
        b: f64,
    },
    /// A full rectangle.
    Rectangle {
        /// Side along `d1`, m.
        width: f64,
        /// Side along `d2`, m.
        height: f64,
    },
}

impl Section {
    /// The name of the shape, as scene files write it.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Circle { .. } => "circle",
            Self::Annulus { .. } => "annulus",
            Self::Ellipse { .. } => "ellipse",
            Self::Rectangle { .. } => "rectangle",
        }
    }

    /// Checks that every length is positive and finite and that a tube's hole is smaller than the tube.
    ///
    /// # Errors
    /// The first length that is not.
    pub fn validate(&self) -> Result<(), RodError> {
        match *self {
            Self::Circle { radius } => RodError::positive("radius", radius),
            Self::Annulus { outer_radius, inner_radius } => {
                RodError::positive("outer_radius", outer_radius)?;
                RodError::not_negative("inner_radius", inner_radius)?;
                if inner_radius < outer_radius {
                    return Ok(());
                }
                Err(RodError::OutOfRange {
                    quantity: "inner_radius",
                    value: inner_radius,
                    expected: "less than outer_radius",
                })
            }
            Self::Ellipse { a, b } => RodError::positive("a", a).and(RodError::positive("b", b)),
            Self::Rectangle { width, height } => {
                RodError::positive("width", width).and(RodError::positive("height", height))
            }
        }
    }

    /// Area `A`, m².
    pub fn area(&self) -> f64 {
        match *self {
            Self::Circle { radius } => PI * radius * radius,
            Self::Annulus { outer_radius: o, inner_radius: i } => PI * (o - i) * (o + i),
            Self::Ellipse { a, b } => PI * a * b,
            Self::Rectangle { width, height } => width * height,
        }
    }

    /// Second moments `[I1, I2]` about `d1` and `d2`, m⁴.
    pub fn second_moments(&self) -> [f64; 2] {
        match *self {
            Self::Circle { radius } => [PI * radius.powi(4) / 4.0; 2],
            Self::Annulus { outer_radius: o, inner_radius: i } => [PI * (o.powi(4) - i.powi(4)) / 4.0; 2],
            Self::Ellipse { a, b } => [PI * a * b.powi(3) / 4.0, PI * a.powi(3) * b / 4.0],
            Self::Rectangle { width: w, height: h } => [w * h.powi(3) / 12.0, w.powi(3) * h / 12.0],
        }
    }

    /// Saint-Venant's torsion constant `J`, m⁴ (Timoshenko & Goodier, *Theory of Elasticity*, ch. 10): the polar moment for a
    /// circle, `π a³b³/(a² + b²)` for an ellipse, and for a rectangle the series in `tanh`, summed to round-off.
    pub fn torsion_constant(&self) -> f64 {
        match *self {
            Self::Circle { .. } | Self::Annulus { .. } => 2.0 * self.second_moments()[0],
            Self::Ellipse { a, b } => PI * (a * b).powi(3) / (a * a + b * b),
            Self::Rectangle { width, height } => {
                let (long, short) = (width.max(height), width.min(height));
                // Σ tanh(nπ w/2h)/n⁵ over odd n: the sum with tanh = 1 is known, 31 ζ(5)/32, and what tanh lacks falls as e^−nπ.
                const ODD_FIFTH_POWERS: f64 = 1.004_523_762_795_139_6;
                let lack = |n: f64| 2.0 / ((n * PI * long / short).exp() + 1.0) / n.powi(5);
                let sum = ODD_FIFTH_POWERS - (0..8).rev().map(|k| lack(f64::from(2 * k + 1))).sum::<f64>();
                long * short.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * short / long * sum)
            }
        }
    }

    /// Timoshenko's shear factors `[k1, k2]` for shear along `d1` and `d2` (Cowper 1966, J. Appl. Mech. 33:335–340).
    pub fn shear_factors(&self, poisson_ratio: f64) -> [f64; 2] {
        let nu = poisson_ratio;
        match *self {
            Self::Circle { .. } => [6.0 * (1.0 + nu) / (7.0 + 6.0 * nu); 2],
            Self::Annulus { outer_radius, inner_radius } => {
                let m2 = (inner_radius / outer_radius).powi(2);
                let s = (1.0 + m2).powi(2);
                [6.0 * (1.0 + nu) * s / ((7.0 + 6.0 * nu) * s + (20.0 + 12.0 * nu) * m2); 2]
            }
            Self::Ellipse { a, b } => {
                let along = |a: f64, b: f64| {
                    let (a2, b2) = (a * a, b * b);
                    12.0 * (1.0 + nu) * a2 * (3.0 * a2 + b2)
                        / ((40.0 + 37.0 * nu) * a2 * a2 + (16.0 + 10.0 * nu) * a2 * b2 + nu * b2 * b2)
                };
                [along(a, b), along(b, a)]
            }
            Self::Rectangle { .. } => [10.0 * (1.0 + nu) / (12.0 + 11.0 * nu); 2],
        }
    }

    /// The stiffnesses that the section has in a material.
    pub fn stiffness(&self, material: &Material) -> Stiffness {
        let (e, g) = (material.youngs_modulus, material.shear_modulus);
        let [i1, i2] = self.second_moments();
        let [k1, k2] = self.shear_factors(material.poisson_ratio());
        let area = self.area();
        Stiffness {
            bending: [e * i1, e * i2],
            torsion: g * self.torsion_constant(),
            axial: e * area,
            shear: [k1 * g * area, k2 * g * area],
        }
    }

    /// Half the extent along `d1` and `d2`, m.
    pub fn half_extent(&self) -> [f64; 2] {
        match *self {
            Self::Circle { radius } => [radius; 2],
            Self::Annulus { outer_radius, .. } => [outer_radius; 2],
            Self::Ellipse { a, b } => [a, b],
            Self::Rectangle { width, height } => [0.5 * width, 0.5 * height],
        }
    }

    /// The section a part `x ∈ [0, 1]` of the way to another of the same shape; `None` where the shapes differ.
    pub fn interpolate(&self, other: &Self, x: f64) -> Option<Self> {
        let mix = |p: f64, q: f64| p + (q - p) * x;
        Some(match (*self, *other) {
            (Self::Circle { radius: p }, Self::Circle { radius: q }) => Self::Circle { radius: mix(p, q) },
            (
                Self::Annulus { outer_radius: p, inner_radius: i },
                Self::Annulus { outer_radius: q, inner_radius: j },
            ) => Self::Annulus { outer_radius: mix(p, q), inner_radius: mix(i, j) },
            (Self::Ellipse { a, b }, Self::Ellipse { a: c, b: d }) => {
                Self::Ellipse { a: mix(a, c), b: mix(b, d) }
            }
            (Self::Rectangle { width: a, height: b }, Self::Rectangle { width: c, height: d }) => {
                Self::Rectangle { width: mix(a, c), height: mix(b, d) }
            }
            _ => return None,
        })
    }
}
