//! Problems that cannot be posed are refused, with what is wrong.

use super::*;

fn reason(problem: &Problem) -> FailureReason {
    let (settings, mut workspace) = (Settings::default(), Workspace::default());
    let failure = solve(problem, &settings, None, &mut workspace).unwrap_err();
    assert_eq!(failure.nearest.poses.len(), problem.rod.elements() + 1);
    let mut guess = failure.nearest.guess;
    assert!(!follow(problem, &settings, &mut guess, &mut workspace, &mut SolveReport::default()));
    failure.reason
}

#[test]
fn loads_of_another_rod_are_refused() {
    let other = rod(Kinematics::Cosserat, curved(), 30, Order::Second);
    for elements in [20, 40] {
        let mut problem = loaded(Kinematics::Cosserat, elements, Order::Second, Frame::World);
        let nodes = elements + 1;
        problem.loads.body = NodalLoads::none(&other).body;
        assert_eq!(reason(&problem), FailureReason::LoadsOfAnotherRod { loads: 31, nodes });
        problem.loads = NodalLoads::none(&other);
        assert_eq!(reason(&problem), FailureReason::LoadsOfAnotherRod { loads: 31, nodes });
    }
}

#[test]
fn a_hand_at_the_start_is_refused() {
    let mut problem = loaded(Kinematics::Cosserat, 20, Order::Second, Frame::World);
    let coupling = VirtualCoupling {
        linear_stiffness: 100.0,
        angular_stiffness: 1.0,
        linear_damping: 0.0,
        angular_damping: 0.0,
        max_force: 1.0,
        max_torque: 0.1,
    };
    problem.start.grip = Some(Grip { coupling, hand: problem.start.pose, last: None });
    assert_eq!(reason(&problem), FailureReason::GripAtStart);
    let start = problem.start.pose;
    problem.start = Support { fixed: [false; 6], ..problem.start };
    problem.end = Support::clamped(start);
    assert_eq!(reason(&problem), FailureReason::GripAtStart);
}
