//! The coefficients of the exponential on SO(3) and SE(3), as functions of `t = θ²`.
//!
//! With `b(t) = (1 − cos θ)/θ²` and `c(t) = (θ − sin θ)/θ³` every map that the rod needs is a polynomial in `û`, `v̂`:
//! `exp û = 1 + (1 − t c) û + b û²`, the tangent `1 − b û + c û²`, and the coupling of turn and shift enters through `b'`
//! and `c'` alone (the minimal polynomial of `ad` on se(3) is `z (z² + θ²)²`; Selig 2005, ch. 4; Sonneville et al. 2014).
//! Up to one radian an element they are sums of eight terms, exact to round-off and the same on every target; beyond, they
//! come from sine and cosine.

use super::Real;

/// Up to this `θ²` five terms of `b` and `c` are exact to round-off (`2⁻³⁰/12! < 2⁻⁵⁸`), and four of their derivatives to 1e-11: those come
/// times `θ²` and more.
const SHORT_SERIES_LIMIT: f64 = 1.0 / 64.0;
/// Up to this `θ²` eight terms are (`1/18! < 2⁻⁵²`).
const SERIES_LIMIT: f64 = 1.0;

/// `b`, `c` and their derivatives by `t = θ²`.
#[derive(Clone, Copy, Debug)]
pub struct ExpCoefficients<R = f64> {
    /// `(1 − cos θ)/θ²`.
    pub b: R,
    /// `(θ − sin θ)/θ³`.
    pub c: R,
    /// `db/dt`.
    pub db: R,
    /// `dc/dt`.
    pub dc: R,
}

/// `Σ (−1)^k falling(k, derivative) t^(k − derivative) / (2k + first)!`, as its eight coefficients.
const fn coefficients(first: u32, derivative: u32) -> [f64; 8] {
    let mut out = [0.0; 8];
    let mut i = 0;
    while i < 8 {
        let k = i as u32 + derivative;
        let mut factorial = 1.0;
        let mut j = 2;
        while j <= 2 * k + first {
            factorial *= j as f64;
            j += 1;
        }
        let mut numerator = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut d = 0;
        while d < derivative {
            numerator *= (k - d) as f64;
            d += 1;
        }
        out[i] = numerator / factorial;
        i += 1;
    }
    out
}

const B: [f64; 8] = coefficients(2, 0);
const C: [f64; 8] = coefficients(3, 0);
const DB: [f64; 8] = coefficients(2, 1);
const DC: [f64; 8] = coefficients(3, 1);
const DDB: [f64; 8] = coefficients(2, 2);
const DDC: [f64; 8] = coefficients(3, 2);

/// Not a closure: those are not always put in line.
#[inline(always)]
fn two_terms<R: Real>(a: &[f64; 8], i: usize, t: R) -> R {
    R::splat(a[i]) + R::splat(a[i + 1]) * t
}

/// The first four terms, in an order that shortens the chain of operations (Estrin).
#[inline(always)]
fn short_polynomial<R: Real>(a: &[f64; 8], t: R, t2: R) -> R {
    two_terms(a, 0, t) + two_terms(a, 2, t) * t2
}

/// All eight.
#[inline(always)]
fn polynomial<R: Real>(a: &[f64; 8], t: R, t2: R, t4: R) -> R {
    (two_terms(a, 0, t) + two_terms(a, 2, t) * t2) + (two_terms(a, 4, t) + two_terms(a, 6, t) * t2) * t4
}

/// The coefficients at `t = θ²`. Each lane takes the series that its own `t` asks for, so that it gets the same bits alone.
#[inline(always)]
pub fn exp_coefficients<R: Real>(t: R) -> ExpCoefficients<R> {
    let tiny = t.at_most(SHORT_SERIES_LIMIT);
    let t2 = t * t;
    let short = ExpCoefficients {
        b: short_polynomial(&B, t, t2) + R::splat(B[4]) * (t2 * t2),
        c: short_polynomial(&C, t, t2) + R::splat(C[4]) * (t2 * t2),
        db: short_polynomial(&DB, t, t2),
        dc: short_polynomial(&DC, t, t2),
    };
    if R::all(tiny) { short } else { with_larger_angles(t, tiny, short) }
}

/// The second derivatives of `b` and `c` by `t`, at `t = θ²`.
#[inline(always)]
pub fn exp_coefficients_second<R: Real>(t: R) -> (R, R) {
    let small = t.at_most(SERIES_LIMIT);
    let (t2, t4) = (t * t, (t * t) * (t * t));
    let series = (polynomial(&DDB, t, t2, t4), polynomial(&DDC, t, t2, t4));
    if R::all(small) {
        return series;
    }
    second_with_larger_angles(t, small, series)
}

#[inline(never)]
fn second_with_larger_angles<R: Real>(t: R, small: R::Mask, series: (R, R)) -> (R, R) {
    (
        R::select(small, series.0, t.map(|t| (exact(t).ddb, f64::NAN))),
        R::select(small, series.1, t.map(|t| (exact(t).ddc, f64::NAN))),
    )
}

