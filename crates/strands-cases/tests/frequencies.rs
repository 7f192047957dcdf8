//! Frequencies of small vibrations, against their reference values.

use core::f64::consts::PI;
use strands::assembly::MassMatrix;
use strands_cases::{VibrationCase, VibrationRow, all_vibrations};

fn case(name: &str) -> VibrationCase {
    all_vibrations().into_iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no case {name}"))
}

fn measured(row: &VibrationRow, elements: usize) -> Vec<f64> {
    row.with_elements(elements).unwrap_or_else(|error| panic!("{}: {error}", row.label))
}

/// Compares the frequencies of every row on the finer mesh, and what both meshes say of one that is endlessly fine.
fn check(name: &str) {
    let case = case(name);
    for row in &case.rows {
        let [fine, beyond] =
            row.on_two_meshes(case.elements).unwrap_or_else(|error| panic!("{name}, {}: {error}", row.label));
        for (k, expected) in row.frequencies.iter().enumerate() {
            let on_mesh = fine[k] / expected - 1.0;
            let beyond = beyond[k] / expected - 1.0;
            let fits = on_mesh.abs() < case.on_mesh && beyond.abs() < case.tolerance;
            assert!(fits, "{name}, {}, mode {}: {on_mesh:.1e}, {beyond:.1e}", row.label, k + 1);
        }
    }
}

#[test]
fn bending_torsional_and_axial_frequencies_are_exact_within_half_a_percent_and_of_second_order() {
    let bending = case("bending-vibrations").rows.into_iter().take(2);
    let waves = case("standing-waves").rows.into_iter().filter(|row| row.label.ends_with("clamped and free"));
    let mut modes = 0;
    for row in bending.chain(waves) {
        let [coarse, fine] = [50, 100].map(|elements| measured(&row, elements));
        for (k, expected) in row.frequencies.iter().enumerate() {
            let [coarse, fine] = [coarse[k], fine[k]].map(|found| found / expected - 1.0);
            assert!(fine.abs() < 5e-3, "{}, mode {}: off by {fine:.1e}", row.label, k + 1);
            let ratio = coarse / fine;
            assert!((3.9..4.1).contains(&ratio), "{}, mode {}: {coarse:.2e} {fine:.2e}", row.label, k + 1);
            modes += 1;
        }
    }
    assert_eq!(modes, 5 + 5 + 3 + 3);
}

/// A sine wave of wave number `k` on a mesh of elements of length `h`: its frequency over that in a rod that is not cut, by `x = k h`. Strains are differences of
/// places and turns; a rod that bends without shear turns at a node by the mean of both sides, `cos(x/2) θ = (2/h) sin(x/2) w`.
#[test]
fn waves_on_a_mesh_have_the_frequencies_of_either_mass_matrix() {
    const ELEMENTS: usize = 20;
    let half = |x: f64| (0.5 * x).sin() / (0.5 * x);
    let stretching = |x: f64, mass: f64| half(x) / mass.sqrt();
    let bending = |x: f64, mass: f64| half(x).powi(2) / (0.5 * x).cos() / mass.sqrt();
    let consistent = |x: f64| (2.0 + x.cos()) / 3.0;
    let waves = case("standing-waves").rows.into_iter();
    let pinned = case("bending-vibrations").rows.into_iter().filter(|row| row.label.starts_with("pinned"));
    let mut modes = 0;
    for row in waves.chain(pinned) {
        let bends = row.label.starts_with("pinned");
        for matrix in [MassMatrix::Lumped, MassMatrix::Consistent] {
            let found = measured(&row.clone().with_mass_matrix(matrix), ELEMENTS);
            for (k, (found, in_rod)) in found.iter().zip(&row.frequencies).enumerate() {
                let first = if row.label.ends_with("clamped and free") { 0.5 } else { 1.0 };
                let x = PI * (k as f64 + first) / ELEMENTS as f64;
                let mass = if matrix == MassMatrix::Lumped { 1.0 } else { consistent(x) };
                let expected = in_rod * if bends { bending(x, mass) } else { stretching(x, mass) };
                let off = found / expected - 1.0;
                assert!(off.abs() < 1e-7, "{matrix:?}, {}, mode {}: {off:.1e}", row.label, k + 1);
                modes += 1;
            }
        }
    }
    assert_eq!(modes, 2 * (6 * 3 + 4));
}

#[test]
fn slender_rods_vibrate_as_euler_and_bernoulli_say() {
    check("bending-vibrations");
}

#[test]
fn thick_rods_vibrate_as_timoshenko_says() {
    check("shearing-vibrations");
}

#[test]
fn rods_stretch_and_twist_to_and_fro_alone_and_with_a_body_at_their_tip() {
    check("standing-waves");
    check("waves-with-a-body");
}

#[test]
fn rings_vibrate_in_their_plane_and_out_of_it() {
    check("ring-vibrations");
}

#[test]
fn chains_and_cables_swing() {
    check("hanging-vibrations");
}

#[test]
fn waves_in_thick_rods_have_their_dispersion() {
    check("dispersion");
}

#[test]
fn a_cantilever_that_turns_vibrates_faster_in_all_modes() {
    check("turning-vibrations");
}
