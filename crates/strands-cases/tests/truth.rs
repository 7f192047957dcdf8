//! The named cases, solved from rest, against their reference answers.

use strands::rod::Order;
use strands::statics::Settings;
use strands_cases::{Case, find};

/// Solves every row of a case with elements of order 4 and checks each quantity against the nearest known answer.
fn check(name: &str, tolerance: f64) {
    check_rows(name, tolerance, |_| true);
}

/// The same for the rows whose label `keep` takes.
fn check_rows(name: &str, tolerance: f64, keep: impl Fn(&str) -> bool) {
    let mut case: Case = find(name).unwrap_or_else(|| panic!("no case {name}"));
    case.rows.retain(|row| keep(&row.label));
    assert!(!case.rows.is_empty());
    // A row that starts near its answer must be found from there: nothing found from rest instead.
    let settings = Settings { tolerance, restart_from_rest: false, ..Settings::default() };
    for (row, outcome) in case.rows.iter().zip(case.solve(case.elements, Order::Fourth, &settings)) {
        let outcome = outcome.unwrap_or_else(|error| panic!("{name}, {}: {error}", row.label));
        for comparison in &outcome.comparisons {
            let (error, quantity) = (comparison.error, comparison.expected.quantity);
            assert!(error <= case.tolerance, "{name}, {}: {quantity} is off by {error:.2e}", row.label);
        }
        let known = row.answers[outcome.answer].index;
        if known.is_some() {
            assert_eq!(outcome.solution.report.morse_index, known, "{name}, {}: stability", row.label);
        }
        assert!(outcome.solution.imbalance(&outcome.problem) < 1e-9, "{name}, {}", row.label);
    }
}

#[test]
fn planar_elastica_matches_elliptic_integrals() {
    check("cantilever-dead-load", 1e-9);
}

#[test]
fn follower_load_matches_the_rectangular_elastica() {
    check("cantilever-follower-load", 1e-12);
}

#[test]
fn end_moment_bends_the_rod_to_a_circle() {
    check("cantilever-end-moment", 1e-12);
}

#[test]
fn heavy_cantilever_matches_up_to_three_thousand_times_its_stiffness() {
    check("heavy-cantilever", 1e-9);
}

#[test]
fn shear_and_stretch_match_reissner() {
    check("reissner-cantilever", 1e-12);
}

#[test]
fn small_deflections_match_timoshenko() {
    check("timoshenko-cantilever", 1e-12);
}

#[test]
fn the_45_degree_bend_matches_its_converged_values() {
    check("bend-45", 1e-12);
}

#[test]
fn a_rod_rolls_up_to_a_helix_of_ten_turns() {
    check("helix-roll-up-cosserat", 1e-11);
    check("helix-roll-up-kirchhoff", 1e-11);
}

#[test]
fn helical_springs_match_the_helices_that_they_turn_into() {
    // These are 16 and 20 times as long as ℓ, ℓ² = EI/F, and found no better than to exp(L/ℓ) times round-off.
    let hard = ["5 turns at 30°, stretched by 0.5,", "3 turns at 60°, stretched by 0.1,"];
    let is_hard = |label: &str| hard.iter().any(|start| label.starts_with(start));
    for name in ["helical-spring-wrench", "helical-spring-pose"] {
        assert_eq!(find(name).map(|case| case.rows.len()), Some(42), "{name}");
        check_rows(name, 5e-9, is_hard);
        // The force of one that is stretched by 1e-5 is a difference of places that are nearly the same.
        check_rows(name, 1e-12, |label| !is_hard(label));
    }
}

#[test]
fn macneal_and_harders_beams_match() {
    check("twisted-beam", 1e-12);
    check("curved-beam", 1e-12);
}

#[test]
fn tip_wrench_with_a_distributed_force_matches() {
    for number in [1, 2, 4, 5, 7, 8, 10, 11] {
        check(&format!("tip-wrench-{number:02}"), 1e-11);
    }
}

#[test]
fn a_steel_rod_with_a_tip_wrench_matches_a_runge_kutta_solution() {
    check("steel-tip-wrench", 1e-12);
}

#[test]
fn a_held_tip_is_reached_cold_at_a_known_stable_equilibrium() {
    let posed = strands_cases::all().into_iter().filter(|case| case.name.starts_with("pose-"));
    let names: Vec<String> = posed.map(|case| case.name).collect();
    assert_eq!(names.len(), 34);
    for name in names {
        check(&name, 1e-11);
    }
}

#[test]
fn held_tips_stay_on_the_stable_branch_and_match_frame_by_frame() {
    for workload in strands_cases::workloads::all() {
        let settings = Settings { tolerance: 1e-10, ..Settings::default() };
        let frames = workload.run(400, Order::Fourth, &settings);
        let frames = frames.unwrap_or_else(|error| panic!("{}: {error}", workload.name));
        assert_eq!(frames.len(), strands_cases::workloads::FRAMES);
        for frame in frames {
            for comparison in &frame.comparisons {
                let (error, quantity) = (comparison.error, comparison.expected.quantity);
                assert!(error < 1e-8, "{} {}: {quantity} is off by {error:.2e}", workload.name, frame.frame);
            }
        }
    }
}

#[test]
fn buckled_rods_match_eulers_elastica() {
    // So close to the buckling load that a residual of 1e-10 shows.
    check("buckled-column", 1e-12);
    check("buckled-pinned-distance", 1e-11);
    check("buckled-pinned-load", 1e-12);
    check("buckled-clamped-distance", 1e-11);
    check("buckled-clamped-load", 1e-12);
}

#[test]
fn the_cantilever_test_matches_its_master_curve() {
    check("romero-cantilever", 1e-11);
}

#[test]
fn heavy_rods_between_clamps_match_down_to_the_catenary() {
    check("heavy-clamped", 1e-11);
    check("catenary-limit", 1e-10);
}

#[test]
fn wires_that_stretch_hang_as_irvine_says() {
    check("hanging-rod", 1e-11);
    check("elastic-catenary", 1e-10);
}

#[test]
fn rings_and_arches_match() {
    check("pinched-ring", 1e-11);
    check("deep-arch", 1e-10);
    check("symmetric-arch", 1e-11);
}

#[test]
fn three_points_are_held_cold_at_a_known_stable_equilibrium() {
    for number in [1, 3, 5, 7, 9] {
        check(&format!("three-points-{number:02}"), 1e-11);
    }
}
