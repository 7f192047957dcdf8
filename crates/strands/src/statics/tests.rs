use super::*;
use crate::load::{Frame, NodalLoads, PointLoad};
use crate::math::{Pose, Quat, Wrench};
use crate::rod::{Law, Mesh, Order, Profile, RestShape, Rod, RodDescription, Stiffness};

fn description(kinematics: Kinematics, rest: RestShape) -> RodDescription {
    let stiffness = Stiffness { bending: [0.05, 0.08], torsion: 0.04, axial: 900.0, shear: [300.0, 320.0] };
    RodDescription {
        length: 0.8,
        kinematics,
        profile: Profile::Given { law: Law::Diagonal(stiffness), mass_per_length: 0.02, half_extent: [0.002; 2] },
        rest,
        base: Pose::from_parts(
            Vec3::new(0.1, -0.2, 0.3),
            Quat::from_wxyz([0.9, 0.1, -0.3, 0.2]).unwrap(),
        ),
    }
}

fn curved() -> RestShape {
    RestShape::samples(vec![(0.0, Vec3::new(1.0, -2.0, 3.0)), (0.8, Vec3::new(-1.5, 2.5, 1.0))]).unwrap()
}

fn rod(kinematics: Kinematics, rest: RestShape, elements: usize, order: Order) -> Rod {
    Rod::with_elements(description(kinematics, rest), elements, &[], order).unwrap()
}

/// A rod with rest curvature, clamped, a force and a moment at its tip.
fn loaded(kinematics: Kinematics, elements: usize, order: Order, frame: Frame) -> Problem {
    let rod = rod(kinematics, curved(), elements, order);
    let load = PointLoad {
        at: 0.8,
        wrench: Wrench::new(Vec3::new(0.05, -0.08, 0.06), Vec3::new(0.15, 0.1, -0.2)),
        frame,
    };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    Problem { loads, ..Problem::cantilever(rod) }
}

fn tip(solution: &Solution) -> Pose {
    solution.poses[solution.poses.len() - 1]
}

fn solved(problem: &Problem, settings: &Settings) -> Solution {
    match solve(problem, settings, None, &mut Workspace::default()) {
        Ok(solution) => solution,
        Err(failure) => panic!("{failure}: {:?}", failure.nearest.report),
    }
}

fn slope_of(error: impl Fn(usize) -> f64, coarse: usize) -> f64 {
    (error(coarse) / error(2 * coarse)).log2()
}

#[test]
fn tip_error_falls_at_the_order_of_the_scheme() {
    let settings = Settings { tolerance: 1e-13, ..Settings::default() };
    for kinematics in [Kinematics::Kirchhoff, Kinematics::Cosserat] {
        for frame in [Frame::World, Frame::Body] {
            for (order, coarse) in [(Order::First, 512), (Order::Second, 64), (Order::Fourth, 32)] {
                let fine = tip(&solved(&loaded(kinematics, 32 * coarse, order, frame), &settings));
                let error = |n| {
                    let tip = tip(&solved(&loaded(kinematics, n, order, frame), &settings));
                    fine.between(&tip).log().max_abs()
                };
                let slope = slope_of(error, coarse);
                println!("{kinematics:?} {frame:?} {order:?}: slope {slope:.3}, error {:.2e}", error(2 * coarse));
            }
        }
    }
}

#[test]
fn a_tolerance_is_met_with_fewer_elements_than_an_even_mesh_needs() {
    // Soft over a short stretch: all of the bending is there.
    for order in [Order::Second, Order::Fourth] {
        let rest = RestShape::samples(vec![
            (0.0, Vec3::ZERO),
            (0.6, Vec3::ZERO),
            (0.7, Vec3::new(0.0, 40.0, 0.0)),
            (0.8, Vec3::new(0.0, 0.0, 30.0)),
        ])
        .unwrap();
        let description = description(Kinematics::Kirchhoff, rest);
        let posed = |rod: Rod| -> Result<Problem, crate::rod::RodError> {
            let load = PointLoad {
                at: 0.8,
                wrench: Wrench::new(Vec3::ZERO, Vec3::new(0.1, 0.2, 0.05)),
                frame: Frame::World,
            };
            let loads = NodalLoads::none(&rod).with_point(&rod, &load)?;
            Ok(Problem { loads, ..Problem::cantilever(rod) })
        };
        let settings = Settings { tolerance: 1e-12, ..Settings::default() };
        let on = |mesh: Mesh| {
            let rod = Rod::new(description.clone(), mesh, order).unwrap();
            tip(&solved(&posed(rod).unwrap(), &settings))
        };
        let exact = on(Mesh::even(0.8, 6400, &[0.6, 0.7]).unwrap());
        for tolerance in [1e-3, 1e-5, 1e-7] {
            if order == Order::Second && tolerance < 1e-6 {
                continue;
            }
            let refined =
                refine(&description, order, &[0.6, 0.7], tolerance, 100_000, &settings, posed).unwrap();
            let error = exact.between(&tip(&refined.solution)).log().max_abs();
            let n = refined.problem.rod.elements();
            let even = exact.between(&on(Mesh::even(0.8, n, &[0.6, 0.7]).unwrap())).log().max_abs();
            println!("{order:?} {tolerance:e}: {n} elements, error {error:.2e}, even {even:.2e}");
            assert!(error <= tolerance, "{order:?} {tolerance:e}: {error:e} with {n}");
            assert!(error <= even, "{order:?} {tolerance:e}: an even mesh does better, {even:e}");
        }
    }
}
