//! The march: from the frame and wrench at the rod's end, element by element, to those at its start.
//!
//! This is the paper's backward sweep, (9)–(11), with the frames carried along: since the wrench that a node's left element
//! carries is known once its right element is solved, nothing is left to iterate over but each element's own small equation. Dead
//! loads need the frame only where they act, which the march has. One pass, O(N), no allocation.

use crate::element::{self, DiagonalPoint, PointStrains, exponent, solve_diagonal};
use crate::load::NodalLoads;
use crate::math::{Kernel, Pose, Real, SimdLevel, Strain, Vec6, Wrench, dispatch};
use crate::rod::{Order, Rod};

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
    fn element(&mut self, element: usize, wrench: Wrench<R>, strain: &PointStrains<R>, relative: &Pose<R>);
    fn node(&mut self, node: usize, pose: &Pose<R>);
}

impl Watch<f64> for Record {
    #[inline(always)]
    fn element(&mut self, element: usize, wrench: Wrench, strain: &PointStrains, relative: &Pose) {
        self.wrenches[element] = wrench;
        self.strains[element] = *strain;
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
    fn element(&mut self, _: usize, _: Wrench<R>, _: &PointStrains<R>, _: &Pose<R>) {}
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
    const MULTISTEP: usize = 0;
    macro_rules! with_order {
        ($order:expr) => {
            dispatch(level, DiagonalMarch::<R, W, { $order }> { rod, points, loads, end, watch })
        };
    }
    match (scheme, rod.order()) {
        (Scheme::Multistep, _) => with_order!(MULTISTEP),
        (Scheme::Element, Order::First) => with_order!(1),
        (Scheme::Element, Order::Second) => with_order!(2),
        (Scheme::Element, Order::Fourth) => with_order!(4),
    }
}

/// The march for diagonal laws, of a fixed order (0 for the multistep scheme).
struct DiagonalMarch<'a, R: Real, W, const ORDER: usize> {
    rod: &'a Rod,
    points: &'a [DiagonalPoint],
    loads: &'a NodalLoads,
    end: Section<R>,
    watch: &'a mut W,
}

impl<R: Real, W: Watch<R>, const ORDER: usize> Kernel for DiagonalMarch<'_, R, W, ORDER> {
    type Output = Section<R>;

    #[inline(always)]
    fn run(self) -> Section<R> {
        let Self { rod, points, loads, end, watch } = self;
        let order = rod.order();
        let per_element = order.places().len();
        let nodes = rod.mesh().nodes();
        let Section { mut pose, mut wrench } = end;
        let mut history = History::new();
        watch.node(rod.elements(), &pose);
        for e in (0..rod.elements()).rev() {
            let h = nodes[e + 1] - nodes[e];
            let points = &points[e * per_element..(e + 1) * per_element];
            let strain = match ORDER {
                0 => history.multistep(h, &points[0], wrench),
                1 => solve_diagonal::<R, 1>(h, points, wrench, [Vec6::zero(); 2]),
                2 => {
                    let strain = solve_diagonal::<R, 2>(h, points, wrench, history.predict::<1>(points, wrench));
                    history.push::<1>(points, wrench, &strain);
                    strain
                }
                _ => {
                    let strain = solve_diagonal::<R, 4>(h, points, wrench, history.predict::<2>(points, wrench));
                    history.push::<2>(points, wrench, &strain);
                    strain
                }
            };
            let relative = Pose::exp(exponent(order, h, &strain));
            watch.element(e, wrench, &strain, &relative);
            wrench = relative.carry_wrench(wrench);
            pose = step_back(&pose, &relative);
            watch.node(e, &pose);
            if e > 0 {
                wrench += loads.body[e].splat() + turned(&pose, loads.world[e].splat());
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
        record.element(e, wrench, &strain, &relative);
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

/// What the last elements needed beyond `ε̂ + S w`: it changes slowly along the rod, even across loads, and so extrapolates well.
struct History<R> {
    corrections: [PointStrains<R>; 3],
    known: usize,
}

impl<R: Real> History<R> {
    #[inline(always)]
    fn new() -> Self {
        Self { corrections: [[Vec6::zero(); 2]; 3], known: 0 }
    }

    #[inline(always)]
    fn explicit(point: &DiagonalPoint, wrench: Wrench<R>) -> Strain<R> {
        point.rest.splat::<R>() + point.compliance.splat::<R>().scale(wrench)
    }

    #[inline(always)]
    fn predict<const POINTS: usize>(&self, points: &[DiagonalPoint], wrench: Wrench<R>) -> PointStrains<R> {
        let [a, b, c] = &self.corrections;
        let mut out = [Vec6::zero(); 2];
        for i in 0..POINTS {
            // Quadratic once three are known; before that the last one.
            let extrapolated =
                if self.known >= 3 { (a[i] - b[i]) * R::splat(3.0) + c[i] } else { a[i] };
            out[i] = Self::explicit(&points[i], wrench) + extrapolated;
        }
        out
    }

    #[inline(always)]
    fn push<const POINTS: usize>(&mut self, points: &[DiagonalPoint], wrench: Wrench<R>, strain: &PointStrains<R>) {
        self.corrections[2] = self.corrections[1];
        self.corrections[1] = self.corrections[0];
        for i in 0..POINTS {
            self.corrections[0][i] = strain[i] - Self::explicit(&points[i], wrench);
        }
        self.known += 1;
    }

    /// The strain of an element from those of its two neighbours; the first elements take what is known.
    #[inline(always)]
    fn multistep(&mut self, h: f64, point: &DiagonalPoint, wrench: Wrench<R>) -> PointStrains<R> {
        let (compliance, rest) = (point.compliance.splat::<R>(), point.rest.splat::<R>());
        let [a, b, _] = &self.corrections;
        let elastic = match self.known {
            0 => compliance.scale(wrench),
            1 => a[0],
            _ => a[0] * R::splat(2.0) - b[0],
        };
        let mean = element::mean_wrench((rest + elastic) * R::splat(h), wrench);
        let elastic = compliance.scale(mean);
        self.corrections[1] = self.corrections[0];
        self.corrections[0][0] = elastic;
        self.known += 1;
        [rest + elastic; 2]
    }
}
