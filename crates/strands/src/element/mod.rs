//! One element of a rod: the one place where its mechanics is written.
//!
//! An element joins node `a` to node `b`. Its exponent `Ω` takes the frame of `a` to that of `b`, `H_b = H_a exp(Ω)`. Its
//! energy is the quadrature of the stored energy at its points, and making the sum of energies stationary gives, with `w` the
//! wrench that the rod carries through `b` and `T` the tangent of the exponential,
//!
//! | order | exponent | stress at the points |
//! | --- | --- | --- |
//! | 1 | `Ω = h ε` | `σ = w` |
//! | 2 | `Ω = h ε` | `σ = σ̄` |
//! | 4 | `Ω = h (ε₁ + ε₂)/2 + (√3/12) h² [ε₁, ε₂]` | `σ₁,₂ = σ̄ ± (√3/6) h ad*(ε₂,₁) σ̄` |
//!
//! where `σ̄ = T(Ω)ᵀ w` is the mean along the element of the wrench that it carries, in the local frame, and
//! `ad*(ε) σ = (u×m + v×n, u×n)`. The wrench carried through `a` is the same wrench, moved and turned: `Ad⁻ᵀ(exp Ω) w`. So
//! force and moment balance are exact at any number of elements, whatever the law. Order 2 is the element of Sonneville, Cardona &
//! Brüls (2014); order 4 is the two-point Gauss collocation of Magnus (Orekhov & Simaan 2020), with the stresses that follow from its
//! energy. The sign of the bracket is that of `H' = H ε^`.
//!
//! Given `w`, the strain solves a small local equation; the functions here solve it, and linearise the solution.

mod diagonal;

pub(crate) use diagonal::{
    DiagonalPoint, First, Fourth, LocalSolver, Multistep, Resistance, Second, Solved, diagonal_flexibility,
    diagonal_resistance, multistep_weights,
};

use crate::math::{
    ExpCoefficients, Lu, Mat3, Mat6, Pose, Real, Strain, Stress, Vec3, Vec6, Vector, Wrench,
    exp_coefficients, exp_coefficients_second, lu, tangent,
};
use crate::rod::{Kinematics, Order, Point, Rod};

/// `√3/6`, half the distance of the Gauss points over the element's length.
const GAUSS_OFFSET: f64 = 0.288_675_134_594_812_9;
/// A local iteration that takes longer than this is not going to end.
const MAX_LOCAL_ITERATIONS: usize = 60;
/// The strain at the points of an element, one or two of them.
pub(crate) type PointStrains<V = Vec3> = [Strain<V>; 2];

/// The wrench that an element of exponent `x` carries, `w` through its far node, seen along the element in the local frame.
pub(crate) struct Carried<V: Vector> {
    /// Its mean, `σ̄ = T(x)ᵀ w`.
    pub mean: Stress<V>,
    /// `θ² = u·u`.
    pub t: V::Number,
    /// The coefficients of the exponential there.
    pub coefficients: ExpCoefficients<V::Number>,
    /// `u×m + v×n`.
    bent: V,
}

impl<V: Vector> Carried<V> {
    #[inline(always)]
    pub fn new(x: &Vec6<V>, w: &Wrench<V>) -> Self {
        let u = x.angular;
        let t = u.dot(u);
        let k = exp_coefficients(t);
        let first = x.coadjoint(*w);
        let second = x.coadjoint(first);
        let twice = u.dot(x.linear) * V::Number::splat(2.0);
        let mean = Stress::new(
            w.angular
                + (first.angular * k.b
                    + second.angular * k.c
                    + first.linear * (twice * k.db)
                    + second.linear * (twice * k.dc)),
            w.linear + (first.linear * k.b + second.linear * k.c),
        );
        Self { mean, t, coefficients: k, bent: first.angular }
    }
}

/// `σ̄ = T(x)ᵀ w`: the mean along an element of the wrench that it carries.
#[inline(always)]
pub(crate) fn mean_wrench<V: Vector>(x: Vec6<V>, w: Wrench<V>) -> Stress<V> {
    Carried::new(&x, &w).mean
}

