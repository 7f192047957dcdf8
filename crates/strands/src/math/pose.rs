//! Poses: the group SE(3) of frames `(R, p)`, its exponential, logarithm and tangent.

use super::series::{BERNOULLI, arcsine_series, bernoulli_series};
use super::{ExpCoefficients, Mat3, Mat6, Quat, Real, Vec3, Vec6, Vector, Wide, exp_coefficients};

/// A little below it, so that a whole radian is within.
const COS_OF_HALF_A_RADIAN: f64 = 0.8775;

/// A frame: an orientation whose columns are the directors, and a position, m.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Pose<V = Vec3> {
    /// Orientation, body to world.
    pub rotation: Mat3<V>,
    /// Position in the world, m.
    pub position: V,
}

impl Pose {
    /// The world frame.
    pub const IDENTITY: Self = Self { rotation: Mat3::IDENTITY, position: Vec3::ZERO };

    /// A frame from its position and quaternion.
    pub fn from_parts(position: Vec3, orientation: Quat) -> Self {
        Self { rotation: orientation.to_matrix(), position }
    }

    /// The orientation as a quaternion.
    pub fn orientation(&self) -> Quat {
        Quat::from_matrix(self.rotation)
    }

    /// The logarithm: the constant strain that leads from the identity to this pose over unit length, its angle at most π.
    /// Accurate to round-off for every angle; at exactly half a turn one of the two axes is taken.
    pub fn log(&self) -> Vec6 {
        let u = self.rotation.rotation_vector();
        let (_, d, _) = inverse_coefficients(u.dot(u));
        let p = self.position;
        let up = u.cross(p);
        Vec6::new(u, p - up * 0.5 + u.cross(up) * d)
    }

    /// The frame a part of the way to another: along a straight line, by the shortest turn.
    pub fn towards(&self, other: &Self, part: f64) -> Self {
        let turn = self.rotation.turn_to(&other.rotation) * part;
        Self {
            rotation: self.rotation * Quat::from_rotation_vector(turn).to_matrix(),
            position: self.position + (other.position - self.position) * part,
        }
    }

    /// The matrix of [`Pose::adjoint`].
    pub(crate) fn adjoint_matrix(&self) -> Mat6 {
        let arm = Mat3 { cols: self.rotation.cols.map(|column| self.position.cross(column)) };
        Mat6 { blocks: [[self.rotation, Mat3::ZERO], [arm, self.rotation]] }
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.position.is_finite()
    }

    /// The same pose in every lane.
    #[inline(always)]
    pub fn splat<V: Vector>(self) -> Pose<V> {
        Pose { rotation: self.rotation.splat(), position: V::splat(self.position) }
    }
}

impl<R: Real> Mat3<Vec3<R>> {
    /// The rotation vector of a turn by less than a radian; NaN where it is larger. By the sine of a quarter of the angle, whose inverse is a short series.
    #[inline(always)]
    pub(crate) fn small_turn(&self) -> Vec3<R> {
        let ([a, b, c], half) = (self.cols, R::splat(0.5));
        let sine = Vec3::new(b.z - c.y, c.x - a.z, a.y - b.x) * half;
        let cos = (a.x + b.y + c.z - R::one()) * half;
        let cos_half = ((R::one() + cos) * half).sqrt();
        let cos_quarter = ((R::one() + cos_half) * half).sqrt();
        let quarters = cos_half * cos_quarter;
        let sine_quarter = sine * (R::splat(0.25) / quarters);
        let q = sine_quarter.dot(sine_quarter);
        let known = R::select((-cos_half).at_most(-COS_OF_HALF_A_RADIAN), R::one(), R::splat(f64::NAN));
        sine * (arcsine_series(q) / quarters * known)
    }
}

/// The logarithms of poses, in lanes.
#[inline(always)]
pub(crate) fn logs<R: Wide>(poses: &Pose<Vec3<R>>) -> Vec6<Vec3<R>> {
    let mut logs = poses.log_of_small_turn();
    if !R::all(logs.angular.x.at_most(f64::INFINITY)) {
        log_large_turns(poses, &mut logs);
    }
    logs
}

/// Where a turn is too large for the short way.
#[cold]
#[inline(never)]
fn log_large_turns<R: Wide>(poses: &Pose<Vec3<R>>, logs: &mut Vec6<Vec3<R>>) {
    for lane in 0..R::LANES {
        if logs.angular.x.number(lane).is_nan() {
            logs.put(lane, poses.lane(lane).log());
        }
    }
}

