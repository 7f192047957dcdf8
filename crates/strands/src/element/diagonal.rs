//! The hot path: elements of a diagonal law, for one rod or several side by side.
//!
//! Everything is written for the exponent of an element, `x = h ε`, and for the mean `σ̄` of the wrench that it carries, which is the
//! unknown: `σ̄ = T(x)ᵀ w` with `x = h ε̂ + h S σ̄`. A strain that is not free has no compliance and needs no code of its own.
//!
//! A [`LocalSolver`] is stepped along the rod from its end. Most elements take one evaluation of this equation: `σ̄ − w` changes slowly
//! along the rod, and extrapolates to within a small step of the solution; one quasi-Newton step does the rest.

use super::{Carried, GAUSS_OFFSET, MAX_LOCAL_ITERATIONS, exponent, gauss_stresses};
use crate::math::{
    ExpCoefficients, Mat3, Mat6, Pose, Real, Vec3, Vec6, Vector, Wrench, exp_coefficients,
    exp_coefficients_second,
};
use crate::rod::{Kinematics, Law, Order, Point};

/// How far, in rad or as a part, the exponent of an element may be from the solution of its local equation.
const LOCAL_TOLERANCE: f64 = 1e-14;
/// A last step larger than this would spoil the first-order update of the coefficients.
const LARGEST_LAST_STEP: f64 = 1e-8;
/// Steps by the truncated series before the matrix is inverted.
const SERIES_STEPS: usize = 4;

/// One point of an element with a diagonal law, over the element's length. A strain that is not free has no compliance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DiagonalPoint {
    /// `h S`.
    pub compliance: Vec6,
    /// `h ε̂`.
    pub rest: Vec6,
}

impl DiagonalPoint {
    /// From a point of an element of length `h`; `None` where its law is not diagonal.
    pub fn new(kinematics: Kinematics, h: f64, point: &Point) -> Option<Self> {
        let Law::Diagonal(stiffness) = &point.law else {
            return None;
        };
        let c = stiffness.to_diagonal();
        let over = |v: Vec3| Vec3::new(h / v.x, h / v.y, h / v.z);
        let linear = match kinematics {
            Kinematics::Cosserat => over(c.linear),
            Kinematics::Kirchhoff => Vec3::ZERO,
        };
        Some(Self { compliance: Vec6::new(over(c.angular), linear), rest: point.rest * h })
    }

    #[inline(always)]
    fn exponent<V: Vector>(&self, stress: Wrench<V>) -> Vec6<V> {
        self.rest.splat::<V>() + self.compliance.splat::<V>().scale(stress)
    }
}

/// An element, solved.
pub(crate) struct Solved<V: Vector> {
    /// Its length times the strain at its points; where there is but one point, twice the same.
    pub points: [Vec6<V>; 2],
    /// Its exponent.
    pub exponent: Vec6<V>,
    /// `θ²` of the exponent.
    pub t: V::Number,
    /// The coefficients of the exponential there.
    pub coefficients: ExpCoefficients<V::Number>,
    /// The mean of the wrench that it carries.
    pub mean: Wrench<V>,
}

impl<V: Vector> Solved<V> {
    #[inline(always)]
    fn at(points: [Vec6<V>; 2], exponent: Vec6<V>, wrench: &Wrench<V>) -> Self {
        let carried = Carried::new(&exponent, wrench);
        Self { points, exponent, t: carried.t, coefficients: carried.coefficients, mean: carried.mean }
    }

    /// The wrench through the near node, in its frame. Along the element `dw/ds = −ad*(ε) w`, so over it `w_a − w_b = ad*(x) σ̄`.
    #[inline(always)]
    pub fn carry(&self, wrench: &Wrench<V>) -> Wrench<V> {
        *wrench + self.exponent.coadjoint(self.mean)
    }

