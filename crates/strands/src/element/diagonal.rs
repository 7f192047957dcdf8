//! The hot path: elements of a diagonal law, for one rod or several side by side.
//!
//! A [`LocalSolver`] is stepped along the rod from its end. Most elements take one evaluation of their local equation: what the last
//! elements needed beyond `ε̂ + S w` changes slowly along the rod, even across loads, and extrapolates to within round-off of the
//! solution; one quasi-Newton step does the rest.

use super::{GAUSS_OFFSET, MAX_LOCAL_ITERATIONS, PointStrains, exponent, gauss_stresses, mean_wrench};
use crate::math::{
    ExpCoefficients, Mat3, Mat6, Pose, Real, Strain, Vec3, Vec6, Wrench, exp_coefficients,
    exp_coefficients_second, exp_rotation,
};
use crate::rod::Order;

/// How far, in rad or as a part, the strain over an element may be from the solution of its local equation.
const LOCAL_TOLERANCE: f64 = 1e-14;
/// A last step larger than this would spoil the first-order update of the coefficients.
const LARGEST_LAST_STEP: f64 = 1e-8;
/// Steps by the truncated series before the matrix is inverted.
const SERIES_STEPS: usize = 4;

/// The compliance and rest strain at one point of an element with a diagonal law. A strain that is not free has compliance zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DiagonalPoint {
    pub compliance: Vec6,
    pub rest: Strain,
}

/// An element, solved.
pub(crate) struct Solved<R> {
    /// The strain at its first point.
    pub strain: Strain<R>,
    /// The strain at its second point; the same as the first where there is but one.
    pub second: Strain<R>,
    /// The frame of its far node from its near node.
    pub relative: Pose<R>,
}

/// Finds the elements' strains one after the other, from the rod's end to its start.
pub(crate) trait LocalSolver<R: Real> {
    /// How many points an element has.
    const POINTS: usize;
    /// At the rod's end.
    fn new() -> Self;
    /// The next element, from its length, its points, and the wrench through its far node. Lanes that do not converge come back as NaN.
    fn next(&mut self, h: f64, points: &[DiagonalPoint], wrench: Wrench<R>) -> Solved<R>;
}

/// The linear part of an element's exponent: any, or straight ahead.
pub(crate) trait Shift<R: Real>: Copy {
    /// Whether it is free.
    const FREE: bool;
    /// From the linear strain and the element's length.
    fn new(linear: Vec3<R>, h: R) -> Self;
    /// `to + v × n`.
    fn add_cross(self, n: Vec3<R>, to: Vec3<R>) -> Vec3<R>;
    /// `v · u`.
    fn dot(self, u: Vec3<R>) -> R;
    /// `v + b u×v + c u×(u×v)`, with `t = u·u`.
    fn carried(self, u: Vec3<R>, t: R, b: R, c: R) -> Vec3<R>;
}

impl<R: Real> Shift<R> for Vec3<R> {
    const FREE: bool = true;
    #[inline(always)]
    fn new(linear: Vec3<R>, h: R) -> Self {
        linear * h
    }
    #[inline(always)]
    fn add_cross(self, n: Vec3<R>, to: Vec3<R>) -> Vec3<R> {
        to + self.cross(n)
    }
    #[inline(always)]
    fn dot(self, u: Vec3<R>) -> R {
        Vec3::dot(self, u)
    }
    #[inline(always)]
    fn carried(self, u: Vec3<R>, t: R, b: R, c: R) -> Vec3<R> {
        let along = Vec3::dot(self, u);
        self * (R::one() - t * c) + u.cross(self) * b + u * (along * c)
    }
}

/// Straight ahead by a length: the exponent of an inextensible, unshearable rod.
#[derive(Clone, Copy)]
pub(crate) struct Straight<R>(R);

