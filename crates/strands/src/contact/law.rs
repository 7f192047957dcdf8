//! What two surfaces that touch exert on each other: Signorini's law and Coulomb's, as equations for Newton's method.
//!
//! Of a normal force `λ` and a gap `g` each is nought or more, and one of them nought. That is `λ = max(λ − ρ g, 0)` for any `ρ`; smoothed (Chen & Mangasarian 1993),
//! `λ = (z + √(z² + 4ε²))/2` with `z = λ − ρ g`, it is `λ ρ g = ε²`: of the sort of a barrier, but solved for the force too. Surfaces give way
//! to a load by `d λ/(λ₀ + λ)`, so much less is the gap. The friction is the projection of
//! `a − κ u` onto the disk of radius `μ λ`, with `u` the slip since the step began and `a` what the friction was when all else was solved last; where that is found
//! again and again nothing slips by however little as long as it sticks (augmented Lagrangian, Alart & Curnier 1991). Both are implicit in the step.

use crate::math::{Mat3, Vec3};

/// How much softer than `ρ`, over it, what is pressed is in one iteration; the force itself makes up for it in the next ones.
const LENT: f64 = 1e-5;
/// The stiffness `κ` against slip over `ρ` at first; each time friction is told anew so many times more, up to some most.
const STICKING: f64 = 30.0;
const MORE: f64 = 10.0;
const MOST: f64 = 3e5;

/// The numbers of a contact's laws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    /// The coefficient of friction.
    pub friction: f64,
    /// The stiffness `ρ`, N/m: about that of what is pressed.
    pub stiffness: f64,
    /// The smoothing `ε`, N.
    pub smoothing: f64,
    /// How far surfaces give way at most, m, and the load that takes half of it, N.
    pub gives: f64,
    pub load: f64,
    /// The stiffness `κ`, N/m.
    sticking: f64,
}

/// What is known of a contact where it is looked at: what presses it, N, from where its friction is told, N, and how much that bears at most, N, where it is told that too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Multipliers {
    pub pressed: f64,
    pub anchor: Vec3,
    pub bound: Option<f64>,
}

impl Multipliers {
    pub const NONE: Self = Self { pressed: 0.0, anchor: Vec3::ZERO, bound: None };
}

/// The force of a contact, and how it is to change: by so much at once, and by so much with a shift of one side against the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Response {
    pub force: Vec3,
    pub friction: Vec3,
    pub pull: Vec3,
    /// What resists, N/m: the force changes by as much less.
    pub stiffness: Mat3,
    /// What the law of the normal force is off by, m.
    pub off: f64,
    /// The slip, m, and by how much slips what sticks.
    pub slip: Vec3,
    pub slips: f64,
}

impl Law {
    pub fn new(friction: f64, stiffness: f64, smoothing: f64, (gives, load): (f64, f64)) -> Self {
        Self { friction, stiffness, smoothing, gives, load, sticking: STICKING * stiffness }
    }

    /// Lets what is known to press slide after a slip of no more than so much, m.
    pub fn slides_after(&mut self, slip: f64, pressed: f64) {
        self.sticking = self.sticking.max(self.friction * pressed / slip);
    }

    /// The same without friction.
    pub fn smooth(self) -> Self {
        Self { friction: 0.0, ..self }
    }

    /// Lets what sticks slip less.
    pub fn sticks_more(&mut self) {
        self.sticking = (MORE * self.sticking).min(MOST * self.stiffness);
    }

    /// On the first side, with the normal from the second to the first, the gap, and the slip of the first side against the second; and how it responded before in
    /// the same search. It may be known to stick.
    pub fn respond(
        &self,
        known: &Multipliers,
        normal: Vec3,
        gap: f64,
        slip: Vec3,
        before: Option<&(Response, f64)>,
        sticks: bool,
    ) -> Response {
        let Self { friction, stiffness: rho, smoothing, gives, load, sticking: kappa } = *self;
        let pressed = known.pressed;
        let given = gives * pressed / (load + pressed);
        let by_force = gives * load / ((load + pressed) * (load + pressed));
        let z = pressed - rho * (gap + given);
        let root = (z * z + 4.0 * smoothing * smoothing).sqrt();
        // Without cancellation where it is nearly nought.
        let projected = if z > 0.0 { 0.5 * (z + root) } else { 2.0 * smoothing * smoothing / (root - z) };
        let touches = projected / root;
        let soft = (1.0 - touches + touches * rho * by_force).max(LENT);
        let by_gap = rho * touches / soft;
        let pull = (projected - pressed) / soft;
        let across = Mat3::IDENTITY - Mat3::outer(normal, normal);
        let mut response = Response {
            force: normal * pressed,
            friction: Vec3::ZERO,
            pull: normal * pull,
            stiffness: Mat3::outer(normal, normal).scaled(by_gap),
            off: (projected - pressed).abs() / rho,
            slip: across * slip,
            slips: 0.0,
        };
        if friction == 0.0 {
            return response;
        }
        let slip = response.slip;
        let tried = across * known.anchor - slip * kappa;
        // What is told does not follow what presses.
        let follows = if known.bound.is_none() { friction } else { 0.0 };
        let (size, bound) = (tried.norm(), known.bound.unwrap_or(friction * pressed.max(0.0)));
        if sticks || size <= bound {
            response.friction = tried;
            response.stiffness = response.stiffness + across.scaled(kappa);
            response.slips = slip.norm();
        } else {
            let way = tried * (1.0 / size);
            let other = normal.cross(way);
            response.friction = way * bound;
            response.pull += way * (follows * pull);
            // Where it slid the other way before, the answer is between: along the secant.
            let turned = before.filter(|(before, _)| before.friction.dot(way) < 0.0);
            let secant = turned.map_or(0.0, |(before, counts)| {
                let gone = (slip - before.slip).norm();
                counts * ((response.friction - before.friction).norm() / gone.max(bound / kappa)).min(kappa)
            });
            response.stiffness = response.stiffness
                + Mat3::outer(way, way).scaled(secant)
                + Mat3::outer(way, normal).scaled(follows * by_gap)
                + Mat3::outer(other, other).scaled(kappa * bound / size);
        }
        response.force += response.friction;
        response
    }
}