#[inline(never)]
fn with_larger_angles<R: Real>(t: R, tiny: R::Mask, short: ExpCoefficients<R>) -> ExpCoefficients<R> {
    let small = t.at_most(SERIES_LIMIT);
    let t2 = t * t;
    let t4 = t2 * t2;
    let long = |a: &[f64; 8]| polynomial(a, t, t2, t4);
    let mut out = ExpCoefficients { b: long(&B), c: long(&C), db: long(&DB), dc: long(&DC) };
    if !R::all(small) {
        let exactly = |pick: fn(Exact) -> (f64, f64)| t.map(move |t| pick(exact(t)));
        out = ExpCoefficients {
            b: R::select(small, out.b, exactly(|e| (e.b, e.db))),
            c: R::select(small, out.c, exactly(|e| (e.c, e.dc))),
            db: R::select(small, out.db, exactly(|e| (e.db, e.ddb))),
            dc: R::select(small, out.dc, exactly(|e| (e.dc, e.ddc))),
        };
    }
    ExpCoefficients {
        b: R::select(tiny, short.b, out.b),
        c: R::select(tiny, short.c, out.c),
        db: R::select(tiny, short.db, out.db),
        dc: R::select(tiny, short.dc, out.dc),
    }
}

/// `arcsin(x)/x` of `x²`, exact to round-off up to 1/16. Six terms are so up to 1/1024.
#[inline(always)]
pub(super) fn arcsine_series<R: Real>(square: R) -> R {
    /// `(2k)!/(4^k k!² (2k + 1))`.
    const TERMS: [f64; 14] = {
        let mut terms = [1.0; 14];
        let (mut k, mut binomial) = (1, 1.0);
        while k < 14 {
            binomial *= (2 * k - 1) as f64 / (2 * k) as f64;
            terms[k] = binomial / (2 * k + 1) as f64;
            k += 1;
        }
        terms
    };
    by_size(first::<6>(&TERMS), &TERMS, square, square.at_most(1.0 / 1024.0))
}

/// `|B₂ₖ|/(2k)!`, the Bernoulli series of `(1 − (θ/2) cot(θ/2))/θ²` by `θ²`.
pub(super) const BERNOULLI: [f64; 11] = [
    1.0 / 12.0,
    1.0 / 720.0,
    1.0 / 30240.0,
    1.0 / 1_209_600.0,
    1.0 / 47_900_160.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 74_724_249_600.0,
    3617.0 / 10_670_622_842_880_000.0,
    43867.0 / 5_109_094_217_170_944_000.0,
    174_611.0 / 330.0 / 2_432_902_008_176_640_000.0,
    854_513.0 / 138.0 / 1_124_000_727_777_607_680_000.0,
];

/// `(1 − (θ/2) cot(θ/2))/θ²` of `t = θ²`, up to one. Five terms are exact to round-off up to 1/64.
#[inline(always)]
pub(super) fn bernoulli_series<R: Real>(t: R) -> R {
    by_size(first::<5>(&BERNOULLI), &BERNOULLI, t, t.at_most(SHORT_SERIES_LIMIT))
}

const fn first<const N: usize>(terms: &[f64]) -> &[f64; N] {
    match terms.first_chunk() {
        Some(first) => first,
        None => panic!("so many terms there are"),
    }
}

/// A polynomial of which the first terms are enough where `t` is small.
#[inline(always)]
fn by_size<R: Real, const FEW: usize, const ALL: usize>(
    few: &[f64; FEW],
    all: &[f64; ALL],
    t: R,
    small: R::Mask,
) -> R {
    let short = sum(few, t);
    if R::all(small) { short } else { R::select(small, short, sum(all, t)) }
}

/// A polynomial, its even and odd terms apart, which halves the chain of operations.
#[inline(always)]
fn sum<R: Real, const N: usize>(terms: &[f64; N], t: R) -> R {
    let square = t * t;
    let (mut even, mut odd) = (R::zero(), R::zero());
    for k in (0..N).rev() {
        if k % 2 == 0 {
            even = even * square + R::splat(terms[k]);
        } else {
            odd = odd * square + R::splat(terms[k]);
        }
    }
    even + odd * t
}

struct Exact {
    b: f64,
    c: f64,
    db: f64,
    dc: f64,
    ddb: f64,
    ddc: f64,
}

/// From sine and cosine; accurate for `t` of order one and more, where nothing cancels.
fn exact(t: f64) -> Exact {
    let t = t.abs();
    let theta = t.sqrt();
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let (sinc, b) = (sin / theta, (1.0 - cos) / t);
    let c = (1.0 - sinc) / t;
    // d(sinc)/dt and d(cos)/dt follow from dθ/dt = 1/(2θ).
    let dsinc = (cos - sinc) / (2.0 * t);
    let db = (0.5 * sinc - b) / t;
    let dc = (-dsinc - c) / t;
    let ddsinc = (-0.5 * sinc - dsinc) / (2.0 * t) - dsinc / t;
    let ddb = (0.5 * dsinc - 2.0 * db) / t;
    let ddc = (-ddsinc - 2.0 * dc) / t;
    Exact { b, c, db, dc, ddb, ddc }
}
