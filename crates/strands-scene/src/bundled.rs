//! The scenes that come with Strands.

/// A bundled scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bundled {
    /// Its name, by which commands and the page know it.
    pub name: &'static str,
    /// One line on what it shows.
    pub title: &'static str,
    /// Its TOML.
    pub text: &'static str,
}

macro_rules! scene {
    ($name:literal, $title:literal) => {
        Bundled {
            name: $name,
            title: $title,
            text: include_str!(concat!("../../../scenes/", $name, ".toml")),
        }
    };
}

const SCENES: &[Bundled] = &[
    scene!("suture", "A surgical thread between tissue and needle"),
    scene!("telephone_cord", "A coiled cord, stretched"),
    scene!("hanging_cable", "A steel cable hanging between two clamps"),
    scene!("guidewire", "A guidewire with a soft J tip"),
    scene!("ribbon", "A spring-steel strip, bent and turned"),
    scene!("hair_curl", "A curl of hair under its own weight"),
    scene!("clipped_cable", "A cable in seven clips"),
    scene!("cantilever", "A clamped strip with a force at its end"),
    scene!("swinging_rope", "A rope that falls and swings"),
    scene!("whip", "A whip that is raised and let fall"),
    scene!("hair_tuft", "Fifty hairs that fall and sway"),
    scene!("willow", "A young willow in the wind"),
    scene!("hanging_net", "A net that hangs by its corners"),
    scene!("spiders_ring", "A spider on its web"),
    scene!("needle_and_thread", "A needle that hangs on its thread"),
    scene!("overhand_knot", "A knot to pull tight"),
    scene!("capstan", "A rope around a post, held by friction"),
    scene!("rope_pile", "Ropes that fall onto each other"),
    scene!("twisted_cord", "A cord that is twisted until it coils up"),
    scene!("stitch", "Two edges of tissue, sewn together"),
];

/// All bundled scenes.
pub fn bundled() -> &'static [Bundled] {
    SCENES
}

/// The bundled scene of a name.
pub fn bundled_scene(name: &str) -> Option<&'static Bundled> {
    SCENES.iter().find(|scene| scene.name == name)
}
