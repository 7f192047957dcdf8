//! The variational sweep: how a march answers to small changes of its end, by the linearised recurrence.
//!
//! Between nodes the wrench and the variations of frame and wrench are constant when they are seen from one fixed frame, so the sweep
//! goes in the axes of the world, about the rod's start. With `G` an element's flexibility and `w` the wrench that it carries, both seen so,
//!
//! ```text
//! ξ = G δw,   δη_a = δη_b − ξ,   δw_a = δw_b + ad*(ξ) w,
//! ```
//!
//! and a dead load `l` at a node adds `l × δθ`. The flexibilities of several elements do not depend on one another, and are formed side by
//! side in lanes; then the columns go past these elements, side by side in lanes too, or one after the other. The numbers are the same.

use super::march::Record;
use crate::element::{self, DiagonalPoint, diagonal_flexibility};
use crate::load::NodalLoads;
use crate::math::{Kernel, Lanes, Mat3, Pose, SimdLevel, Vec3, Vec6, Vector, Wrench, dispatch};
use crate::rod::{Order, Rod};
use core::ops::Range;

/// A variation of a section: of its frame and of its wrench in it; both in body axes, or both seen from the start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variation<V = Vec3> {
    pub frame: Vec6<V>,
    pub wrench: Wrench<V>,
}

/// Six columns, one for each unknown of the end.
pub(crate) type Columns = [Variation; 6];

/// How many elements' flexibilities are formed side by side, and room for the six columns.
const BATCH: usize = 8;
type Side = Vec3<Lanes<BATCH>>;

/// Carries the columns from the end to the start of a rod along a recorded march, all at once in lanes, or one by one. `None` where an
/// element's law is singular there.
pub(crate) fn vary(
    level: SimdLevel,
    rod: &Rod,
    loads: &NodalLoads,
    record: &Record,
    columns: &Columns,
    in_lanes: bool,
) -> Option<Columns> {
    let way = Way { rod, loads, record, first: 0, origin: record.poses[0].position };
    let last = rod.elements();
    if in_lanes {
        return way.vary_in_lanes(level, last, &record.poses[0], &[*columns]).map(|[columns]| columns);
    }
    let columns = columns.map(|column| way.seen(&record.poses[last], column));
    let columns = dispatch(level, Sweep { way, last, columns })?;
    Some(columns.map(|column| way.back(&record.poses[0], column)))
}

/// Carries sets of columns along a recorded march over some of the elements, in lanes, from the far node of the last of them to the near
/// node of the first, where the march has arrived at the pose `near`.
pub(crate) fn vary_along<const N: usize>(
    level: SimdLevel,
    rod: &Rod,
    loads: &NodalLoads,
    record: &Record,
    elements: Range<usize>,
    near: &Pose,
    columns: &[Columns; N],
) -> Option<[Columns; N]> {
    let way = Way { rod, loads, record, first: elements.start, origin: near.position };
    way.vary_in_lanes(level, elements.end, near, columns)
}

fn into_lanes(columns: &Columns) -> Variation<Side> {
    let mut packed = Variation { frame: Vec6::zero(), wrench: Vec6::zero() };
    for (i, column) in columns.iter().enumerate() {
        packed.frame.put(i, column.frame);
        packed.wrench.put(i, column.wrench);
    }
    packed
}

fn out_of_lanes(packed: &Variation<Side>) -> Columns {
    core::array::from_fn(|i| Variation { frame: packed.frame.lane(i), wrench: packed.wrench.lane(i) })
}

/// A recorded march, seen from where it arrives.
#[derive(Clone, Copy)]
struct Way<'a> {
    rod: &'a Rod,
    loads: &'a NodalLoads,
    record: &'a Record,
    /// The element before which it arrives.
    first: usize,
    origin: Vec3,
}

/// An element on the way: its flexibility and the wrench that it carries, both seen from the start.
struct Yielding {
    flexibility: [[Mat3; 2]; 2],
    wrench: Wrench,
}

/// The elements of a batch, side by side.
struct Batch {
    flexibility: [[Mat3<Side>; 2]; 2],
    wrench: Wrench<Side>,
}

impl Batch {
    #[inline(always)]
    fn element(&self, i: usize) -> Yielding {
        let [[a, b], [c, d]] = &self.flexibility;
        Yielding {
            flexibility: [[block(a, i), block(b, i)], [block(c, i), block(d, i)]],
            wrench: self.wrench.lane(i),
        }
    }
}

#[inline(always)]
fn block(block: &Mat3<Side>, i: usize) -> Mat3 {
    let [a, b, c] = &block.cols;
    Mat3::from_cols(a.lane(i), b.lane(i), c.lane(i))
}

