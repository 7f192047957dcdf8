//! Numbers that are off by a thousand: what is given in millimetres, megapascals or grams where metres, pascals and kilograms are meant.

use super::numbers::{Numbers, rest_curvature};
use super::{Remarks, View, metres, short};
use crate::document::KeyPath;
use crate::file::{SceneFile, SectionFile};
use strands::math::Vec3;

/// Young's moduli, Pa, between a very soft gel and diamond ten times over.
const MODULI: core::ops::RangeInclusive<f64> = 1e3..=1e13;
/// Below this, Pa, no metal is; above the density, kg/m³, little else is.
const SOFTEST_METAL: f64 = 1e7;
const LIGHTEST_METAL: f64 = 4e3;
/// Densities, kg/m³, between a foam and the heaviest metal.
const DENSITIES: core::ops::RangeInclusive<f64> = 25.0..=25e3;
/// A rod thicker than this part of its length is none.
const THICKEST: f64 = 1.0 / 3.0;
/// A thread of 10 m is a hundred thousand of its radii long; rods longer than this many are hardly ever meant.
const LONGEST: f64 = 3e5;
/// What the Earth gives, m/s².
const EARTH: f64 = 9.81;

/// Looks at materials and gravity.
pub(super) fn look(remarks: &mut Remarks<'_>, file: &SceneFile) {
    for (name, material) in &file.materials {
        let path = KeyPath::of("materials").key(name);
        modulus(remarks, &path, material.youngs_modulus, material.density);
        let density = material.density;
        if density > 0.0 && !DENSITIES.contains(&density) {
            let meant = if density < *DENSITIES.start() { density * 1e3 } else { density * 1e-3 };
            remarks.warn(
                &path.key("density"),
                format!("a density of {} kg/m³ is that of no solid", short(density)),
                format!("give it in kg/m³: water has 1000, steel 7850; perhaps {} was meant", short(meant)),
            );
        }
    }
    let gravity = Vec3::from(file.gravity.unwrap_or_default()).norm();
    for (factor, unit) in [(1e3, "mm/s²"), (1e-3, "km/s²")] {
        if (gravity / (EARTH * factor) - 1.0).abs() < 0.1 {
            remarks.warn(
                &KeyPath::of("gravity"),
                format!("gravity is {} m/s², which is the Earth's in {unit}", short(gravity)),
                "give it in m/s², as `gravity = [0.0, 0.0, -9.81]`",
            );
        }
    }
}

fn modulus(remarks: &mut Remarks<'_>, path: &KeyPath, modulus: f64, density: f64) {
    let metal_too_soft = density > LIGHTEST_METAL && modulus < SOFTEST_METAL;
    if MODULI.contains(&modulus) && !metal_too_soft {
        return;
    }
    let message = if metal_too_soft {
        format!(
            "a Young's modulus of {} Pa is softer than rubber, and the density of {} kg/m³ is a metal's",
            short(modulus),
            short(density)
        )
    } else {
        format!("no material has a Young's modulus of {} Pa", short(modulus))
    };
    let mend = if modulus < SOFTEST_METAL && !short(modulus).contains('e') {
        format!("give it in Pa: {0} GPa is {0}e9, {0} MPa is {0}e6", short(modulus))
    } else {
        "give it in Pa: steel has 200e9, rubber 5e6".to_owned()
    };
    remarks.warn(&path.key("youngs_modulus"), message, mend);
}

/// Looks at a rod's thickness beside its length and its rest shape.
pub(super) fn look_at_rod(remarks: &mut Remarks<'_>, view: &View<'_>) {
    let Numbers { length, radius: Some(radius), .. } = Numbers::expected(view) else { return };
    let key = |path: &KeyPath, name: &str| path.key(name);
    let thick = view.sections().into_iter().map(|(path, section)| {
        let (name, size) = largest(section);
        (key(&path, name), size)
    });
    let thickest = thick.reduce(|most, here| if here.1 > most.1 { here } else { most });
    if let Some((path, size)) = thickest
        && 2.0 * radius > THICKEST * length
    {
        remarks.warn(
            &path,
            format!(
                "the rod is {} thick and {} long: that is no rod",
                metres(2.0 * radius),
                metres(length)
            ),
            format!("lengths are in metres: {0} mm is {0}e-3; a rod should be ten times as long as it is thick, or more", short(size)),
        );
    } else if length > LONGEST * radius {
        remarks.warn(
            &view.path.key("length"),
            format!("the rod is {} long, {} of its radii", metres(length), short(length / radius)),
            "lengths are in metres, those of the section too: is this one in millimetres?",
        );
    }
    let (curvature, s) = rest_curvature(&view.rod.problem.rod);
    let half = view.rod.problem.rod.mesh().nodes().partition_point(|node| *node < s);
    let half = view.rod.problem.rod.half_extent()[half].iter().fold(0.0_f64, |most, half| most.max(*half));
    let ratio = half * curvature;
    let says = format!(
        "at rest the rod is curved to a radius of {} at s = {}, and {} thick there",
        metres(1.0 / curvature),
        metres(s),
        metres(2.0 * half)
    );
    let rest = view.path.key("rest");
    if ratio >= 1.0 {
        remarks.warn(
            &rest,
            says,
            "it would run into itself: curvature is in 1/m, the inverse of the radius in metres",
        );
    } else if ratio > 0.1 {
        let percent = 100.0 * ratio;
        let why = format!(
            "a rod's law holds where it is thin beside the radius it is curved to; here r κ is {percent:.0} %, and errors of that square are to \
             be expected"
        );
        remarks.note(&rest, says, why);
    }
}

/// The key of a section's largest size, and the size, m.
fn largest(section: &SectionFile) -> (&'static str, f64) {
    let sizes = [
        ("radius", section.radius),
        ("outer_radius", section.outer_radius),
        ("a", section.a),
        ("b", section.b),
        ("width", section.width),
        ("height", section.height),
    ];
    let given = sizes.into_iter().filter_map(|(key, size)| Some((key, size?)));
    given.reduce(|most, here| if here.1 > most.1 { here } else { most }).unwrap_or(("shape", 0.0))
}