impl<R: Real> Shift<R> for Straight<R> {
    const FREE: bool = false;
    #[inline(always)]
    fn new(_: Vec3<R>, h: R) -> Self {
        Self(h)
    }
    #[inline(always)]
    fn add_cross(self, n: Vec3<R>, to: Vec3<R>) -> Vec3<R> {
        Vec3::new(to.x - self.0 * n.y, to.y + self.0 * n.x, to.z)
    }
    #[inline(always)]
    fn dot(self, u: Vec3<R>) -> R {
        self.0 * u.z
    }
    #[inline(always)]
    fn carried(self, u: Vec3<R>, t: R, b: R, c: R) -> Vec3<R> {
        let (bh, ch) = (b * self.0, c * self.0);
        let turned = u.z * ch;
        Vec3::new(bh * u.y + turned * u.x, turned * u.y - bh * u.x, self.0 - ch * t + turned * u.z)
    }
}

/// Order 1: `ε = ε̂ + S w`.
pub(crate) struct First;

impl<R: Real> LocalSolver<R> for First {
    const POINTS: usize = 1;
    #[inline(always)]
    fn new() -> Self {
        Self
    }
    #[inline(always)]
    fn next(&mut self, h: f64, points: &[DiagonalPoint], wrench: Wrench<R>) -> Solved<R> {
        let strain = points[0].explicit(wrench);
        Solved { strain, second: strain, relative: Pose::exp(strain * R::splat(h)) }
    }
}

impl DiagonalPoint {
    #[inline(always)]
    fn explicit<R: Real>(&self, wrench: Wrench<R>) -> Strain<R> {
        self.rest.splat::<R>() + self.compliance.splat::<R>().scale(wrench)
    }
}

/// Room for the six past elements that the extrapolation looks at: a power of two.
const ROOM: usize = 8;

/// What the last elements needed beyond `ε̂ + S w`.
struct History<R> {
    angular: [Vec3<R>; ROOM],
    linear: [Vec3<R>; ROOM],
    known: usize,
}

impl<R: Real> History<R> {
    #[inline(always)]
    fn new() -> Self {
        Self { angular: [Vec3::zero(); ROOM], linear: [Vec3::zero(); ROOM], known: 0 }
    }

    /// The next one. The linear part only where it is free.
    #[inline(always)]
    fn next<const FREE: bool>(&self) -> Vec6<R> {
        let linear = if FREE { Self::extrapolate(&self.linear, self.known) } else { Vec3::zero() };
        Vec6::new(Self::extrapolate(&self.angular, self.known), linear)
    }

    /// Through the last six, `6a − 15b + 20c − 15d + 6e − f`, or through as many as there are.
    #[inline(always)]
    fn extrapolate(past: &[Vec3<R>; ROOM], known: usize) -> Vec3<R> {
        let ago = |i: usize| past[known.wrapping_sub(1 + i) % ROOM];
        let k = R::splat;
        if known >= 6 {
            return (ago(0) + ago(4)) * k(6.0) - (ago(1) + ago(3)) * k(15.0) + ago(2) * k(20.0) - ago(5);
        }
        match known {
            0 => Vec3::zero(),
            1 => ago(0),
            2 => ago(0) * k(2.0) - ago(1),
            3 => (ago(0) - ago(1)) * k(3.0) + ago(2),
            4 => (ago(0) + ago(2)) * k(4.0) - ago(1) * k(6.0) - ago(3),
            _ => (ago(0) - ago(3)) * k(5.0) + (ago(2) - ago(1)) * k(10.0) + ago(4),
        }
    }

    #[inline(always)]
    fn push<const FREE: bool>(&mut self, correction: Vec6<R>) {
        self.angular[self.known % ROOM] = correction.angular;
        if FREE {
            self.linear[self.known % ROOM] = correction.linear;
        }
        self.known += 1;
    }
}

/// Order 2, with the linear strain free or not.
pub(crate) struct Second<R, V> {
    history: History<R>,
    shift: core::marker::PhantomData<V>,
}

impl<R: Real, V: Shift<R>> LocalSolver<R> for Second<R, V> {
    const POINTS: usize = 1;

    #[inline(always)]
    fn new() -> Self {
        Self { history: History::new(), shift: core::marker::PhantomData }
    }

