//! Rods against walls without friction: how far they touch, and how hard they press.

use super::set_up::{Thread, at_rest, framed, free, settled};
use core::f64::consts::PI;
use strands::assembly::{Assembly, Member};
use strands::contact::{Obstacle, Shape, Surfaces};
use strands::dynamics::Simulation;
use strands::load::NodalLoads;
use strands::math::{Pose, Vec3};
use strands::rod::Section;
use strands::statics::{Problem, Support};

fn smooth(problem: Problem, walls: &[Shape]) -> Assembly {
    let obstacle =
        |shape: &Shape| Obstacle { shape: shape.clone(), friction: None, body: None, tissue: None };
    let obstacles = walls.iter().map(obstacle).collect();
    Assembly { surfaces: Some(Surfaces { friction: 0.0 }), obstacles, ..problem.into() }
}

/// Where it presses, and how hard.
fn pressed(simulation: &Simulation) -> Vec<(Vec3, f64)> {
    simulation.state().contacts.iter().map(|contact| (contact.point, contact.force.norm())).collect()
}

/// A rod about a post, pulled at both ends: how hard, N, and how far the ends' ways are apart. It is cut into elements of such a part of the post's radius. Gives the angle over
/// which it touches, the force where that begins, N, and the force on a length between, N/m.
fn about_a_post(tension: f64, turn: f64, part: f64) -> [f64; 3] {
    const RADIUS: f64 = 5e-4;
    let modulus = BENDING / (PI * RADIUS.powi(4) / 4.0);
    let thread = Thread { radius: RADIUS, modulus, poisson: 0.3, density: 1000.0 };
    let bent = (BENDING / tension).sqrt();
    let length = 14.0 * bent + ARC * turn;
    let near = length - 11.0 * bent;
    let count = |length: f64, element: f64| (length / element).ceil() as usize;
    let tail = count(5.5 * bent, bent / 6.0);
    let pieces =
        [(5.5 * bent, tail), (length - 5.5 * bent, 2 * count(0.5 * near, ARC * part)), (length, tail)];
    // The post is along y, and the middle of the rod above it.
    let place = |s: f64| {
        let from_middle = s - 0.5 * length;
        let angle = (from_middle / ARC).clamp(-0.5 * turn, 0.5 * turn);
        let (sin, cos) = angle.sin_cos();
        Vec3::new(cos, 0.0, sin) * (1.001 * ARC) + Vec3::new(-sin, 0.0, cos) * (from_middle - ARC * angle)
    };
    let rod = thread.rod(Pose::IDENTITY, &pieces);
    let places: Vec<Vec3> = rod.mesh().nodes().iter().map(|s| place(*s)).collect();
    let poses = framed(&places, Vec3::Y);
    let rod = thread.rod(poses[0], &pieces);
    let (elements, middle) = (rod.elements(), rod.elements() / 2);
    let mut loads = NodalLoads::none(&rod);
    for (node, side) in [(0, -1.0), (elements, 1.0)] {
        let (sin, cos) = (0.5 * turn).sin_cos();
        loads.world[node].linear += Vec3::new(-sin, 0.0, side * cos) * tension;
    }
    // Else it might slide about the post and along it.
    let held = Support::of([false, false, false, false, true, true], poses[middle]);
    let element = rod.element_length(middle);
    let problem = Problem { loads, between: vec![(middle, held)], ..free(rod) };
    // Surfaces rest a hundredth of the radius apart.
    let ends = [-0.1, 0.1].map(|y| Vec3::new(0.0, y, 0.0));
    let assembly = smooth(problem, &[Shape::Cylinder { ends, radius: ARC - 1.01 * RADIUS }]);
    let state = at_rest(&assembly, poses);
    let slow = 50.0 * bent * bent * (thread.density * PI * RADIUS * RADIUS / BENDING).sqrt();
    let touches: Vec<(f64, f64)> = pressed(&settled(&assembly, state, slow))
        .into_iter()
        .filter(|(_, force)| *force > 1e-4 * tension)
        .map(|(point, force)| (point.z.atan2(point.x), force))
        .collect();
    let widest = touches.iter().map(|(angle, _)| angle.abs()).fold(0.0, f64::max);
    let between = touches.iter().filter(|(angle, _)| angle.abs() < 0.5 * widest);
    let mut between: Vec<f64> = between.map(|(_, force)| *force).collect();
    between.sort_by(f64::total_cmp);
    let sum: f64 = touches.iter().map(|(_, force)| force).sum();
    if between.len() < 5 {
        return [2.0 * widest, 0.5 * sum, 0.0];
    }
    let pressure = between[between.len() / 2] / element;
    // A force at each end of the arc and what is between have the same sum and the same second moment.
    let second: f64 = touches.iter().map(|(angle, force)| force * angle * angle).sum();
    let on_half = |half: f64| pressure * ARC * half;
    let (mut low, mut high) = (0.0, widest + part);
    for _ in 0..60 {
        let half = 0.5 * (low + high);
        let less = half * half * (sum - 4.0 / 3.0 * on_half(half)) < second;
        *(if less { &mut low } else { &mut high }) = half;
    }
    [2.0 * low, 0.5 * sum - on_half(low), pressure]
}

