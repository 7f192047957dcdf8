//! The variational sweep: how a march answers to small changes of its end, by the linearised recurrence.
//!
//! With `g` the frame of an element's far node from its near one, `w` the wrench through its far node and `G` its flexibility,
//!
//! ```text
//! ξ = G δw_b,   δη_a = Ad_g (δη_b − ξ),   δw_a = Ad_g⁻ᵀ (δw_b + ad*(ξ) w),
//! ```
//!
//! and a dead load `l` (in the node's axes) adds `l × δθ`. The columns are the lanes of one vector, or go one after the other; the numbers are the same.

use super::march::{Record, turned};
use crate::element::{self, DiagonalFlexibility};
use crate::load::NodalLoads;
use crate::math::{Kernel, Lanes, Mat3, Mat6, Real, SimdLevel, Vec3, Vec6, Wrench, dispatch};
use crate::rod::{Kinematics, Order, Rod};

/// A variation of a section: of its frame (body axes) and of its wrench (body axes).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variation<R = f64> {
    pub frame: Vec6<R>,
    pub wrench: Wrench<R>,
}

/// Six columns, one for each unknown of the end.
pub(crate) type Columns = [Variation; 6];

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
    if in_lanes {
        let lane = |column: usize, pick: &dyn Fn(&Variation) -> f64| {
            if column < 6 { pick(&columns[column]) } else { 0.0 }
        };
        let gather = |pick: &dyn Fn(&Variation) -> f64| Lanes::<8>::from_fn(|i| lane(i, pick));
        let vector = |pick: &dyn Fn(&Variation) -> Vec3| {
            Vec3::new(gather(&|v| pick(v).x), gather(&|v| pick(v).y), gather(&|v| pick(v).z))
        };
        let packed = Variation {
            frame: Vec6::new(vector(&|v| v.frame.angular), vector(&|v| v.frame.linear)),
            wrench: Vec6::new(vector(&|v| v.wrench.angular), vector(&|v| v.wrench.linear)),
        };
        let out = sweep::<Lanes<8>>(level, rod, loads, record, packed)?;
        let scatter = |v: Vec3<Lanes<8>>, i: usize| Vec3::new(v.x.0[i], v.y.0[i], v.z.0[i]);
        let part = |v: Vec6<Lanes<8>>, i: usize| Vec6::new(scatter(v.angular, i), scatter(v.linear, i));
        return Some(core::array::from_fn(|i| Variation {
            frame: part(out.frame, i),
            wrench: part(out.wrench, i),
        }));
    }
    let mut out = *columns;
    for column in &mut out {
        *column = sweep::<f64>(level, rod, loads, record, *column)?;
    }
    Some(out)
}

#[inline]
fn sweep<R: Real>(
    level: SimdLevel,
    rod: &Rod,
    loads: &NodalLoads,
    record: &Record,
    columns: Variation<R>,
) -> Option<Variation<R>> {
    let diagonal = if rod.order() == Order::Second { rod.diagonal_points() } else { None };
    if diagonal.is_none() {
        return general(rod, loads, record, columns);
    }
    let out = match rod.kinematics() {
        Kinematics::Kirchhoff => dispatch(level, DiagonalSweep::<R, true> { rod, loads, record, columns }),
        Kinematics::Cosserat => dispatch(level, DiagonalSweep::<R, false> { rod, loads, record, columns }),
    };
    Some(out)
}

/// The sweep for order 2 and diagonal laws: the hot path.
struct DiagonalSweep<'a, R, const KIRCHHOFF: bool> {
    rod: &'a Rod,
    loads: &'a NodalLoads,
    record: &'a Record,
    columns: Variation<R>,
}

impl<R: Real, const KIRCHHOFF: bool> Kernel for DiagonalSweep<'_, R, KIRCHHOFF> {
    type Output = Variation<R>;

    #[inline(always)]
    fn run(self) -> Variation<R> {
        let Self { rod, loads, record, mut columns } = self;
        let points = rod.diagonal_points().unwrap_or(&[]);
        let nodes = rod.mesh().nodes();
        for e in (0..rod.elements()).rev() {
            let wrench = record.wrenches[e];
            let h = nodes[e + 1] - nodes[e];
            let flexibility =
                element::diagonal_flexibility::<KIRCHHOFF>(h, &points[e], wrench, &record.strains[e][0]);
            let yielded = apply::<R, KIRCHHOFF>(&flexibility, columns.wrench);
            columns = carry(record, loads, e, wrench, columns, yielded);
        }
        columns
    }
}

/// `T · inner · Tᵀ δw`.
#[inline(always)]
fn apply<R: Real, const KIRCHHOFF: bool>(f: &DiagonalFlexibility, dw: Wrench<R>) -> Vec6<R> {
    let moment = transpose_mul(&f.turn, dw.angular) + transpose_mul(&f.shift, dw.linear);
    let (bend, stretch) = if KIRCHHOFF {
        (mul(&f.a, moment), Vec3::zero())
    } else {
        let force = transpose_mul(&f.turn, dw.linear);
        let bend = mul(&f.a, moment) + mul(&f.b, force);
        (bend, f.stretch.splat().scale(force) + mul(&f.c, bend))
    };
    let linear = mul(&f.shift, bend);
    Vec6::new(mul(&f.turn, bend), if KIRCHHOFF { linear } else { linear + mul(&f.turn, stretch) })
}

#[inline(always)]
fn mul<R: Real>(m: &Mat3, v: Vec3<R>) -> Vec3<R> {
    m.splat::<R>() * v
}

#[inline(always)]
fn transpose_mul<R: Real>(m: &Mat3, v: Vec3<R>) -> Vec3<R> {
    m.splat::<R>().transpose_mul(v)
}

/// Takes the columns from the far to the near node of an element that yields by `xi`, and past the near node's loads.
#[inline(always)]
pub(crate) fn carry<R: Real>(
    record: &Record,
    loads: &NodalLoads,
    e: usize,
    wrench: Wrench,
    columns: Variation<R>,
    xi: Vec6<R>,
) -> Variation<R> {
    let relative = record.relative[e].splat::<R>();
    let frame = relative.adjoint(columns.frame - xi);
    let mut out =
        Variation { frame, wrench: relative.carry_wrench(columns.wrench + xi.coadjoint(wrench.splat())) };
    if e > 0 {
        out.wrench += turned_by(turned(&record.poses[e], loads.world[e]), frame.angular);
    }
    out
}

/// How a dead wrench, in the axes of a frame, changes there when the frame turns by `turn`.
#[inline(always)]
pub(crate) fn turned_by<R: Real>(load: Wrench, turn: Vec3<R>) -> Wrench<R> {
    Wrench::new(load.angular.splat().cross(turn), load.linear.splat().cross(turn))
}

/// The sweep for any order and law.
fn general<R: Real>(
    rod: &Rod,
    loads: &NodalLoads,
    record: &Record,
    mut columns: Variation<R>,
) -> Option<Variation<R>> {
    for e in (0..rod.elements()).rev() {
        let wrench = record.wrenches[e];
        let flexibility = element::flexibility_of(rod, e, wrench, &record.strains[e], rod.order())?;
        let yielded = mul6(&flexibility, columns.wrench);
        columns = carry(record, loads, e, wrench, columns, yielded);
    }
    Some(columns)
}

fn mul6<R: Real>(m: &Mat6, v: Vec6<R>) -> Vec6<R> {
    let [[a, b], [c, d]] = &m.blocks;
    Vec6::new(mul(a, v.angular) + mul(b, v.linear), mul(c, v.angular) + mul(d, v.linear))
}