    #[inline(always)]
    fn next(&mut self, h: f64, points: &[DiagonalPoint], wrench: Wrench<R>) -> Solved<R> {
        let length = R::splat(h);
        let compliance = points[0].compliance.splat::<R>();
        let explicit = points[0].explicit(wrench);
        // The unknown is what the strain needs beyond the explicit one; for a straight element the linear part of everything is left alone.
        let mut correction = if V::FREE { self.history.next::<true>() } else { self.history.next::<false>() };
        let straight = points[0].rest.linear.splat::<R>();
        let mut strain = corrected::<R, V>(&explicit, &correction, straight);
        for iteration in 0..MAX_LOCAL_ITERATIONS {
            let (u, v) = (strain.angular * length, V::new(strain.linear, length));
            let t = u.dot(u);
            let k = exp_coefficients(t);
            let local = Linearisation::new(u, v, &k, wrench);
            let residual = Vec6::new(
                compliance.angular.scale(local.moment_change) - correction.angular,
                if V::FREE {
                    compliance.linear.scale(local.force_change(&k)) - correction.linear
                } else {
                    Vec3::zero()
                },
            );
            let gap = Gap::new::<V>(residual, t, length, compliance, wrench);
            let near = R::all(gap.closed_by_first_order());
            let step = if near {
                first_order_step::<R, V>(length, compliance, wrench, residual)
            } else if iteration < SERIES_STEPS {
                local.series_step::<V>(u, v, length, compliance, wrench, residual)
            } else {
                LocalNewton::new(h, compliance, strain, wrench).step(residual)
            };
            correction += step;
            strain = corrected::<R, V>(&explicit, &correction, straight);
            if near || R::all(gap.closed_by_second_order()) {
                if V::FREE {
                    self.history.push::<true>(correction);
                } else {
                    self.history.push::<false>(correction);
                }
                let (u, v) = (strain.angular * length, V::new(strain.linear, length));
                let t_now = u.dot(u);
                // The last step moved t by so little that the coefficients follow to first order.
                let (b, c) = (k.b + k.db * (t_now - t), k.c + k.dc * (t_now - t));
                let relative =
                    Pose { rotation: exp_rotation(u, t_now, b, c), position: v.carried(u, t_now, b, c) };
                return Solved { strain, second: strain, relative };
            }
        }
        not_converged()
    }
}

/// The explicit strain with its correction, its linear part as it is at rest where that is not free.
#[inline(always)]
fn corrected<R: Real, V: Shift<R>>(
    explicit: &Strain<R>,
    correction: &Strain<R>,
    straight: Vec3<R>,
) -> Strain<R> {
    let linear = if V::FREE { explicit.linear + correction.linear } else { straight };
    Vec6::new(explicit.angular + correction.angular, linear)
}

fn not_converged<R: Real>() -> Solved<R> {
    let nan = Vec6::from([f64::NAN; 6]).splat();
    Solved { strain: nan, second: nan, relative: Pose::exp(nan) }
}

/// The parts of the local equation that its value and its steps share.
struct Linearisation<R> {
    un: Vec3<R>,
    first: Vec3<R>,
    uun: Vec3<R>,
    /// `m̄ − m`.
    moment_change: Vec3<R>,
}

impl<R: Real> Linearisation<R> {
    #[inline(always)]
    fn new<V: Shift<R>>(u: Vec3<R>, v: V, k: &ExpCoefficients<R>, w: Wrench<R>) -> Self {
        let un = u.cross(w.linear);
        let uun = u.cross(un);
        let first = v.add_cross(w.linear, u.cross(w.angular));
        let second = v.add_cross(un, u.cross(first));
        let twice = v.dot(u) * R::splat(2.0);
        let moment_change = first * k.b + second * k.c + un * (twice * k.db) + uun * (twice * k.dc);
        Self { un, first, uun, moment_change }
    }

