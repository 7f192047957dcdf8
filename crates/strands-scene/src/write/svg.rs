//! A picture: the rods as seen along the direction in which the scene is flattest, with the world's axes and a scale.

use super::Solved;
use super::names::escaped;
use super::view::View;
use crate::model::Model;
use std::fmt::Write;
use strands::math::Vec3;
use strands::statics::Solution;

const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 600.0;
/// Room around the shape for labels, axes and scale.
const MARGIN: f64 = 80.0;
/// The thinnest line that is drawn.
const HAIRLINE: f64 = 1.6;
/// Colours of lines, apart for the colour-blind (Okabe & Ito 2008).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];

/// The solutions as an SVG picture, orthographic, as upright as the view allows. Rods are drawn as thick as they are, but never
/// thinner than a hairline; squares mark ends that are held.
pub fn svg(model: &Model, solutions: &[(&str, &Solution)]) -> String {
    let solved = Solved::all(model, solutions);
    let points: Vec<Vec3> =
        solved.iter().flat_map(|rod| rod.solution.poses.iter().map(|pose| pose.position)).collect();
    let view = View::of(&points);
    let frame = Frame::around(points.iter().map(|point| view.project(*point)));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fcfcfa\"/>\n\
         <text x=\"24\" y=\"34\" font-size=\"18\" fill=\"#222\">{title}</text>\n",
        title = escaped(&model.name)
    );
    let mut line = |text: String| out.extend([text.as_str(), "\n"]);
    for (i, rod) in solved.iter().enumerate() {
        // Many shapes of one rod have its name once.
        let named = solved[i + 1..].iter().all(|other| other.rod.name != rod.rod.name);
        line(drawn(rod, &view, &frame, COLOURS[i % COLOURS.len()], named));
    }
    line(axes(&view));
    line(scale_bar(frame.scale));
    out + "</svg>\n"
}

/// How metres in the view become places on the sheet.
struct Frame {
    scale: f64,
    centre: [f64; 2],
}

impl Frame {
    fn around(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for i in 0..2 {
                low[i] = low[i].min(point[i]);
                high[i] = high[i].max(point[i]);
            }
        }
        let room = [WIDTH - 2.0 * MARGIN, HEIGHT - 2.0 * MARGIN];
        let scale =
            (0..2).map(|i| room[i] / (high[i] - low[i]).max(f64::MIN_POSITIVE)).fold(f64::INFINITY, f64::min);
        Self { scale, centre: std::array::from_fn(|i| 0.5 * (low[i] + high[i])) }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [0.5 * WIDTH + (x - self.centre[0]) * self.scale, 0.5 * HEIGHT - (y - self.centre[1]) * self.scale]
    }
}

fn drawn(rod: &Solved<'_>, view: &View, frame: &Frame, colour: &str, named: bool) -> String {
    let place = |pose: &strands::math::Pose| frame.place(view.project(pose.position));
    let poses = &rod.solution.poses;
    let mut path = String::new();
    for (i, pose) in poses.iter().enumerate() {
        let [x, y] = place(pose);
        write!(path, "{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' })
            .unwrap_or_else(|error| unreachable!("in memory: {error}"));
    }
    let half = rod.rod.problem.rod.half_extent().iter().map(|half| half[0].min(half[1])).sum::<f64>()
        / poses.len() as f64;
    let width = (2.0 * half * frame.scale).max(HAIRLINE);
    let mut out = format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width:.2}\" stroke-linejoin=\"round\"/>"
    );
    let problem = &rod.rod.problem;
    for (node, support) in problem.supports() {
        if support.fixed.contains(&true) {
            let [x, y] = place(&poses[node]);
            write!(
                out,
                "\n<rect x=\"{:.2}\" y=\"{:.2}\" width=\"8\" height=\"8\" fill=\"#444\"/>",
                x - 4.0,
                y - 4.0
            )
            .unwrap_or_else(|error| unreachable!("in memory: {error}"));
        }
    }
    if !named {
        return out;
    }
    let [x, y] = place(&poses[poses.len() / 2]);
    let (x, y) = (x + 0.5 * width + 6.0, y - 0.5 * width - 6.0);
    let name = escaped(&rod.rod.name);
    // A halo, and the name on it, so that it can be read where the rod crosses.
    out + &format!(
        "\n<text x=\"{x:.2}\" y=\"{y:.2}\" stroke=\"#fcfcfa\" stroke-width=\"5\" stroke-linejoin=\"round\">{name}</text>\
         \n<text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"{colour}\">{name}</text>"
    )
}

/// The world's axes in the lower left corner; one that points at the viewer, or nearly, is left out.
fn axes(view: &View) -> String {
    let (x0, y0, size) = (48.0, HEIGHT - 48.0, 32.0);
    let mut out = String::from("<g stroke=\"#444\" fill=\"#444\" stroke-width=\"1.5\">");
    for (name, axis) in [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)] {
        let [x, y] = view.project(axis);
        if x.hypot(y) < 0.3 {
            continue;
        }
        let (x, y) = (x0 + size * x, y0 - size * y);
        let (tx, ty) = (x0 + 1.35 * (x - x0), y0 + 1.35 * (y - y0));
        write!(
            out,
            "\n<line x1=\"{x0}\" y1=\"{y0}\" x2=\"{x:.2}\" y2=\"{y:.2}\"/><text x=\"{tx:.2}\" y=\"{ty:.2}\" stroke=\"none\" \
             text-anchor=\"middle\" dominant-baseline=\"central\">{name}</text>"
        )
        .unwrap_or_else(|error| unreachable!("in memory: {error}"));
    }
    out + "\n</g>"
}

/// A bar of a round length, about a fifth of the sheet.
fn scale_bar(scale: f64) -> String {
    let wanted = 0.2 * WIDTH / scale;
    let power = 10.0_f64.powf(wanted.log10().floor());
    let length = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|step| step * power)
        .find(|length| *length <= wanted)
        .unwrap_or(power);
    let (x1, y) = (WIDTH - 40.0, HEIGHT - 40.0);
    let x0 = x1 - length * scale;
    format!(
        "<path d=\"M{x0:.2} {:.2}V{y:.2}H{x1:.2}V{:.2}\" fill=\"none\" stroke=\"#444\" stroke-width=\"1.5\"/>\n\
         <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\" fill=\"#444\">{}</text>",
        y - 5.0,
        y - 5.0,
        0.5 * (x0 + x1),
        y - 10.0,
        metres(length)
    )
}

/// A length in the unit that reads best.
fn metres(length: f64) -> String {
    let (factor, unit) = match length {
        _ if length >= 1.0 => (1.0, "m"),
        _ if length >= 1e-3 => (1e3, "mm"),
        _ if length >= 1e-6 => (1e6, "µm"),
        _ => return format!("{length:.0e} m"),
    };
    format!("{:.0} {unit}", length * factor)
}
