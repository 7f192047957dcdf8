//! How a place of a rod, or a body, is held, and how what holds it moves.

use strands::assembly::{Keyframes, Member};
use strands::math::{Mat3, Pose, Vec3};
use strands::statics::Support;

/// How a place of a rod is held, apart from any mesh, or a body. Targets that are not given are where the rod is in its initial shape, or unloaded where
/// it has none, on whichever mesh, or the body at rest.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    /// Where along the rod, m; 0 for a body.
    pub s: f64,
    pub fixed: [bool; 6],
    pub target: Target,
    /// Where it is at growing times, s, as far as that is not its target.
    pub motion: Vec<(f64, Target)>,
    pub slide_along: Option<Vec3>,
    pub turn_about: Option<Vec3>,
}

/// Where something is held, as far as that is given.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Target {
    /// x, y and z.
    pub position: [Option<f64>; 3],
    /// The frame.
    pub rotation: Option<Mat3>,
}

impl Held {
    /// A place that nothing holds.
    pub fn free(s: f64) -> Self {
        Self {
            s,
            fixed: [false; 6],
            target: Target::default(),
            motion: Vec::new(),
            slide_along: None,
            turn_about: None,
        }
    }

    /// The support as it is at the beginning, of what has the frame `rest` where nothing acts on it.
    pub fn support(&self, rest: Pose) -> Support {
        // Which member it is does not matter here.
        let keyframes = self.keyframes(Member::Body(0), rest);
        let pose = keyframes.map_or_else(|| self.target.of(rest), |keyframes| keyframes.at(0.0));
        let mut support = Support::of(self.fixed, pose);
        if let Some(axis) = self.slide_along {
            support = support.sliding_along(axis);
        }
        if let Some(axis) = self.turn_about {
            support = support.turning_about(axis);
        }
        support
    }

    /// How it moves; `None` where it stands still.
    pub fn keyframes(&self, member: Member, rest: Pose) -> Option<Keyframes> {
        let target = self.target.of(rest);
        let frames: Vec<_> = self.motion.iter().map(|(time, then)| (*time, then.of(target))).collect();
        (!frames.is_empty()).then_some(Keyframes { member, frames })
    }
}

impl Target {
    /// The frame, where what is not given is as in another.
    fn of(&self, other: Pose) -> Pose {
        let mut pose = Pose { rotation: self.rotation.unwrap_or(other.rotation), ..other };
        for (i, target) in self.position.iter().enumerate() {
            pose.position[i] = target.unwrap_or(pose.position[i]);
        }
        pose
    }
}