/// The derivative of [`mean_wrench`] by `x`: the blocks `∂m̄/∂u`, `∂m̄/∂v` and `∂n̄/∂u` (`∂n̄/∂v` is zero).
struct MeanWrenchDerivative {
    moment_by_turn: Mat3,
    moment_by_shift: Mat3,
    force_by_turn: Mat3,
}

fn mean_wrench_derivative(x: Vec6, w: Wrench) -> MeanWrenchDerivative {
    let (u, v, m, n) = (x.angular, x.linear, w.angular, w.linear);
    let t = u.dot(u);
    let k = exp_coefficients(t);
    let (ddb, ddc) = exp_coefficients_second(t);
    let un = u.cross(n);
    let uun = u.cross(un);
    let first = u.cross(m) + v.cross(n);
    let second = u.cross(first) + v.cross(un);
    let twice = 2.0 * u.dot(v);
    let (hat_u, hat_n) = (Mat3::hat(u), Mat3::hat(n));
    let d_un = hat_n.scaled(-1.0);
    let d_uun = (Mat3::hat(un) + hat_u * hat_n).scaled(-1.0);
    let d_first = Mat3::hat(m).scaled(-1.0);
    let d_second = (Mat3::hat(first) + hat_u * Mat3::hat(m) + Mat3::hat(v) * hat_n).scaled(-1.0);
    let coupling = (un * k.db + uun * k.dc) * 2.0;
    MeanWrenchDerivative {
        moment_by_turn: d_first.scaled(k.b)
            + d_second.scaled(k.c)
            + (d_un.scaled(k.db) + d_uun.scaled(k.dc)).scaled(twice)
            + Mat3::outer((first * k.db + second * k.dc + (un * ddb + uun * ddc) * twice) * 2.0, u)
            + Mat3::outer(coupling, v),
        moment_by_shift: d_un.scaled(k.b) + d_uun.scaled(k.c) + Mat3::outer(coupling, u),
        force_by_turn: d_un.scaled(k.b) + d_uun.scaled(k.c) + Mat3::outer((un * k.db + uun * k.dc) * 2.0, u),
    }
}

/// The exponent of an element from the strains at its points.
#[inline(always)]
pub(crate) fn exponent<V: Vector>(order: Order, h: f64, strain: &PointStrains<V>) -> Vec6<V> {
    match order {
        Order::First | Order::Second => strain[0] * V::Number::splat(h),
        Order::Fourth => {
            (strain[0] + strain[1]) * V::Number::splat(0.5 * h)
                + strain[0].bracket(strain[1]) * V::Number::splat(0.5 * GAUSS_OFFSET * h * h)
        }
    }
}

/// The stresses at the two points of an element of order 4.
#[inline(always)]
fn gauss_stresses<V: Vector>(h: f64, strain: &PointStrains<V>, mean: Stress<V>) -> [Stress<V>; 2] {
    let k = V::Number::splat(GAUSS_OFFSET * h);
    [mean + strain[1].coadjoint(mean) * k, mean - strain[0].coadjoint(mean) * k]
}

/// Solves the local equation of an element of any law, by Newton's method with the exact derivative.
/// `None` where it does not converge.
pub(crate) fn solve_general(
    order: Order,
    kinematics: Kinematics,
    h: f64,
    points: &[Point],
    w: Wrench,
    guess: PointStrains,
) -> Option<PointStrains> {
    let free = free_strains(kinematics);
    let mut strain = guess;
    for _ in 0..MAX_LOCAL_ITERATIONS {
        let system = LocalSystem::new(order, h, points, w, &strain);
        let step = system.factored(free)?.solve(&system.residual);
        let mut largest = 0.0_f64;
        for (i, strain) in strain.iter_mut().enumerate().take(points.len()) {
            let step = Strain::from(core::array::from_fn::<f64, 6, _>(|k| step[6 * i + k]));
            *strain += step;
            largest = largest.max(h * step.angular.max_abs()).max(step.linear.max_abs());
        }
        if !largest.is_finite() {
            return None;
        }
        if largest <= 1e-12 {
            if points.len() == 1 {
                strain[1] = strain[0];
            }
            return Some(strain);
        }
    }
    None
}

