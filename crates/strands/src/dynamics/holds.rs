//! What holds frames while a step goes on.
//!
//! A support that is elsewhere than where its frame is has moved since the last step, and does so evenly: at a stage in the middle of the step it is
//! in between. So does the hand of a grip, whose damper looks back on where hand and frame were. A support with keyframes is where these say.

use super::Simulation;
use crate::assembly::{Assembly, Member};
use crate::coupling::LastFrame;
use crate::math::Pose;
use crate::statics::{Support, meet};

/// A support that moves during a step, and the frame it holds.
struct Moving {
    member: Member,
    frame: usize,
    /// Which keyframes say where it is.
    planned: Option<usize>,
    /// Where it is at the step's end.
    target: Pose,
    /// Where the frame is at the beginning, and where it has to be at the end.
    from: Pose,
    to: Pose,
    hand: Option<Hand>,
}

/// A hand that holds on through a coupling.
struct Hand {
    /// Where it is at the step's end, and at its beginning.
    target: Pose,
    before: Pose,
}

/// All supports of a step that moves some of them.
pub(super) struct Held {
    moving: Vec<Moving>,
    /// When the whole step began, and how long it is, s.
    began: f64,
    step: f64,
}

impl Held {
    pub fn begin(simulation: &mut Simulation) -> Self {
        put_as_planned(&mut simulation.assembly, simulation.state.time + simulation.work.step);
        let Simulation { assembly, state, .. } = simulation;
        let mut moving = Vec::new();
        for member in held(assembly) {
            let (Some(frame), Some(support)) = (assembly.frame(member), assembly.support(member)) else {
                continue;
            };
            let pose = state.poses[frame];
            let to = meet(support, &pose);
            let hand = support.grip.map(|grip| {
                let before = grip.last.map_or(grip.hand, |last| last.hand);
                Hand { target: grip.hand, before }
            });
            if hand.is_some() || pose.between(&to).log().max_abs() > 0.0 {
                let planned = assembly.moving.iter().position(|keyframes| keyframes.member == member);
                moving.push(Moving { member, frame, planned, target: support.pose, from: pose, to, hand });
            }
        }
        Self { moving, began: simulation.state.time, step: simulation.work.step }
    }

    /// Puts all where they are when a part of the step is over, for the stage that has been set up.
    pub fn at(&self, part: f64, simulation: &mut Simulation) {
        self.put(part, simulation, true);
    }

    /// Puts all evenly between where they are at the step's beginning and end.
    pub fn halfway(&self, part: f64, simulation: &mut Simulation) {
        self.put(part, simulation, false);
    }

    fn put(&self, part: f64, simulation: &mut Simulation, as_planned: bool) {
        let Simulation { assembly, work, .. } = simulation;
        for moving in &self.moving {
            let planned = moving.planned.filter(|_| as_planned);
            let planned = planned.map(|at| assembly.moving[at].at(self.began + part * self.step));
            let Some(support) = assembly.support_mut(moving.member) else { continue };
            let between = moving.from.towards(&moving.to, part);
            let moved = || between.compose(&moving.to.inverse()).compose(&moving.target);
            support.pose = planned.unwrap_or_else(moved);
            if let (Some(hand), Some(grip)) = (&moving.hand, &mut support.grip) {
                // The damper looks back to where the frame would be, were its rate of this stage nought.
                let (held, since) = work.stage.without_rate(moving.frame);
                let hand_at = |part: f64| hand.before.towards(&hand.target, part);
                grip.hand = hand_at(part);
                grip.last =
                    Some(LastFrame { hand: hand_at(part - since / self.step), held, time_step: since });
            }
        }
    }

    /// Puts all where they are at the step's end.
    pub fn end(self, simulation: &mut Simulation) {
        let Simulation { assembly, state, .. } = simulation;
        for moving in &self.moving {
            let Some(support) = assembly.support_mut(moving.member) else { continue };
            support.pose = moving.target;
            if let (Some(hand), Some(grip)) = (&moving.hand, &mut support.grip) {
                grip.hand = hand.target;
                let held = state.poses[moving.frame];
                grip.last = Some(LastFrame { hand: hand.target, held, time_step: self.step });
            }
        }
    }
}

/// Puts supports with keyframes where these say that they are at a time, s.
pub(super) fn put_as_planned(assembly: &mut Assembly, time: f64) {
    for at in 0..assembly.moving.len() {
        let keyframes = &assembly.moving[at];
        let (member, pose) = (keyframes.member, keyframes.at(time));
        if let Some(support) = assembly.support_mut(member) {
            support.pose = pose;
        }
    }
}

/// All frames that are held.
fn held(assembly: &Assembly) -> Vec<Member> {
    let rods = assembly.strands.iter().enumerate().flat_map(|(rod, strand)| {
        let held = strand.problem.supports().filter(|(_, support)| Support::holds_anything(support));
        held.map(move |(node, _)| Member::Node { rod, node })
    });
    let bodies = assembly.bodies.iter().enumerate();
    let bodies = bodies.filter(|(_, body)| body.support.as_ref().is_some_and(Support::holds_anything));
    rods.chain(bodies.map(|(body, _)| Member::Body(body))).collect()
}