impl Way<'_> {
    #[inline(always)]
    fn vary_in_lanes<const N: usize>(
        &self,
        level: SimdLevel,
        last: usize,
        near: &Pose,
        columns: &[Columns; N],
    ) -> Option<[Columns; N]> {
        let end = &self.record.poses[last];
        let columns = columns.map(|columns| into_lanes(&columns.map(|column| self.seen(end, column))));
        let columns = dispatch(level, Sweep { way: *self, last, columns })?;
        Some(columns.map(|columns| out_of_lanes(&columns).map(|column| self.back(near, column))))
    }

    /// A variation in the axes of a frame, as it is seen from where the march arrives.
    fn seen(&self, from: &Pose, column: Variation) -> Variation {
        let from = Pose { rotation: from.rotation, position: from.position - self.origin };
        Variation { frame: from.adjoint(column.frame), wrench: from.carry_wrench(column.wrench) }
    }

    /// The way back.
    fn back(&self, to: &Pose, column: Variation) -> Variation {
        let to = Pose { rotation: to.rotation, position: to.position - self.origin }.inverse();
        Variation { frame: to.adjoint(column.frame), wrench: to.carry_wrench(column.wrench) }
    }

    /// The elements `last, last − 1, …` of a rod of order 2 with a diagonal law; past the first of the march they repeat it.
    #[inline(always)]
    fn batch(&self, points: &[DiagonalPoint], last: usize) -> Batch {
        let (record, nodes) = (self.record, self.rod.mesh().nodes());
        let [mut compliance, mut x, mut wrench] = [Vec6::<Side>::zero(); 3];
        let mut far = Pose { rotation: Mat3 { cols: [Side::zero(); 3] }, position: Side::zero() };
        for i in 0..BATCH {
            let e = last.saturating_sub(i).max(self.first);
            compliance.put(i, points[e].compliance);
            x.put(i, record.strains[e][0] * (nodes[e + 1] - nodes[e]));
            wrench.put(i, record.wrenches[e]);
            let pose = &record.poses[e + 1];
            far.rotation.cols[0].put(i, pose.rotation.cols[0]);
            far.rotation.cols[1].put(i, pose.rotation.cols[1]);
            far.rotation.cols[2].put(i, pose.rotation.cols[2]);
            far.position.put(i, pose.position - self.origin);
        }
        let flexibility = diagonal_flexibility(compliance, x, wrench).seen_from(&far);
        Batch { flexibility: flexibility.blocks(), wrench: far.carry_wrench(wrench) }
    }

    /// An element of any order and law.
    fn general(&self, e: usize) -> Option<Yielding> {
        let (rod, record) = (self.rod, self.record);
        let wrench = record.wrenches[e];
        let body = element::flexibility_of(rod, e, wrench, &record.strains[e], rod.order())?;
        let far = record.poses[e + 1];
        let far = Pose { rotation: far.rotation, position: far.position - self.origin };
        let adjoint = far.adjoint_matrix();
        let flexibility = adjoint.mul(&body).mul(&adjoint.transpose()).blocks;
        Some(Yielding { flexibility, wrench: far.carry_wrench(wrench) })
    }

    /// Takes a variation past an element and the load on its near node.
    #[inline(always)]
    fn pass<V: Vector>(&self, e: usize, element: &Yielding, at: Variation<V>) -> Variation<V> {
        let [[a, b], [c, d]] = &element.flexibility;
        let (moment, force) = (at.wrench.angular, at.wrench.linear);
        let yielded = Vec6::new(
            a.splat::<V>() * moment + b.splat::<V>() * force,
            c.splat::<V>() * moment + d.splat::<V>() * force,
        );
        let frame = at.frame - yielded;
        let mut wrench = at.wrench + yielded.coadjoint(element.wrench.splat());
        let load = &self.loads.world[e];
        if e > self.first && load.linear != Vec3::ZERO {
            let change = V::splat(load.linear).cross(frame.angular);
            wrench.linear += change;
            wrench.angular += V::splat(self.record.poses[e].position - self.origin).cross(change);
        }
        if e > self.first && load.angular != Vec3::ZERO {
            wrench.angular += V::splat(load.angular).cross(frame.angular);
        }
        Variation { frame, wrench }
    }
}

struct Sweep<'a, V, const N: usize> {
    way: Way<'a>,
    /// The element after the last.
    last: usize,
    columns: [Variation<V>; N],
}

impl<V: Vector, const N: usize> Kernel for Sweep<'_, V, N> {
    type Output = Option<[Variation<V>; N]>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { way, last, mut columns } = self;
        let rod = way.rod;
        let points = if rod.order() == Order::Second { rod.diagonal_points() } else { None };
        let Some(points) = points else {
            for e in (way.first..last).rev() {
                let element = way.general(e)?;
                for column in &mut columns {
                    *column = way.pass(e, &element, *column);
                }
            }
            return Some(columns);
        };
        let mut left = last;
        while left > way.first {
            let batch = way.batch(points, left - 1);
            let here = (left - way.first).min(BATCH);
            for i in 0..here {
                let element = batch.element(i);
                for column in &mut columns {
                    *column = way.pass(left - 1 - i, &element, *column);
                }
            }
            left -= here;
        }
        Some(columns)
    }
}

/// How a dead wrench, in the axes of a frame, changes there when the frame turns by `turn`.
pub(crate) fn turned_by(load: Wrench, turn: Vec3) -> Wrench {
    Wrench::new(load.angular.cross(turn), load.linear.cross(turn))
}
