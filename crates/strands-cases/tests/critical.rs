//! The loads at which rods lose their stability, against their reference values, and the Morse index below and above each.

use strands::rod::Order;
use strands_cases::{CriticalCase, all_critical};

fn check(name: &str) {
    let case: CriticalCase =
        all_critical().into_iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no case {name}"));
    assert!(!case.branches.is_empty());
    for branch in &case.branches {
        let found = branch
            .critical_loads(case.elements, Order::Fourth)
            .unwrap_or_else(|error| panic!("{name}, {}: {error}", branch.label));
        assert_eq!(found.len(), branch.critical.len(), "{name}, {}: {found:?}", branch.label);
        for (k, (found, known)) in found.iter().zip(&branch.critical).enumerate() {
            let error = (found.load / known - 1.0).abs();
            assert!(error <= case.tolerance, "{name}, {}, load {k}: off by {error:.1e}", branch.label);
            let ways = [k * branch.ways, (k + 1) * branch.ways];
            assert!(found.index.is_none_or(|index| index == ways), "{name}, {}: {found:?}", branch.label);
        }
    }
}

#[test]
fn columns_buckle_at_eulers_loads() {
    check("euler-loads");
}

#[test]
fn columns_that_shear_and_stretch_buckle_at_haringxs_loads() {
    check("shearing-columns");
}

#[test]
fn upright_columns_buckle_under_greenhills_weights() {
    check("greenhill-columns");
}

#[test]
fn beams_tip_over_to_the_side_after_an_exact_deflection() {
    check("lateral-torsional");
    check("lateral-torsional-fork");
    check("ribbon");
}

#[test]
fn torque_and_thrust_coil_a_straight_rod() {
    check("torque-and-thrust");
}

#[test]
fn a_twisted_ring_leaves_the_plane_where_michell_and_zajac_say() {
    check("twisted-ring");
}

#[test]
fn a_ring_collapses_under_pressure_and_an_arch_sways() {
    check("pressed-ring");
    check("swaying-arch");
}
