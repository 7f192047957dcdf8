//! Multiple shooting: it finds what the other ways find, and goes on where single shooting has lost its digits.

use super::*;
use crate::math::Mat3;
use crate::statics::almost_block_diagonal::{AlmostBlockDiagonal, Twelve};
use crate::statics::multiple_shooting::misjudged;

const KINEMATICS: [Kinematics; 2] = [Kinematics::Kirchhoff, Kinematics::Cosserat];

fn by(method: Method) -> Settings {
    Settings { method, tolerance: 1e-12, restart_from_rest: false, ..Settings::default() }
}

fn found(
    problem: &Problem,
    settings: &Settings,
    guess: Option<&Guess>,
    workspace: &mut Workspace,
) -> Solution {
    match solve(problem, settings, guess, workspace) {
        Ok(solution) => solution,
        Err(failure) => panic!("{}: {failure}: {:?}", settings.method.name(), failure.nearest.report),
    }
}

/// How far two solutions are apart: frames over the length, wrenches over the largest.
fn apart(problem: &Problem, a: &Solution, b: &Solution) -> f64 {
    let length = problem.rod.length();
    let frames = a.poses.iter().zip(&b.poses).map(|(a, b)| {
        let gap = a.between(b).log();
        gap.angular.max_abs().max(gap.linear.max_abs() / length)
    });
    let reactions = |of: &Solution, pick: &dyn Fn(&Reaction) -> Vec3| -> Vec<Vec3> {
        of.reactions
            .iter()
            .map(pick)
            .chain(of.stress.iter().map(|stress| pick(&as_reaction(stress))))
            .collect()
    };
    let wrenches =
        [&(|r: &Reaction| r.force) as &dyn Fn(&Reaction) -> Vec3, &|r: &Reaction| r.moment].map(|pick| {
            let (a, b) = (reactions(a, pick), reactions(b, pick));
            let size = a.iter().fold(f64::MIN_POSITIVE, |max, v| max.max(v.norm()));
            a.iter().zip(&b).map(|(a, b)| (*a - *b).norm() / size).fold(0.0, f64::max)
        });
    frames.fold(0.0, f64::max).max(wrenches[0]).max(wrenches[1])
}

fn as_reaction(stress: &crate::math::Stress) -> Reaction {
    Reaction { s: 0.0, force: stress.linear, moment: stress.angular }
}

/// Numbers between −1 and 1, always the same ones.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
    fn motion(&mut self, turn: f64, shift: f64) -> Pose {
        Pose::exp(Vec6::new(self.vector() * turn, self.vector() * shift))
    }
}

#[test]
fn the_structured_elimination_solves_what_it_was_given() {
    let mut random = Random(1);
    let mut system = AlmostBlockDiagonal::default();
    // The second and third are shorter: what is left of the first must not matter.
    for joints in [7, 3, 0] {
        let start: [Twelve; 6] = core::array::from_fn(|_| core::array::from_fn(|_| random.next()));
        let mut blocks: Vec<[[Twelve; 12]; 2]> = Vec::new();
        for _ in 0..joints {
            // Some grow by far more than others, and some diagonals vanish: rows have to be interchanged.
            let size = 10_f64.powf(4.0 * random.next());
            let mut block = || core::array::from_fn(|_| core::array::from_fn(|_| random.next()));
            let (mut own, next): ([Twelve; 12], [Twelve; 12]) = (block(), block());
            (0..12).for_each(|k| own[k][k] = 0.0);
            blocks.push([own.map(|row| row.map(|x| size * x)), next]);
        }
        system.begin(&start);
        for [own, next] in &blocks {
            system.push(SimdLevel::detect(), own, next).unwrap();
        }
        system.end().unwrap();
        let rhs: [f64; 6] = core::array::from_fn(|_| random.next());
        let given: Vec<Twelve> = (0..=joints).map(|_| core::array::from_fn(|_| random.next())).collect();
        let mut x = given.clone();
        system.solve(&rhs, &mut x);
        let dot = |row: &Twelve, x: &Twelve| row.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
        for r in 0..6 {
            assert!((dot(&start[r], &x[0]) - rhs[r]).abs() < 1e-9, "start {r}");
        }
        for (i, [own, next]) in blocks.iter().enumerate() {
            for r in 0..12 {
                let (a, b) = (dot(&own[r], &x[i]), dot(&next[r], &x[i + 1]));
                let size = own[r].iter().fold(1.0, |max: f64, x| max.max(x.abs()));
                assert!((a + b - given[i][r]).abs() < 1e-9 * size, "{joints}: {i}, {r}");
            }
        }
    }
}

