//! The march: from the frame and wrench at the rod's end, element by element, to those at its start.
//!
//! This is the paper's backward sweep, (9)–(11), with the frames carried along: since the wrench that a node's left element
//! carries is known once its right element is solved, nothing is left to iterate over but each element's own small equation. Dead
//! loads need the frame only where they act, which the march has. One pass, O(N), no allocation.

use crate::element::{
    self, DiagonalPoint, First, Fourth, LocalSolver, Multistep, PointStrains, Second, Solved, exponent,
};
use crate::load::NodalLoads;
use crate::math::{Kernel, Mat3, Pose, Real, SimdLevel, Strain, Vec3, Vec6, Vector, Wrench, dispatch};
#[cfg(target_arch = "x86_64")]
use crate::math::{Packed, with_avx2};
use crate::rod::{Order, Rod};

use super::solution::Scheme;
use core::marker::PhantomData;
use core::ops::Range;

/// A frame and the internal wrench in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section<V = Vec3> {
    /// The frame.
    pub pose: Pose<V>,
    /// The internal wrench: what the part beyond exerts on the part before, in the frame.
    pub wrench: Wrench<V>,
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
}

impl Record {
    /// Makes room for a rod; allocates only where a longer one comes.
    pub fn fit(&mut self, elements: usize) {
        if self.wrenches.len() != elements {
            self.poses.resize(elements + 1, Pose::IDENTITY);
            self.wrenches.resize(elements, Wrench::ZERO);
            self.strains.resize(elements, [Strain::ZERO; 2]);
        }
    }

    /// The wrench that the element after a node carries, in that node's frame.
    pub fn carried_beyond(&self, node: usize) -> Wrench {
        self.poses[node].between(&self.poses[node + 1]).carry_wrench(self.wrenches[node])
    }

    /// The same with what acts on the node: what the element before it carries where nothing holds the node.
    pub fn carried_with_loads(&self, node: usize, loads: &NodalLoads) -> Wrench {
        let pose = &self.poses[node];
        let world = loads.in_world(node, pose.position);
        self.carried_beyond(node) + loads.body[node] + world.turned_back_by(&pose.rotation)
    }

    /// The largest force that an element carries, N.
    pub fn largest_force(&self) -> f64 {
        self.wrenches.iter().fold(0.0, |max: f64, w| max.max(w.linear.norm()))
    }
}

/// Watches a march go by.
trait Watch<V: Vector> {
    fn element(&mut self, element: usize, h: f64, wrench: &Wrench<V>, solved: &Solved<V>);
    fn node(&mut self, node: usize, pose: &Pose<V>);
}

impl<V: Vector<Number = f64>> Watch<V> for Record {
    #[inline(always)]
    fn element(&mut self, element: usize, h: f64, wrench: &Wrench<V>, solved: &Solved<V>) {
        let per_length = 1.0 / h;
        self.wrenches[element] = numbers(wrench);
        let [first, second] = solved.points;
        self.strains[element] = [numbers(&(first * per_length)), numbers(&(second * per_length))];
    }
    #[inline(always)]
    fn node(&mut self, node: usize, pose: &Pose<V>) {
        self.poses[node] = plain(pose);
    }
}

#[inline(always)]
fn numbers<V: Vector<Number = f64>>(pair: &Vec6<V>) -> Vec6 {
    Vec6::new(pair.angular.parts().into(), pair.linear.parts().into())
}

#[inline(always)]
fn plain<V: Vector<Number = f64>>(pose: &Pose<V>) -> Pose {
    let [a, b, c] = pose.rotation.cols;
    Pose {
        rotation: Mat3::from_cols(a.parts().into(), b.parts().into(), c.parts().into()),
        position: pose.position.parts().into(),
    }
}

/// Keeps nothing.
struct Blind;

impl<V: Vector> Watch<V> for Blind {
    #[inline(always)]
    fn element(&mut self, _: usize, _: f64, _: &Wrench<V>, _: &Solved<V>) {}
    #[inline(always)]
    fn node(&mut self, _: usize, _: &Pose<V>) {}
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
    march_along(level, rod, scheme, loads, 0..rod.elements(), end, record)
}

/// The same over some of the elements: from the far node of the last of them to the near node of the first, before that one's loads.
pub(crate) fn march_along(
    level: SimdLevel,
    rod: &Rod,
    scheme: Scheme,
    loads: &NodalLoads,
    elements: Range<usize>,
    end: Section,
    record: &mut Record,
) -> Section {
    record.fit(rod.elements());
    let Some(points) = rod.diagonal_points() else {
        return general(rod, scheme, loads, elements, end, record);
    };
    let way = Way { rod, points, scheme, loads, last: elements.end, first: elements.start };
    #[cfg(target_arch = "x86_64")]
    if level != SimdLevel::Baseline
        && let Some(start) = with_avx2(Single::<Packed> { way, end, record, vector: PhantomData })
    {
        return start;
    }
    dispatch(level, Single::<Vec3> { way, end, record, vector: PhantomData })
}

/// Marches from several ends at once, one a lane, and keeps only where they arrive. `None` where the rod's law is not diagonal.
pub(crate) fn march_lanes<R: Real>(
    level: SimdLevel,
    rod: &Rod,
    scheme: Scheme,
    loads: &NodalLoads,
    end: Section<Vec3<R>>,
) -> Option<Section<Vec3<R>>> {
    let way = Way { rod, points: rod.diagonal_points()?, scheme, loads, last: rod.elements(), first: 0 };
    Some(dispatch(level, InLanes { way, end }))
}

