//! Supports that are further apart than the rod is long, and forces that tear it.

use super::numbers::{Numbers, axial};
use super::{Remarks, View, metres, short};
use crate::document::KeyPath;
use strands::rod::Kinematics;

/// More than this part of its length, a support should not stretch a rod unawares.
const MUCH_STRETCH: f64 = 0.03;
/// Beyond this strain the law, stress in proportion to strain, holds for hardly any material.
pub(super) const MUCH_STRAIN: f64 = 0.1;

/// Looks at the supports.
pub(super) fn look(remarks: &mut Remarks<'_>, view: &View<'_>) {
    let rod = &view.rod.problem.rod;
    let nodes = rod.mesh().nodes();
    for stretch in view.rod.problem.stretches() {
        let by = -stretch.spare();
        let key = || view.support_key(nodes[stretch.to]);
        let apart = format!(
            "the rod is held at s = {} and at s = {} in places {} apart",
            metres(nodes[stretch.from]),
            metres(nodes[stretch.to]),
            metres(stretch.chord.norm())
        );
        match rod.kinematics() {
            Kinematics::Kirchhoff if by > 1e-12 => remarks.warn(
                &key(),
                format!(
                    "{apart}, and it is inextensible and {} long between: there is no equilibrium",
                    metres(stretch.length)
                ),
                "bring them nearer, give the rod more length, or let it stretch: `kinematics = \"cosserat\"`",
            ),
            Kinematics::Cosserat if by > MUCH_STRETCH => {
                let pull = axial(rod)
                    .map_or_else(String::new, |axial| format!(", which takes {} N", short(axial * by)));
                remarks.warn(
                    &key(),
                    format!("{apart}: it is stretched by {:.1} %{pull}", 100.0 * by),
                    format!(
                        "it is {} long between them; bring them nearer if that is not meant",
                        metres(stretch.length)
                    ),
                );
            }
            _ => {}
        }
    }
}

/// Looks at what the loads would do if they all pulled along the rod.
pub(super) fn look_at_loads(remarks: &mut Remarks<'_>, view: &View<'_>) {
    let (rod, numbers) = (&view.rod.problem.rod, Numbers::expected(view));
    let pull = numbers.force + numbers.weight * numbers.length;
    if let Some(axial) = axial(rod)
        && pull > MUCH_STRAIN * axial
    {
        remarks.warn(
            &largest_load(view),
            format!(
                "the loads come to {} N, and the rod's EA is {} N: along it they would strain it by {:.0} %",
                short(pull),
                short(axial),
                100.0 * pull / axial
            ),
            "forces are in N, and the law holds for strains of some percent: check the load's unit, the modulus and the section",
        );
    }
}

/// The key of the largest force at a point or along a stretch; gravity's where the weight is larger.
fn largest_load(view: &View<'_>) -> KeyPath {
    let loads = view.path.key("loads");
    let length = view.rod.problem.rod.length();
    let weight = view.rod.loads.gravity.norm() * view.rod.problem.rod.mass();
    let forces = view.file.loads.iter().enumerate().filter_map(|(i, load)| {
        let place = loads.index(i);
        let norm = |force: [f64; 3]| force.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along = |per_length| {
            let (from, to) = (
                load.from.map_or(0.0, |at| at.metres(length)),
                load.to.map_or(length, |at| at.metres(length)),
            );
            (place.key("force_per_length"), norm(per_length) * (to - from))
        };
        load.force.map(|force| (place.key("force"), norm(force))).or_else(|| load.force_per_length.map(along))
    });
    forces.fold((KeyPath::of("gravity"), weight), |most, here| if here.1 > most.1 { here } else { most }).0
}
