use super::*;
use core::f64::consts::PI;
use proptest::prelude::*;

fn unit_vector() -> impl Strategy<Value = Vec3> {
    (-1.0..1.0f64, 0.0..(2.0 * PI)).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * phi.cos(), r * phi.sin(), z)
    })
}

/// Angles near zero, near π and between.
fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        (-300.0..0.0f64).prop_map(|e| 10f64.powf(e / 20.0)),
        0.0..PI,
        (-14.0..-1.0f64).prop_map(|e| PI - 10f64.powf(e)),
    ]
}

fn twist() -> impl Strategy<Value = Vec6> {
    (unit_vector(), angle(), unit_vector(), 0.0..3.0f64)
        .prop_map(|(axis, angle, direction, length)| Vec6::new(axis * angle, direction * length))
}

fn ad(x: Vec6) -> Mat6 {
    let (u, v) = (Mat3::hat(x.angular), Mat3::hat(x.linear));
    Mat6 { blocks: [[u, Mat3::ZERO], [v, u]] }
}

/// `Σ coefficient(k) ad^k`, summed until nothing changes.
fn series(x: Vec6, coefficient: impl Fn(usize) -> f64) -> Mat6 {
    let (mut sum, mut power) = (Mat6::IDENTITY, Mat6::IDENTITY);
    for k in 1..60 {
        power = power.mul(&ad(x));
        sum = sum.add(&power.scaled(coefficient(k)));
    }
    sum
}

fn factorial(k: usize) -> f64 {
    (1..=k).map(|i| i as f64).product()
}

fn distance(a: &Mat6, b: &Mat6) -> f64 {
    let (a, b) = (a.to_rows(), b.to_rows());
    let size = a.iter().flatten().fold(1.0_f64, |m, x| m.max(x.abs()));
    a.iter().flatten().zip(b.iter().flatten()).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_log_of_a_small_turn_is_the_log_and_says_where_the_turn_is_large(x in twist()) {
        let pose = Pose::exp(x);
        let (log, quick) = (pose.log(), pose.log_of_small_turn());
        let angle = x.angular.norm();
        if angle <= 1.0 {
            prop_assert!((quick - log).max_abs() <= 4e-15 * (1.0 + log.linear.max_abs()), "{quick:?} {log:?}");
        } else if angle > 1.02 {
            prop_assert!(!quick.angular.is_finite());
        }
    }

    #[test]
    fn log_undoes_exp_from_zero_to_half_a_turn(x in twist()) {
        let back = Pose::exp(x).log();
        let angle = x.angular.norm();
        // At half a turn the axis is known up to its sign, and near it the angle only as well as the matrix tells it.
        if angle < PI - 1e-12 {
            let tolerance = 1e-15 * (1.0 + x.linear.norm()) * 16.0;
            prop_assert!((back - x).max_abs() <= tolerance, "{:e} at {angle}", (back - x).max_abs());
        }
        let again = Pose::exp(back);
        prop_assert!((again.rotation - Pose::exp(x).rotation).max_abs() < 1e-14);
        prop_assert!((again.position - Pose::exp(x).position).max_abs() < 1e-14 * (1.0 + x.linear.norm()));
    }

    #[test]
    fn exp_is_a_rotation(x in twist()) {
        let r = Pose::exp(x).rotation;
        let gap = r.transpose() * r - Mat3::IDENTITY;
        prop_assert!(gap.max_abs() < 1e-15 * 8.0);
        prop_assert!((r.determinant() - 1.0).abs() < 1e-15 * 8.0);
    }

    #[test]
    fn tangent_is_its_series(x in twist()) {
        let exact = series(x, |k| if k % 2 == 0 { 1.0 } else { -1.0 } / factorial(k + 1));
        prop_assert!(distance(&exact, &tangent(x)) < 1e-13, "{:e}", distance(&exact, &tangent(x)));
    }

    #[test]
    fn inverse_tangent_inverts_the_tangent(x in twist()) {
        let product = tangent(x).mul(&tangent_inverse(x));
        prop_assert!(distance(&product, &Mat6::IDENTITY) < 1e-13, "{:e}", distance(&product, &Mat6::IDENTITY));
    }

    #[test]
    fn adjoint_is_the_exponential_of_the_bracket(x in twist(), y in twist()) {
        let exact = series(x, |k| 1.0 / factorial(k)).mul_vec(y);
        prop_assert!((Pose::exp(x).adjoint(y) - exact).max_abs() < 1e-12 * (1.0 + exact.max_abs()));
    }

    #[test]
    fn carried_wrenches_do_the_same_work(x in twist(), w in twist(), y in twist()) {
        // (Ad⁻ᵀ w) · (Ad y) = w · y.
        let g = Pose::exp(x);
        let work = g.carry_wrench(w).dot(g.adjoint(y));
        prop_assert!((work - w.dot(y)).abs() < 1e-12 * (1.0 + w.max_abs() * y.max_abs()));
    }

    #[test]
    fn quaternions_and_matrices_agree(x in twist()) {
        let q = Quat::from_rotation_vector(x.angular);
        prop_assert!((q.to_matrix() - Pose::exp(x).rotation).max_abs() < 1e-15 * 8.0);
        let back = Quat::from_matrix(q.to_matrix()).to_rotation_vector();
        prop_assert!((Quat::from_rotation_vector(back).to_matrix() - q.to_matrix()).max_abs() < 1e-15 * 8.0);
    }

    #[test]
    fn lanes_give_the_bits_of_single_numbers(xs in prop::array::uniform8(twist())) {
        let gather = |pick: &dyn Fn(&Vec6) -> f64| Lanes::<8>::from_fn(|i| pick(&xs[i]));
        let vector = |pick: &dyn Fn(&Vec6) -> Vec3| {
            Vec3::new(gather(&|x| pick(x).x), gather(&|x| pick(x).y), gather(&|x| pick(x).z))
        };
        let together = Pose::exp(Vec6::new(vector(&|x| x.angular), vector(&|x| x.linear)));
        for (i, x) in xs.iter().enumerate() {
            let alone = Pose::exp(*x);
            prop_assert_eq!(together.position.x.0[i].to_bits(), alone.position.x.to_bits());
            prop_assert_eq!(together.rotation.cols[1].z.0[i].to_bits(), alone.rotation.cols[1].z.to_bits());
        }
    }
}

