//! How the ends of a rod are held, and the hand.

use super::{Context, load};
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{FixName, HandFile, Place, RodFile, SupportFile};
use crate::model::{GivenTargets, ModelRod};
use crate::words;
use strands::math::Pose;
use strands::rod::Rod;
use strands::statics::End;

/// The six freedoms of an end, in the order of [`End::fixed`].
const FREEDOMS: [&str; 6] = ["the tangent", "the tangent", "the twist", "x", "y", "z"];

/// The start and the end of a rod, as its supports hold them, and what of the end's targets they give.
pub(super) fn ends(
    context: &Context,
    path: &KeyPath,
    file: &RodFile,
    rod: &Rod,
) -> Result<(End, End, GivenTargets), SceneError> {
    let unloaded = rod.rest_poses();
    let mut start = Held::free(unloaded[0]);
    let mut end = Held::free(unloaded[rod.elements()]);
    let supports = path.key("supports");
    for (i, support) in file.supports.iter().enumerate() {
        let place = supports.index(i);
        let s = load::place(context, &place.key("at"), support.at, rod.length())?;
        let slack = 1e-9 * rod.length();
        let held = if s <= slack {
            &mut start
        } else if support.at.is_end(rod.length()) {
            &mut end
        } else {
            let error =
                context.document.error(&place.key("at"), "supports inside the rod are not in this version");
            return Err(error.mend("hold the rod at \"start\" or \"end\""));
        };
        held.add(context.document, &place, support)?;
    }
    if !start.end.fixed.contains(&true) && !end.end.fixed.contains(&true) {
        let error = context.document.error(path, "nothing holds the rod");
        return Err(error.mend(format!(
            "clamp its start: `[[{path}.supports]]` with `at = \"start\"` and `fix = [\"position\", \"orientation\"]`"
        )));
    }
    Ok((start.end, end.end, end.given))
}

/// An end on which supports are being put.
struct Held {
    end: End,
    given: GivenTargets,
}

impl Held {
    fn free(pose: Pose) -> Self {
        Self { end: End::free(pose), given: GivenTargets::default() }
    }

    fn add(&mut self, document: &Document, path: &KeyPath, support: &SupportFile) -> Result<(), SceneError> {
        if support.fix.is_empty() {
            let error = document.error(&path.key("fix"), "the support holds nothing");
            return Err(error.mend("say what it holds, as `fix = [\"position\", \"orientation\"]`"));
        }
        let mut fixed = [false; 6];
        for (i, name) in support.fix.iter().enumerate() {
            for freedom in freedoms(*name) {
                if fixed[freedom] || self.end.fixed[freedom] {
                    let message = format!("{} is held here twice", FREEDOMS[freedom]);
                    let error = document.error(&path.key("fix").index(i), message);
                    return Err(error.mend("\"position\" holds x, y and z, \"orientation\" holds tangent and twist: hold each once"));
                }
                fixed[freedom] = true;
            }
        }
        self.place(document, path, support, &fixed)?;
        for (held, fixed) in self.end.fixed.iter_mut().zip(fixed) {
            *held |= fixed;
        }
        Ok(())
    }

    /// Takes over the targets of a support.
    fn place(
        &mut self,
        document: &Document,
        path: &KeyPath,
        support: &SupportFile,
        fixed: &[bool; 6],
    ) -> Result<(), SceneError> {
        let unused = |key: &str, words: &str| {
            let error = document.error(&path.key(key), format!("the support does not hold the {key}"));
            error.mend(format!("add {words} to `fix`, or remove `{key}`"))
        };
        if let Some(position) = support.position {
            if !fixed[3..].contains(&true) {
                return Err(unused("position", "\"position\""));
            }
            for i in (0..3).filter(|i| fixed[3 + i]) {
                self.end.pose.position[i] = position[i];
                self.given.position[i] = true;
            }
        }
        if let Some(orientation) = support.orientation {
            let place = path.key("orientation");
            if !fixed[..3].contains(&true) {
                return Err(unused("orientation", "\"orientation\", \"tangent\" or \"twist\""));
            }
            let rotation = document.quaternion(&place, orientation)?.to_matrix();
            if self.given.orientation && rotation != self.end.pose.rotation {
                let error = document.error(&place, "two supports of this end give different orientations");
                return Err(error.mend(
                    "tangent and twist of an end are held in one frame: give both the same orientation",
                ));
            }
            self.end.pose.rotation = rotation;
            self.given.orientation = true;
        }
        Ok(())
    }
}

/// Which freedoms a word of `fix` holds.
fn freedoms(name: FixName) -> std::ops::Range<usize> {
    match name {
        FixName::Tangent => 0..2,
        FixName::Twist => 2..3,
        FixName::Orientation => 0..3,
        FixName::X => 3..4,
        FixName::Y => 4..5,
        FixName::Z => 5..6,
        FixName::Position => 3..6,
    }
}

/// Puts the hand on its rod.
pub(super) fn hand(document: &Document, hand: &HandFile, rods: &mut [ModelRod]) -> Result<(), SceneError> {
    let path = KeyPath::of("coupling").key("hand");
    let names: Vec<String> = rods.iter().map(|rod| rod.name.clone()).collect();
    let Some(rod) = rods.iter_mut().find(|rod| rod.name == hand.rod) else {
        let error = document.error(&path.key("rod"), format!("there is no rod `{}`", hand.rod));
        return Err(error.mend(words::choices("the rods here", &hand.rod, &names)));
    };
    let length = rod.problem.rod.length();
    if !hand.at.unwrap_or(Place::End).is_end(length) {
        let error =
            document.error(&path.key("at"), "a hand elsewhere than at the rod's end is not in this version");
        return Err(error.mend("write `at = \"end\"`"));
    }
    let coupling =
        hand.coupling().map_err(|bad| document.refused(&path.key(bad.key), bad.value, bad.must))?;
    rod.hand = Some(coupling);
    Ok(())
}