    #[inline(always)]
    fn not_converged() -> Self {
        let (nan, t) = (Vec6::from([f64::NAN; 6]).splat(), V::Number::splat(f64::NAN));
        let coefficients = ExpCoefficients { b: t, c: t, db: t, dc: t };
        Self { points: [nan; 2], exponent: nan, t, coefficients, mean: nan }
    }
}

/// Finds the elements' strains one after the other, from the rod's end to its start.
pub(crate) trait LocalSolver<V: Vector> {
    /// How many points an element has.
    const POINTS: usize;
    /// At the rod's end.
    fn new() -> Self;
    /// The next element, from its points, its length, and the wrench through its far node. Where it does not converge all is NaN.
    fn next(&mut self, points: &[DiagonalPoint], h: f64, wrench: &Wrench<V>) -> Solved<V>;
}

/// Order 1: `ε = ε̂ + S w`.
pub(crate) struct First;

impl<V: Vector> LocalSolver<V> for First {
    const POINTS: usize = 1;
    #[inline(always)]
    fn new() -> Self {
        Self
    }
    #[inline(always)]
    fn next(&mut self, points: &[DiagonalPoint], _: f64, wrench: &Wrench<V>) -> Solved<V> {
        let x = points[0].exponent(*wrench);
        Solved::at([x; 2], x, wrench)
    }
}

/// How many past elements the extrapolation looks at: with more, the round-off in them, which it makes larger by `2^PAST`, would count.
const PAST: usize = 10;
/// Room for them: a power of two.
const ROOM: usize = 16;
/// The value that a polynomial through `n` past ones takes next, newest first: `(−1)^i n!/((i + 1)! (n − 1 − i)!)`, for each `n`.
const EXTRAPOLATION: [[f64; PAST]; PAST + 1] = extrapolation();

const fn extrapolation() -> [[f64; PAST]; PAST + 1] {
    let mut weights = [[0.0; PAST]; PAST + 1];
    let mut n = 1;
    while n <= PAST {
        let (mut weight, mut i) = (-1.0, 0);
        while i < n {
            weight *= -((n - i) as f64) / (i + 1) as f64;
            weights[n][i] = weight;
            i += 1;
        }
        n += 1;
    }
    weights
}

/// What changed slowly over the last elements.
struct History<V> {
    /// A ring, written twice over, so that the past lies in one piece wherever it begins.
    ring: [Vec6<V>; 2 * ROOM],
    known: usize,
}

impl<V: Vector> History<V> {
    #[inline(always)]
    fn new() -> Self {
        Self { ring: [Vec6::zero(); 2 * ROOM], known: 0 }
    }

    /// The next one, extrapolated from as many as there are.
    #[inline(always)]
    fn next(&self) -> Vec6<V> {
        // The newest of the past lies last.
        let past = &self.ring[self.known % ROOM + ROOM - PAST..][..PAST];
        let k = V::Number::splat;
        if self.known < PAST {
            let mut sum = Vec6::zero();
            for i in 0..self.known {
                sum += past[PAST - 1 - i] * k(EXTRAPOLATION[self.known][i]);
            }
            return sum;
        }
        // The weights read the same from both sides, but for the oldest; the newest one comes last, as it is known last.
        let w = &EXTRAPOLATION[PAST];
        let (far, near) = ((past[3] + past[7]) * k(w[2]), (past[4] + past[6]) * k(w[3]));
        let older = (past[5] * k(w[4]) + near) + (far - past[0]);
        (older + (past[2] + past[8]) * k(w[1])) + (past[1] + past[9]) * k(w[0])
    }

    #[inline(always)]
    fn push(&mut self, new: Vec6<V>) {
        let at = self.known % ROOM;
        self.ring[at] = new;
        self.ring[at + ROOM] = new;
        self.known += 1;
    }
}

/// Order 2.
pub(crate) struct Second<V> {
    /// `σ̄ − w`.
    history: History<V>,
}

impl<V: Vector> LocalSolver<V> for Second<V> {
    const POINTS: usize = 1;

