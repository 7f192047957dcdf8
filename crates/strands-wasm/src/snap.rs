//! What is a snap: a shape far from the last one, though the hand has hardly moved.

use strands::math::Pose;

/// How far some node must have turned (rad) or moved (over the length), beyond what the hand did.
const TURN: f64 = 0.5;
const MOVE: f64 = 0.05;
/// What a hand does at most (rad, and over the length) between two frames of a drag.
const SMALL_TURN: f64 = 0.5;
const SMALL_MOVE: f64 = 0.1;

/// How a hand has moved.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    turn: f64,
    shift: f64,
}

impl Motion {
    pub fn of(from: &Pose, to: &Pose) -> Self {
        let turn = from.rotation.turn_to(&to.rotation).norm();
        Self { turn, shift: (to.position - from.position).norm() }
    }
}

/// Whether a hand has moved no further than in a frame of a drag.
pub fn is_small(from: &Pose, to: &Pose, length: f64) -> bool {
    let hand = Motion::of(from, to);
    hand.turn <= SMALL_TURN && hand.shift <= SMALL_MOVE * length
}

/// Whether a shape is so far from the one before it that the hand alone has not brought it there.
pub fn is_far(before: &[Pose], after: &[Pose], hand: Motion, length: f64) -> bool {
    before.iter().zip(after).any(|(before, after)| {
        let node = Motion::of(before, after);
        node.turn > hand.turn + TURN || node.shift > hand.shift + MOVE * length
    })
}
