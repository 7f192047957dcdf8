//! Every scheme with every order and every kind of law: it agrees with the others, or it is refused.

use super::*;
use crate::rod::StiffeningEnergy;

/// The law of the test rods in each kind, one rod for each: diagonal, a matrix that couples the strains, a stored energy.
fn laws() -> [(&'static str, Law); 3] {
    let Profile::Given { law, .. } = description(Kinematics::Cosserat, curved()).profile else {
        unreachable!()
    };
    let Law::Diagonal(stiffness) = law else { unreachable!() };
    let mut matrix = law.tangent(Vec6::ZERO).to_rows();
    for (i, j, part) in [(0, 2, 0.3), (1, 3, 0.1), (0, 5, -0.2), (3, 5, 0.25)] {
        matrix[i][j] = part * f64::sqrt(matrix[i][i] * matrix[j][j]);
        matrix[j][i] = matrix[i][j];
    }
    let doubling_strain = Vec6::from([4.0, 4.0, 4.0, 0.1, 0.1, 0.1]);
    let energy = StiffeningEnergy { stiffness, doubling_strain };
    [
        ("diagonal", law),
        ("full", Law::full(matrix).unwrap()),
        ("hyperelastic", Law::Hyperelastic(std::sync::Arc::new(energy))),
    ]
}

fn with_law(law: &Law, elements: usize, order: Order) -> Problem {
    let plain = loaded(Kinematics::Cosserat, elements, order, Frame::World);
    let mut description = plain.rod.description().clone();
    let Profile::Given { law: own, .. } = &mut description.profile else { unreachable!() };
    *own = law.clone();
    Problem { rod: Rod::with_elements(description, elements, &[], order).unwrap(), ..plain }
}

#[test]
fn every_scheme_agrees_with_the_finest_to_its_order_or_is_refused() {
    for (name, law) in laws() {
        let precise = Settings { tolerance: 1e-12, ..Settings::default() };
        let fine = tip(&solved(&with_law(&law, 400, Order::Fourth), &precise));
        for scheme in [Scheme::Element, Scheme::Multistep] {
            let settings = Settings { scheme, ..precise };
            for (order, coarse) in [(Order::First, 512), (Order::Second, 128), (Order::Fourth, 32)] {
                let what = format!("{name} {scheme:?} {order:?}");
                let solve = |n| solve(&with_law(&law, n, order), &settings, None, &mut Workspace::default());
                if scheme == Scheme::Multistep && order == Order::Fourth {
                    let failure = solve(coarse).unwrap_err();
                    assert_eq!(failure.reason, FailureReason::SchemeOfOrder { order: 4 }, "{what}");
                    continue;
                }
                let error = |n| {
                    let solution = solve(n).unwrap_or_else(|failure| panic!("{what}: {failure}"));
                    fine.between(&tip(&solution)).log().max_abs()
                };
                let (slope, expected) = (slope_of(error, coarse), order.as_number() as f64);
                assert!((slope - expected).abs() < 0.15, "{what}: slope {slope:.3}");
            }
        }
    }
}

#[test]
fn a_refused_scheme_is_not_followed_either() {
    let problem = loaded(Kinematics::Cosserat, 20, Order::Fourth, Frame::World);
    let mut guess = solved(&problem, &Settings::default()).guess;
    let settings = Settings { scheme: Scheme::Multistep, ..Settings::default() };
    let before = guess;
    assert!(!follow(&problem, &settings, &mut guess, &mut Workspace::default(), &mut SolveReport::default()));
    assert_eq!(guess, before);
}