    /// `n̄ − n`.
    #[inline(always)]
    fn force_change(&self, k: &ExpCoefficients<R>) -> Vec3<R> {
        self.un * k.b + self.uun * k.c
    }

    /// `(1 + E + E²) r`, with `E = h S ∂σ̄/∂x` up to second order in the exponent (its square to first order): the inverse of `1 − E` up to
    /// third order.
    #[inline(always)]
    fn series_step<V: Shift<R>>(
        &self,
        u: Vec3<R>,
        v: V,
        h: R,
        compliance: Vec6<R>,
        w: Wrench<R>,
        r: Vec6<R>,
    ) -> Vec6<R> {
        let (half, sixth) = (R::splat(0.5), R::splat(1.0 / 6.0));
        let (m, n) = (w.angular, w.linear);
        let (su, sv) = (compliance.angular * h, compliance.linear * h);
        let turn = m * half + self.first * sixth;
        // ∂m̄/∂u r ≈ r×(m/2 + (u×m + v×n)/6) + ((u·m + v·n) r − m (u·r) − n (v·r))/6
        let a = r.angular;
        let trace = u.dot(m) + v.dot(n);
        let stretch = (a * trace - m * u.dot(a) - n * v.dot(a)) * sixth;
        let mut moment = a.cross(turn) + stretch;
        if V::FREE {
            moment += r.linear.cross(n) * half;
        }
        let once =
            Vec6::new(su.scale(moment), if V::FREE { sv.scale(a.cross(n)) * half } else { Vec3::zero() });
        let mut moment = once.angular.cross(m) * half;
        if V::FREE {
            moment += once.linear.cross(n) * half;
        }
        let twice_angular = su.scale(moment);
        Vec6::new(
            a + once.angular + twice_angular,
            if V::FREE {
                r.linear + once.linear + sv.scale(once.angular.cross(n)) * half
            } else {
                Vec3::zero()
            },
        )
    }
}

/// `(1 + E) r` with `E` to first order in the exponent.
#[inline(always)]
fn first_order_step<R: Real, V: Shift<R>>(h: R, compliance: Vec6<R>, w: Wrench<R>, r: Vec6<R>) -> Vec6<R> {
    let half = h * R::splat(0.5);
    let mut moment = r.angular.cross(w.angular);
    if V::FREE {
        moment += r.linear.cross(w.linear);
    }
    let angular = r.angular + compliance.angular.scale(moment) * half;
    let linear = if V::FREE {
        r.linear + compliance.linear.scale(r.angular.cross(w.linear)) * half
    } else {
        Vec3::zero()
    };
    Vec6::new(angular, linear)
}

/// How large a residual is, and what the two kinds of step would leave of it: with `q = h² n/EI`, about `(θ² + q)/2` of it, and
/// `θ (θ² + q)/4`.
struct Gap<R> {
    size: R,
    rate: R,
    t: R,
}

impl<R: Real> Gap<R> {
    #[inline(always)]
    fn new<V: Shift<R>>(residual: Vec6<R>, t: R, h: R, compliance: Vec6<R>, w: Wrench<R>) -> Self {
        let (a, s, n) = (residual.angular, compliance.angular, w.linear);
        let mut size = (a.x.abs() + a.y.abs() + a.z.abs()) * h;
        if V::FREE {
            size += residual.linear.x.abs() + residual.linear.y.abs() + residual.linear.z.abs();
        }
        let q = (s.x + s.y) * (n.x.abs() + n.y.abs() + n.z.abs()) * (h * h);
        Self { size, rate: t + q, t }
    }

    #[inline(always)]
    fn closed_by_first_order(&self) -> R::Mask {
        (self.size * (self.rate + self.size)).at_most(LOCAL_TOLERANCE)
    }

    /// Newton's error in a residual of this size is of second order, and counts too.
    #[inline(always)]
    fn closed_by_second_order(&self) -> R::Mask {
        let left = self.size * self.rate;
        R::and(
            self.size.at_most(LARGEST_LAST_STEP),
            (left * left * (self.t + self.size)).at_most(16.0 * LOCAL_TOLERANCE * LOCAL_TOLERANCE),
        )
    }
}