/// Its axis is so far from that of the post, m, and this is its stiffness, N·m².
const ARC: f64 = 0.05;
const BENDING: f64 = 0.01;

/// By the elastica's first integral, `ψ = acos(1 − EI/(2TR²))` is the angle of the rod to its tail where it begins to touch. There the post presses with `T sin ψ`, and with
/// `T cos ψ/R` between.
#[test]
fn a_stiff_rod_about_a_post_presses_where_it_begins_to_touch() {
    for (tension, turn) in [(4.0, PI), (8.0, PI), (20.0, PI), (20.0, 0.5 * PI), (80.0, PI)] {
        let found = about_a_post(tension, turn, 1.0 / 30.0);
        let psi = (1.0 - BENDING / (2.0 * tension * ARC * ARC)).acos();
        let expected = [turn - 2.0 * psi, tension * psi.sin(), tension * psi.cos() / ARC];
        println!("{tension} N, {turn:.2}: {found:.4?} for {expected:.4?}");
        let off = |k: usize| (found[k] / expected[k] - 1.0).abs();
        assert!(
            (found[0] - expected[0]).abs() < 5e-3 && off(1) < 0.01 && off(2) < 1e-3,
            "{tension} N, {turn}: {found:?} for {expected:?}"
        );
    }
    // What is too stiff for that, or does not turn enough, touches in one place.
    for (tension, turn) in [(1.8, PI), (2.4, 0.5 * PI)] {
        let [angle, force, _] = about_a_post(tension, turn, 1.0 / 30.0);
        let expected = tension * (0.5 * turn).sin();
        println!("{tension} N, {turn:.2}: {force:.4} for {expected:.4} in {angle:.4}");
        assert!(angle < 0.05 && (force / expected - 1.0).abs() < 1e-3, "{tension} N: {angle}, {force}");
    }
}

/// A heavy rod on a table, of which one end is lifted: how high it gets, how far the rod has come off, how that end is inclined, rad, and by how much nearer it is; forces are over
/// `wL`, lengths over `L = (EI/w)^{1/3}`.
fn lifted(force: f64) -> [f64; 4] {
    let steel = Thread { radius: 1e-3, modulus: 200e9, poisson: 0.3, density: 7850.0 };
    let weight = steel.density * 9.81 * PI * steel.radius * steel.radius;
    let unit = (steel.bending() / weight).cbrt();
    let length = 7.0 * unit;
    let base = Pose { position: Vec3::X * (1.016 * steel.radius), ..Pose::IDENTITY };
    let rod = steel.rod(base, &[(2.0 * unit, 10), (length, 100)]);
    let (poses, elements) = (rod.rest_poses(), rod.elements());
    let mut loads = NodalLoads::none(&rod).with_gravity(&rod, Vec3::X * -9.81);
    loads.world[elements].linear += Vec3::X * (force * weight * unit);
    let start = Support::clamped(base).sliding_along(Vec3::X);
    let table = Shape::Plane { point: Vec3::ZERO, normal: Vec3::X };
    let assembly = smooth(Problem { loads, start, ..free(rod) }, &[table]);
    let state = at_rest(&assembly, poses);
    let simulation = settled(&assembly, state, (unit / 9.81).sqrt());
    let poses = &simulation.state().poses;
    let end = &poses[elements];
    let lies = poses[5].position.x;
    let rise = (end.position.x - lies) / unit;
    let nearer = (length - (end.position.z - poses[0].position.z)) / unit;
    // What has come off bears nothing; where that begins it rises by `R₀ s³/6`, with a force R₀ of the table.
    let nodes = simulation.assembly().strands[0].problem.rod.mesh().nodes();
    let off = (0..=elements).find(|i| poses[*i].position.x > lies + 1e-6 * unit).unwrap();
    let mut come_off = (length - nodes[off]) / unit;
    for _ in 0..20 {
        let above = (poses[off].position.x - lies) / unit;
        come_off = (length - nodes[off]) / unit + (6.0 * above / (come_off - force)).cbrt();
    }
    [rise, come_off, end.rotation.cols[2].x.asin(), nearer]
}

