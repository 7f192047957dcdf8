//! What the elements bear in a shape that is known by its frames and by the wrenches that it carries, at rest or in motion.

use super::Rod;
use crate::element::mean_wrench;
use crate::math::{Pose, Strain, Stress, Vec6, Wrench};

impl Rod {
    /// The strains and stresses of the elements between nodes at these frames, body frame. `wrenches` are those that the elements carry through their
    /// far nodes, in those nodes' frames.
    ///
    /// With the exponent `x` of the relative pose of an element's nodes, its strain is `x` over its length, constant along it, and its stress the mean
    /// `T(x)ᵀ w` of the wrench that it carries, damping with it. In an equilibrium of elements of order 2 they are those of a
    /// [`Solution`](crate::statics::Solution).
    pub fn strains_and_stresses(&self, poses: &[Pose], wrenches: &[Wrench]) -> (Vec<Strain>, Vec<Stress>) {
        let of_element =
            |(e, x): (usize, Vec6)| (x * (1.0 / self.element_length(e)), mean_wrench(x, wrenches[e]));
        exponents(poses).enumerate().map(of_element).unzip()
    }
}

/// The exponents of the elements between nodes at these frames.
pub(crate) fn exponents(poses: &[Pose]) -> impl Iterator<Item = Vec6> {
    poses.windows(2).map(|pair| pair[0].between(&pair[1]).log())
}
