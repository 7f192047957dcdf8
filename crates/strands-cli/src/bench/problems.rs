//! The problems that are timed: a steel wire, 0.5 m long and 2 mm thick.

use std::f64::consts::FRAC_PI_2;

use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Pose, Vec3, Vec6, Wrench};
use strands::rod::{
    Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, RodError, Section, Station,
};
use strands::statics::{Problem, Support};

/// Length of the wire, m.
pub const LENGTH: f64 = 0.5;

/// The wire without loads, its end free.
fn wire(elements: usize, order: Order, kinematics: Kinematics) -> Result<Problem, RodError> {
    let material = Material::new(200e9, 80e9, 8000.0)?;
    let description = RodDescription {
        length: LENGTH,
        kinematics,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 1e-3 },
            material,
        }]),
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    Ok(Problem::cantilever(Rod::with_elements(description, elements, &[], order)?))
}

/// The standard problem of the paper: clamped, and a wrench at the tip, given in the tip's frame. Two sweeps solve it.
pub fn standard(elements: usize, order: Order, kinematics: Kinematics) -> Result<Problem, RodError> {
    let mut problem = wire(elements, order, kinematics)?;
    let wrench = Wrench::new(Vec3::new(0.3, 0.5, 0.2), Vec3::new(1.0, -0.5, -0.3));
    let load = PointLoad { at: LENGTH, wrench, frame: Frame::Body };
    problem.loads = problem.loads.with_point(&problem.rod, &load)?;
    Ok(problem)
}

/// The interactive problem: both ends held, the tip at `held`, under gravity.
pub fn held(elements: usize, held: Pose) -> Result<Problem, RodError> {
    let mut problem = wire(elements, Order::Second, Kinematics::Cosserat)?;
    problem.loads = NodalLoads::none(&problem.rod).with_gravity(&problem.rod, Vec3::new(0.0, 0.0, -9.81));
    problem.end = Support::clamped(held);
    Ok(problem)
}

/// Where the tip is held at first: a third of the length aside and two thirds up, turned by a quarter turn, so that the wire bends over.
pub fn home() -> Pose {
    let turn = Vec6::new(Vec3::Y * FRAC_PI_2, Vec3::ZERO);
    Pose { rotation: Pose::exp(turn).rotation, position: Vec3::new(1.0 / 3.0, 0.0, 2.0 / 3.0) * LENGTH }
}

/// A hand that wanders: each step shifts it by 0.3 % of the length and turns it by 1°, in directions drawn from a fixed seed, and it
/// turns back before it strays further than a twentieth of the length or a quarter of a radian from home.
pub fn wander(steps: usize) -> Vec<Pose> {
    let mut random = fastrand::Rng::with_seed(2002);
    let mut direction = move || loop {
        let v = Vec3::new(random.f64(), random.f64(), random.f64()) * 2.0 - Vec3::new(1.0, 1.0, 1.0);
        if v.norm() <= 1.0
            && let Some(unit) = v.normalized()
        {
            return unit;
        }
    };
    let (mut shift, mut turn) = (Vec3::ZERO, Vec3::ZERO);
    let step = |from: Vec3, by: Vec3, bound: f64| {
        let to = from + by;
        if to.norm() <= bound { to } else { from - by * (by.dot(from).signum()) }
    };
    let poses = (0..steps).map(|_| {
        shift = step(shift, direction() * (0.003 * LENGTH), 0.05 * LENGTH);
        turn = step(turn, direction() * 1_f64.to_radians(), 0.25);
        let home = home();
        let turned = Pose::exp(Vec6::new(turn, Vec3::ZERO)).rotation;
        Pose { rotation: turned * home.rotation, position: home.position + shift }
    });
    poses.collect()
}