/// One rod's march, its vectors of kind `V`, recorded.
struct Single<'a, V> {
    way: Way<'a>,
    end: Section,
    record: &'a mut Record,
    vector: PhantomData<V>,
}

impl<V: Vector<Number = f64>> Kernel for Single<'_, V> {
    type Output = Section;

    #[inline(always)]
    fn run(self) -> Section {
        let end = Section { pose: self.end.pose.splat::<V>(), wrench: self.end.wrench.splat() };
        let start = self.way.march(end, self.record);
        Section { pose: plain(&start.pose), wrench: numbers(&start.wrench) }
    }
}

/// A march in lanes.
struct InLanes<'a, V> {
    way: Way<'a>,
    end: Section<V>,
}

impl<V: Vector> Kernel for InLanes<'_, V> {
    type Output = Section<V>;

    #[inline(always)]
    fn run(self) -> Section<V> {
        self.way.march(self.end, &mut Blind)
    }
}

/// Elements of a rod with a diagonal law, and its loads.
#[derive(Clone, Copy)]
struct Way<'a> {
    rod: &'a Rod,
    points: &'a [DiagonalPoint],
    scheme: Scheme,
    loads: &'a NodalLoads,
    /// The node where it starts, and the one where it arrives.
    last: usize,
    first: usize,
}

impl Way<'_> {
    #[inline(always)]
    fn march<V: Vector, W: Watch<V>>(&self, end: Section<V>, watch: &mut W) -> Section<V> {
        match (self.scheme, self.rod.order()) {
            (Scheme::Multistep, _) => self.along(Multistep::<V>::new(), end, watch),
            (Scheme::Element, Order::First) => self.along(<First as LocalSolver<V>>::new(), end, watch),
            (Scheme::Element, Order::Second) => self.along(Second::<V>::new(), end, watch),
            (Scheme::Element, Order::Fourth) => self.along(Fourth::<V>::new(), end, watch),
        }
    }

    #[inline(always)]
    fn along<V: Vector, S: LocalSolver<V>, W: Watch<V>>(
        &self,
        mut solver: S,
        end: Section<V>,
        watch: &mut W,
    ) -> Section<V> {
        let (Self { first, last, .. }, nodes) = (*self, self.rod.mesh().nodes());
        let any = |loads: &[Wrench]| loads[first + 1..last].iter().any(acts);
        let (any_body, any_world) = (any(&self.loads.body), any(&self.loads.world));
        let Section { mut pose, mut wrench } = end;
        watch.node(last, &pose);
        for e in (first..last).rev() {
            let h = nodes[e + 1] - nodes[e];
            let solved = solver.next(&self.points[e * S::POINTS..(e + 1) * S::POINTS], h, &wrench);
            watch.element(e, h, &wrench, &solved);
            wrench = solved.carry(&wrench);
            pose = pose.before(&solved.exponent, solved.t, &solved.coefficients);
            watch.node(e, &pose);
            if any_world && e > first {
                wrench += self.loads.world[e].splat().turned_back_by(&pose.rotation);
            }
            if any_body && e > first {
                wrench += self.loads.body[e].splat();
            }
        }
        Section { pose, wrench }
    }
}

/// Whether a load is not zero; without a branch for each number.
fn acts(load: &Wrench) -> bool {
    load.to_array().iter().fold(0, |bits, x| bits | (x.to_bits() << 1)) != 0
}

/// The same for any law, in plain numbers, each element by Newton's method.
fn general(
    rod: &Rod,
    scheme: Scheme,
    loads: &NodalLoads,
    elements: Range<usize>,
    end: Section,
    record: &mut Record,
) -> Section {
    let Range { start: first, end: far } = elements;
    let nodes = rod.mesh().nodes();
    let Section { mut pose, mut wrench } = end;
    // Elastic strains of the last two elements, and their lengths.
    let (mut last, mut lengths) = ([[Strain::ZERO; 2]; 2], [1.0; 2]);
    record.poses[far] = pose;
    for e in (first..far).rev() {
        let h = nodes[e + 1] - nodes[e];
        let points = rod.points(e);
        let rest = rod.rest_strains(e);
        let guess: PointStrains = core::array::from_fn(|i| rest[i] + last[0][i]);
        let solve = |order: Order, driving: Wrench| {
            element::solve_general(order, rod.kinematics(), h, points, driving, guess)
                .unwrap_or([Vec6::from([f64::NAN; 6]); 2])
        };
        let (order, driving) = match scheme {
            Scheme::Element => (rod.order(), wrench),
            Scheme::Multistep => {
                let known = far - 1 - e;
                let elastic = if known == 0 {
                    solve(Order::First, wrench)[0] - rest[0]
                } else {
                    let [near, far] = element::multistep_weights(known, h, lengths);
                    last[0][0] * near + last[1][0] * far
                };
                (Order::First, element::mean_wrench((rest[0] + elastic) * h, wrench))
            }
        };
        let strain = solve(order, driving);
        last = [core::array::from_fn(|i| strain[i] - rest[i]), last[0]];
        lengths = [h, lengths[0]];
        let relative = Pose::exp(exponent(rod.order(), h, &strain));
        (record.wrenches[e], record.strains[e]) = (wrench, strain);
        wrench = relative.carry_wrench(wrench);
        pose = pose.compose(&relative.inverse());
        record.poses[e] = pose;
        if e > first {
            wrench += loads.body[e] + loads.world[e].turned_back_by(&pose.rotation);
        }
    }
    Section { pose, wrench }
}
