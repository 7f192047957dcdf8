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

/// Pieces of elements whose length changes from each to the next.
fn uneven(pieces: usize) -> Mesh {
    let (mut at, mut out) = (0.0, Vec::new());
    for i in 0..pieces {
        at += if i % 2 == 0 { 1.4 } else { 0.6 } * 0.8 / pieces as f64;
        out.push((if i == pieces - 1 { 0.8 } else { at }, 1 + i % 3 / 2));
    }
    Mesh::from_pieces(&out).unwrap()
}

fn on_mesh(law: Option<&Law>, mesh: Mesh, kinematics: Kinematics) -> Problem {
    let plain = loaded(kinematics, 1, Order::Second, Frame::World);
    let mut description = plain.rod.description().clone();
    if let (Some(law), Profile::Given { law: own, .. }) = (law, &mut description.profile) {
        *own = law.clone();
    }
    let rod = Rod::new(description, mesh, Order::Second).unwrap();
    let load = PointLoad { at: 0.8, wrench: plain.loads.world[1], frame: Frame::World };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

#[test]
fn the_multistep_scheme_is_the_same_for_a_diagonal_law_and_its_matrix() {
    let settings = Settings { scheme: Scheme::Multistep, tolerance: 1e-13, ..Settings::default() };
    let [(_, diagonal), ..] = laws();
    let matrix = Law::full(diagonal.tangent(Vec6::ZERO).to_rows()).unwrap();
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for mesh in [Mesh::even(0.8, 12, &[]).unwrap(), uneven(16)] {
            let tip = |law| tip(&solved(&on_mesh(law, mesh.clone(), kinematics), &settings));
            let gap = tip(None).between(&tip(Some(&matrix))).log().max_abs();
            assert!(gap < 1e-12, "{kinematics:?}, {} elements: {gap:e}", mesh.elements());
        }
    }
}

#[test]
fn the_multistep_scheme_keeps_its_order_where_the_lengths_of_the_elements_change() {
    let settings = Settings { scheme: Scheme::Multistep, tolerance: 1e-13, ..Settings::default() };
    let at = |pieces| tip(&solved(&on_mesh(None, uneven(pieces), Kinematics::Cosserat), &settings));
    let fine = at(4096);
    let slope = slope_of(|pieces| fine.between(&at(pieces)).log().max_abs(), 128);
    assert!((slope - 2.0).abs() < 0.1, "slope {slope:.3}");
}

#[test]
fn two_sweeps_that_lose_where_the_rod_points_are_no_solution() {
    let mut problem = loaded(Kinematics::Cosserat, 7, Order::First, Frame::Body);
    problem.loads = problem.loads.scaled(1e13);
    for scheme in [Scheme::Element, Scheme::Multistep] {
        let settings = Settings { scheme, ..Settings::default() };
        let answer = solve(&problem, &settings, None, &mut Workspace::default());
        let failure = answer.expect_err("a moment that turns an element by more than numbers can tell");
        assert!(failure.nearest.is_finite(), "{scheme:?}: {failure}");
        let report = failure.nearest.report;
        assert!(report.residual.is_nan() || report.residual > settings.tolerance, "{report:?}");
    }
}