#[test]
fn a_free_end_is_found_as_by_the_sweep_and_by_shooting() {
    for kinematics in KINEMATICS {
        for rest in [RestShape::default(), curved()] {
            for order in [Order::First, Order::Second, Order::Fourth] {
                for frame in [Frame::World, Frame::Body] {
                    let mut problem = loaded(kinematics, 60, order, frame);
                    problem.rod = rod(kinematics, rest.clone(), 60, order);
                    if frame == Frame::World {
                        problem.loads =
                            problem.loads.clone().with_gravity(&problem.rod, Vec3::new(0.0, 1.0, -9.81));
                    }
                    let what = format!("{kinematics:?} {order:?} {frame:?}");
                    let mut workspace = Workspace::default();
                    let other = match frame {
                        Frame::World => found(&problem, &by(Method::Shooting), None, &mut workspace),
                        Frame::Body => found(&problem, &by(Method::Sweep), None, &mut workspace),
                    };
                    let cold = found(&problem, &by(Method::MultipleShooting), None, &mut workspace);
                    assert_eq!(cold.report.method, Method::MultipleShooting);
                    assert!(cold.report.residual <= 1e-12, "{what}");
                    assert_eq!(cold.report.morse_index, other.report.morse_index, "{what}");
                    let gap = apart(&problem, &other, &cold);
                    assert!(gap < 1e-10, "{what}: {gap:e}");
                    assert!(cold.imbalance(&problem) < 1e-12, "{what}: {:e}", cold.imbalance(&problem));
                }
            }
        }
    }
}

/// A rod whose tip is held, in one of many ways, near where a load takes it.
fn held(
    random: &mut Random,
    kinematics: Kinematics,
    order: Order,
    fixed: [bool; 6],
    frame: Frame,
) -> Problem {
    let mut problem = loaded(kinematics, 60, order, frame);
    problem.loads = problem.loads.clone().with_gravity(&problem.rod, random.vector() * 5.0);
    let hanging = tip(&solved(&problem, &Settings { tolerance: 1e-11, ..Settings::default() }));
    problem.end = Support::of(fixed, hanging.compose(&random.motion(0.3, 0.02)));
    problem
}

#[test]
fn rods_held_in_any_way_are_found_as_by_shooting() {
    let mut random = Random(2);
    let (mut tries, mut both) = (0, 0);
    for kinematics in KINEMATICS {
        for order in [Order::First, Order::Second, Order::Fourth] {
            for frame in [Frame::World, Frame::Body] {
                for (name, fixed) in held_in_many_ways() {
                    let what = format!("{kinematics:?} {order:?} {frame:?} {name}");
                    let mut problem = held(&mut random, kinematics, order, fixed, frame);
                    tries += 1;
                    // Some of these are hard, and it is enough that most are found.
                    let Ok(first) = solve(&problem, &by(Method::Auto), None, &mut Workspace::default())
                    else {
                        continue;
                    };
                    problem.end.pose = problem.end.pose.compose(&random.motion(0.05, 0.01));
                    let shooting = Settings { max_halvings: 0, ..by(Method::Shooting) };
                    let Ok(shot) = solve(&problem, &shooting, Some(&first.guess), &mut Workspace::default())
                    else {
                        continue;
                    };
                    both += 1;
                    let many = found(
                        &problem,
                        &by(Method::MultipleShooting),
                        Some(&first.guess),
                        &mut Workspace::default(),
                    );
                    let gap = apart(&problem, &shot, &many);
                    assert!(gap < 1e-10, "{what}: {gap:e}, {:?}, {:?}", shot.report, many.report);
                    assert!(many.imbalance(&problem) < 1e-12, "{what}: {:e}", many.imbalance(&problem));
                }
            }
        }
    }
    assert!(both * 4 >= tries * 3, "{both} of {tries}");
}