/// Which of the six strains are free.
pub(crate) const fn free_strains(kinematics: Kinematics) -> usize {
    match kinematics {
        Kinematics::Cosserat => 6,
        Kinematics::Kirchhoff => 3,
    }
}

/// How an element yields: a change `δw` of the wrench through `b` turns and shifts the exponential by
/// `ξ = flexibility · δw` (in frame `b`: `exp(Ω + δΩ) = exp(Ω) exp(ξ)`).
pub(crate) fn flexibility(
    order: Order,
    kinematics: Kinematics,
    h: f64,
    points: &[Point],
    w: Wrench,
    strain: &PointStrains,
) -> Option<Mat6> {
    let free = free_strains(kinematics);
    let system = LocalSystem::new(order, h, points, w, strain);
    let factors = system.factored(free)?;
    let omega = exponent(order, h, strain);
    let t = tangent(omega);
    let transpose = t.transpose();
    let mut columns = [[0.0; 6]; 6];
    for (j, column) in columns.iter_mut().enumerate() {
        let unit = Wrench::from(core::array::from_fn::<f64, 6, _>(|i| f64::from(u8::from(i == j))));
        let rhs = system.driven_by(
            order,
            h,
            strain,
            if order == Order::First { unit } else { transpose.mul_vec(unit) },
        );
        let step = factors.solve(&rhs);
        let d: PointStrains = core::array::from_fn(|i| {
            Strain::from(core::array::from_fn::<f64, 6, _>(|k| step[6 * i.min(points.len() - 1) + k]))
        });
        let d_omega = match order {
            Order::First | Order::Second => d[0] * h,
            Order::Fourth => {
                (d[0] + d[1]) * (0.5 * h)
                    + (d[0].bracket(strain[1]) + strain[0].bracket(d[1])) * (0.5 * GAUSS_OFFSET * h * h)
            }
        };
        *column = t.mul_vec(d_omega).to_array();
    }
    Some(Mat6::from_rows(&columns).transpose())
}

/// The [`flexibility`] of an element of a rod, by the quickest way that its law allows, taken as one of the given order.
pub(crate) fn flexibility_of(
    rod: &Rod,
    e: usize,
    w: Wrench,
    strain: &PointStrains,
    order: Order,
) -> Option<Mat6> {
    let h = rod.element_length(e);
    match (order, rod.diagonal_points()) {
        (Order::Second, Some(points)) => {
            Some(diagonal_flexibility::<f64>(points[e].compliance, strain[0] * h, w).to_matrix())
        }
        _ => flexibility(order, rod.kinematics(), h, rod.points(e), w, strain),
    }
}

/// The [`Resistance`] of an element of any order and law, seen from axes where its far node is, which is `turned` so in them; `relative` is that node's
/// pose in the near node's frame, and `strain` a guess, replaced by the strains that belong to the wrench. `lent` is added to the compliance of
/// its shifts.
///
/// With `G` its flexibility and `g` the gap between where its exponential leads and where its far node is, `(G + lent) δw = ξ + g`.
pub(crate) fn resistance(
    rod: &Rod,
    e: usize,
    w: Wrench,
    relative: &Pose,
    turned: &Mat3,
    strain: &mut PointStrains,
    lent: f64,
) -> Option<Resistance> {
    let (order, kinematics, h, points) =
        (rod.order(), rod.kinematics(), rod.element_length(e), rod.points(e));
    *strain = solve_general(order, kinematics, h, points, w, *strain)
        .or_else(|| solve_general(order, kinematics, h, points, w, rod.rest_strains(e)))?;
    let gap = Pose::exp(exponent(order, h, strain)).between(relative).log();
    let lend = Mat6::diagonal(Vec6::new(Vec3::ZERO, Vec3::new(lent, lent, lent)));
    let factors = lu::<6>(flexibility(order, kinematics, h, points, w, strain)?.add(&lend).to_rows())?;
    let columns = Mat6::IDENTITY.to_rows().map(|column| factors.solve(&column));
    let stiffness = Mat6::from_rows(&columns).transpose();
    let far = Pose { rotation: *turned, position: Vec3::ZERO };
    let pull = far.carry_wrench(stiffness.mul_vec(gap));
    let back = far.inverse().adjoint_matrix();
    Some(Resistance { stiffness: back.transpose().mul(&stiffness).mul(&back).blocks, pull, slack: gap })
}

