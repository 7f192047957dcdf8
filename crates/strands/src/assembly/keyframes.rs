//! Supports that move as is written beforehand.

use super::Member;
use crate::math::Pose;

/// Where a support is over time: at its keyframes there, between them along a straight line and by the shortest turn, before the first and after the
/// last at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes {
    /// Which support.
    pub member: Member,
    /// Times that grow, s, and where it then is. At least one.
    pub frames: Vec<(f64, Pose)>,
}

impl Keyframes {
    /// Where the support is at a time.
    pub fn at(&self, time: f64) -> Pose {
        let after = self.frames.partition_point(|(at, _)| *at <= time);
        let Some((began, from)) = after.checked_sub(1).map(|before| self.frames[before]) else {
            return self.frames[0].1;
        };
        let Some((ends, to)) = self.frames.get(after) else { return from };
        from.towards(to, (time - began) / (ends - began))
    }
}