/// The rotation vectors of turns, in lanes.
#[inline(always)]
pub(crate) fn turns<R: Wide>(rotations: &Mat3<Vec3<R>>) -> Vec3<R> {
    let mut turns = rotations.small_turn();
    if !R::all(turns.x.at_most(f64::INFINITY)) {
        take_large_turns(rotations, &mut turns);
    }
    turns
}

#[cold]
#[inline(never)]
fn take_large_turns<R: Wide>(rotations: &Mat3<Vec3<R>>, turns: &mut Vec3<R>) {
    for lane in 0..R::LANES {
        if turns.x.number(lane).is_nan() {
            turns.put(lane, rotations.lane(lane).rotation_vector());
        }
    }
}

impl<R: Real> Pose<Vec3<R>> {
    /// The exponential: where the constant strain `x` leads over unit length ((12)–(15) of the paper).
    #[inline(always)]
    pub fn exp(x: Vec6<Vec3<R>>) -> Self {
        let (u, v) = (x.angular, x.linear);
        let t = u.dot(u);
        let k = exp_coefficients(t);
        let (a, cos) = (R::one() - t * k.c, R::one() - t * k.b);
        // exp û = cos θ + a û + b u uᵀ, which saves forming û².
        let (bu, au) = (u * k.b, u * a);
        let (xy, xz, yz) = (bu.x * u.y, bu.x * u.z, bu.y * u.z);
        let rotation = Mat3::from_cols(
            Vec3::new(cos + bu.x * u.x, xy + au.z, xz - au.y),
            Vec3::new(xy - au.z, cos + bu.y * u.y, yz + au.x),
            Vec3::new(xz + au.y, yz - au.x, cos + bu.z * u.z),
        );
        let uv = u.cross(v);
        Self { rotation, position: v + uv * k.b + u.cross(uv) * k.c }
    }

    /// The logarithm of a pose that turns by less than a radian; NaN in its turn where it turns further.
    #[inline(always)]
    pub(crate) fn log_of_small_turn(&self) -> Vec6<Vec3<R>> {
        let (u, p) = (self.rotation.small_turn(), self.position);
        let up = u.cross(p);
        Vec6::new(u, p - up * R::splat(0.5) + u.cross(up) * bernoulli_series(u.dot(u)))
    }

    /// The inverse.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, position: -(rotation * self.position) }
    }

    /// `self⁻¹ · other`: `other` as seen from this frame.
    #[inline(always)]
    pub fn between(&self, other: &Self) -> Self {
        Self {
            rotation: self.rotation.transpose() * other.rotation,
            position: self.rotation.transpose_mul(other.position - self.position),
        }
    }
}

impl<V: Vector> Pose<V> {
    /// The product `self · other`: `other` given in this frame.
    #[inline(always)]
    pub fn compose(&self, other: &Self) -> Self {
        Self {
            rotation: self.rotation * other.rotation,
            position: self.rotation * other.position + self.position,
        }
    }

    /// `self · exp(−x)`: the frame from which the exponent `x` leads to this one, with `t = u·u` and the coefficients there.
    #[inline(always)]
    pub(crate) fn before(&self, x: &Vec6<V>, t: V::Number, k: &ExpCoefficients<V::Number>) -> Self {
        let (u, v) = (x.angular, x.linear);
        let [d1, d2, d3] = self.rotation.cols;
        let one = V::Number::one();
        let (sin, cos) = (u * (one - t * k.c), one - t * k.b);
        // R exp(−û) = cos θ R − a R û + b (R u) uᵀ.
        let [sx, sy, sz] = sin.spread();
        let [bx, by, bz] = (u * k.b).spread();
        let turned = self.rotation * u;
        let rotation = Mat3::from_cols(
            (d1 * cos + turned.scale(bx)) + (d3.scale(sy) - d2.scale(sz)),
            (d2 * cos + turned.scale(by)) + (d1.scale(sz) - d3.scale(sx)),
            (d3 * cos + turned.scale(bz)) + (d2.scale(sx) - d1.scale(sy)),
        );
        let uv = u.cross(v);
        let ahead = v - uv * k.b + u.cross(uv) * k.c;
        Self { rotation, position: self.position - self.rotation * ahead }
    }

