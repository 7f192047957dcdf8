//! Elements that are too long for the shape, or shorter than there is any use for.

use super::numbers::{rest_curvature, thickness};
use super::{Remarks, View, metres};
use crate::MeshChoice;
use strands::rod::Rod;

/// Fewer elements than this are told of.
const FEW: usize = 4;

/// The shortest and the longest element, m.
pub(super) fn element_lengths(rod: &Rod) -> [f64; 2] {
    let lengths = (0..rod.elements()).map(|e| rod.element_length(e));
    lengths.fold([f64::INFINITY, 0.0], |[short, long], h| [short.min(h), long.max(h)])
}

pub(super) fn look(remarks: &mut Remarks<'_>, view: &View<'_>) {
    // A mesh that is chosen for a tolerance is not yet there.
    if let MeshChoice::Tolerance(_) = view.rod.mesh {
        return;
    }
    let rod = &view.rod.problem.rod;
    let [shortest, longest] = element_lengths(rod);
    let (curvature, s) = rest_curvature(rod);
    let at = rod.mesh().nodes().partition_point(|node| *node < s).max(1) - 1;
    let here = rod.element_length(at);
    let key = view.mesh_key();
    if here * curvature > 1.0 {
        let needed = (4.0 * rod.length() * curvature).ceil();
        remarks.warn(
            &key,
            format!(
                "an element at s = {} is {} long, and the rod at rest is curved there to a radius of {}",
                metres(s),
                metres(here),
                metres(1.0 / curvature)
            ),
            format!("use elements a quarter as long as the radius: `elements = {needed}`"),
        );
    } else if rod.elements() < FEW {
        remarks.note(
            &key,
            format!("the rod has {} elements", rod.elements()),
            "a shape that bends takes 20 or more; 100 is a good number to begin with",
        );
    }
    if let Some(thickness) = thickness(rod).filter(|thickness| longest < *thickness) {
        remarks.note(
            &key,
            format!(
                "elements of {} are shorter than the rod is thick, {}",
                metres(shortest),
                metres(thickness)
            ),
            "fewer do as well, unless the shape asks for them",
        );
    }
}
