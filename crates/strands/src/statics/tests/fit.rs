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