/// The local equations `σ(ε) − T-stress = 0` of an element and their derivative, stiffness form, dense.
struct LocalSystem {
    size: usize,
    matrix: [[f64; 12]; 12],
    residual: [f64; 12],
}

impl LocalSystem {
    fn new(order: Order, h: f64, points: &[Point], w: Wrench, strain: &PointStrains) -> Self {
        let size = 6 * points.len();
        let mut matrix = [[0.0; 12]; 12];
        let mut residual = [0.0; 12];
        let mut put = |i: usize, j: usize, block: &Mat6| {
            for (r, row) in block.to_rows().iter().enumerate() {
                for (c, value) in row.iter().enumerate() {
                    matrix[6 * i + r][6 * j + c] += value;
                }
            }
        };
        let elastic = |i: usize| strain[i] - points[i].rest;
        let mut demand = [w, w];
        match order {
            Order::First => put(0, 0, &points[0].law.tangent(elastic(0))),
            Order::Second => {
                let x = strain[0] * h;
                demand[0] = mean_wrench(x, w);
                put(0, 0, &points[0].law.tangent(elastic(0)));
                put(0, 0, &mean_derivative(x, w).scaled(-h));
            }
            Order::Fourth => {
                let omega = exponent(order, h, strain);
                let mean = mean_wrench(omega, w);
                demand = gauss_stresses(h, strain, mean);
                let by_omega = mean_derivative(omega, w);
                let k = GAUSS_OFFSET * h;
                for i in 0..2 {
                    put(i, i, &points[i].law.tangent(elastic(i)));
                    let sign = if i == 0 { 1.0 } else { -1.0 };
                    let other = strain[1 - i];
                    // σ = σ̄ ± k ad*(other) σ̄: by σ̄ through Ω, and by the other strain directly.
                    let through =
                        coadjoint_matrix(other).scaled(sign * k).add(&Mat6::IDENTITY).mul(&by_omega);
                    for j in 0..2 {
                        let sign_j = if j == 0 { -1.0 } else { 1.0 };
                        let d_omega = Mat6::IDENTITY
                            .scaled(0.5 * h)
                            .add(&bracket_matrix(strain[1 - j]).scaled(sign_j * 0.5 * GAUSS_OFFSET * h * h));
                        put(i, j, &through.mul(&d_omega).scaled(-1.0));
                    }
                    put(i, 1 - i, &coadjoint_by_strain(mean).scaled(-sign * k));
                }
            }
        }
        for i in 0..points.len() {
            let gap = demand[i] - points[i].law.stress(elastic(i));
            residual[6 * i..6 * i + 6].copy_from_slice(&gap.to_array());
        }
        Self { size, matrix, residual }
    }

    /// The right-hand side of a change of the mean wrench.
    fn driven_by(&self, order: Order, h: f64, strain: &PointStrains, mean: Wrench) -> [f64; 12] {
        let mut rhs = [0.0; 12];
        let stresses = if order == Order::Fourth { gauss_stresses(h, strain, mean) } else { [mean, mean] };
        rhs[..6].copy_from_slice(&stresses[0].to_array());
        rhs[6..].copy_from_slice(&stresses[1].to_array());
        rhs
    }

