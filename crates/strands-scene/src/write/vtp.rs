//! VTK's XML PolyData, for ParaView and PyVista: one line cell an element.

use super::{Shape, Solved};
use crate::model::Model;
use std::fmt::Write;
use strands::math::Vec3;
use strands::statics::{Solution, UnstableMode};

/// The solutions as a `.vtp` file.
///
/// Point data: `s` (m), directors `d1`, `d2`, `d3`, `radius` (half the larger extent of the section, m), and, where an equilibrium is unstable,
/// `mode_rotation` (rad) and `mode_displacement` (m) of the mode in which it falls, zero where it is stable. Cell data: `rod` (its number),
/// `curvature_twist` (1/m), `stretch_shear`, `moment` (N·m) and `force` (N), each in body axes.
pub fn vtp(model: &Model, solutions: &[(&str, &Solution)]) -> String {
    let solved = Solved::all(model, solutions);
    let mut more = Vec::new();
    let modes: Vec<_> = solved.iter().map(Solved::unstable_mode).collect();
    if modes.iter().any(Option::is_some) {
        let of_mode = |of: fn(&UnstableMode) -> &[Vec3]| {
            let nodes = solved.iter().zip(&modes).flat_map(move |(rod, mode)| {
                let vectors = mode.as_ref().map(of);
                (0..rod.solution.poses.len()).map(move |i| vectors.map_or(Vec3::ZERO, |vectors| vectors[i]))
            });
            nodes.flat_map(Vec3::to_array)
        };
        more.push(array("Float64", "mode_rotation", 3, of_mode(|mode| &mode.rotation)));
        more.push(array("Float64", "mode_displacement", 3, of_mode(|mode| &mode.displacement)));
    }
    let shapes: Vec<(usize, Shape)> = solved.iter().map(Solved::shape).enumerate().collect();
    poly_data(&shapes, &more)
}

/// Rods by their numbers, with more arrays at their nodes.
pub(super) fn poly_data(shapes: &[(usize, Shape<'_>)], more: &[String]) -> String {
    let nodes = || {
        shapes
            .iter()
            .flat_map(|(_, shape)| shape.poses.iter().zip(shape.s()).zip(shape.rod.problem.rod.half_extent()))
    };
    let strain = || shapes.iter().flat_map(|(_, shape)| shape.strain);
    let stress = || shapes.iter().flat_map(|(_, shape)| shape.stress);
    let (points, cells) = (nodes().count(), strain().count());
    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n",
    );
    let mut line = |text: String| out.extend([text.as_str(), "\n"]);
    line(format!("<Piece NumberOfPoints=\"{points}\" NumberOfLines=\"{cells}\">"));
    line("<Points>".into());
    line(array("Float64", "position", 3, nodes().flat_map(|((pose, _), _)| pose.position.to_array())));
    line("</Points>\n<Lines>".into());
    line(array("Int64", "connectivity", 1, connectivity(shapes)));
    line(array("Int64", "offsets", 1, (1..=cells).map(|cell| 2 * cell)));
    line("</Lines>\n<PointData>".into());
    line(array("Float64", "s", 1, nodes().map(|((_, s), _)| *s)));
    for (i, name) in ["d1", "d2", "d3"].into_iter().enumerate() {
        line(array("Float64", name, 3, nodes().flat_map(|((pose, _), _)| pose.rotation.cols[i].to_array())));
    }
    line(array("Float64", "radius", 1, nodes().map(|(_, half)| half[0].max(half[1]))));
    more.iter().for_each(|array| line(array.clone()));
    line("</PointData>\n<CellData>".into());
    let rods = shapes.iter().flat_map(|(number, shape)| shape.strain.iter().map(move |_| *number));
    line(array("Int64", "rod", 1, rods));
    line(array("Float64", "curvature_twist", 3, strain().flat_map(|strain| strain.angular.to_array())));
    line(array("Float64", "stretch_shear", 3, strain().flat_map(|strain| strain.linear.to_array())));
    line(array("Float64", "moment", 3, stress().flat_map(|stress| stress.angular.to_array())));
    line(array("Float64", "force", 3, stress().flat_map(|stress| stress.linear.to_array())));
    line("</CellData>\n</Piece>\n</PolyData>\n</VTKFile>".into());
    out
}

/// The two nodes of every element, counted over all rods.
fn connectivity(shapes: &[(usize, Shape<'_>)]) -> Vec<usize> {
    let mut pairs = Vec::new();
    let mut first = 0;
    for (_, shape) in shapes {
        pairs.extend((0..shape.strain.len()).flat_map(|e| [first + e, first + e + 1]));
        first += shape.poses.len();
    }
    pairs
}

/// An array of numbers, so many a line.
pub(super) fn array<T: std::fmt::Debug>(
    kind: &str,
    name: &str,
    components: usize,
    values: impl IntoIterator<Item = T>,
) -> String {
    let mut out = format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for (i, value) in values.into_iter().enumerate() {
        let gap = if i % components == 0 { '\n' } else { ' ' };
        write!(out, "{gap}{value:?}").unwrap_or_else(|error| unreachable!("in memory: {error}"));
    }
    out + "\n</DataArray>"
}