#[test]
fn rods_held_between_and_by_a_hand_are_found_as_all_at_once() {
    let mut random = Random(3);
    let settings = by(Method::MultipleShooting);
    let (mut tries, mut both) = (0, 0);
    for kinematics in KINEMATICS {
        for order in [Order::Second, Order::Fourth] {
            for (number, (name, fixed)) in held_in_many_ways().into_iter().enumerate() {
                let what = format!("{kinematics:?} {order:?} {name}");
                let mut problem = held(&mut random, kinematics, order, [true; 6], Frame::World);
                let free = found(&problem, &by(Method::Equilibrium), None, &mut Workspace::default());
                // An inextensible rod has little to spare between two places.
                let shift = if kinematics == Kinematics::Kirchhoff { 3e-4 } else { 5e-3 };
                for node in [13, 40] {
                    let pose = free.poses[node].compose(&random.motion(0.2, shift));
                    problem.between.push((node, Support::of(fixed, pose)));
                }
                let axes = [random.vector(), random.vector()];
                problem.between.push((
                    50,
                    Support::clamped(free.poses[50]).sliding_along(axes[0]).turning_about(axes[1]),
                ));
                match number % 3 {
                    0 => problem.end = Support::free(problem.end.pose),
                    1 => {
                        let coupling = VirtualCoupling {
                            linear_stiffness: 100.0,
                            angular_stiffness: 1.0,
                            linear_damping: 0.0,
                            angular_damping: 0.0,
                            max_force: 10.0,
                            max_torque: 1.0,
                        };
                        problem.end = Support::gripped(Grip { coupling, hand: problem.end.pose, last: None });
                    }
                    _ => {}
                }
                tries += 1;
                let mut workspaces = [Workspace::default(), Workspace::default()];
                let first = solve(&problem, &by(Method::Equilibrium), None, &mut workspaces[0]);
                let Ok(first) = first else { continue };
                both += 1;
                workspaces[1] = workspaces[0].clone();
                let mut guesses = [first.guess; 2];
                for _ in 0..3 {
                    for (_, support) in &mut problem.between {
                        support.pose = support.pose.compose(&random.motion(0.05, 0.2 * shift));
                    }
                    let all =
                        found(&problem, &by(Method::Equilibrium), Some(&guesses[0]), &mut workspaces[0]);
                    let many = found(&problem, &settings, Some(&guesses[1]), &mut workspaces[1]);
                    let gap = apart(&problem, &all, &many);
                    assert!(gap < 1e-10, "{what}: {gap:e}, {:?}, {:?}", all.report, many.report);
                    assert!(many.imbalance(&problem) < 1e-12, "{what}: {:e}", many.imbalance(&problem));
                    assert_eq!(many.report.morse_index, all.report.morse_index, "{what}");
                    guesses = [all.guess, many.guess];
                }
            }
        }
    }
    assert!(both * 10 >= tries * 8, "{both} of {tries}");
}

#[test]
fn the_derivative_is_exact() {
    let mut random = Random(4);
    let mut worst = 0.0_f64;
    for kinematics in KINEMATICS {
        for order in [Order::First, Order::Second, Order::Fourth] {
            for (number, (name, fixed)) in held_in_many_ways().into_iter().enumerate() {
                let mut problem = held(&mut random, kinematics, order, fixed, Frame::World);
                problem.loads.body.clone_from(&problem.loads.world);
                problem.loads.world[30].angular = random.vector() * 0.05;
                problem.loads.world[23].angular = random.vector() * 0.05;
                let pose = problem.rod.rest_poses()[23];
                problem.between.push((23, Support::of(held_in_many_ways()[6 - number].1, pose)));
                if number % 2 == 0 {
                    problem.start.fixed = [false, true, false, true, true, true];
                }
                // A state with gaps of every kind.
                let mut workspace = Workspace::default();
                workspace.record.fit(60);
                workspace.record.poses = problem.rod.rest_poses();
                for pose in &mut workspace.record.poses {
                    *pose = pose.compose(&random.motion(0.3, 0.02));
                }
                for wrench in &mut workspace.record.wrenches {
                    *wrench = Wrench::new(random.vector() * 0.1, random.vector() * 0.3);
                }
                let off = [1e-3, 1e-4].map(|part| misjudged(&problem, part, 0.15, &mut workspace.clone()));
                // Of second order in the step, so that ten times less of it is ten times less off.
                let falls = off[0] / off[1];
                assert!(falls > 8.0 || off[1] < 1e-7, "{kinematics:?} {order:?} {name}: {off:?}");
                worst = worst.max(off[1]);
            }
        }
    }
    assert!(worst > 0.0);
}

