//! How a rod is held, and the hand.

use super::{Context, load};
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{BodySupportFile, FixName, HandFile, KeyframeFile, Place, RodFile};
use crate::model::{Held, ModelRod, Target};
use crate::words;
use strands::math::Vec3;

/// The six freedoms of a support, in the order of [`strands::statics::Support::fixed`].
const FREEDOMS: [&str; 6] = ["the tangent", "the tangent", "the twist", "x", "y", "z"];

/// Where and how a rod's supports hold it, in the order of places. One that joints tie to something need not be held.
pub(super) fn supports(
    context: &Context,
    path: &KeyPath,
    file: &RodFile,
    length: f64,
    is_tied: bool,
) -> Result<Vec<Held>, SceneError> {
    let supports = path.key("supports");
    let mut all: Vec<Held> = Vec::new();
    for (i, support) in file.supports.iter().enumerate() {
        let place = supports.index(i);
        let s = load::place(context, &place.key("at"), support.at, length)?;
        let slack = 1e-9 * length;
        let at = match all.iter().position(|held| (held.s - s).abs() <= slack) {
            Some(at) => at,
            None => {
                all.push(Held::free(s));
                all.len() - 1
            }
        };
        all[at].add(context.document, &place, &support.without_place())?;
    }
    // What falls may come to rest on something.
    if all.is_empty() && !is_tied && context.file.contact.is_none() {
        let error = context.document.error(path, "nothing holds the rod");
        return Err(error.mend(format!(
            "clamp its start: `[[{path}.supports]]` with `at = \"start\"` and `fix = [\"position\", \"orientation\"]`"
        )));
    }
    all.sort_by(|a, b| a.s.total_cmp(&b.s));
    Ok(all)
}

/// How a body's support holds it.
pub(super) fn body(
    document: &Document,
    path: &KeyPath,
    support: &BodySupportFile,
) -> Result<Held, SceneError> {
    let mut held = Held::free(0.0);
    held.add(document, path, support)?;
    Ok(held)
}

impl Held {
    /// Takes over what a support holds.
    fn add(
        &mut self,
        document: &Document,
        path: &KeyPath,
        support: &BodySupportFile,
    ) -> Result<(), SceneError> {
        if support.fix.is_empty() {
            let error = document.error(&path.key("fix"), "the support holds nothing");
            return Err(error.mend("say what it holds, as `fix = [\"position\", \"orientation\"]`"));
        }
        let mut fixed = [false; 6];
        for (i, name) in support.fix.iter().enumerate() {
            for freedom in freedoms(*name) {
                if fixed[freedom] || self.fixed[freedom] {
                    let message = format!("{} is held here twice", FREEDOMS[freedom]);
                    let error = document.error(&path.key("fix").index(i), message);
                    return Err(error.mend("\"position\" holds x, y and z, \"orientation\" holds tangent and twist: hold each once"));
                }
                fixed[freedom] = true;
            }
        }
        let here = target(document, path, &fixed, support.position, support.orientation)?;
        self.put(document, path, here)?;
        self.moves(document, &path.key("motion"), &support.motion, &fixed)?;
        let axis = |key: &str, axis: Option<[f64; 3]>, whole: bool, word: &str| {
            let Some(axis) = axis.map(Vec3::from) else { return Ok(None) };
            if !whole {
                let error =
                    document.error(&path.key(key), format!("the support does not hold the whole {word}"));
                return Err(error.mend(format!(
                    "`{key}` frees one axis of what is held: add \"{word}\" to `fix`, or remove `{key}`"
                )));
            }
            if axis.norm() == 0.0 {
                let error = document.error(&path.key(key), "the axis has no direction");
                return Err(
                    error.mend(format!("give a direction in world axes, as `{key} = [0.0, 0.0, 1.0]`"))
                );
            }
            Ok(Some(axis))
        };
        self.slide_along = axis("slide_along", support.slide_along, fixed[3..] == [true; 3], "position")?
            .or(self.slide_along);
        self.turn_about = axis("turn_about", support.turn_about, fixed[..3] == [true; 3], "orientation")?
            .or(self.turn_about);
        for (held, fixed) in self.fixed.iter_mut().zip(fixed) {
            *held |= fixed;
        }
        Ok(())
    }

    /// Takes over where a support holds.
    fn put(&mut self, document: &Document, path: &KeyPath, here: Target) -> Result<(), SceneError> {
        for (target, position) in self.target.position.iter_mut().zip(here.position) {
            *target = position.or(*target);
        }
        if self.target.rotation.is_some_and(|other| here.rotation.is_some_and(|rotation| rotation != other)) {
            let place = path.key("orientation");
            let error = document.error(&place, "two supports of this place give different orientations");
            return Err(error
                .mend("tangent and twist of a place are held in one frame: give both the same orientation"));
        }
        self.target.rotation = here.rotation.or(self.target.rotation);
        Ok(())
    }

    /// Takes over how a support moves.
    fn moves(
        &mut self,
        document: &Document,
        path: &KeyPath,
        frames: &[KeyframeFile],
        fixed: &[bool; 6],
    ) -> Result<(), SceneError> {
        if !frames.is_empty() && !self.motion.is_empty() {
            let error = document.error(path, "two supports of this place move");
            return Err(error.mend("write them as one support, with one `motion`"));
        }
        for (i, frame) in frames.iter().enumerate() {
            let place = path.index(i);
            if let Some((before, _)) = self.motion.last().filter(|(before, _)| *before >= frame.t) {
                let message = format!("t does not grow: {} comes after {before}", frame.t);
                return Err(document
                    .error(&place.key("t"), message)
                    .mend("order the keyframes by growing t"));
            }
            let then = target(document, &place, fixed, frame.position, frame.orientation)?;
            self.motion.push((frame.t, then));
        }
        Ok(())
    }
}

/// Where a support holds what it holds, as far as it is given.
fn target(
    document: &Document,
    path: &KeyPath,
    fixed: &[bool; 6],
    position: Option<[f64; 3]>,
    orientation: Option<[f64; 4]>,
) -> Result<Target, SceneError> {
    let unused = |key: &str, words: &str| {
        let error = document.error(&path.key(key), format!("the support does not hold the {key}"));
        error.mend(format!("add {words} to `fix`, or remove `{key}`"))
    };
    let mut target = Target::default();
    if let Some(position) = position {
        if !fixed[3..].contains(&true) {
            return Err(unused("position", "\"position\""));
        }
        for i in (0..3).filter(|i| fixed[3 + i]) {
            target.position[i] = Some(position[i]);
        }
    }
    if let Some(orientation) = orientation {
        if !fixed[..3].contains(&true) {
            return Err(unused("orientation", "\"orientation\", \"tangent\" or \"twist\""));
        }
        target.rotation = Some(document.quaternion(&path.key("orientation"), orientation)?.to_matrix());
    }
    Ok(target)
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
