//! A log–log plot of errors against numbers of elements, as SVG that takes its colours from the page around it.

use std::fmt::Write;

use super::convergence::{Curve, Curves};

const WIDTH: f64 = 370.0;
const HEIGHT: f64 = 300.0;
/// Room for the labels of the axes: left, right, top, bottom.
const MARGIN: [f64; 4] = [56.0, 14.0, 12.0, 46.0];
/// The least that is drawn.
const FLOOR: f64 = 1e-13;

/// The curves of a row, each with its measured slope beside its last point.
pub fn svg(curves: &Curves) -> String {
    let axes = Axes::around(curves);
    let mut out = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"error against number of elements, {}\">\n",
        curves.case
    );
    out += &axes.drawn();
    for curve in &curves.orders {
        out += &drawn(curve, &axes);
    }
    out + &legend(curves) + "</svg>\n"
}

/// The part of the plane that is shown, by its logarithms to base ten.
struct Axes {
    x: [f64; 2],
    y: [f64; 2],
}

impl Axes {
    fn around(curves: &Curves) -> Self {
        let points = || curves.orders.iter().flat_map(|curve| &curve.points);
        let span = |of: &dyn Fn(&(usize, f64)) -> f64| {
            points()
                .map(of)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let (x, y) = (span(&|p| (p.0 as f64).log10()), span(&|p| p.1.clamp(FLOOR, 10.0).log10()));
        // Whole decades upwards, and some air to both sides.
        Self { x: [x[0] - 0.08, x[1] + 0.08], y: [y[0].floor(), y[1].ceil().max(y[0].floor() + 1.0)] }
    }

    fn place(&self, elements: f64, error: f64) -> [f64; 2] {
        let part = |[low, high]: [f64; 2], x: f64| (x.log10() - low) / (high - low);
        let [left, right, top, bottom] = MARGIN;
        [
            left + part(self.x, elements) * (WIDTH - left - right),
            HEIGHT - bottom - part(self.y, error.max(FLOOR)) * (HEIGHT - top - bottom),
        ]
    }

    /// Grid, numbers and names.
    fn drawn(&self) -> String {
        let [left, right, top, bottom] = MARGIN;
        let (x1, y1) = (WIDTH - right, HEIGHT - bottom);
        let mut out = String::from("<g class=\"axes\">\n");
        let mut line = |text: String| out.extend([text.as_str(), "\n"]);
        // Every second decade is named.
        for decade in self.y[0] as i32..=self.y[1] as i32 {
            let [_, y] = self.place(10.0, 10.0_f64.powi(decade));
            line(format!("<path class=\"grid\" d=\"M{left} {y:.1}H{x1}\"/>"));
            if decade % 2 == 0 {
                let power = superscript(decade);
                line(format!(
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">10{power}</text>",
                    left - 7.0,
                    y + 4.0
                ));
            }
        }
        let mut elements = 8.0;
        while f64::log10(elements) < self.x[1] {
            let [x, _] = self.place(elements, 1.0);
            line(format!("<path class=\"grid\" d=\"M{x:.1} {top}V{y1}\"/>"));
            line(format!(
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{elements}</text>",
                y1 + 17.0
            ));
            elements *= 2.0;
        }
        let middle = 0.5 * (left + x1);
        line(format!(
            "<text class=\"name\" x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">elements</text>",
            HEIGHT - 8.0
        ));
        line(format!(
            "<text class=\"name\" transform=\"translate(14 {:.1}) rotate(-90)\" text-anchor=\"middle\">largest relative error</text>",
            0.5 * (top + y1)
        ));
        out + "</g>\n"
    }
}

fn drawn(curve: &Curve, axes: &Axes) -> String {
    let mut path = String::new();
    let mut dots = String::new();
    for (i, &(elements, error)) in curve.points.iter().enumerate() {
        let [x, y] = axes.place(elements as f64, error);
        let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        let _ = write!(
            dots,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.2\"><title>{elements} elements of order {}: {error:.2e}</title></circle>",
            curve.order
        );
    }
    format!("<g class=\"order{}\"><path class=\"curve\" d=\"{path}\"/>{dots}</g>\n", curve.order)
}

/// Which colour is which order, and the slopes, in the lower left corner: there the errors are not.
fn legend(curves: &Curves) -> String {
    let mut out = String::new();
    let rows = curves.orders.len() as f64;
    for (i, curve) in curves.orders.iter().enumerate() {
        let (x, y) = (MARGIN[0] + 14.0, HEIGHT - MARGIN[3] - 14.0 - 19.0 * (rows - 1.0 - i as f64));
        let slope = curve.slope.map_or_else(|| "not measured".into(), |slope| format!("{slope:.2}"));
        let _ = writeln!(
            out,
            "<g class=\"order{order}\"><path class=\"curve\" d=\"M{x} {:.1}h22\"/><circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.2\"/>\
             <text class=\"legend\" x=\"{:.1}\" y=\"{y:.1}\">order {order}, slope {slope}</text></g>",
            y - 4.0,
            x + 11.0,
            y - 4.0,
            x + 30.0,
            order = curve.order,
        );
    }
    out
}

fn superscript(power: i32) -> String {
    let digit = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(c as u32 - '0' as u32 + '⁰' as u32).unwrap_or(c),
    };
    power.to_string().chars().map(digit).collect()
}