#[test]
fn coefficients_join_smoothly_where_their_series_change() {
    for limit in [1.0 / 64.0, 1.0] {
        let (below, above) = (exp_coefficients(limit), exp_coefficients(limit * (1.0 + 1e-15)));
        for (a, b) in [(below.b, above.b), (below.c, above.c)] {
            assert!((a - b).abs() <= 4e-16 * a, "{a} {b} at {limit}");
        }
        for (a, b) in [(below.db, above.db), (below.dc, above.dc)] {
            assert!((a - b).abs() <= 1e-11 * a.abs(), "{a} {b} at {limit}");
        }
    }
}

#[test]
fn lu_solves_and_knows_the_sign_of_the_determinant() {
    let a = [[0.0, 2.0, 1.0], [1.0, 0.5, -1.0], [3.0, 1.0, 4.0]];
    let x = lu(a).unwrap().solve(&[5.0, -1.0, 2.0]);
    for (row, b) in a.iter().zip([5.0, -1.0, 2.0]) {
        let sum: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
        assert!((sum - b).abs() < 1e-14);
    }
    assert!(lu([[1.0, 2.0], [2.0, 4.0]]).is_none());
}

#[cfg(target_arch = "x86_64")]
mod packed_vectors {
    use super::*;

    /// Every operation of a vector, its results as bits.
    struct EveryOperation<V> {
        vectors: [Vec3; 4],
        k: f64,
        kind: core::marker::PhantomData<V>,
    }