    #[inline(always)]
    fn new() -> Self {
        Self { history: History::new() }
    }

    #[inline(always)]
    fn next(&mut self, points: &[DiagonalPoint], h: f64, wrench: &Wrench<V>) -> Solved<V> {
        let point = &points[0];
        let compliance = point.compliance.splat::<V>();
        let mut mean = *wrench + self.history.next();
        let mut x = point.exponent(mean);
        for iteration in 0..MAX_LOCAL_ITERATIONS {
            let carried = Carried::new(&x, wrench);
            let residual = carried.mean - mean;
            let turn = compliance.scale(residual);
            let gap = Gap::new(&turn, carried.t, h, &compliance, wrench);
            let near = V::Number::all(gap.closed_by_first_order());
            let step = if near {
                residual + turn.coadjoint(*wrench) * V::Number::splat(0.5)
            } else if iteration < SERIES_STEPS {
                Response::new(&x, wrench, carried.bent).series_step(&compliance, residual, turn)
            } else {
                let response = Response::new(&x, wrench, carried.bent);
                let turn = LocalNewton::new(&compliance, &response).step(turn);
                residual + response.to(turn)
            };
            mean += step;
            x = point.exponent(mean);
            if near || V::Number::all(gap.closed_by_second_order()) {
                self.history.push(mean - *wrench);
                let (k, t) = (carried.coefficients, x.angular.dot(x.angular));
                // The last step moved t by so little that the coefficients follow to first order.
                let change = t - carried.t;
                let coefficients =
                    ExpCoefficients { b: k.b + k.db * change, c: k.c + k.dc * change, db: k.db, dc: k.dc };
                return Solved { points: [x; 2], exponent: x, t, coefficients, mean };
            }
        }
        Solved::not_converged()
    }
}

/// How `T(x)ᵀ w` answers to the exponent: its derivative up to second order in `x`.
struct Response<V: Vector> {
    x: Vec6<V>,
    wrench: Wrench<V>,
    /// `m/2 + (u×m + v×n)/6`.
    turn: V,
    /// `(u·m + v·n)/6`.
    trace: V::Number,
}

impl<V: Vector> Response<V> {
    #[inline(always)]
    fn new(x: &Vec6<V>, wrench: &Wrench<V>, bent: V) -> Self {
        let (half, sixth) = (V::Number::splat(0.5), V::Number::splat(1.0 / 6.0));
        Self {
            x: *x,
            wrench: *wrench,
            turn: wrench.angular * half + bent * sixth,
            trace: x.dot(*wrench) * sixth,
        }
    }

    /// To a change `d` of the exponent:
    /// `∂m̄ ≈ d_u × (m/2 + (u×m + v×n)/6) + ((u·m + v·n) d_u − m (u·d_u) − n (v·d_u))/6 + d_v × n/2`, `∂n̄ ≈ d_u × n/2`.
    #[inline(always)]
    fn to(&self, d: Vec6<V>) -> Wrench<V> {
        let (half, sixth) = (V::Number::splat(0.5), V::Number::splat(1.0 / 6.0));
        let (m, n) = (self.wrench.angular, self.wrench.linear);
        let along = m * (self.x.angular.dot(d.angular) * sixth) + n * (self.x.linear.dot(d.angular) * sixth);
        Wrench::new(
            d.angular.cross(self.turn) + (d.angular * self.trace - along) + d.linear.cross(n) * half,
            d.angular.cross(n) * half,
        )
    }

    /// The step of the mean wrench that closes a residual, which turns the element by `turn`: `r + K (1 + S K) S r` in place of
    /// `r + K (1 − S K)⁻¹ S r`, with the last factor to first order in the exponent.
    #[inline(always)]
    fn series_step(&self, compliance: &Vec6<V>, residual: Wrench<V>, turn: Vec6<V>) -> Wrench<V> {
        let once = self.to(turn);
        let twice = compliance.scale(once).coadjoint(self.wrench) * V::Number::splat(0.5);
        residual + once + twice
    }
}

