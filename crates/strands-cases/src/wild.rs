//! Problems drawn at random without regard to whether anyone would pose them, to find a panic or a number that is none.
//!
//! Lengths, stiffnesses and loads over many powers of ten, rest shapes from straight to wound up, any mix of freedoms held at either end and
//! between, in any place, along and about any axis, or by a hand; any load in any frame, or towards any point; any order, method and number of
//! elements; and what may be asked of a problem beside one equilibrium. Many have no solution. Most are small and soon given up, so that there can be
//! many: what no method solves costs the more the longer they try.

mod draw;

use core::f64::consts::PI;
use draw::Draw;
use strands::load::{DistributedLoad, DistributedPull, Frame, NodalLoads, PointLoad, PointPull};
use strands::math::{Pose, Vec3, Wrench};
use strands::rod::{Kinematics, Order, Profile, Rod, RodDescription, RodError};
use strands::statics::{Method, PathSettings, Problem, Scheme, SearchSettings, Settings};

/// A problem, and what is asked of it.
#[derive(Clone, Debug)]
pub struct Question {
    /// The problem.
    pub problem: Problem,
    /// How it is to be solved.
    pub settings: Settings,
    /// What is asked beside that.
    pub more: More,
}

/// What is asked of a problem beside one equilibrium.
#[derive(Clone, Debug)]
pub enum More {
    /// Nothing.
    Nothing,
    /// The equilibrium of the problem when it has changed, from the one that was found.
    Follow(Change),
    /// The path of equilibria as it changes.
    Path(Change, PathSettings),
    /// All its equilibria.
    All(SearchSettings),
}

/// How a problem changes.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// By which part of themselves the loads grow.
    pub loads: f64,
    /// How far the end's support, or hand, moves, m.
    pub end: Vec3,
}

impl Change {
    /// The problem when a part of the change is made.
    pub fn made(&self, problem: &Problem, part: f64) -> Problem {
        let mut changed = problem.clone();
        changed.loads = problem.loads.scaled(1.0 + self.loads * part);
        changed.end.pose.position += self.end * part;
        if let Some(grip) = &mut changed.end.grip {
            grip.hand.position += self.end * part;
        }
        changed
    }
}

/// Between which powers of ten numbers are drawn that have no unit: most often those of rods that are built, and one time in four beyond.
struct Powers {
    /// The loads, over what bends the rod.
    loads: [f64; 2],
    /// The stiffness against stretching, over that against bending.
    stretch: [f64; 2],
    /// The other stiffnesses, over the softer against bending, either way.
    spread: f64,
    /// How far supports are from where the rod is at rest, at most, over its length.
    far: f64,
}

const USUAL: Powers = Powers { loads: [-2.0, 1.5], stretch: [2.0, 6.0], spread: 0.5, far: -0.4 };
const BEYOND: Powers = Powers { loads: [-4.0, 5.0], stretch: [0.0, 8.0], spread: 3.0, far: 0.3 };

/// The question of that number.
///
/// # Errors
/// Where what was drawn is no rod.
pub fn question(number: u64) -> Result<Question, RodError> {
    let mut draw = Draw::new(number);
    let powers = if draw.once_in(4) { BEYOND } else { USUAL };
    // A few are large, and are not given up before their time.
    let large = draw.once_in(50);
    let rod = rod(&mut draw, &powers, large)?;
    let scale = rod.scale();
    let (length, elements) = (rod.length(), rod.elements());
    let loads = loads(&mut draw, &powers, &rod)?;
    let rest = rod.rest_poses();
    let mut problem = Problem { loads, ..Problem::cantilever(rod) };
    if draw.once_in(3) {
        problem.start = draw.support(&rest[0], length, powers.far);
    }
    match draw.whole(0, 7) {
        0 | 1 => {}
        2 => problem.end = draw.hand(&rest[elements], length, scale.moment * length, powers.far),
        _ => problem.end = draw.support(&rest[elements], length, powers.far),
    }
    for node in 1..elements {
        if draw.once_in(4 * elements as u32) {
            problem.between.push((node, draw.support(&rest[node], length, powers.far)));
        }
    }
    let settings = settings(&mut draw, &problem, large);
    let more = more(&mut draw, settings, length);
    Ok(Question { problem, settings, more })
}