/// Order 4.
pub(crate) struct Fourth<R> {
    history: [History<R>; 2],
}

impl<R: Real> LocalSolver<R> for Fourth<R> {
    const POINTS: usize = 2;

    #[inline(always)]
    fn new() -> Self {
        Self { history: [History::new(), History::new()] }
    }

    #[inline(always)]
    fn next(&mut self, h: f64, points: &[DiagonalPoint], wrench: Wrench<R>) -> Solved<R> {
        let explicit = [points[0].explicit(wrench), points[1].explicit(wrench)];
        let compliance = [points[0].compliance.splat::<R>(), points[1].compliance.splat::<R>()];
        let half = R::splat(0.5);
        let mut strains: PointStrains<R> =
            core::array::from_fn(|i| explicit[i] + self.history[i].next::<true>());
        let mean_strain = (strains[0] + strains[1]) * half;
        let newton = LocalNewton::new(h, (compliance[0] + compliance[1]) * half, mean_strain, wrench);
        for _ in 0..MAX_LOCAL_ITERATIONS {
            let mean = mean_wrench(exponent(Order::Fourth, h, &strains), wrench);
            let stress = gauss_stresses(h, &strains, mean);
            let residual: PointStrains<R> =
                core::array::from_fn(|i| explicit[i] + compliance[i].scale(stress[i] - wrench) - strains[i]);
            let common_residual = (residual[0] + residual[1]) * half;
            let common = newton.step(common_residual);
            // The difference of the two strains follows from the mean one.
            let follow = common.coadjoint(mean) * R::splat(GAUSS_OFFSET * h);
            let step = [
                residual[0] - common_residual + common + compliance[0].scale(follow),
                residual[1] - common_residual + common - compliance[1].scale(follow),
            ];
            strains[0] += step[0];
            strains[1] += step[1];
            if R::all(R::and(newton.converged(step[0]), newton.converged(step[1]))) {
                for i in 0..2 {
                    self.history[i].push::<true>(strains[i] - explicit[i]);
                }
                let relative = Pose::exp(exponent(Order::Fourth, h, &strains));
                return Solved { strain: strains[0], second: strains[1], relative };
            }
        }
        not_converged()
    }
}

/// The multistep variant: the strains of the two neighbours, extrapolated, in place of the unknown one.
pub(crate) struct Multistep<R> {
    elastic: [Strain<R>; 2],
    known: usize,
}

impl<R: Real> LocalSolver<R> for Multistep<R> {
    const POINTS: usize = 1;

    #[inline(always)]
    fn new() -> Self {
        Self { elastic: [Vec6::zero(); 2], known: 0 }
    }

    #[inline(always)]
    fn next(&mut self, h: f64, points: &[DiagonalPoint], wrench: Wrench<R>) -> Solved<R> {
        let (compliance, rest) = (points[0].compliance.splat::<R>(), points[0].rest.splat::<R>());
        let elastic = match self.known {
            0 => compliance.scale(wrench),
            1 => self.elastic[0],
            _ => self.elastic[0] * R::splat(2.0) - self.elastic[1],
        };
        let mean = mean_wrench((rest + elastic) * R::splat(h), wrench);
        self.elastic = [compliance.scale(mean), self.elastic[0]];
        self.known += 1;
        let strain = rest + self.elastic[0];
        Solved { strain, second: strain, relative: Pose::exp(strain * R::splat(h)) }
    }
}

/// The Newton matrix of the local equation up to second order in the exponent, inverted: for elements of large turn, and for order 4.
struct LocalNewton<R> {
    h: R,
    compliance: Vec6<R>,
    half_force: Vec3<R>,
    inverse: Mat3<R>,
    theta2: R,
}

