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
        "eyelets" => "remove it: a support with `fix = [\"position\"]` holds a point of the rod",
        "initial" => "remove it: the search starts from the rest shape",
        "continuation" => "use \"auto\", \"sweep\", \"shooting\", \"multiple_shooting\" or \"equilibrium\"",
        _ => return None,
    })
}

/// How to give a key: its unit and an example.
pub(crate) fn example(key: &str) -> Option<&'static str> {
    Some(match key {
        "format" => "begin the file with `format = 1`, so that later versions can read it",
        "name" => "give it a name, as `name = \"suture\"`",
        "rods" => "add a rod: `[rods.thread]`",
        "youngs_modulus" => "give it in Pa, as `youngs_modulus = 1.5e9`",
        "density" => "give it in kg/m³, as `density = 910.0` (0 for a weightless material)",
        "shape" => {
            "give `shape = \"circle\"`, \"annulus\", \"ellipse\" or \"rectangle\"; of a body \"ball\", \"capsule\", \"cylinder\", \"block\" or \"ring\""
        }
        "at" => "give `at = \"start\"`, `at = \"end\"`, or metres from the start",
        "fix" => "say what it holds, as `fix = [\"position\", \"orientation\"]`",
        "s" => "give the place in metres from the rod's start, as `s = 0.1`",
        "length" => "give it in metres, as `length = 0.3`",
        "radius" | "outer_radius" => "give it in metres, as 75e-6 for 75 µm",
        "inner_radius" => "give it in metres; 0 for a full section",
        "a" | "b" => "give half the extent along d1 (`a`) and d2 (`b`) in metres, as 40e-6",
        "width" | "height" => "give the side along d1 (`width`) and d2 (`height`) in metres, as 10e-3",
        "poisson_ratio" => "most metals have about 0.3, polymers 0.4, rubber nearly 0.5",
        "shear_modulus" => "give it in Pa, as `shear_modulus = 77e9`",
        "damping" => "give a time in s, as `damping = 1e-3`; 0 for none",
        "tolerance" => "a small number, as `tolerance = 1e-4`",
        "mass_per_length" => "give it in kg/m, as `mass_per_length = 1e-3`; 0 for a rod without weight",
        "rotational_inertia_per_length" => "give it in kg·m about d1, d2 and d3, as [1e-9, 1e-9, 2e-9]",
        "axial" => "give EA in N, as `axial = 1e4`; a rod with `kinematics = \"kirchhoff\"` does without",
        "shear" => {
            "give it along d1 and d2 in N, as `shear = [4e3, 4e3]`; a rod with `kinematics = \"kirchhoff\"` does without"
        }
        "slide_along" => "give a direction in world axes, as `slide_along = [0.0, 0.0, 1.0]`",
        "turn_about" => "give an axis in world directions, as `turn_about = [1.0, 0.0, 0.0]`",
        "linear_stiffness" => "give it in N/m, as `linear_stiffness = 50.0`",
        "angular_stiffness" => "give it in N·m/rad, as `angular_stiffness = 1e-3`",
        "linear_damping" => "give it in N·s/m, as `linear_damping = 0.05`; 0 for none",
        "angular_damping" => "give it in N·m·s/rad, as `angular_damping = 1e-6`; 0 for none",
        "max_force" => "give it in N, as `max_force = 3.3`; leave it out for no limit",
        "max_torque" => "give it in N·m, as `max_torque = 0.02`; leave it out for no limit",
        "friction" => "give Coulomb's coefficient, as `friction = 0.3`; 0 for none",
        "time_step" | "duration" | "t" => "give it in s, as 1e-3",
        "mass_damping" => "give it in 1/s, as `mass_damping = 0.5`; 0 for none",
        "spectral_radius" => "give a number from 0 to 1, as `spectral_radius = 0.5`",
        "wind" => "write `[wind]` with `velocity = [3.0, 0.0, 0.0]` in m/s",
        "velocity" => "give it in m/s along the world's axes, as `velocity = [3.0, 0.0, 0.0]`",
        "angular_velocity" => {
            "give it in rad/s about the world's axes, as `angular_velocity = [0.0, 0.0, 6.0]`"
        }
        "drag" => "write `[rods.thread.drag]` with `linear` in N·s/m², `quadratic` in N·s²/m³, or both",
        "linear" => "give it in N·s/m², as `linear = 1e-3`; 0 for none",
        "quadratic" => "give it in N·s²/m³, as `quadratic = 1e-4`; 0 for none",
        "motion" => "give keyframes, as `motion = [{ t = 0.0 }, { t = 1.0, position = [0.1, 0.0, 0.0] }]`",
        "bodies" => "write each as `[[bodies]]`, with `name`, `shape` and `density`",
        "mass" => "give it in kg, as `mass = 1e-3`",
        "inertia" => "give it in kg·m² about its three principal axes, as `inertia = [2e-9, 2e-9, 1e-9]`",
        "size" => "give the three edges in metres, as `size = [0.02, 0.01, 0.01]`",
        "support" => "say what it holds, as `support = { fix = [\"position\", \"orientation\"] }`",
        "joints" => "write each as `[[joints]]`, with `kind` and `between`",
        "kind" => "give `kind = \"rigid\"`, \"ball\" or \"hinge\"",
        "between" => {
            "name the two, as `between = [{ rod = \"thread\", at = \"end\" }, { body = \"needle\" }]`"
        }
        "body" => "name a body, as `body = \"needle\"`",
        "axis" => "give the hinge's axis in world directions, as `axis = [0.0, 1.0, 0.0]`",
        "output_rate" => "give it in frames a second, as `output_rate = 60`",
        "hand" => "describe the hand in `[coupling.hand]`",
        "rod" => "name a rod, as `rod = \"thread\"`",
        "gravity" => "give it in m/s², as `gravity = [0.0, 0.0, -9.81]`",
        "position" => "give [x, y, z] in metres, as `position = [0.0, 0.0, 0.1]`",
        "orientation" => {
            "give a unit quaternion [w, x, y, z]; no rotation is `orientation = [1.0, 0.0, 0.0, 0.0]`"
        }
        "force" => "give it in N, as `force = [0.0, 0.0, -0.1]`",
        "moment" => "give it in N·m, as `moment = [0.0, 0.0, 1e-5]`",
        "force_per_length" => "give it in N/m, as `force_per_length = [0.0, 0.0, -0.01]`",
        "moment_per_length" => "give it in N, as `moment_per_length = [0.0, 0.0, 1e-3]`",
        "elements" | "max_iterations" | "newton_iterations" => "give a whole number, as 100",
        "order" => "use 1, 2 or 4",
        "points" => {
            "give points in metres, as `points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.1], [0.0, 0.05, 0.2]]`"
        }
        "matrix" => "give six rows of six numbers, for κ1, κ2, τ, v1, v2, v3",
        "material" => "name one, as `material = \"steel\"`, and describe it in `[materials.steel]`",
        "section" => {
            "give it as `section = { shape = \"circle\", radius = 1e-3 }`, or a list of them with `s`"
        }
        "rest" => "give it as `rest = { curvature = [0.0, 8.0, 0.0] }`; a straight rod needs none",
        "stiffness" => {
            "give it as `stiffness = { bending = [1e-3, 1e-3], torsion = 8e-4, axial = 1e4, shear = [4e3, 4e3] }`"
        }
        "supports" => "write each as `[[rods.thread.supports]]`, with `at` and `fix`",
        "loads" => "write each as `[[rods.thread.loads]]`, with `at` and `force`",
        "towards" => {
            "give the point in metres, as `towards = [0.0, 0.0, 0.0]`, and how hard it pulls in N, as `tension = 0.1`"
        }
        "pitch" => "give the rise in one turn in metres, as `pitch = 6e-3`",
        "bending" => "give it about d1 and d2 in N·m², as `bending = [1e-3, 1e-3]`",
        "torsion" => "give it in N·m², as `torsion = 8e-4`",
        "curvature" => "give it in 1/m about d1, d2 and d3, as `curvature = [0.0, 8.0, 0.0]`",
        _ => return None,
    })
}
