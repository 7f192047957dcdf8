//! Problems drawn at random without regard to whether anyone would pose them, to find a panic or a number that is none.
//!
//! Lengths, stiffnesses and loads over many powers of ten, rest shapes from straight to wound up, any mix of freedoms held at either end and
//! between, in any place, any load in any frame; any order, method and number of elements. Many have no solution.

use core::f64::consts::PI;
use fastrand::Rng;
use strands::load::{DistributedLoad, Frame, NodalLoads, PointLoad};
use strands::math::{Pose, Quat, Vec3, Wrench};
use strands::rod::{Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, RodError, Stiffness};
use strands::statics::{Method, Problem, Scheme, Settings, Support};

/// The problem of that number, and how it is to be solved.
///
/// # Errors
/// Where what was drawn is no rod.
pub fn problem(number: u64) -> Result<(Problem, Settings), RodError> {
    let mut draw = Draw(Rng::with_seed(number));
    (0..8).for_each(|_| _ = draw.0.f64());
    let length = draw.power(-3.0, 2.0);
    let bending = draw.power(-8.0, 4.0);
    let stretch = draw.power(0.0, 8.0) * bending / (length * length);
    let order = *draw.one_of(&[Order::First, Order::Second, Order::Second, Order::Fourth]);
    let turns = draw.power(-1.0, 1.0) * PI / length;
    let description = RodDescription {
        length,
        kinematics: *draw.one_of(&[Kinematics::Kirchhoff, Kinematics::Cosserat]),
        profile: Profile::Given {
            law: Law::Diagonal(Stiffness {
                bending: [bending, bending * draw.power(-3.0, 3.0)],
                torsion: bending * draw.power(-3.0, 3.0),
                axial: stretch,
                shear: [stretch * draw.power(-2.0, 1.0), stretch * draw.power(-2.0, 1.0)],
            }),
            mass_per_length: draw.power(-6.0, 2.0),
            half_extent: [1e-3 * length; 2],
        },
        rest: if draw.0.bool() { RestShape::default() } else { RestShape::Constant(draw.vector(turns)) },
        base: draw.pose(length),
    };
    let elements = draw.0.usize(2..24);
    let rod = Rod::with_elements(description, elements, &[], order)?;
    let force = draw.power(-4.0, 5.0) * bending / (length * length);
    let mut loads = NodalLoads::none(&rod);
    if draw.0.bool() {
        loads = loads.with_gravity(&rod, draw.vector(20.0));
    }
    let frame = *draw.one_of(&[Frame::World, Frame::Body]);
    let wrench = Wrench::new(draw.vector(force * length), draw.vector(force));
    if draw.0.bool() {
        loads = loads.with_point(&rod, &PointLoad { at: length, wrench, frame })?;
    }
    if draw.0.u8(..4) == 0 {
        let per_length = Wrench::new(draw.vector(force), draw.vector(force / length));
        loads =
            loads.with_distributed(&rod, &DistributedLoad { from: 0.0, to: length, per_length, frame })?;
    }
    let rest = rod.rest_poses();
    let mut problem = Problem { loads, ..Problem::cantilever(rod) };
    if draw.0.u8(..3) == 0 {
        problem.start = draw.support(&rest[0], length);
    }
    if draw.0.u8(..4) > 0 {
        problem.end = draw.support(&rest[elements], length);
    }
    if draw.0.u8(..4) == 0 {
        let node = draw.0.usize(1..elements);
        problem.between.push((node, draw.support(&rest[node], length)));
    }
    let methods = [
        Method::Auto,
        Method::Auto,
        Method::Shooting,
        Method::MultipleShooting,
        Method::Equilibrium,
        Method::Sweep,
    ];
    let scheme = if draw.0.u8(..8) == 0 { Scheme::Multistep } else { Scheme::Element };
    let settings = Settings { method: *draw.one_of(&methods), scheme, ..Settings::default() };
    Ok((problem, settings))
}

struct Draw(Rng);

impl Draw {
    fn one_of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.0.usize(..all.len())]
    }

    /// A number of which the power of ten lies evenly between two.
    fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(low + (high - low) * self.0.f64())
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        let mut part = || 2.0 * self.0.f64() - 1.0;
        Vec3::new(part(), part(), part()) * size
    }

    fn pose(&mut self, length: f64) -> Pose {
        let turn = Quat::from_rotation_vector(self.vector(PI));
        Pose::from_parts(self.vector(length), turn)
    }

    /// A support somewhere about where the rod is anyway.
    fn support(&mut self, rest: &Pose, length: f64) -> Support {
        let fixed = core::array::from_fn(|_| self.0.bool());
        let far = self.power(-6.0, 0.3);
        let turn = Quat::from_rotation_vector(self.vector(far.min(PI))).to_matrix();
        let pose =
            Pose { rotation: rest.rotation * turn, position: rest.position + self.vector(far * length) };
        let support = Support::of(fixed, pose);
        match self.0.u8(..8) {
            0 => support.sliding_along(self.vector(1.0) + Vec3::Z * 2.0),
            1 => support.turning_about(self.vector(1.0) + Vec3::X * 2.0),
            _ => support,
        }
    }
}