/// A straight thread under a tension that bends it over `1/ratio` of its length, its ends clamped askew to the pull; and a
/// solution of it.
fn taut(kinematics: Kinematics, order: Order, ratio: f64) -> (Problem, Workspace, Solution) {
    let elements = (2.5 * ratio) as usize;
    let mut description = description(kinematics, RestShape::default());
    if let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile {
        // Stiff enough against stretching that the pull makes it one part in ten longer.
        let tension = ratio * ratio * 0.063 / 0.64;
        stiffness.axial = 10.0 * tension;
        stiffness.shear = [10.0 * tension; 2];
    }
    let rod = Rod::with_elements(description, elements, &[], order).unwrap();
    let base = rod.description().base;
    let scale = rod.scale();
    let along = base.rotation * Vec3::new(0.3, -0.2, 1.0).normalized().unwrap();
    let load = PointLoad {
        at: 0.8,
        wrench: Wrench::new(Vec3::ZERO, along * (ratio * ratio * scale.force)),
        frame: Frame::World,
    };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    let problem = Problem { loads, ..Problem::cantilever(rod) };
    let mut workspace = Workspace::default();
    let solution = found(&problem, &by(Method::MultipleShooting), None, &mut workspace);
    (problem, workspace, solution)
}

#[test]
fn taut_threads_are_found_from_a_solution_nearby_and_from_rest_where_shooting_is_not() {
    for kinematics in KINEMATICS {
        for (order, ratio) in [(Order::Second, 100.0), (Order::Fourth, 100.0), (Order::Second, 1000.0)] {
            let what = format!("{kinematics:?} {order:?} {ratio}");
            let (mut problem, mut workspace, first) = taut(kinematics, order, ratio);
            assert!(first.imbalance(&problem) < 1e-12, "{what}: {:e}", first.imbalance(&problem));
            // The end is turned aside and clamped: it bends within `ℓ` of either end.
            let aside = Pose::exp(Vec6::new(Vec3::new(0.2, 0.3, 0.1), Vec3::ZERO));
            problem.end = Support::of([true, true, true, false, false, false], tip(&first).compose(&aside));
            let settings = Settings { tolerance: 1e-11, ..by(Method::MultipleShooting) };
            let turned = found(&problem, &settings, Some(&first.guess), &mut workspace);
            // And where it is held goes round its start, under no load but what holds it.
            let round = Quat::from_rotation_vector(Vec3::new(0.01, 0.02, -0.01)).to_matrix();
            let start = problem.start.pose.position;
            let mut target = tip(&turned);
            target.position = start + round * (target.position - start);
            problem.end = Support::clamped(target);
            problem.loads = NodalLoads::none(&problem.rod);
            let mut beside = workspace.clone();
            let many = found(&problem, &settings, Some(&turned.guess), &mut workspace);
            // The tautest are too much for that search from where they were, and not from where they are.
            let (tolerance, from) =
                if ratio > 100.0 { (1e-9, (&many, &mut workspace)) } else { (1e-12, (&turned, &mut beside)) };
            let at_once = Settings { tolerance, ..by(Method::Equilibrium) };
            let all = found(&problem, &at_once, Some(&from.0.guess), from.1);
            // Of a thousand lengths `ℓ` each of hundreds of joints may be off by the tolerance, 1e-11 of the length, and what the thread stretches by is a
            // tenth of it. What an inextensible one has to spare is of the order of `ℓ`, and its tension follows from that.
            let within = match kinematics {
                _ if ratio <= 100.0 => 1e-10,
                Kinematics::Cosserat => 1e-9,
                Kinematics::Kirchhoff => 1e-8,
            };
            let gap = apart(&problem, &all, &many);
            assert!(gap < within, "{what}: {gap:e}");
            assert!(many.imbalance(&problem) < 1e-12, "{what}: {:e}", many.imbalance(&problem));
            assert_eq!(many.report.morse_index, Some(0), "{what}");
            let shooting = Settings { max_halvings: 0, ..by(Method::Shooting) };
            let shot = solve(&problem, &shooting, Some(&turned.guess), &mut Workspace::default());
            assert!(shot.is_err(), "{what}: shooting gets there too");
            let cold = found(&problem, &settings, None, &mut Workspace::default());
            let gap = apart(&problem, &many, &cold);
            assert!(gap < within, "{what}: cold {gap:e}");
        }
    }
}

