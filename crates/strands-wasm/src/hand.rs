//! How a hand holds the rod's end, and how far an inextensible rod lets it.

use strands::coupling::VirtualCoupling;
use strands::math::{Pose, Vec3};
use strands::rod::Kinematics;
use strands::statics::Problem;
use strands_scene::ModelRod;

/// How the hand holds the rod's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandMode {
    /// As the scene has it.
    Scene,
    /// The hand imposes its frame.
    Pose,
    /// The hand holds on through a spring and damper.
    Coupling,
    /// Nobody holds it.
    Free,
}

const MODES: [(&str, HandMode); 4] = [
    ("scene", HandMode::Scene),
    ("pose", HandMode::Pose),
    ("coupling", HandMode::Coupling),
    ("free", HandMode::Free),
];

impl HandMode {
    pub fn from_name(name: &str) -> Option<Self> {
        MODES.iter().find(|(known, _)| *known == name).map(|(_, mode)| *mode)
    }

    pub fn name(self) -> &'static str {
        MODES.iter().find(|(_, mode)| *mode == self).map_or("", |(name, _)| name)
    }

    /// Whether the hand says where the end is, and not the end where the hand is.
    pub fn leads(self) -> bool {
        matches!(self, Self::Pose | Self::Coupling)
    }
}

/// How much of its length an inextensible thread is held at, at most.
const REACH: f64 = 0.985;

/// A coupling for a scene that gives none: stiff beside the rod, and limited to ten times what buckles it.
pub fn coupling_for(rod: &ModelRod) -> VirtualCoupling {
    let scale = rod.problem.rod.scale();
    VirtualCoupling {
        linear_stiffness: 200.0 * scale.force / scale.length,
        angular_stiffness: 20.0 * scale.moment,
        linear_damping: 0.0,
        angular_damping: 0.0,
        max_force: 400.0 * scale.force,
        max_torque: 40.0 * scale.moment,
    }
}

/// Where the end of a rod can be held for a hand.
pub fn reachable(rod: &ModelRod, hand: &Pose) -> Pose {
    let Problem { rod, start, .. } = &rod.problem;
    let tethered = rod.kinematics() == Kinematics::Kirchhoff && start.fixed[3..] == [true; 3];
    if tethered { within(hand, start.pose.position, REACH * rod.length()) } else { *hand }
}

/// A place that an inextensible thread can be held at: pulled tight, it is a boundary layer at either end and nothing in between, which
/// no search from one end resolves.
fn within(hand: &Pose, base: Vec3, reach: f64) -> Pose {
    let arm = hand.position - base;
    let distance = arm.norm();
    if distance <= reach { *hand } else { Pose { position: base + arm * (reach / distance), ..*hand } }
}
