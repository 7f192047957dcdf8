//! Any bytes are a scene or an error: never a panic, never more time or memory than a scene's size allows.
//!
//! `cargo +nightly fuzz run scene fuzz/corpus/scene scenes -- -max_total_time=120`

#![no_main]

use libfuzzer_sys::fuzz_target;
use strands_scene::Scene;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    for name in ["scene.toml", "scene.json"] {
        match Scene::parse(text, name, None) {
            Ok(scene) => {
                // What was understood can be written, and is understood again.
                let again = Scene::parse(&scene.file.to_toml(), "again.toml", None);
                assert_eq!(again.expect("it was a scene before").file, scene.file);
            }
            Err(error) => assert!(!error.render(true).is_empty()),
        }
    }
});