#[test]
fn other_units_change_nothing_in_the_search() {
    let in_units = |length: f64, force: f64| {
        let mut description = description(Kinematics::Cosserat, RestShape::default());
        description.length *= length;
        description.base.position = description.base.position * length;
        let Profile::Given { law: Law::Diagonal(stiffness), .. } = &mut description.profile else {
            unreachable!()
        };
        let bending = force * length * length;
        stiffness.bending = stiffness.bending.map(|x| x * bending);
        stiffness.torsion *= bending;
        stiffness.axial *= force;
        stiffness.shear = stiffness.shear.map(|x| x * force);
        let rod = Rod::with_elements(description, 50, &[], Order::Second).unwrap();
        let base = rod.description().base;
        let mut problem = Problem::cantilever(rod);
        problem.loads.world.iter_mut().for_each(|load| load.linear = Vec3::new(0.02, 0.0, -0.05) * force);
        let shift = Vec3::new(0.1, 0.2, 0.5) * length;
        let turn = Quat::from_rotation_vector(Vec3::new(0.8, -1.0, 0.5)).to_matrix();
        problem.end = Support::clamped(base.compose(&Pose { rotation: turn, position: shift }));
        found(&problem, &by(Method::MultipleShooting), None, &mut Workspace::default()).report
    };
    let plain = in_units(1.0, 1.0);
    for (length, force) in [(1e3, 1.0), (1e-3, 1e4), (7.0, 1e-6)] {
        let scaled = in_units(length, force);
        assert_eq!(scaled.iterations, plain.iterations, "{length} {force}");
        assert_eq!(scaled.factorisations, plain.factorisations, "{length} {force}");
        for (a, b) in scaled.residual_history.iter().zip(&plain.residual_history) {
            assert!((a - b).abs() <= 1e-6 * b + 1e-12, "{length} {force}: {a:e}, {b:e}");
        }
    }
}

#[test]
fn work_grows_linearly_with_the_length_over_which_the_thread_bends() {
    let mut before = None;
    for ratio in [60.0, 120.0, 240.0, 480.0] {
        let (mut problem, mut workspace, first) = taut(Kinematics::Cosserat, Order::Second, ratio);
        problem.start.pose =
            problem.start.pose.compose(&Pose::exp(Vec6::new(Vec3::new(0.1, 0.0, 0.0), Vec3::ZERO)));
        let eliminated = workspace.multiple.system.eliminated;
        let settings = Settings { tolerance: 1e-11, ..by(Method::MultipleShooting) };
        let turned = found(&problem, &settings, Some(&first.guess), &mut workspace);
        let joints = workspace.multiple.system.eliminated - eliminated;
        let each = joints as f64 / turned.report.factorisations as f64;
        assert_eq!(each.fract(), 0.0);
        assert!((0.45..0.6).contains(&(each / ratio)), "{ratio}: {each} joints");
        if let Some((iterations, factorisations)) = before {
            assert!(turned.report.iterations <= iterations + 1, "{ratio}: {:?}", turned.report);
            assert!(turned.report.factorisations <= factorisations + 1, "{ratio}: {:?}", turned.report);
        }
        before = Some((turned.report.iterations, turned.report.factorisations));
    }
}

#[test]
fn what_is_not_found_is_a_failure_with_its_history_and_the_multistep_scheme_is_refused() {
    let rod = rod(Kinematics::Kirchhoff, RestShape::default(), 50, Order::Second);
    let base = rod.description().base;
    let near = base.compose(&Pose { rotation: Mat3::IDENTITY, position: Vec3::new(0.0, 0.1, 0.5) });
    let problem = Problem { end: Support::clamped(near), ..Problem::cantilever(rod) };
    let settings = Settings { max_iterations: 2, ..by(Method::MultipleShooting) };
    let guess = Guess::new(near, Wrench::ZERO);
    let failure = solve(&problem, &settings, Some(&guess), &mut Workspace::default()).unwrap_err();
    assert!(matches!(failure.reason, FailureReason::NotConverged { .. }), "{failure}");
    let report = &failure.nearest.report;
    assert!(!report.residual_history.is_empty() && report.residual > 1e-12, "{report:?}");
    assert_eq!(report.method, Method::MultipleShooting);
    let settings = Settings { scheme: Scheme::Multistep, ..by(Method::MultipleShooting) };
    let failure = solve(&problem, &settings, None, &mut Workspace::default()).unwrap_err();
    assert_eq!(failure.reason, FailureReason::SchemeOfSegments);
}