impl<R: Real> LocalNewton<R> {
    #[inline(always)]
    fn new(h: f64, compliance: Vec6<R>, strain: Strain<R>, w: Wrench<R>) -> Self {
        let length = R::splat(h);
        let (u, v, m, n) = (strain.angular * length, strain.linear * length, w.angular, w.linear);
        let sixth = R::splat(1.0 / 6.0);
        let turn = m * R::splat(0.5) + (u.cross(m) + v.cross(n)) * sixth;
        let trace = (u.dot(m) + v.dot(n)) * sixth;
        let one = R::one();
        let (su, m6, n6) = (compliance.angular * length, m * sixth, n * sixth);
        // 1 − h S ∂m̄/∂u with ∂m̄/∂u ≈ −(m/2 + (u×m + v×n)/6)^ − (m uᵀ + n vᵀ)/6 + (u·m + v·n)/6, row by row.
        let row = |scale: R, hat: Vec3<R>, mi: R, ni: R| (hat + u * mi + v * ni) * scale;
        let rows = [
            row(su.x, Vec3::new(R::zero(), -turn.z, turn.y), m6.x, n6.x),
            row(su.y, Vec3::new(turn.z, R::zero(), -turn.x), m6.y, n6.y),
            row(su.z, Vec3::new(-turn.y, turn.x, R::zero()), m6.z, n6.z),
        ];
        let matrix = Mat3::from_cols(
            Vec3::new(one - su.x * trace + rows[0].x, rows[0].y, rows[0].z),
            Vec3::new(rows[1].x, one - su.y * trace + rows[1].y, rows[1].z),
            Vec3::new(rows[2].x, rows[2].y, one - su.z * trace + rows[2].z),
        );
        Self {
            h: length,
            compliance,
            half_force: n * (length * R::splat(0.5)),
            inverse: matrix.inverse().transpose(),
            theta2: u.dot(u),
        }
    }

    #[inline(always)]
    fn step(&self, residual: Strain<R>) -> Strain<R> {
        let bent = self.compliance.angular.scale(residual.linear.cross(self.half_force));
        let angular = self.inverse * (residual.angular + bent);
        let sheared = self.compliance.linear.scale(angular.cross(self.half_force));
        Strain::new(angular, residual.linear + sheared)
    }

    /// Whether what is left after a step is round-off: the next step would be smaller by about `θ²` or more.
    #[inline(always)]
    fn converged(&self, step: Strain<R>) -> R::Mask {
        let (a, l) = (step.angular, step.linear);
        let turn = (a.x.abs() + a.y.abs() + a.z.abs()) * self.h;
        let shift = l.x.abs() + l.y.abs() + l.z.abs();
        let size = turn + shift;
        R::and(size.at_most(LARGEST_LAST_STEP), (size * self.theta2).at_most(LOCAL_TOLERANCE))
    }
}

/// The flexibility of an element of order 2 with a diagonal law, in the factors that are cheapest to apply: `T · inner · Tᵀ`, with `T`
/// made of `turn` on its diagonal and `shift` below it. `inner` takes a moment and a force `(m, n)` to a bend `a m + b n` and a
/// stretch `stretch ∘ n + c bend`; only `a` is there where the linear strain is not free.
pub(crate) struct DiagonalFlexibility {
    pub turn: Mat3,
    pub shift: Mat3,
    pub a: Mat3,
    pub b: Mat3,
    pub c: Mat3,
    pub stretch: Vec3,
}

impl DiagonalFlexibility {
    /// As one matrix.
    pub(crate) fn to_matrix(&self) -> Mat6 {
        let zero = Mat3::ZERO;
        let tangent = Mat6 { blocks: [[self.turn, zero], [self.shift, self.turn]] };
        let inner = [[self.a, self.b], [self.c * self.a, Mat3::diagonal(self.stretch) + self.c * self.b]];
        tangent.mul(&Mat6 { blocks: inner }).mul(&tangent.transpose())
    }
}