    /// Factors the equations of the free strains, the first `free` of each six.
    fn factored(&self, free: usize) -> Option<LocalFactors> {
        let unknowns = (0..self.size).filter(|i| i % 6 < free);
        // Rows are scaled by their diagonal: bending and stretching differ by many orders of magnitude.
        let scales = core::array::from_fn(|i| 1.0 / self.matrix[i][i].abs().max(f64::MIN_POSITIVE));
        let mut places = [None; 12];
        places.iter_mut().zip(unknowns).for_each(|(place, i)| *place = Some(i));
        let factors = match places[6] {
            None => Factors::Six(lu(self.rows(&places, &scales))?),
            Some(_) => Factors::Twelve(lu(self.rows(&places, &scales))?),
        };
        Some(LocalFactors { places, scales, factors })
    }

    /// The scaled equations of the unknowns at so many places; a place without one keeps its own row of the identity.
    fn rows<const N: usize>(&self, places: &[Option<usize>; 12], scales: &[f64; 12]) -> [[f64; N]; N] {
        let entry = |i: usize, j: usize| match (places[i], places[j]) {
            (Some(row), Some(column)) => self.matrix[row][column] * scales[row],
            _ => f64::from(u8::from(i == j)),
        };
        core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
    }
}

/// The equations of an element's free strains, factored: which of the twelve are unknown, by what their rows were scaled, and the factors, of as few
/// rows as will do.
struct LocalFactors {
    places: [Option<usize>; 12],
    scales: [f64; 12],
    factors: Factors,
}

#[expect(clippy::large_enum_variant, reason = "lives on the stack for the time of an element")]
enum Factors {
    Six(Lu<6>),
    Twelve(Lu<12>),
}

impl LocalFactors {
    /// The changes of all strains, zero for those that are not free.
    fn solve(&self, rhs: &[f64; 12]) -> [f64; 12] {
        let mut solution = [0.0; 12];
        match &self.factors {
            Factors::Six(factors) => self.put(&factors.solve(&self.take(rhs)), &mut solution),
            Factors::Twelve(factors) => self.put(&factors.solve(&self.take(rhs)), &mut solution),
        }
        solution
    }

    fn take<const N: usize>(&self, rhs: &[f64; 12]) -> [f64; N] {
        core::array::from_fn(|i| self.places[i].map_or(0.0, |place| rhs[place] * self.scales[place]))
    }

    fn put<const N: usize>(&self, unknowns: &[f64; N], solution: &mut [f64; 12]) {
        for (place, unknown) in self.places.iter().zip(unknowns) {
            if let Some(place) = place {
                solution[*place] = *unknown;
            }
        }
    }
}

/// The derivative of [`mean_wrench`] by `x` as one matrix.
fn mean_derivative(x: Vec6, w: Wrench) -> Mat6 {
    let d = mean_wrench_derivative(x, w);
    Mat6 { blocks: [[d.moment_by_turn, d.moment_by_shift], [d.force_by_turn, Mat3::ZERO]] }
}

/// The matrix of `σ ↦ ad*(ε) σ`.
fn coadjoint_matrix(strain: Strain) -> Mat6 {
    let (u, v) = (Mat3::hat(strain.angular), Mat3::hat(strain.linear));
    Mat6 { blocks: [[u, v], [Mat3::ZERO, u]] }
}

/// The matrix of `ε ↦ ad*(ε) σ`.
pub(crate) fn coadjoint_by_strain(stress: Stress) -> Mat6 {
    let (m, n) = (Mat3::hat(stress.angular).scaled(-1.0), Mat3::hat(stress.linear).scaled(-1.0));
    Mat6 { blocks: [[m, n], [n, Mat3::ZERO]] }
}

/// The matrix of `y ↦ [x, y]`.
fn bracket_matrix(x: Vec6) -> Mat6 {
    let (u, v) = (Mat3::hat(x.angular), Mat3::hat(x.linear));
    Mat6 { blocks: [[u, Mat3::ZERO], [v, u]] }
}

#[cfg(test)]
mod tests;