/// How far a residual turns and shifts the element, and what the two kinds of step would leave of it: with `q = h² n/EI`, about
/// `(θ² + q)/2` of it, and `θ (θ² + q)/4`.
struct Gap<R> {
    size: R,
    rate: R,
    t: R,
}

impl<R: Real> Gap<R> {
    #[inline(always)]
    fn new<V: Vector<Number = R>>(
        turn: &Vec6<V>,
        t: R,
        h: f64,
        compliance: &Vec6<V>,
        wrench: &Wrench<V>,
    ) -> Self {
        Self { size: turned(h, turn), rate: t + force_stiffening(h, compliance, wrench), t }
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

/// How large a change of the exponent is, in rad and as a part of the length.
#[inline(always)]
fn turned<V: Vector>(h: f64, change: &Vec6<V>) -> V::Number {
    change.angular.size() + change.linear.size() * V::Number::splat(1.0 / h)
}

/// `q = h² n/EI`: how much of a turn the force across the turned element adds to it.
#[inline(always)]
fn force_stiffening<V: Vector>(h: f64, compliance: &Vec6<V>, wrench: &Wrench<V>) -> V::Number {
    let [bend1, bend2, _] = compliance.angular.parts();
    (bend1 + bend2) * (wrench.linear.size() * V::Number::splat(h))
}

/// Order 4.
pub(crate) struct Fourth<V> {
    /// What each point's strain, times the length, has beyond `ε̂ + S w`.
    history: [History<V>; 2],
}

impl<V: Vector> LocalSolver<V> for Fourth<V> {
    const POINTS: usize = 2;

    #[inline(always)]
    fn new() -> Self {
        Self { history: [History::new(), History::new()] }
    }

    #[inline(always)]
    fn next(&mut self, points: &[DiagonalPoint], h: f64, wrench: &Wrench<V>) -> Solved<V> {
        let compliance = [points[0].compliance.splat::<V>(), points[1].compliance.splat::<V>()];
        let explicit = [points[0].exponent(*wrench), points[1].exponent(*wrench)];
        let half = V::Number::splat(0.5);
        // Written out: closures over arrays are not always put in line, and must be for their vector instructions.
        let mut x = [explicit[0] + self.history[0].next(), explicit[1] + self.history[1].next()];
        let middle = (x[0] + x[1]) * half;
        let response = Response::new(&middle, wrench, middle.coadjoint(*wrench).angular);
        let compliance_between = (compliance[0] + compliance[1]) * half;
        let newton = LocalNewton::new(&compliance_between, &response);
        // A step leaves about this part of itself.
        let turns = x[0].angular.dot(x[0].angular) + x[1].angular.dot(x[1].angular);
        let rate = turns + force_stiffening(h, &compliance_between, wrench);
        for _ in 0..MAX_LOCAL_ITERATIONS {
            // Over the element's length all is dimensionless: an element of length one with the strains `x`.
            let mean = Carried::new(&exponent(Order::Fourth, 1.0, &x), wrench).mean;
            let stress = gauss_stresses(1.0, &x, mean);
            let residual = [
                explicit[0] + compliance[0].scale(stress[0] - *wrench) - x[0],
                explicit[1] + compliance[1].scale(stress[1] - *wrench) - x[1],
            ];
            let common_residual = (residual[0] + residual[1]) * half;
            let common = newton.step(common_residual);
            // The difference of the two strains follows from the mean one.
            let follow = common.coadjoint(mean) * V::Number::splat(GAUSS_OFFSET);
            let step = [
                residual[0] - common_residual + common + compliance[0].scale(follow),
                residual[1] - common_residual + common - compliance[1].scale(follow),
            ];
            x[0] += step[0];
            x[1] += step[1];
            let size = turned(h, &step[0]) + turned(h, &step[1]);
            let left = (size * rate).at_most(LOCAL_TOLERANCE);
            if V::Number::all(V::Number::and(size.at_most(LARGEST_LAST_STEP), left)) {
                self.history[0].push(x[0] - explicit[0]);
                self.history[1].push(x[1] - explicit[1]);
                return Solved::at(x, exponent(Order::Fourth, 1.0, &x), wrench);
            }
        }
        Solved::not_converged()
    }
}

/// The multistep variant: the strains of the two neighbours, extrapolated, in place of the unknown one.
pub(crate) struct Multistep<V> {
    /// Elastic strains of the last two elements, times their lengths.
    elastic: [Vec6<V>; 2],
    lengths: [f64; 2],
    known: usize,
}

/// The weights of the elastic strains of the last two elements in that of the next one, linear in `s` from middle to middle. The lengths are
/// theirs, the last one's first; only one may be known.
#[inline(always)]
pub(crate) fn multistep_weights(known: usize, h: f64, lengths: [f64; 2]) -> [f64; 2] {
    if known == 1 {
        return [1.0, 0.0];
    }
    let ahead = (h + lengths[0]) / (lengths[0] + lengths[1]);
    [1.0 + ahead, -ahead]
}

impl<V: Vector> LocalSolver<V> for Multistep<V> {
    const POINTS: usize = 1;

    #[inline(always)]
    fn new() -> Self {
        Self { elastic: [Vec6::zero(); 2], lengths: [1.0; 2], known: 0 }
    }

    #[inline(always)]
    fn next(&mut self, points: &[DiagonalPoint], h: f64, wrench: &Wrench<V>) -> Solved<V> {
        let (compliance, rest) = (points[0].compliance.splat::<V>(), points[0].rest.splat::<V>());
        let elastic = if self.known == 0 {
            compliance.scale(*wrench)
        } else {
            let [near, far] = multistep_weights(self.known, h, self.lengths);
            let over = |i: usize, weight: f64| V::Number::splat(weight * h / self.lengths[i]);
            self.elastic[0] * over(0, near) + self.elastic[1] * over(1, far)
        };
        let mean = Carried::new(&(rest + elastic), wrench).mean;
        self.elastic = [compliance.scale(mean), self.elastic[0]];
        self.lengths = [h, self.lengths[0]];
        self.known += 1;
        let x = rest + self.elastic[0];
        Solved::at([x; 2], x, wrench)
    }
}

/// The Newton matrix of the local equation, `1 − S K` with `K` the [`Response`], inverted: for elements of large turn, and for order 4.
struct LocalNewton<V: Vector> {
    compliance: Vec6<V>,
    half_force: V,
    inverse: Mat3<V>,
}

impl<V: Vector> LocalNewton<V> {
    #[inline(always)]
    fn new(compliance: &Vec6<V>, response: &Response<V>) -> Self {
        let sixth = V::Number::splat(1.0 / 6.0);
        let (u, v, turn) = (vec3(response.x.angular), vec3(response.x.linear), vec3(response.turn));
        let (m6, n6) = (vec3(response.wrench.angular * sixth), vec3(response.wrench.linear * sixth));
        let s = vec3(compliance.angular);
        let one = Vec3::new(V::Number::one(), V::Number::one(), V::Number::one());
        // 1 − S ∂m̄/∂u with ∂m̄/∂u ≈ −turn^ − (m uᵀ + n vᵀ)/6 + trace, transposed.
        let by_turn = outer(u, m6) + outer_plus_hat(v, n6, -response.trace, -turn);
        let transposed = Mat3::diagonal(one) + scale_columns(by_turn, s);
        let inverse = transposed.inverse().transpose();
        Self {
            compliance: *compliance,
            half_force: response.wrench.linear * V::Number::splat(0.5),
            inverse: Mat3::from_cols(
                vector(inverse.cols[0]),
                vector(inverse.cols[1]),
                vector(inverse.cols[2]),
            ),
        }
    }

    #[inline(always)]
    fn step(&self, residual: Vec6<V>) -> Vec6<V> {
        let bent = self.compliance.angular.scale(residual.linear.cross(self.half_force));
        let angular = self.inverse * (residual.angular + bent);
        let sheared = self.compliance.linear.scale(angular.cross(self.half_force));
        Vec6::new(angular, residual.linear + sheared)
    }
}

/// The flexibility of an element of order 2 with a diagonal law, or of several side by side, in factors: `T · inner · Tᵀ`, with `T` made of
/// `turn` on its diagonal and `shift` below it. `inner` takes a moment and a force `(m, n)` to a bend `a m + b n` and a stretch
/// `stretch ∘ n + c bend`.
pub(crate) struct DiagonalFlexibility<R = f64> {
    turn: Mat3<Vec3<R>>,
    shift: Mat3<Vec3<R>>,
    a: Mat3<Vec3<R>>,
    b: Mat3<Vec3<R>>,
    c: Mat3<Vec3<R>>,
    stretch: Vec3<R>,
}

impl DiagonalFlexibility {
    /// As one matrix.
    pub(crate) fn to_matrix(&self) -> Mat6 {
        Mat6 { blocks: self.blocks() }
    }
}

impl<R: Real> DiagonalFlexibility<R> {
    /// The same element, its flexibility seen from a frame in which its far node has the given pose.
    #[inline(always)]
    pub(crate) fn seen_from(mut self, far: &Pose<Vec3<R>>) -> Self {
        self.turn = far.rotation * self.turn;
        let [a, b, c] = self.turn.cols;
        let p = far.position;
        self.shift = far.rotation * self.shift + Mat3::from_cols(p.cross(a), p.cross(b), p.cross(c));
        self
    }

    /// `T · inner · Tᵀ`, block by block.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> [[Mat3<Vec3<R>>; 2]; 2] {
        let (turn, shift) = (self.turn, self.shift);
        let (turn_t, shift_t) = (turn.transpose(), shift.transpose());
        // inner Tᵀ, with inner = [[a, b], [c a, stretch + c b]].
        let bend = [self.a * turn_t, self.a * shift_t + self.b * turn_t];
        let stretch = [self.c * bend[0], self.c * bend[1] + scale_rows(self.stretch, turn_t)];
        [
            [turn * bend[0], turn * bend[1]],
            [shift * bend[0] + turn * stretch[0], shift * bend[1] + turn * stretch[1]],
        ]
    }
}

/// How an element of order 2, or several side by side, answers to its exponent `x` and to the wrench `w` through its far node.
struct Turned<R> {
    /// The tangent of the exponential: `turn` on its diagonal, `shift` below it.
    turn: Mat3<Vec3<R>>,
    shift: Mat3<Vec3<R>>,
    /// `∂m̄/∂u`.
    moment_by_turn: Mat3<Vec3<R>>,
    /// `∂m̄/∂v` and `∂n̄/∂u`, which are the same; `∂n̄/∂v` is zero.
    common: Mat3<Vec3<R>>,
    /// `T(x)ᵀ w`.
    mean: Wrench<Vec3<R>>,
}

impl<R: Real> Turned<R> {
    #[inline(always)]
    fn new(x: Vec6<Vec3<R>>, w: Wrench<Vec3<R>>) -> Self {
        let (u, v, m, n) = (x.angular, x.linear, w.angular, w.linear);
        let t = u.dot(u);
        let k = exp_coefficients(t);
        let (ddb, ddc) = exp_coefficients_second(t);
        let two = R::splat(2.0);
        let twice = u.dot(v) * two;
        // The tangent, by the identities û² = u uᵀ − t and û v̂ + v̂ û = v uᵀ + u vᵀ − 2 u·v.
        let turn = outer_plus_hat(u * k.c, u, R::one() - t * k.c, -(u * k.b));
        let shift = outer(v * k.c, u)
            + outer_plus_hat(
                u * (twice * k.dc),
                u,
                -(twice * (k.c + t * k.dc)),
                -(v * k.b + u * (twice * k.db)),
            )
            + outer(u * k.c, v);
        let un = u.cross(n);
        let uun = u.cross(un);
        let first = u.cross(m) + v.cross(n);
        let second = u.cross(first) + v.cross(un);
        // ∂m̄/∂u, with û m̂ = m uᵀ − u·m and the like.
        let coupling = (un * k.db + uun * k.dc) * two;
        let along_u = (first * k.db + second * k.dc + (un * ddb + uun * ddc) * twice) * two
            - (m * k.c + n * (twice * k.dc));
        let along_v = coupling - n * k.c;
        let trace = k.c * (u.dot(m) + v.dot(n)) + twice * k.dc * u.dot(n);
        let hat = m * k.b + first * k.c + n * (twice * k.db) + un * (twice * k.dc);
        Self {
            turn,
            shift,
            moment_by_turn: outer(along_u, u) + outer_plus_hat(along_v, v, trace, -hat),
            common: outer_plus_hat(along_v, u, k.c * u.dot(n), -(n * k.b + un * k.c)),
            mean: Wrench::new(
                m + first * k.b + second * k.c + un * (twice * k.db) + uun * (twice * k.dc),
                n + un * k.b + uun * k.c,
            ),
        }
    }
}

/// [`flexibility`](super::flexibility) for order 2 and a diagonal law: from `h S`, the exponent, and the wrench through the far node.
#[inline(always)]
pub(crate) fn diagonal_flexibility<R: Real>(
    compliance: Vec6<Vec3<R>>,
    x: Vec6<Vec3<R>>,
    w: Wrench<Vec3<R>>,
) -> DiagonalFlexibility<R> {
    let Turned { turn, shift, moment_by_turn, common, .. } = Turned::new(x, w);
    // (1 − S K) δx = S Tᵀ δw; ∂n̄/∂v = 0 and ∂n̄/∂u = ∂m̄/∂v, so the shifts are eliminated by hand.
    let (bend, stretch) = (compliance.angular, compliance.linear);
    let (by_shift, c) = (scale_rows(bend, common), scale_rows(stretch, common));
    let one = Mat3::diagonal(Vec3::new(R::one(), R::one(), R::one()));
    let schur = (one - scale_rows(bend, moment_by_turn) - by_shift * c).inverse();
    DiagonalFlexibility {
        turn,
        shift,
        a: scale_columns(schur, bend),
        b: scale_columns(schur * by_shift, stretch),
        c,
        stretch,
    }
}

/// How an element, or several side by side, resists: seen from fixed axes where its far node is.
pub(crate) struct Resistance<R = f64> {
    /// `F`: a change of its far frame against its near one, by `ξ`, changes the wrench that it carries by `F ξ`.
    pub stiffness: [[Mat3<Vec3<R>>; 2]; 2],
    /// How the wrench that it carries has to change for its law to hold at the frames as they are.
    pub pull: Wrench<Vec3<R>>,
    /// What its exponent is off by for the law to hold, in its own axes.
    pub slack: Vec6<Vec3<R>>,
}

/// The resistance of an element of order 2 with a diagonal law, from `h S`, `h ε̂`, the exponent between its frames, the wrench through
/// its far node, and how that node is turned in the axes, which are where it is. `lent` is added to the compliance of its shifts, on the way to the
/// solution and not in what must hold there.
///
/// With `x = h ε̂ + h S σ̄`, `σ̄ = T(x)ᵀ w`, the change of the wrench follows from that of the exponent, `T δx = ξ`:
/// `Tᵀ δw = ((h S)⁻¹ − K) δx − (h S)⁻¹ (h ε̂ + h S σ̄ − x)`, with `K = ∂σ̄/∂x`.
#[inline(always)]
pub(crate) fn diagonal_resistance<R: Real>(
    compliance: Vec6<Vec3<R>>,
    rest: Vec6<Vec3<R>>,
    lent: R,
    x: Vec6<Vec3<R>>,
    w: Wrench<Vec3<R>>,
    turned: &Mat3<Vec3<R>>,
) -> Resistance<R> {
    let element = Turned::new(x, w);
    // T⁻¹ seen from the axes. With T's blocks `D` on its diagonal and `S` below, and `R` the far node's, those are `D⁻¹ Rᵀ` on the diagonal and
    // `−D⁻¹ S D⁻¹ Rᵀ` below.
    let tangent = element.turn.inverse();
    let inverse = tangent * turned.transpose();
    let below = (tangent * element.shift * inverse).scaled(-R::one());
    let slack = rest + compliance.scale(element.mean) - x;
    let reciprocal = |v: Vec3<R>| Vec3::new(R::one() / v.x, R::one() / v.y, R::one() / v.z);
    let (bend, stretch) =
        (reciprocal(compliance.angular), reciprocal(compliance.linear + Vec3::new(lent, lent, lent)));
    let bent = Mat3::diagonal(bend) - element.moment_by_turn;
    // ((h S)⁻¹ − K) T⁻¹, block by block.
    let top = [bent * inverse - element.common * below, (element.common * inverse).scaled(-R::one())];
    let bottom = [scale_rows(stretch, below) + top[1], scale_rows(stretch, inverse)];
    let (inverse_t, below_t) = (inverse.transpose(), below.transpose());
    let (moment, force) = (bend.scale(slack.angular), stretch.scale(slack.linear));
    Resistance {
        stiffness: [
            [inverse_t * top[0] + below_t * bottom[0], inverse_t * top[1] + below_t * bottom[1]],
            [inverse_t * bottom[0], inverse_t * bottom[1]],
        ],
        pull: Wrench::new(-(inverse_t * moment + below_t * force), -(inverse_t * force)),
        slack,
    }
}

#[inline(always)]
fn vec3<V: Vector>(v: V) -> Vec3<V::Number> {
    let [x, y, z] = v.parts();
    Vec3 { x, y, z }
}

#[inline(always)]
fn vector<V: Vector>(v: Vec3<V::Number>) -> V {
    V::new(v.x, v.y, v.z)
}

#[inline(always)]
fn outer<R: Real>(a: Vec3<R>, b: Vec3<R>) -> Mat3<Vec3<R>> {
    Mat3::outer(a, b)
}

/// `a bᵀ + diagonal + hat^`.
#[inline(always)]
fn outer_plus_hat<R: Real>(a: Vec3<R>, b: Vec3<R>, diagonal: R, hat: Vec3<R>) -> Mat3<Vec3<R>> {
    Mat3::from_cols(
        Vec3::new(a.x * b.x + diagonal, a.y * b.x + hat.z, a.z * b.x - hat.y),
        Vec3::new(a.x * b.y - hat.z, a.y * b.y + diagonal, a.z * b.y + hat.x),
        Vec3::new(a.x * b.z + hat.y, a.y * b.z - hat.x, a.z * b.z + diagonal),
    )
}

#[inline(always)]
fn scale_rows<R: Real>(s: Vec3<R>, m: Mat3<Vec3<R>>) -> Mat3<Vec3<R>> {
    Mat3 { cols: [m.cols[0].scale(s), m.cols[1].scale(s), m.cols[2].scale(s)] }
}

#[inline(always)]
fn scale_columns<R: Real>(m: Mat3<Vec3<R>>, s: Vec3<R>) -> Mat3<Vec3<R>> {
    Mat3 { cols: [m.cols[0] * s.x, m.cols[1] * s.y, m.cols[2] * s.z] }
}
