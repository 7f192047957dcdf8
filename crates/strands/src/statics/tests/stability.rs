//! Which equilibria are stable, where round-off would say otherwise, and how the others fall.

use super::*;
use core::f64::consts::PI;

/// A straight rod of length one and `EI = 1` about its `d1`, pinned at both ends along an axis, along which a force presses it: `part` of Euler's.
fn pinned_column(base: Pose, elements: usize, bending: [f64; 2], part: f64) -> Problem {
    let stiffness = Stiffness { bending, torsion: 0.8, axial: 1e6, shear: [1e6; 2] };
    let description = RodDescription {
        length: 1.0,
        profile: Profile::Given {
            law: Law::Diagonal(stiffness),
            mass_per_length: 0.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.001; 2],
        },
        base,
        ..description(Kinematics::Kirchhoff, RestShape::default())
    };
    let rod = Rod::with_elements(description, elements, &[], Order::Second).unwrap();
    let along = base.rotation.cols[2];
    let wrench = Wrench::new(Vec3::ZERO, along * (-part * PI * PI));
    let load = PointLoad { at: 1.0, wrench, frame: Frame::World };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load).unwrap();
    // It must not turn about its axis as a whole.
    let start = Support::of([false, false, true, true, true, true], base);
    let far = base.compose(&Pose { position: Vec3::Z, ..Pose::IDENTITY });
    let end = Support::pinned(far).sliding_along(along);
    Problem { loads, start, end, ..Problem::cantilever(rod) }
}

fn skew() -> Pose {
    description(Kinematics::Kirchhoff, RestShape::default()).base
}

fn unstable(problem: &Problem) -> (Solution, UnstableMode) {
    let mut workspace = Workspace::default();
    let straight = nearest(problem, &Settings::default(), None, &mut workspace).unwrap();
    let mode = unstable_mode(problem, &straight, &mut workspace).unwrap();
    (straight, mode)
}

/// The largest distance of a mode's shifts from those of `sin kπs/L`, over the largest of these.
fn off_sine(mode: &UnstableMode, waves: f64) -> f64 {
    let n = mode.displacement.len() - 1;
    let sine = |i: usize| (waves * PI * i as f64 / n as f64).sin();
    let crest = (0.5 / waves * n as f64).round() as usize;
    let most = mode.displacement[crest] * (1.0 / sine(crest));
    let off = |i: usize| (mode.displacement[i] - most * sine(i)).norm() / most.norm();
    (0..=n).map(off).fold(0.0, f64::max)
}

#[test]
fn eulers_column_falls_in_a_sine() {
    for (elements, part) in [(20, 1.2), (100, 1.2), (100, 5.0), (2000, 1.000_01)] {
        let problem = pinned_column(skew(), elements, [1.0, 1.3], part);
        let (_, mode) = unstable(&problem);
        assert!(off_sine(&mode, 1.0) < 1e-5, "{elements}, {part}: {:e}", off_sine(&mode, 1.0));
        // Softest about d1, it moves along d2; where it turns most, at its ends, it turns by one.
        let middle = mode.displacement[elements / 2];
        assert!((middle.dot(skew().rotation.cols[1]).abs() - 1.0 / PI).abs() < 2e-3, "{middle:?}");
        assert!((mode.rotation[0].norm() - 1.0).abs() < 2e-3);
        // ½ ∫ EI θ'² − P θ² with θ = cos πs: a quarter of π² − P, and twice that is the second derivative.
        let exact = 0.5 * PI * PI * (1.0 - part);
        let off = mode.curvature - exact;
        let discrete = 50.0 / (elements * elements) as f64;
        assert!(off.abs() < discrete + 1e-6, "{elements}, {part}: {} and {exact}", mode.curvature);
    }
}

#[test]
fn of_several_ways_down_the_steepest_is_given() {
    // Under ten times the load three waves, of one or two arches, are unstable about d1, and two about d2: steepest is that of two arches.
    let problem = pinned_column(skew(), 200, [1.0, 1.3], 10.0);
    let (straight, mode) = unstable(&problem);
    assert_eq!(straight.report.morse_index, Some(5));
    assert!(off_sine(&mode, 2.0) < 1e-5, "{:e}", off_sine(&mode, 2.0));
}