/// [`flexibility`](super::flexibility) for order 2 and a diagonal law.
#[inline(always)]
pub(crate) fn diagonal_flexibility<const KIRCHHOFF: bool>(
    h: f64,
    point: &DiagonalPoint,
    w: Wrench,
    strain: &Strain,
) -> DiagonalFlexibility {
    let (u, v) = (strain.angular * h, if KIRCHHOFF { Vec3::new(0.0, 0.0, h) } else { strain.linear * h });
    let t = u.dot(u);
    let k = exp_coefficients(t);
    let (ddb, ddc) = exp_coefficients_second(t);
    let (m, n) = (w.angular, w.linear);
    let twice = 2.0 * u.dot(v);
    // The tangent, by the identities û² = u uᵀ − t and û v̂ + v̂ û = v uᵀ + u vᵀ − 2 u·v.
    let turn = symmetric_plus_hat(u * k.c, u, 1.0 - t * k.c, u * -k.b);
    let shift = Mat3::outer(v * k.c, u)
        + symmetric_plus_hat(
            u * (twice * k.dc),
            u,
            -twice * (k.c + t * k.dc),
            v * -k.b + u * (-twice * k.db),
        )
        + Mat3::outer(u * k.c, v);
    let un = u.cross(n);
    let uun = u.cross(un);
    let first = u.cross(m) + v.cross(n);
    let second = u.cross(first) + v.cross(un);
    // ∂m̄/∂u, with û m̂ = m uᵀ − u·m and the like.
    let coupling = (un * k.db + uun * k.dc) * 2.0;
    let along_u =
        (first * k.db + second * k.dc + (un * ddb + uun * ddc) * twice) * 2.0 - m * k.c - n * (twice * k.dc);
    let along_v = coupling - n * k.c;
    let trace = k.c * (u.dot(m) + v.dot(n)) + twice * k.dc * u.dot(n);
    let hat = m * k.b + first * k.c + n * (twice * k.db) + un * (twice * k.dc);
    let moment_by_turn = Mat3::outer(along_u, u) + symmetric_plus_hat(along_v, v, trace, -hat);
    let (su, sv) = (point.compliance.angular * h, point.compliance.linear * h);
    if KIRCHHOFF {
        let a = scale_columns((Mat3::IDENTITY - scale_rows(su, moment_by_turn)).inverse(), su);
        let zero = Mat3::ZERO;
        return DiagonalFlexibility { turn, shift, a, b: zero, c: zero, stretch: Vec3::ZERO };
    }
    let common = symmetric_plus_hat(coupling - n * k.c, u, k.c * u.dot(n), -(n * k.b + un * k.c));
    // (1 − S h K) δε = S Tᵀ δw; ∂n̄/∂v = 0 and ∂n̄/∂u = ∂m̄/∂v, so the shifts are eliminated by hand.
    let (by_shift, c) = (scale_rows(su, common), scale_rows(sv, common));
    let schur = (Mat3::IDENTITY - scale_rows(su, moment_by_turn) - by_shift * c).inverse();
    let a = scale_columns(schur, su);
    let b = scale_columns(schur * by_shift, sv);
    DiagonalFlexibility { turn, shift, a, b, c, stretch: sv }
}

/// `a bᵀ + diagonal + hat^`.
#[inline(always)]
fn symmetric_plus_hat(a: Vec3, b: Vec3, diagonal: f64, hat: Vec3) -> Mat3 {
    Mat3::from_cols(
        Vec3::new(a.x * b.x + diagonal, a.y * b.x + hat.z, a.z * b.x - hat.y),
        Vec3::new(a.x * b.y - hat.z, a.y * b.y + diagonal, a.z * b.y + hat.x),
        Vec3::new(a.x * b.z + hat.y, a.y * b.z - hat.x, a.z * b.z + diagonal),
    )
}

#[inline(always)]
fn scale_rows(s: Vec3, m: Mat3) -> Mat3 {
    Mat3 { cols: [m.cols[0].scale(s), m.cols[1].scale(s), m.cols[2].scale(s)] }
}

#[inline(always)]
fn scale_columns(m: Mat3, s: Vec3) -> Mat3 {
    Mat3 { cols: [m.cols[0] * s.x, m.cols[1] * s.y, m.cols[2] * s.z] }
}