fn rod(draw: &mut Draw, powers: &Powers, large: bool) -> Result<Rod, RodError> {
    let length = draw.power(-3.0, 2.0);
    let bending = draw.power(-8.0, 4.0);
    let stretch = draw.power(powers.stretch[0], powers.stretch[1]) * bending / (length * length);
    let force = bending / (length * length);
    let weight = draw.power(powers.loads[0], powers.loads[1]) * force;
    let description = RodDescription {
        length,
        kinematics: draw.one_of(&[Kinematics::Kirchhoff, Kinematics::Cosserat]),
        profile: Profile::Given {
            law: draw.law(bending, stretch, powers.spread),
            mass_per_length: weight / (9.81 * length),
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [1e-3 * length; 2],
        },
        rest: draw.rest_shape(length, powers.spread),
        base: Pose::from_parts(draw.vector(length), draw.turn(PI)),
    };
    // An element of order 4 costs ten of the others.
    let order = match draw.whole(0, 11) {
        0 => Order::Fourth,
        1 | 2 => Order::First,
        _ => Order::Second,
    };
    let most = match order {
        _ if large => 24,
        Order::Fourth => 4,
        _ => 7,
    };
    Rod::with_elements(description, draw.whole(2, most), &[], order)
}

fn loads(draw: &mut Draw, powers: &Powers, rod: &Rod) -> Result<NodalLoads, RodError> {
    let length = rod.length();
    let force = draw.power(powers.loads[0], powers.loads[1]) * rod.scale().force;
    let mut loads = NodalLoads::none(rod);
    if draw.once_in(2) {
        loads = loads.with_gravity(rod, draw.vector(20.0));
    }
    let nodes = rod.mesh().nodes();
    let frame = draw.one_of(&[Frame::World, Frame::World, Frame::Body]);
    if draw.once_in(2) {
        let at = if draw.once_in(2) { length } else { draw.one_of(nodes) };
        let wrench = Wrench::new(draw.vector(force * length), draw.vector(force));
        loads = loads.with_point(rod, &PointLoad { at, wrench, frame })?;
    }
    let mut ends = [draw.one_of(nodes), draw.one_of(nodes)];
    ends.sort_by(f64::total_cmp);
    let [from, to] = draw.one_of(&[[0.0, length], ends]);
    if draw.once_in(4) {
        let per_length = Wrench::new(draw.vector(force), draw.vector(force / length));
        loads = loads.with_distributed(rod, &DistributedLoad { from, to, per_length, frame })?;
    }
    // One towards where a node is at rest, too.
    let place = draw.one_of(&rod.rest_poses()).position;
    let towards = if draw.once_in(8) { place } else { place + draw.vector(2.0 * length) };
    let sign = draw.one_of(&[1.0, 1.0, -1.0]);
    if draw.once_in(6) {
        let tension = sign * force;
        loads = loads.with_pull(rod, &PointPull { at: draw.one_of(nodes), towards, tension })?;
    }
    if draw.once_in(12) {
        let tension_per_length = sign * force / length;
        loads =
            loads.with_distributed_pull(rod, &DistributedPull { from, to, towards, tension_per_length })?;
    }
    // Numbers may be larger, or smaller, than any that has a meaning.
    Ok(if draw.once_in(64) { loads.scaled(draw.power(-300.0, 300.0)) } else { loads })
}

fn settings(draw: &mut Draw, problem: &Problem, large: bool) -> Settings {
    let scheme = if draw.once_in(12) { Scheme::Multistep } else { Scheme::Element };
    let methods =
        [Method::Auto, Method::Auto, Method::Shooting, Method::MultipleShooting, Method::Equilibrium];
    let mut method = if draw.once_in(16) { Method::Sweep } else { draw.one_of(&methods) };
    // What a method refuses is soon known; that it does so, a few show.
    let shoots = problem.between.is_empty() && problem.loads.pulls().is_empty();
    if (scheme == Scheme::Multistep || !shoots) && !draw.once_in(8) {
        method = Method::Auto;
    }
    let hasty = Settings { method, scheme, ..Settings::default() };
    if large {
        return hasty;
    }
    Settings { max_iterations: draw.whole(2, 8), max_halvings: draw.whole(0, 3), ..hasty }
}

fn more(draw: &mut Draw, settings: Settings, length: f64) -> More {
    let far = draw.power(-6.0, -0.5) * length;
    let change = Change { loads: draw.part() - 0.5, end: draw.vector(far) };
    match draw.whole(0, 255) {
        0 => {
            let (starts, paths) = (draw.whole(0, 12), draw.whole(0, 2));
            let solver = Settings { max_iterations: draw.whole(1, 4), ..settings };
            More::All(SearchSettings { solver, starts, paths, seed: draw.whole(0, 9) as u64 })
        }
        1..=6 => {
            let switch_at = draw.one_of(&[None, Some(0)]);
            let (largest_step, most_points) = (draw.power(-1.5, -0.3), draw.whole(2, 8));
            More::Path(change, PathSettings { solver: settings, largest_step, most_points, switch_at })
        }
        7..=38 => More::Follow(change),
        _ => More::Nothing,
    }
}