    impl<V: Vector<Number = f64>> Kernel for EveryOperation<V> {
        type Output = Vec<[u64; 3]>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let [a, b, c, d] = self.vectors;
            let (a, b, c, d) = (V::splat(a), V::splat(b), V::splat(c), V::new(d.x, d.y, d.z));
            let (mut sum, mut difference) = (a, a);
            sum += b;
            difference -= b;
            let [x, y, z] = a.spread();
            let results = [
                a + b,
                a - b,
                -a,
                a * self.k,
                sum,
                difference,
                V::zero(),
                a.cross(b),
                a.scale(b),
                x,
                y,
                z,
                d.dots([a, b, c]),
                V::new(a.dot(b), c.size(), d.dot(d)),
            ];
            results.iter().map(|v| v.parts().map(f64::to_bits)).collect()
        }
    }

    proptest! {
        #[test]
        fn packed_vectors_give_the_bits_of_single_numbers(
            parts in prop::array::uniform4(prop::array::uniform3(-10.0..10.0f64)),
            k in -10.0..10.0f64,
        ) {
            let vectors = parts.map(|[x, y, z]| Vec3::new(x, y, z));
            let single = EveryOperation::<Vec3> { vectors, k, kind: core::marker::PhantomData }.run();
            let packed = with_avx2(EveryOperation::<Packed> { vectors, k, kind: core::marker::PhantomData });
            // A machine without AVX2 has no packed vectors to test.
            if let Some(packed) = packed {
                prop_assert_eq!(single, packed);
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod registers {
    use super::*;
    use crate::math::{Eight, Four, Register};

    /// Every operation of numbers side by side, once; the bits of the results, lane by lane.
    struct EveryOperation<R> {
        a: [f64; 8],
        b: [f64; 8],
        kind: core::marker::PhantomData<R>,
    }

    impl<R: Register> Kernel for EveryOperation<R> {
        type Output = Vec<[u64; 8]>;

        #[inline(always)]
        fn run(self) -> Self::Output {
            let mut results = vec![[0; 8]; 14];
            for first in (0..8).step_by(R::LANES) {
                let a = R::from_lanes(|lane| self.a[first + lane]);
                let b = R::from_lanes(|lane| self.b[first + lane]);
                let (below, both) = (a.at_most(0.5), R::and(a.at_most(0.5), b.at_most(0.5)));
                let (mut sum, mut difference) = (a, a);
                sum += b;
                difference -= b;
                let all = R::select(below, R::splat(f64::from(R::all(R::splat(0.25).at_most(0.5)))), b);
                let operations = [
                    a + b,
                    a - b,
                    a * b,
                    a / b,
                    -a,
                    sum,
                    difference,
                    a.abs(),
                    a.abs().sqrt(),
                    R::select(below, a, b),
                    R::select(both, a, b),
                    a.map(|x| (x.cbrt(), f64::NAN)),
                    R::zero() + R::one(),
                    all,
                ];
                for (result, operation) in results.iter_mut().zip(operations) {
                    for lane in 0..R::LANES {
                        result[first + lane] = operation.number(lane).to_bits();
                    }
                }
            }
            results
        }
    }

    proptest! {
        #[test]
        fn numbers_in_registers_give_the_bits_of_single_numbers(
            mut a in prop::array::uniform8(-2.0..2.0f64),
            b in prop::array::uniform8(-2.0..2.0f64),
            odd in prop::sample::select(vec![0.0, -0.0, f64::INFINITY, f64::MIN_POSITIVE, 0.5]),
            at in 0..8usize,
        ) {
            a[at] = odd;
            let single = f64::run(EveryOperation::<f64> { a, b, kind: core::marker::PhantomData });
            // A machine without the registers has no such numbers to test.
            if SimdLevel::detect() >= SimdLevel::Avx2 {
                let four = Four::run(EveryOperation::<Four> { a, b, kind: core::marker::PhantomData });
                prop_assert_eq!(&single, &four);
            }
            if SimdLevel::detect() >= SimdLevel::Avx512 {
                let eight = Eight::run(EveryOperation::<Eight> { a, b, kind: core::marker::PhantomData });
                prop_assert_eq!(&single, &eight);
            }
        }
    }
}

#[test]
fn a_symmetric_matrix_of_any_signs_is_solved_and_its_negative_eigenvalues_are_counted() {
    let mut rng = fastrand::Rng::with_seed(7);
    for trial in 0..200 {
        // Bᵀ D B has the signs of D (Sylvester). Zeros on the diagonal ask for pairs.
        let negative = trial % 8;
        let b: [[f64; 7]; 7] = core::array::from_fn(|_| core::array::from_fn(|_| rng.f64() - 0.5));
        let d: [f64; 7] = core::array::from_fn(|i| {
            10_f64.powf(8.0 * rng.f64() - 4.0) * if i < negative { -1.0 } else { 1.0 }
        });
        let a: [[f64; 7]; 7] = core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..7).map(|k| b[k][i] * d[k] * b[k][j]).sum())
        });
        let x: [f64; 7] = core::array::from_fn(|_| rng.f64() - 0.5);
        let rhs: [f64; 7] = core::array::from_fn(|i| (0..7).map(|j| a[i][j] * x[j]).sum());
        let factors = ldl(a).unwrap();
        assert_eq!(factors.negative(), negative, "{trial}");
        let found = factors.solve(&rhs);
        let size = a.iter().flatten().fold(0.0, |max: f64, x| max.max(x.abs()));
        for i in 0..7 {
            let back: f64 = (0..7).map(|j| a[i][j] * found[j]).sum();
            let most = found.iter().fold(1.0, |max: f64, x| max.max(x.abs()));
            assert!((back - rhs[i]).abs() < 1e-13 * size * most, "{trial}: {:e}", back - rhs[i]);
        }
    }
    let saddle = ldl([[0.0, 0.0, 1.0], [0.0, 2.0, 0.0], [1.0, 0.0, 0.0]]).unwrap();
    assert_eq!((saddle.negative(), saddle.solve(&[1.0, 2.0, 3.0])), (1, [3.0, 1.0, 1.0]));
    assert!(ldl([[1.0, 1.0], [1.0, 1.0]]).is_none());
}
