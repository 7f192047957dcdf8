//! Rods drawn at random: each is found from rest, at a stable equilibrium.

use strands::rod::Order;
use strands::statics::{Method, Settings, Workspace, solve};
use strands_cases::bank;

/// Every so many of the bank's rods; `strands bench` solves them all.
const STRIDE: usize = 8;

#[test]
fn every_rod_is_found_from_rest_and_is_stable() {
    let mut workspace = Workspace::default();
    for number in (0..bank::RODS).step_by(STRIDE) {
        let problem = bank::problem(number, 100, Order::Second).expect("a rod");
        let solution = solve(&problem, &Settings::default(), None, &mut workspace)
            .unwrap_or_else(|failure| panic!("rod {number}: {failure}"));
        let report = &solution.report;
        assert_eq!(report.morse_index, Some(0), "rod {number}");
        assert!(report.residual <= 1e-9, "rod {number}: {:e}", report.residual);
        assert!(solution.imbalance(&problem) < 1e-12, "rod {number}: {:e}", solution.imbalance(&problem));
        let gap = problem.end.pose.between(&solution.poses[100]);
        assert!(gap.log().max_abs() < 1e-12, "rod {number}");
    }
}

#[test]
fn the_other_orders_find_their_way_too() {
    let mut workspace = Workspace::default();
    // Euler's scheme is far enough off on 60 elements that a branch may end beside the true one.
    for (order, least) in [(Order::Fourth, 40), (Order::First, 36)] {
        let found = (0..bank::RODS).step_by(250).filter(|number| {
            let problem = bank::problem(*number, 60, order).expect("a rod");
            let solution = solve(&problem, &Settings::default(), None, &mut workspace);
            solution.is_ok_and(|solution| solution.report.residual <= 1e-9)
        });
        let found = found.count();
        assert!(found >= least, "{order:?}: {found} of 40");
    }
}

#[test]
fn shooting_finds_the_same_equilibrium_where_it_finds_any() {
    let mut workspace = Workspace::default();
    for order in [Order::Second, Order::Fourth] {
        let (mut shots, mut tries) = (0, 0);
        for number in (0..bank::RODS).step_by(250) {
            let problem = bank::problem(number, 60, order).expect("a rod");
            let at_once = Settings { method: Method::Equilibrium, tolerance: 1e-12, ..Settings::default() };
            let found = solve(&problem, &at_once, None, &mut workspace)
                .unwrap_or_else(|failure| panic!("rod {number}: {failure}"));
            let shooting = Settings {
                method: Method::Shooting,
                tolerance: 1e-11,
                restart_from_rest: false,
                max_halvings: 0,
                ..at_once
            };
            tries += 1;
            let Ok(shot) = solve(&problem, &shooting, Some(&found.guess), &mut workspace) else { continue };
            shots += 1;
            for (a, b) in found.poses.iter().zip(&shot.poses) {
                assert!(a.between(b).log().max_abs() < 1e-10, "rod {number}, {order:?}");
            }
        }
        assert!(shots * 10 >= tries * 8, "{order:?}: {shots} of {tries}");
    }
}
