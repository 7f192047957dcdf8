//! Distances of segments, how they bend, and how far segments may go.

use super::distance::{Ends, Nearest, free_part};
use crate::contact::law::{Law, Multipliers};
use crate::math::Vec3;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vec3> {
    let part = || -1.0..1.0_f64;
    (part(), part(), part()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn ends() -> impl Strategy<Value = Ends> {
    [vector(), vector(), vector(), vector()]
}

fn distance(ends: &Ends) -> f64 {
    Nearest::of(ends).apart.norm()
}

/// By another way: alternating projections from several places, which find the least distance as that of two convex sets.
fn least(ends: &Ends) -> f64 {
    let [a, b, c, d] = *ends;
    let foot = |p: Vec3, from: Vec3, to: Vec3| {
        let t = (p - from).dot(to - from) / (to - from).dot(to - from);
        from + (to - from) * t.clamp(0.0, 1.0)
    };
    let mut p = a;
    for _ in 0..20_000 {
        p = foot(foot(p, c, d), a, b);
    }
    (p - foot(p, c, d)).norm()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_nearest_places_are_nearest(ends in ends()) {
        let (found, least) = (distance(&ends), least(&ends));
        prop_assert!(found <= least + 1e-12 && found > least - 1e-4, "{found} {least}");
    }

    #[test]
    fn a_distance_bends_as_it_says(ends in ends(), shifts in ends()) {
        let nearest = Nearest::of(&ends);
        let distance_now = nearest.apart.norm();
        prop_assume!(distance_now > 0.05);
        let normal = nearest.apart * (1.0 / distance_now);
        let at = |h: f64| core::array::from_fn(|k| ends[k] + shifts[k] * h);
        let h = 1e-4;
        // Not where a place comes to an end of its segment.
        let slides = |ends: &Ends| Nearest::of(ends).at.map(|s| s > 0.0 && s < 1.0);
        prop_assume!(slides(&at(h)) == slides(&at(-h)) && slides(&ends) == slides(&at(h)));
        let along = ends[1] - ends[0];
        let other = ends[3] - ends[2];
        prop_assume!(along.cross(other).norm() > 0.2 * along.norm() * other.norm());
        let curvature = nearest.curvature(&ends, normal, distance_now, 0.0);
        let said: f64 = (0..16).map(|k| shifts[k / 4].dot(curvature[k / 4][k % 4] * shifts[k % 4])).sum();
        let [back, ahead] = [-h, h].map(|h| distance(&at(h)));
        let found = (back + ahead - 2.0 * distance_now) / (h * h);
        prop_assert!((said - found).abs() < 1e-3 * (1.0 + said.abs() / distance_now), "{said} {found}");
        let slope: f64 = shifts.iter().zip(nearest.weights()).map(|(shift, weight)| shift.dot(normal) * weight).sum();
        prop_assert!((slope - (ahead - back) / (2.0 * h)).abs() < 1e-4, "{slope}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_passes_through_anything_on_the_free_part_of_its_way(ends in ends(), shifts in ends()) {
        let thickness = 0.5 * distance(&ends);
        prop_assume!(thickness > 1e-6);
        let part = free_part(&ends, &shifts, thickness);
        for k in 0..=50 {
            let h = part * f64::from(k) / 50.0;
            let moved = core::array::from_fn(|end| ends[end] + shifts[end] * h);
            prop_assert!(distance(&moved) > thickness, "{} at {h} of {part}", distance(&moved));
        }
        // And it goes on where it may.
        let stopped = core::array::from_fn(|end| ends[end] + shifts[end] * part);
        prop_assert!(part == 1.0 || distance(&stopped) < 1.5 * thickness, "{part} {}", distance(&stopped));
    }
}

#[test]
fn parallel_segments_touch_in_the_middle_of_where_they_are_beside_each_other() {
    let ends = [Vec3::ZERO, Vec3::Z, Vec3::new(0.1, 0.0, 0.5), Vec3::new(0.1, 0.0, 2.0)];
    let nearest = Nearest::of(&ends);
    assert!(
        (nearest.at[0] - 0.75).abs() < 1e-12 && (nearest.apart.norm() - 0.1).abs() < 1e-12,
        "{nearest:?}"
    );
}

#[test]
fn what_sticks_and_what_slides() {
    let law = Law::new(0.5, 10.0, 1e-9, (1e-30, 1.0));
    let pressed = Multipliers { pressed: 2.0, anchor: Vec3::new(0.3, 0.0, 0.0), bound: None };
    let stuck = law.respond(&pressed, Vec3::Z, 0.0, Vec3::ZERO, None, false);
    assert!((stuck.force - Vec3::new(0.3, 0.0, 2.0)).norm() < 1e-12 && stuck.off < 1e-12, "{stuck:?}");
    // A slip along x is resisted by the whole of the friction that there may be.
    let slides = law.respond(&pressed, Vec3::Z, 0.0, Vec3::new(0.1, 0.0, 0.0), None, false);
    assert!((slides.friction - Vec3::new(-1.0, 0.0, 0.0)).norm() < 1e-12, "{slides:?}");
    // A gap has no force: what pressed is to go, with all of its stiffness.
    let apart = law.respond(&Multipliers { pressed: 0.0, ..pressed }, Vec3::Z, 0.3, Vec3::ZERO, None, false);
    assert!(apart.force == Vec3::ZERO && apart.pull.norm() < 1e-15 && apart.stiffness.max_abs() < 1e-15);
}

#[test]
fn the_hole_of_a_ring_is_no_narrower_than_said() {
    let (middle, axis) = (Vec3::new(0.1, -0.2, 0.3), Vec3::new(0.6, 0.0, 0.8));
    let ring = super::Shape::Ring { middle, axis, radius: 5e-3, wire_radius: 1e-3 };
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for part in ring.parts() {
        let super::Part::Round { ends, radius, capped: true } = part else { panic!("{part:?}") };
        for k in 0..=100 {
            let away = ends[0] + (ends[1] - ends[0]) * (f64::from(k) / 100.0) - middle;
            assert!(away.dot(axis).abs() < 1e-15);
            least = least.min(away.norm() - radius);
            most = most.max(away.norm() - radius);
        }
    }
    assert!((least - 4e-3).abs() < 1e-15 && most < 4.05e-3, "{least} {most}");
}
