//! The march: from the frame and wrench at the rod's end, element by element, to those at its start.
//!
//! This is the paper's backward sweep, (9)–(11), with the frames carried along: since the wrench that a node's left element
//! carries is known once its right element is solved, nothing is left to iterate over but each element's own small equation. Dead
//! loads need the frame only where they act, which the march has. One pass, O(N), no allocation.

use crate::element::{
    self, DiagonalPoint, First, Fourth, LocalSolver, Multistep, PointStrains, Second, Straight, exponent,
};
use crate::load::NodalLoads;
use crate::math::{Kernel, Pose, Real, SimdLevel, Strain, Vec3, Vec6, Wrench, dispatch};
use crate::rod::{Kinematics, Order, Rod};

use super::solution::Scheme;

/// A frame and the internal wrench in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section<R = f64> {
    /// The frame.
    pub pose: Pose<R>,
    /// The internal wrench: what the part beyond exerts on the part before, in the frame.
    pub wrench: Wrench<R>,
}

/// What a march leaves behind at each element and node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// Frames of the nodes.
    pub poses: Vec<Pose>,
    /// For each element, the internal wrench that it carries through its far node, in that node's frame.
    pub wrenches: Vec<Wrench>,
    /// The strains at each element's points.
    pub strains: Vec<PointStrains>,
    /// The frame of each element's far node as seen from its near node.
    pub relative: Vec<Pose>,
}

impl Record {
    /// Makes room for a rod; allocates only where a longer one comes.
    pub fn fit(&mut self, elements: usize) {
        if self.wrenches.len() != elements {
            self.poses.resize(elements + 1, Pose::IDENTITY);
            self.wrenches.resize(elements, Wrench::ZERO);
            self.strains.resize(elements, [Strain::ZERO; 2]);
            self.relative.resize(elements, Pose::IDENTITY);
        }
    }
}

/// Watches a march go by.
trait Watch<R: Real> {
    fn element(&mut self, element: usize, wrench: Wrench<R>, strains: [&Strain<R>; 2], relative: &Pose<R>);
    fn node(&mut self, node: usize, pose: &Pose<R>);
}

impl Watch<f64> for Record {
    #[inline(always)]
    fn element(&mut self, element: usize, wrench: Wrench, strains: [&Strain; 2], relative: &Pose) {
        self.wrenches[element] = wrench;
        self.strains[element] = strains.map(|strain| *strain);
        self.relative[element] = *relative;
    }
    #[inline(always)]
    fn node(&mut self, node: usize, pose: &Pose) {
        self.poses[node] = *pose;
    }
}

/// Keeps nothing.
struct Blind;

impl<R: Real> Watch<R> for Blind {
    #[inline(always)]
    fn element(&mut self, _: usize, _: Wrench<R>, _: [&Strain<R>; 2], _: &Pose<R>) {}
    #[inline(always)]
    fn node(&mut self, _: usize, _: &Pose<R>) {}
}

/// Marches from the end to the start of a rod and records the way. Gives the section at the start, before the first node's loads.
pub(crate) fn march(
    level: SimdLevel,
    rod: &Rod,
    scheme: Scheme,
    loads: &NodalLoads,
    end: Section,
    record: &mut Record,
) -> Section {
    record.fit(rod.elements());
    match rod.diagonal_points() {
        Some(points) => diagonal(level, rod, points, scheme, loads, end, record),
        None => general(rod, scheme, loads, end, record),
    }
}

/// Marches from several ends at once, one a lane, and keeps only where they arrive. `None` where the rod's law is not diagonal.
pub(crate) fn march_lanes<R: Real>(
    level: SimdLevel,
    rod: &Rod,
    scheme: Scheme,
    loads: &NodalLoads,
    end: Section<R>,
) -> Option<Section<R>> {
    Some(diagonal(level, rod, rod.diagonal_points()?, scheme, loads, end, &mut Blind))
}

#[inline]
fn diagonal<R: Real, W: Watch<R>>(
    level: SimdLevel,
    rod: &Rod,
    points: &[DiagonalPoint],
    scheme: Scheme,
    loads: &NodalLoads,
    end: Section<R>,
    watch: &mut W,
) -> Section<R> {
    macro_rules! with {
        ($solver:ty) => {
            dispatch(
                level,
                DiagonalMarch { rod, points, loads, end, watch, solver: <$solver as LocalSolver<R>>::new() },
            )
        };
    }
    match (scheme, rod.order(), rod.kinematics()) {
        (Scheme::Multistep, _, _) => with!(Multistep<R>),
        (Scheme::Element, Order::First, _) => with!(First),
        (Scheme::Element, Order::Second, Kinematics::Kirchhoff) => with!(Second<R, Straight<R>>),
        (Scheme::Element, Order::Second, Kinematics::Cosserat) => with!(Second<R, Vec3<R>>),
        (Scheme::Element, Order::Fourth, _) => with!(Fourth<R>),
    }
}

