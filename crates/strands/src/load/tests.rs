use super::*;
use crate::math::Pose;
use crate::rod::{Kinematics, Law, Order, Profile, RestShape, RodDescription, Stiffness};

/// A straight rod of length one, ten even elements, without breaks.
fn rod(order: Order) -> Rod {
    let law = Law::Diagonal(Stiffness { bending: [1.0; 2], torsion: 1.0, axial: 1.0, shear: [1.0; 2] });
    let description = RodDescription {
        length: 1.0,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Given {
            law,
            mass_per_length: 1.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.01; 2],
        },
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    Rod::with_elements(description, 10, &[], order).unwrap()
}

fn along(from: f64, to: f64) -> DistributedLoad {
    let per_length = Wrench::new(Vec3::Z * 2.0, Vec3::X * 3.0);
    DistributedLoad { from, to, per_length, frame: Frame::World }
}

#[test]
fn a_load_along_any_stretch_between_nodes_is_summed_whole() {
    for order in [Order::First, Order::Second, Order::Fourth] {
        let rod = rod(order);
        for (from, to) in [(0.2, 0.8), (0.0, 0.3), (0.5, 0.6), (0.7, 1.0), (0.4, 0.4), (0.0, 1.0)] {
            let loads = NodalLoads::none(&rod).with_distributed(&rod, &along(from, to)).unwrap();
            let (mut sum, mut lever) = (Wrench::ZERO, 0.0);
            for (load, s) in loads.world.iter().zip(rod.mesh().nodes()) {
                sum += *load;
                lever += s * load.linear.x;
            }
            let length = to - from;
            assert!((sum.linear.x - 3.0 * length).abs() < 1e-14, "{order:?} {from}..{to}: {sum:?}");
            assert!((sum.angular.z - 2.0 * length).abs() < 1e-14, "{order:?} {from}..{to}: {sum:?}");
            assert!((lever - 1.5 * (to * to - from * from)).abs() < 1e-14, "{order:?} {from}..{to}: {lever}");
        }
    }
}

#[test]
fn a_load_where_it_cannot_act_is_refused_and_says_where_it_could() {
    let rod = rod(Order::Second);
    let none = || NodalLoads::none(&rod);
    let backwards = none().with_distributed(&rod, &along(0.8, 0.2)).unwrap_err();
    assert_eq!(backwards, RodError::Backwards { what: "a load", from: 0.8, to: 0.2 });
    let at = |at: f64| {
        let load = PointLoad { at, wrench: Wrench::ZERO, frame: Frame::Body };
        none().with_point(&rod, &load).unwrap_err()
    };
    assert!(matches!(at(0.33), RodError::NotANode { s: 0.33, nearest, .. } if (nearest - 0.3).abs() < 1e-15));
    assert!(at(0.98).to_string().contains("nearest of them at s = 1: give 0.98 among the mesh's breaks"));
    assert!(matches!(at(1.1), RodError::OutsideRod { .. }));
    assert!(matches!(at(-0.1), RodError::OutsideRod { .. }));
    assert!(matches!(at(f64::NAN), RodError::OutsideRod { .. }));
    let between = none().with_distributed(&rod, &along(0.25, 0.8)).unwrap_err();
    assert!(between.to_string().starts_with("a load's start at s = 0.25 lies between nodes"), "{between}");
}

#[test]
fn a_pull_is_the_slope_of_its_energy_and_its_slope_that_of_the_pull() {
    let pull = Pull { node: 3, towards: Vec3::new(0.3, -0.2, 0.9), tension: 1.7 };
    let place = Vec3::new(-0.4, 0.5, 0.1);
    let step = 1e-6;
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        let (ahead, behind) = (place + axis * step, place - axis * step);
        let by_energy = -(pull.energy(ahead) - pull.energy(behind)) / (2.0 * step);
        assert!((by_energy - pull.force(place).dot(axis)).abs() < 1e-9);
        let slope = (pull.force(ahead) - pull.force(behind)) * (0.5 / step);
        assert!((slope - pull.slope(place) * axis).norm() < 1e-9, "{slope:?}");
    }
    assert!((pull.force(place).norm() - 1.7).abs() < 1e-15);
    assert_eq!(pull.force(pull.towards), Vec3::ZERO);
    assert_eq!(pull.slope(pull.towards), Mat3::ZERO);
}

#[test]
fn pulls_of_a_node_towards_one_point_are_one_and_are_found_by_their_node() {
    let rod = rod(Order::Second);
    let (low, high) = (Vec3::X, Vec3::Z * 2.0);
    let along = |from, to| DistributedPull { from, to, towards: low, tension_per_length: 3.0 };
    let loads = NodalLoads::none(&rod).with_distributed_pull(&rod, &along(0.5, 1.0)).unwrap();
    let loads = loads.with_pull(&rod, &PointPull { at: 0.5, towards: high, tension: 1.0 }).unwrap();
    let loads = loads.with_distributed_pull(&rod, &along(0.0, 0.5)).unwrap();
    assert_eq!((loads.pulls().len(), loads.pulls_at(5).len()), (12, 2));
    assert!(loads.pulls().is_sorted_by_key(|pull| pull.node));
    let sum: f64 = loads.scaled(2.0).pulls().iter().map(|pull| pull.tension).sum();
    assert!((sum - 8.0).abs() < 1e-14, "{sum}");
    assert!(loads.with_distributed_pull(&rod, &along(0.5, 0.2)).is_err());
}