/// The elastica of a half-infinite rod that leaves a plane with neither slope nor curvature, by collocation and by a method of order 8 alike: how hard, how high,
/// how far it has come off, the inclination and how much nearer.
#[test]
fn a_heavy_rod_is_lifted_off_a_table() {
    for (force, expected) in [
        (0.500346462, [0.04158288, 1.0, 0.08320415, 0.001285601]),
        (1.039107660, [0.59486644, 2.0, 0.60952511, 0.137665148]),
        (1.825167562, [1.74633905, 3.0, 1.27582424, 0.930127478]),
        (2.798605795, [2.79407819, 4.0, 1.51390616, 1.956273071]),
    ] {
        let found = lifted(force);
        println!("{force:.4}: {found:.5?} for {expected:.5?}");
        for k in 0..4 {
            assert!((found[k] / expected[k] - 1.0).abs() < 0.01, "{force}: {found:?} for {expected:?}");
        }
    }
}

/// Half of a rod between walls, from a clamp to its middle, which may only go aside: pressed together by as much as is said to need so many times what buckles the rod alone. Over how
/// much of it it touches, how hard it presses where that begins and how hard it is pressed together, the latter two over what is said.
fn between_walls(over_critical: f64) -> [f64; 3] {
    const ELEMENTS: usize = 100;
    // How long it is, and how far it may go aside, m.
    const LENGTH: f64 = 0.5;
    const ASIDE: f64 = 0.01;
    // It is thin towards the walls, so that it does not go across; it touches as if it were round.
    const THIN: f64 = 5e-4;
    let steel = Thread { radius: 4.0 * THIN, modulus: 200e9, poisson: 0.3, density: 7850.0 };
    let area = PI * steel.radius * THIN;
    let bending = steel.modulus * area * THIN * THIN / 4.0;
    let k = PI / LENGTH * over_critical.sqrt();
    let load = bending * k * k;
    let place = |i: usize| {
        let s = LENGTH * i as f64 / ELEMENTS as f64;
        let x = (k * s).min(2.0 * PI);
        Vec3::new(ASIDE * (x - x.sin()) / (2.0 * PI), 0.0, s)
    };
    let places: Vec<Vec3> = (0..=ELEMENTS).map(place).collect();
    let mut poses = framed(&places, Vec3::X);
    let shorter = 3.0 * ASIDE * ASIDE * k / (8.0 * PI) + load * LENGTH / (steel.modulus * area);
    let end = Vec3::new(ASIDE, 0.0, LENGTH - shorter);
    let [start, end] = [Vec3::ZERO, end].map(|position| Pose { position, ..Pose::IDENTITY });
    (poses[0], poses[ELEMENTS]) = (start, end);
    let section = Section::Ellipse { a: THIN, b: steel.radius };
    let rod = steel.rod_of(section, start, &[(LENGTH, ELEMENTS)]);
    let (start, end) = (Support::clamped(start), Support::clamped(end).sliding_along(Vec3::X));
    let wall = |side: f64| Shape::Plane {
        point: Vec3::X * (side * (ASIDE + 1.016 * steel.radius)),
        normal: Vec3::X * -side,
    };
    let assembly = smooth(Problem { start, end, ..free(rod) }, &[wall(1.0), wall(-1.0)]);
    let slow = 0.1 * LENGTH * LENGTH * (steel.density * area / bending).sqrt();
    let simulation = settled(&assembly, at_rest(&assembly, poses), slow);
    let touches = pressed(&simulation);
    let sum: f64 = touches.iter().map(|(_, force)| force).sum();
    let mean: f64 = touches.iter().map(|(point, force)| point.z * force).sum::<f64>() / sum;
    let pressed = simulation.reaction(Member::Node { rod: 0, node: ELEMENTS }).linear.z;
    [1.0 - mean / LENGTH, sum / (load * ASIDE * k / (2.0 * PI)), -pressed / load]
}

