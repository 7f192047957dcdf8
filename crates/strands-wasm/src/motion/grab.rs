//! A hand that has grabbed a node of a rod: it holds on through a spring and a damper, as stiff and as heavy as the rod needs.
//!
//! Where nothing held the node firmly the spring only holds its place, and the node can turn. Where something did, the hand has taken that over: it
//! holds turns too, and on release the node is held as before where it has been brought to.

use super::rods::Rods;
use strands::coupling::{Grip, VirtualCoupling};
use strands::math::{Pose, Vec3};
use strands::statics::{Problem, Support};

/// How fast the whole rod would swing on the spring, rad/s: it hangs a millimetre below the hand.
const FREQUENCY: f64 = 100.0;
/// The spring over the rod's own stiffness, `EI/L³` and `EI/L`: a bent rod hardly pulls it out, or turns it.
const OVER_STIFFNESS: [f64; 2] = [200.0, 2000.0];
/// How much stiffer it is where it takes over from what held the node firmly: so much that it pulls a knot tight.
const FIRMER: f64 = 100.0;
/// How far ahead of the node the hand gets, over the rod's length: out of reach it pulls no harder.
const LEASH: f64 = 0.05;
/// How soon the hand is where the pointer is, s: it follows as a critically damped spring would, since pointers come in leaps from frame to frame.
const FOLLOWS: f64 = 0.02;
/// How far away the hand sees the pointer at most, over the rod's length. It moves that far in twice that time at most.
const SIGHT: f64 = 0.5;

/// A hold on a node.
pub struct Grab {
    pub rod: usize,
    pub node: usize,
    /// Where the hand is to go.
    pub target: Pose,
    /// What held the node before.
    before: Option<Support>,
    /// Of the hand, m/s.
    velocity: Vec3,
    /// Of the rod, m.
    length: f64,
}

impl Grab {
    /// Takes hold of a node where it is; `None` where there is no such node.
    pub fn of(rods: &mut Rods, rod: usize, node: usize) -> Option<Self> {
        let problem = rods.problem(rod).filter(|problem| node <= problem.rod.elements())?;
        let firmly = problem.support(node).is_some_and(|support| support.fixed[..3].contains(&true));
        let (coupling, length) = (coupling(problem, firmly), problem.rod.length());
        let hand = rods.pose(rod, node);
        let before = rods.hold(rod, node, Some(Support::gripped(Grip { coupling, hand, last: None })));
        Some(Self { rod, node, target: hand, before, velocity: Vec3::ZERO, length })
    }

    /// Moves the hand towards its target for the next step.
    pub fn follow(&mut self, rods: &mut Rods) {
        let (time_step, held) = (rods.time_step(), rods.pose(self.rod, self.node));
        let Some(grip) = rods.grip_mut(self.rod, self.node) else { return };
        let hand = grip.hand;
        let seen = within(hand.position, SIGHT * self.length, self.target.position);
        // Of `x'' = (seen - x) / τ² - 2 x' / τ` a step of backward Euler.
        let rate = time_step / FOLLOWS;
        let velocity = (self.velocity + (seen - hand.position) * (rate / FOLLOWS))
            * (1.0 / ((1.0 + rate) * (1.0 + rate)));
        let position = within(held.position, LEASH * self.length, hand.position + velocity * time_step);
        self.velocity = (position - hand.position) * (1.0 / time_step);
        let turned = hand.towards(&self.target, 1.0 - (-rate).exp());
        grip.hand = Pose { position, ..turned };
    }

    /// Where the rod cannot be pulled along so hard, the hand slips: it holds the node where it is, and begins to pull anew.
    pub fn slip(&mut self, rods: &mut Rods) {
        self.velocity = Vec3::ZERO;
        let hand = rods.pose(self.rod, self.node);
        if let Some(grip) = rods.grip_mut(self.rod, self.node) {
            (grip.hand, grip.last) = (hand, None);
        }
    }

    /// The force that the spring exerts on the rod.
    pub fn force(&self, rods: &Rods) -> Vec3 {
        let held = rods.pose(self.rod, self.node);
        let spring = rods.grip(self.rod, self.node).map(|grip| Grip { last: None, ..*grip });
        spring.map_or(Vec3::ZERO, |spring| spring.wrench(&held).linear)
    }

    /// Lets go.
    pub fn let_go(self, rods: &mut Rods) {
        let pose = rods.pose(self.rod, self.node);
        rods.hold(self.rod, self.node, self.before.map(|before| Support { pose, ..before }));
    }
}

/// A place no farther than that from another.
fn within(from: Vec3, most: f64, to: Vec3) -> Vec3 {
    let distance = (to - from).norm();
    if distance <= most { to } else { from + (to - from) * (most / distance) }
}

/// A spring and damper for a rod, near critical damping of all of it.
fn coupling(problem: &Problem, firmly: bool) -> VirtualCoupling {
    let (rod, scale) = (&problem.rod, problem.rod.scale());
    let mass = rod.mass();
    let soft = mass * FREQUENCY * FREQUENCY + OVER_STIFFNESS[0] * scale.force / scale.length;
    let linear_stiffness = if firmly { FIRMER * soft } else { soft };
    let angular_stiffness = if firmly { OVER_STIFFNESS[1] * scale.moment } else { 0.0 };
    VirtualCoupling {
        linear_stiffness,
        angular_stiffness,
        linear_damping: 2.0 * (linear_stiffness * mass).sqrt(),
        angular_damping: 2.0 * angular_stiffness / FREQUENCY,
        max_force: f64::INFINITY,
        max_torque: f64::INFINITY,
    }
}