#[test]
fn displaced_by_its_mode_either_way_a_column_leaves_for_its_two_buckled_shapes() {
    let problem = pinned_column(skew(), 100, [1.0, 1.3], 1.5);
    let (straight, mode) = unstable(&problem);
    let middle = |solution: &Solution| solution.poses[50].position;
    let ends = [0.2, -0.2].map(|part| {
        let mut moved = straight.clone();
        for (i, pose) in moved.poses.iter_mut().enumerate() {
            let turn = Quat::from_rotation_vector(mode.rotation[i] * part).to_matrix();
            *pose = Pose {
                rotation: turn * pose.rotation,
                position: pose.position + mode.displacement[i] * part,
            };
        }
        let found = rest_from(&problem, &Settings::default(), &moved, &mut Workspace::default()).unwrap();
        assert_eq!(found.report.morse_index, Some(0));
        assert!(unstable_mode(&problem, &found, &mut Workspace::default()).is_none());
        let aside = middle(&found) - middle(&straight);
        assert!(aside.dot(mode.displacement[50]) * part > 0.0, "{part}: {aside:?}");
        found
    });
    let energy = ends.each_ref().map(|solution| solution.energy.elastic + solution.energy.load);
    let of_straight = straight.energy.elastic + straight.energy.load;
    assert!((energy[0] - energy[1]).abs() < 1e-9 && energy[0] < of_straight, "{energy:?}");
}

#[test]
fn a_mode_turns_with_the_rod() {
    let turned = Pose::from_parts(Vec3::new(3.0, -1.0, 2.0), Quat::from_wxyz([0.2, -0.7, 0.4, 0.5]).unwrap());
    let modes = [skew(), turned].map(|base| {
        let (_, mode) = unstable(&pinned_column(base, 60, [1.0, 1.3], 2.0));
        let in_base = |v: &Vec3| base.rotation.transpose_mul(*v);
        let parts = mode.rotation.iter().chain(&mode.displacement).map(in_base).collect::<Vec<_>>();
        (mode.curvature, parts)
    });
    let [(a, first), (b, second)] = &modes;
    assert!((a / b - 1.0).abs() < 1e-7, "{a} and {b}");
    let sign = first[30].dot(second[30]).signum();
    for (u, v) in first.iter().zip(second) {
        assert!((*u - *v * sign).norm() < 1e-6, "{u:?} and {v:?}");
    }
}

#[test]
fn a_column_buckles_however_many_elements_it_has_and_stays_straight_below_eulers_load() {
    for tolerance in [1e-9, 1e-12] {
        let settings = Settings { tolerance, ..Settings::default() };
        for elements in [100, 800, 3000] {
            // Round, it is free to turn about its axis when buckled: no way down.
            for bending in [[1.0; 2], [1.0, 1.3]] {
                for (part, amplitude) in [(0.999, 0.0), (1.000_4, 0.018), (1.2, 0.324)] {
                    let problem = pinned_column(skew(), elements, bending, part);
                    let solution = solved(&problem, &settings);
                    let what = format!("{elements}, {bending:?}, {part}, {tolerance:e}");
                    let middle = skew().inverse().compose(&solution.poses[elements / 2]).position;
                    let aside = middle.x.hypot(middle.y);
                    assert!((aside - amplitude).abs() <= 0.15 * amplitude + 1e-6, "{what}: {aside}");
                    assert_eq!(solution.report.morse_index, Some(0), "{what}");
                }
            }
        }
    }
}

#[test]
fn the_index_of_a_column_is_that_of_its_load_to_a_part_in_a_million() {
    let at = |elements: usize, part: f64| {
        let problem = pinned_column(skew(), elements, [1.0, 1.3], part);
        let straight = nearest(&problem, &Settings::default(), None, &mut Workspace::default()).unwrap();
        straight.report.morse_index
    };
    // The elements' own error, of second order, is below that.
    for elements in [2000, 8000] {
        assert_eq!([0.999_998, 1.000_002].map(|part| at(elements, part)), [0, 1].map(Some), "{elements}");
    }
}