/// Domokos, Holmes and Royce 1997, Roman and Pocheau 1999, for small slopes: from 4 to 9 times the critical load `P` it touches over `L − 4π/k`, `k² = P/EI`, and presses with
/// `P h k/2π` at both ends of that and not between; it is then shorter by `3h²k/4π`. Under a dead load it is only just in equilibrium, as what is between
/// the walls is so long that it buckles by itself.
#[test]
fn a_rod_buckles_between_walls_and_touches_along_a_line() {
    for over_critical in [4.5_f64, 5.0, 6.25, 8.0] {
        let [length, force, load] = between_walls(over_critical);
        let expected = 1.0 - 2.0 / over_critical.sqrt();
        println!("{over_critical}: {length:.4} for {expected:.4}, {force:.4} and {load:.4} for 1");
        assert!((length - expected).abs() < 5e-3, "{over_critical}: {length} for {expected}");
        assert!((force - 1.0).abs() < 5e-3 && (load - 1.0).abs() < 5e-3, "{force} {load}");
    }
}

/// A rod folded between two plates, so far apart that its axis is `FOLD` on one side from where it is on the other: how hard it presses each, N, how it is bent at the tip, 1/m, and how far that is beyond
/// where it presses, m.
fn folded() -> [f64; 3] {
    const RADIUS: f64 = 1e-4;
    let modulus = FOLDED / (PI * RADIUS.powi(4) / 4.0);
    let thread = Thread { radius: RADIUS, modulus, poisson: 0.3, density: 1000.0 };
    let (turn, leg) = (0.5 * PI * FOLD, 1.5 * FOLD);
    let length = turn + 2.0 * leg;
    let place = |s: f64| {
        let from_tip = s - 0.5 * length;
        let angle = (from_tip / (0.5 * FOLD)).clamp(-0.5 * PI, 0.5 * PI);
        let (sin, cos) = angle.sin_cos();
        let beyond = (from_tip.abs() - 0.5 * turn).max(0.0);
        Vec3::new(0.5 * FOLD * sin, 0.0, 0.5 * FOLD * cos - beyond)
    };
    const ELEMENTS: usize = 200;
    let places: Vec<Vec3> = (0..=ELEMENTS).map(|i| place(length * i as f64 / ELEMENTS as f64)).collect();
    let poses = framed(&places, Vec3::Y);
    let rod = thread.rod(poses[0], &[(length, ELEMENTS)]);
    // It might go along the plates.
    let middle = ELEMENTS / 2;
    let held = Support::of([false, false, false, false, true, true], poses[middle]);
    let problem = Problem { between: vec![(middle, held)], ..free(rod) };
    let plate = |side: f64| Shape::Plane {
        point: Vec3::X * (side * (0.5 * FOLD + 1.012 * RADIUS)),
        normal: Vec3::X * -side,
    };
    let assembly = smooth(problem, &[plate(1.0), plate(-1.0)]);
    let slow = FOLD * FOLD * (thread.density * PI * RADIUS * RADIUS / FOLDED).sqrt();
    let simulation = settled(&assembly, at_rest(&assembly, poses), slow);
    let (state, rod) = (simulation.state(), &simulation.assembly().strands[0].problem.rod);
    let (strains, _) = rod.strains_and_stresses(&state.poses, &state.wrenches);
    let touches = pressed(&simulation);
    let sum: f64 = touches.iter().map(|(_, force)| force).sum();
    let place: f64 = touches.iter().map(|(point, force)| point.z * force).sum::<f64>() / sum;
    [0.5 * sum, strains[middle].angular.norm(), state.poses[middle].position.z - place]
}

const FOLD: f64 = 0.02;
const FOLDED: f64 = 2e-4;

/// Matthewson, Kurkjian and Gulati 1986, by which the strength of optical fibres is tested: the elastica of which the ends are at right angles to the force. It presses with `EI c²/2D²`, is bent by
/// `c/D` at most, and its tip is `2D/c` beyond where it presses, `c = ∫₀^π √sin`.
#[test]
fn a_rod_folded_between_plates_is_an_elastica() {
    const C: f64 = 2.396_280_469;
    let found = folded();
    let expected = [FOLDED * C * C / (2.0 * FOLD * FOLD), C / FOLD, 2.0 * FOLD / C];
    println!("{found:.5?} for {expected:.5?}");
    for k in 0..3 {
        assert!((found[k] / expected[k] - 1.0).abs() < 0.01, "{found:?} for {expected:?}");
    }
}
