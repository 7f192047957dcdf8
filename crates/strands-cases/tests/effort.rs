//! How hard each named case is: what the solves of its rows take together, from where each row starts, with 100 elements of order 2.
//!
//! A change that makes a solver work harder, or less hard, shows here. The numbers are the same on every machine.

use std::fmt::Write;
use strands::rod::Order;
use strands::statics::Settings;

#[test]
fn the_named_cases_take_what_they_took() {
    let mut table = String::new();
    for case in strands_cases::all() {
        let outcomes = case.solve(100, Order::Second, &Settings::default());
        let rows = outcomes.len();
        let solved: Vec<_> = outcomes.into_iter().flatten().map(|outcome| outcome.solution.report).collect();
        let sum = |what: fn(&strands::statics::SolveReport) -> usize| solved.iter().map(what).sum::<usize>();
        writeln!(
            table,
            "{:<28} {:>3} rows, {:>3} solved: {:>5} iterations, {:>5} factorisations, {:>5} sweeps, {:>4} Jacobians",
            case.name,
            rows,
            solved.len(),
            sum(|report| report.iterations),
            sum(|report| report.factorisations),
            sum(|report| report.sweeps),
            sum(|report| report.jacobians),
        )
        .unwrap();
    }
    insta::assert_snapshot!("effort", table);
}
