//! Poses and couplings as the plain numbers that cross to the page.

use strands::coupling::VirtualCoupling;
use strands::math::{Mat3, Pose, Vec3};
use strands_scene::HandFile;

pub fn coupling_numbers(c: &VirtualCoupling) -> [f64; 6] {
    [c.linear_stiffness, c.angular_stiffness, c.linear_damping, c.angular_damping, c.max_force, c.max_torque]
}

/// The hand of a rod as a scene has it, from the numbers of its coupling; an infinite limit is none.
pub fn hand_from(rod: &str, numbers: [f64; 6]) -> HandFile {
    let [linear_stiffness, angular_stiffness, linear_damping, angular_damping, max_force, max_torque] =
        numbers;
    let unless = |default: f64, value: f64| (value != default).then_some(value);
    HandFile {
        rod: rod.to_owned(),
        at: None,
        linear_stiffness,
        angular_stiffness,
        linear_damping: unless(0.0, linear_damping),
        angular_damping: unless(0.0, angular_damping),
        max_force: unless(f64::INFINITY, max_force),
        max_torque: unless(f64::INFINITY, max_torque),
    }
}

pub fn vector(numbers: &[f64]) -> Vec3 {
    Vec3::new(numbers[0], numbers[1], numbers[2])
}

pub fn unflat(numbers: &[f64]) -> Pose {
    let [d1, d2, d3, position] = [0, 3, 6, 9].map(|i| vector(&numbers[i..i + 3]));
    Pose { rotation: Mat3 { cols: [d1, d2, d3] }, position }
}

pub fn flat(poses: &[Pose]) -> Vec<f64> {
    let parts = |pose: &Pose| {
        let [d1, d2, d3] = pose.rotation.cols;
        [d1, d2, d3, pose.position].map(|v| v.to_array()).into_iter().flatten().collect::<Vec<f64>>()
    };
    poses.iter().flat_map(parts).collect()
}