/// The march for diagonal laws.
struct DiagonalMarch<'a, R: Real, W, S> {
    rod: &'a Rod,
    points: &'a [DiagonalPoint],
    loads: &'a NodalLoads,
    end: Section<R>,
    watch: &'a mut W,
    solver: S,
}

impl<R: Real, W: Watch<R>, S: LocalSolver<R>> Kernel for DiagonalMarch<'_, R, W, S> {
    type Output = Section<R>;

    #[inline(always)]
    fn run(self) -> Section<R> {
        let Self { rod, points, loads, end, watch, mut solver } = self;
        let nodes = rod.mesh().nodes();
        let inner = 1..rod.elements();
        let any = |loads: &[Wrench]| loads[inner.clone()].iter().any(|load| *load != Wrench::ZERO);
        let (any_body, any_world) = (any(&loads.body), any(&loads.world));
        let Section { mut pose, mut wrench } = end;
        watch.node(rod.elements(), &pose);
        for e in (0..rod.elements()).rev() {
            let h = nodes[e + 1] - nodes[e];
            let solved = solver.next(h, &points[e * S::POINTS..(e + 1) * S::POINTS], wrench);
            watch.element(e, wrench, [&solved.strain, &solved.second], &solved.relative);
            wrench = solved.relative.carry_wrench(wrench);
            pose = step_back(&pose, &solved.relative);
            watch.node(e, &pose);
            if any_world && e > 0 {
                wrench += turned(&pose, loads.world[e].splat());
            }
            if any_body && e > 0 {
                wrench += loads.body[e].splat();
            }
        }
        Section { pose, wrench }
    }
}

/// The same for any law, in plain numbers, each element by Newton's method.
fn general(rod: &Rod, scheme: Scheme, loads: &NodalLoads, end: Section, record: &mut Record) -> Section {
    let nodes = rod.mesh().nodes();
    let Section { mut pose, mut wrench } = end;
    // Elastic strains of the last two elements.
    let mut last = [[Strain::ZERO; 2]; 2];
    record.node(rod.elements(), &pose);
    for e in (0..rod.elements()).rev() {
        let h = nodes[e + 1] - nodes[e];
        let points = rod.points(e);
        let rest: PointStrains = core::array::from_fn(|i| points[i.min(points.len() - 1)].rest);
        let guess: PointStrains = core::array::from_fn(|i| rest[i] + last[0][i]);
        let (order, driving) = match scheme {
            Scheme::Element => (rod.order(), wrench),
            Scheme::Multistep => {
                let elastic = last[0][0] * 2.0 - last[1][0];
                (Order::First, element::mean_wrench((rest[0] + elastic) * h, wrench))
            }
        };
        let strain = element::solve_general(order, rod.kinematics(), h, points, driving, guess)
            .unwrap_or([Vec6::from([f64::NAN; 6]); 2]);
        last = [core::array::from_fn(|i| strain[i] - rest[i]), last[0]];
        let relative = Pose::exp(exponent(rod.order(), h, &strain));
        record.element(e, wrench, [&strain[0], &strain[1]], &relative);
        wrench = relative.carry_wrench(wrench);
        pose = step_back(&pose, &relative);
        record.node(e, &pose);
        if e > 0 {
            wrench += loads.body[e] + turned(&pose, loads.world[e]);
        }
    }
    Section { pose, wrench }
}

/// The frame from which `relative` leads to `pose`.
#[inline(always)]
fn step_back<R: Real>(pose: &Pose<R>, relative: &Pose<R>) -> Pose<R> {
    let rotation = pose.rotation * relative.rotation.transpose();
    Pose { rotation, position: pose.position - rotation * relative.position }
}

/// A wrench in world axes, in those of a frame.
#[inline(always)]
pub(crate) fn turned<R: Real>(pose: &Pose<R>, world: Wrench<R>) -> Wrench<R> {
    Wrench::new(pose.rotation.transpose_mul(world.angular), pose.rotation.transpose_mul(world.linear))
}
