//! How errors say things: what was expected, what was found, what was probably meant.

use serde::de::Unexpected;

/// serde's name of what it expected, in words for someone who writes a scene.
pub(crate) fn expected(name: &str) -> String {
    if let Some(length) = name.strip_prefix("an array of length ") {
        return format!("a list of {length}");
    }
    match name {
        "f64" => "a number".into(),
        "usize" | "u32" | "u64" => "a whole number, not negative".into(),
        "a sequence" => "a list".into(),
        "a map" => "a table".into(),
        "a boolean" => "true or false".into(),
        _ => name.into(),
    }
}

/// What was found instead.
pub(crate) fn found(found: &Unexpected<'_>) -> String {
    match found {
        Unexpected::Str(text) => format!("the text \"{text}\""),
        Unexpected::Signed(number) => format!("{number}"),
        Unexpected::Float(number) => format!("{number}"),
        Unexpected::Bool(truth) => format!("{truth}"),
        Unexpected::Seq => "a list".into(),
        Unexpected::Map => "a table".into(),
        other => other.to_string(),
    }
}

/// Which of the known words was probably meant, and else all of them.
pub(crate) fn choices<'a>(
    what: &str,
    word: &str,
    known: impl IntoIterator<Item = &'a (impl AsRef<str> + 'a + ?Sized)>,
) -> String {
    let known: Vec<&str> = known.into_iter().map(AsRef::as_ref).collect();
    match nearest(word, &known) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => format!("{what}: none"),
        None => format!("{what}: {}", quoted(&known)),
    }
}

/// The words in back quotes, with commas.
pub(crate) fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// The known word that a slip of the pen or a plural is away.
fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let plain = |word: &str| word.to_lowercase().replace(['-', ' '], "_");
    let word = plain(word);
    let distance = |known: &str| {
        let (a, b) = (word.as_str(), known);
        if a.len() >= 3 && b.len() >= 3 && (b.starts_with(a) || a.starts_with(b)) {
            return 1;
        }
        strsim::damerau_levenshtein(a, b)
    };
    let near = known.iter().copied().min_by_key(|known| distance(known))?;
    (distance(near) <= (word.chars().count() / 3).max(1)).then_some(near)
}

/// What to do in place of a key or value of the format that this version does not have; `None` for a word that is not one.
pub(crate) fn later(word: &str) -> Option<&'static str> {
    Some(match word {
        "bodies" | "joints" => {
            "remove it: rods stand alone so far; a weight at an end can be given as a load"
        }
        "eyelets" => "remove it: a rod is held at its two ends so far",
        "obstacles" => "remove it: nothing touches a rod so far",
        "motion" => "remove it: supports stand still so far; give `position` and `orientation`",
        "initial" => "remove it: the search starts from the rest shape",
        "multiple_shooting" | "equilibrium" => "use \"auto\", \"sweep\" or \"shooting\"",
        _ => return None,
    })
}

/// How to give a key: its unit and an example.
pub(crate) fn example(key: &str) -> Option<&'static str> {
    Some(match key {
        "format" => "begin the file with `format = 1`, so that later versions can read it",
        "name" => "give the scene a name, as `name = \"suture\"`",
        "rods" => "add a rod: `[rods.thread]`",
        "youngs_modulus" => "give it in Pa, as `youngs_modulus = 1.5e9`",
        "density" => "give it in kg/m³, as `density = 910.0` (0 for a weightless material)",
        "shape" => "give `shape = \"circle\"`, \"annulus\", \"ellipse\" or \"rectangle\"",
        "at" => "give `at = \"start\"`, `at = \"end\"`, or metres from the start",
        "fix" => "say what it holds, as `fix = [\"position\", \"orientation\"]`",
        "s" => "give the place in metres from the rod's start, as `s = 0.1`",
        "bending" => "give it about d1 and d2 in N·m², as `bending = [1e-3, 1e-3]`",
        "torsion" => "give it in N·m², as `torsion = 8e-4`",
        "curvature" => "give it in 1/m about d1, d2 and d3, as `curvature = [0.0, 8.0, 0.0]`",
        _ => return None,
    })
}
