//! How the error falls with the number of elements: `error ∝ N^−p`, with `p` measured for each order.

use strands::rod::Order;
use strands::statics::{Guess, Settings, Solution, Workspace};
use strands_cases::{Case, Row};

/// The rows that are drawn: case, the start of the row's label, and what is special about it.
const DRAWN: [(&str, &str, &str); 6] = [
    ("cantilever-dead-load", "P L²/EI = 10", "bending in a plane, inextensible"),
    ("heavy-cantilever", "w L³/EI = 100", "a distributed load, summed onto the nodes"),
    ("bend-45", "variant A, F = 600", "bending, twist, stretch and shear, curved at rest"),
    ("tip-wrench-01", "", "a force and a moment at the tip, and a weight"),
    ("pose-kirchhoff-01", "", "both ends held, inextensible"),
    ("pose-cosserat-01", "", "both ends held, with stretch and shear"),
];
/// The numbers of elements.
const ELEMENTS: [usize; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];
/// The residuals to which they are solved, the first that can be reached.
const TOLERANCES: [f64; 3] = [1e-12, 1e-11, 1e-9];
/// Errors below this may be the reference's own, or the solver's; above the other the curve is not yet straight.
const STRAIGHT: core::ops::Range<f64> = 1e-9..3e-2;
/// The slope is that of a straight line through so many of the finest of them.
const FITTED: usize = 4;

/// A row solved on finer and finer meshes.
pub struct Curves {
    /// The case's name.
    pub case: String,
    /// What the case is.
    pub title: String,
    /// The row, and what is special about it.
    pub row: String,
    /// One curve for each order.
    pub orders: Vec<Curve>,
}

/// One order's errors.
pub struct Curve {
    /// 1, 2 or 4.
    pub order: usize,
    /// Numbers of elements, and the largest error of the row's quantities with each.
    pub points: Vec<(usize, f64)>,
    /// The power of `1/N` with which the error falls; `None` where too few points tell it.
    pub slope: Option<f64>,
}

/// The curves of those of the representative rows whose cases are named.
pub fn curves(names: &[&str]) -> Vec<Curves> {
    let drawn = DRAWN.iter().filter(|(case, ..)| names.contains(case));
    drawn
        .filter_map(|(name, label, what)| {
            let case = strands_cases::find(name)?;
            let row = case.rows.iter().find(|row| row.label.starts_with(label))?;
            of_row(&case, row, what)
        })
        .collect()
}

/// Each mesh is solved from the end of the finest solution, so that all find the same equilibrium.
fn of_row(case: &Case, row: &Row, what: &str) -> Option<Curves> {
    let mut workspace = Workspace::default();
    let finest = ELEMENTS[ELEMENTS.len() - 1];
    let (finest, answer) = solved(row, finest, Order::Fourth, None, &mut workspace)?;
    let guess = Guess::new(finest.guess.pose, finest.guess.wrench);
    let mut orders = Vec::new();
    for order in [Order::First, Order::Second, Order::Fourth] {
        let mut error = |elements| error(row, answer, elements, order, &guess, &mut workspace);
        let points: Vec<(usize, f64)> =
            ELEMENTS.iter().filter_map(|&elements| Some((elements, error(elements)?))).collect();
        orders.push(Curve { order: order.as_number(), slope: slope(&points), points });
    }
    let row =
        if label_says_something(&row.label) { format!("{}: {what}", row.label) } else { what.to_owned() };
    Some(Curves { case: case.name.clone(), title: case.title.clone(), row, orders })
}

/// A case of one row has no label that tells it from others.
fn label_says_something(label: &str) -> bool {
    label != "all equilibria"
}

/// A solution, and which of the row's answers it is.
fn solved(
    row: &Row,
    elements: usize,
    order: Order,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
) -> Option<(Solution, usize)> {
    let outcome = TOLERANCES.iter().find_map(|&tolerance| {
        let settings = Settings { tolerance, restart_from_rest: false, ..Settings::default() };
        row.solve(elements, order, &settings, guess, workspace).ok()
    })?;
    Some((outcome.solution, outcome.answer))
}

/// The largest error of an answer's quantities; `None` where the mesh has no such equilibrium.
fn error(
    row: &Row,
    answer: usize,
    elements: usize,
    order: Order,
    guess: &Guess,
    workspace: &mut Workspace,
) -> Option<f64> {
    let problem = row.problem(elements, order).ok()?;
    let (solution, _) = solved(row, elements, order, Some(guess), workspace)?;
    let errors = row.answers[answer].expected.iter().map(|one| one.compare(&problem, &solution).error);
    Some(errors.fold(0.0, f64::max))
}

/// The slope of the least-squares line through the logarithms, with its sign turned.
fn slope(points: &[(usize, f64)]) -> Option<f64> {
    let straight: Vec<(f64, f64)> = (points.iter().rev())
        .filter(|(_, error)| STRAIGHT.contains(error))
        .take(FITTED)
        .map(|&(elements, error)| ((elements as f64).ln(), error.ln()))
        .collect();
    if straight.len() < 2 {
        return None;
    }
    let n = straight.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| straight.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    Some(-mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_order_has_its_slope_on_every_row_that_is_drawn() {
        let names = DRAWN.map(|(name, ..)| name);
        let drawn = curves(&names);
        assert_eq!(drawn.iter().map(|curves| curves.case.as_str()).collect::<Vec<_>>(), names);
        for curves in drawn {
            for Curve { order, slope, points } in curves.orders {
                let slope = slope.unwrap_or_else(|| panic!("{} of order {order}: {points:?}", curves.case));
                assert!((slope - order as f64).abs() < 0.15, "{} of order {order}: {slope}", curves.case);
            }
        }
    }
}
