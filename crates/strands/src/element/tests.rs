use super::*;
use crate::math::{Pose, Vec3};
use crate::rod::{Law, Stiffness};
use proptest::prelude::*;

fn vec3(size: f64) -> impl Strategy<Value = Vec3> {
    (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn vec6(angular: f64, linear: f64) -> impl Strategy<Value = Vec6> {
    (vec3(angular), vec3(linear)).prop_map(|(a, l)| Vec6::new(a, l))
}

fn point() -> impl Strategy<Value = Point> {
    (vec3(4.0), 0.02..0.1f64, 0.02..0.1f64, 0.02..0.1f64).prop_map(|(rest, b1, b2, torsion)| Point {
        rest: Strain::new(rest, Vec3::Z),
        law: Law::Diagonal(Stiffness { bending: [b1, b2], torsion, axial: 90.0, shear: [30.0, 40.0] }),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn mean_wrench_is_the_mean_of_the_carried_wrench(x in vec6(2.0, 1.0), w in vec6(1.0, 1.0)) {
        // Simpson's rule over T(x)ᵀ w = ∫₀¹ Ad(exp(−t x))ᵀ w dt, fine enough for its error to vanish.
        let n = 400;
        let at = |t: f64| Pose::exp(x * t).carry_wrench(w);
        let mean = (0..=n).fold(Vec6::ZERO, |sum, i| {
            let weight = if i == 0 || i == n { 1.0 } else if i % 2 == 1 { 4.0 } else { 2.0 };
            sum + at(i as f64 / n as f64) * (weight / (3.0 * n as f64))
        });
        prop_assert!((mean - mean_wrench(x, w)).max_abs() < 1e-9);
    }

    #[test]
    fn mean_wrench_derivative_is_the_derivative(x in vec6(1.5, 1.0), w in vec6(1.0, 1.0), d in vec6(1.0, 1.0)) {
        let step = 1e-5;
        let slope = (mean_wrench(x + d * step, w) - mean_wrench(x - d * step, w)) * (0.5 / step);
        prop_assert!((mean_derivative(x, w).mul_vec(d) - slope).max_abs() < 1e-8);
    }

    #[test]
    fn the_quick_and_the_general_solver_find_the_same_strain(
        points in prop::array::uniform2(point()),
        w in vec6(0.3, 3.0),
        h in 0.001..0.05f64,
        kirchhoff in any::<bool>(),
    ) {
        let kinematics = if kirchhoff { Kinematics::Kirchhoff } else { Kinematics::Cosserat };
        let diagonal = points.clone().map(|p| DiagonalPoint::new(kinematics, h, &p).expect("a diagonal law"));
        let quick = |order: Order| match order {
            Order::First => <First as LocalSolver<Vec3>>::new().next(&diagonal, h, &w),
            Order::Second => Second::<Vec3>::new().next(&diagonal, h, &w),
            Order::Fourth => Fourth::<Vec3>::new().next(&diagonal, h, &w),
        };
        for order in [Order::First, Order::Second, Order::Fourth] {
            let n = order.places().len();
            let quick = quick(order);
            let rest = [points[0].rest, points[n - 1].rest];
            let general = solve_general(order, kinematics, h, &points[..n], w, rest);
            let general = general.expect("converges");
            let exponent = exponent(order, h, &general);
            let gap = (general[0] * h - quick.points[0])
                .max_abs()
                .max((general[n - 1] * h - quick.points[1]).max_abs())
                .max((exponent - quick.exponent).max_abs());
            prop_assert!(gap < 1e-12, "{order:?} {kinematics:?}: {gap:e} at h = {h}");
            let carried = Pose::exp(exponent).carry_wrench(w);
            let gap = (carried - quick.carry(&w)).max_abs();
            prop_assert!(gap < 1e-12 * (1.0 + w.max_abs()), "{order:?} {kinematics:?}: {gap:e} at h = {h}");
        }
    }

    #[test]
    fn flexibility_is_the_derivative_of_the_exponent(
        points in prop::array::uniform2(point()),
        w in vec6(0.2, 1.0),
        d in vec6(0.2, 1.0),
        h in 0.005..0.1f64,
        kirchhoff in any::<bool>(),
    ) {
        let kinematics = if kirchhoff { Kinematics::Kirchhoff } else { Kinematics::Cosserat };
        for order in [Order::First, Order::Second, Order::Fourth] {
            let points = &points[..order.places().len()];
            let rest = [points[0].rest, points[points.len() - 1].rest];
            let at = |w: Wrench| {
                let strain = solve_general(order, kinematics, h, points, w, rest).expect("converges");
                (strain, Pose::exp(exponent(order, h, &strain)))
            };
            let (strain, here) = at(w);
            let step = 1e-5;
            let slope = (here.between(&at(w + d * step).1).log() - here.between(&at(w - d * step).1).log()) * (0.5 / step);
            let exact = flexibility(order, kinematics, h, points, w, &strain).expect("regular").mul_vec(d);
            prop_assert!((exact - slope).max_abs() < 1e-7 * (1.0 + exact.max_abs()), "{order:?} {kinematics:?}");
            if order == Order::Second {
                let point = DiagonalPoint::new(kinematics, h, &points[0]).expect("a diagonal law");
                let quick = diagonal_flexibility::<f64>(point.compliance, strain[0] * h, w);
                let gap = (quick.to_matrix().mul_vec(d) - exact).max_abs();
                prop_assert!(gap < 1e-12 * (1.0 + exact.max_abs()), "{kinematics:?}: {gap:e}");
            }
        }
    }
}