    /// `Ad x`: a variation of the frame at the far end of this pose, as one of the frame at its near end.
    #[inline(always)]
    pub fn adjoint(&self, x: Vec6<V>) -> Vec6<V> {
        let angular = self.rotation * x.angular;
        Vec6::new(angular, self.rotation * x.linear + self.position.cross(angular))
    }

    /// The frame as seen from where it is.
    #[inline(always)]
    pub fn from_itself(&self) -> Self {
        Self { rotation: self.rotation, position: V::zero() }
    }

    /// `Ad⁻ᵀ w`: a wrench at the far end of this pose, moved to and expressed in the frame at its near end.
    #[inline(always)]
    pub fn carry_wrench(&self, w: Vec6<V>) -> Vec6<V> {
        let force = self.rotation * w.linear;
        Vec6::new(self.rotation * w.angular + self.position.cross(force), force)
    }
}

/// The tangent of the exponential `T(x) = Σ (−1)^k/(k+1)! ad_x^k`: `d exp(x) = exp(x) (T(x) dx)^`.
pub fn tangent(x: Vec6) -> Mat6 {
    let (u, v) = (x.angular, x.linear);
    let k = exp_coefficients(u.dot(u));
    let (uh, vh) = (Mat3::hat(u), Mat3::hat(v));
    let (u2, uv2) = (uh * uh, uh * vh + vh * uh);
    let twice = 2.0 * u.dot(v);
    let diagonal = Mat3::IDENTITY - uh.scaled(k.b) + u2.scaled(k.c);
    let coupling = uv2.scaled(k.c) - vh.scaled(k.b) + (u2.scaled(k.dc) - uh.scaled(k.db)).scaled(twice);
    Mat6 { blocks: [[diagonal, Mat3::ZERO], [coupling, diagonal]] }
}

/// The inverse of [`tangent`], `T(x)⁻¹ = 1 + ½ ad + d ad² + …`. Singular at a full turn only.
pub fn tangent_inverse(x: Vec6) -> Mat6 {
    let (u, v) = (x.angular, x.linear);
    let (_, d, dd) = inverse_coefficients(u.dot(u));
    let (uh, vh) = (Mat3::hat(u), Mat3::hat(v));
    let (u2, uv2) = (uh * uh, uh * vh + vh * uh);
    let diagonal = Mat3::IDENTITY + uh.scaled(0.5) + u2.scaled(d);
    let coupling = vh.scaled(0.5) + uv2.scaled(d) + u2.scaled(2.0 * u.dot(v) * dd);
    Mat6 { blocks: [[diagonal, Mat3::ZERO], [coupling, diagonal]] }
}

/// The tangent of the exponential of rotations: `d exp(θ) = exp(θ) (T(θ) dθ)^`, the angular part of [`tangent`].
pub(crate) fn so3_tangent(theta: Vec3) -> Mat3 {
    let (k, hat) = (exp_coefficients(theta.dot(theta)), Mat3::hat(theta));
    Mat3::IDENTITY - hat.scaled(k.b) + (hat * hat).scaled(k.c)
}

/// The inverse of [`so3_tangent`].
pub(crate) fn so3_tangent_inverse(theta: Vec3) -> Mat3 {
    tangent_inverse(Vec6::new(theta, Vec3::ZERO)).blocks[0][0]
}

/// `(θ, d, dd/dt)` with `d(t) = (1 − (θ/2) cot(θ/2))/θ²`, `t = θ²`.
fn inverse_coefficients(t: f64) -> (f64, f64, f64) {
    let theta = t.sqrt();
    if t < 0.3 {
        // So many terms are exact to round-off here.
        let terms = &BERNOULLI[..9];
        let value = terms.iter().rev().fold(0.0, |sum, a| sum * t + a);
        let slope = (1..9).rev().fold(0.0, |sum, k| sum * t + k as f64 * terms[k]);
        return (theta, value, slope);
    }
    let half = 0.5 * theta;
    let (sin, cos) = (libm::sin(half), libm::cos(half));
    let y = half * cos / sin;
    let d = (1.0 - y) / t;
    // dy/dθ = ½ (cot − half/sin²); dθ/dt = 1/(2θ).
    let dy = 0.5 * (cos / sin - half / (sin * sin)) / (2.0 * theta);
    (theta, d, (-dy - d) / t)
}
