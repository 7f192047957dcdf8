//! The files of the page: those of the working copy that this program was built in, where they are, else those in the program.
//!
//! So whoever works on the page sees what they built last, and a program that was moved elsewhere is complete in itself.

use std::borrow::Cow;
use std::path::{Component, Path};

/// The page as it was when the program was built; empty where it had not been built.
const EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// Where the page lies in a working copy.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../web/dist");

/// A file of the page by its path below the root, such as `assets/index.js`.
pub fn file(path: &str) -> Option<Cow<'static, [u8]>> {
    if on_disk() {
        // Nothing outside the page's folder is served.
        let inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        return inside.then(|| std::fs::read(Path::new(FOLDER).join(path)).ok().map(Cow::Owned)).flatten();
    }
    EMBEDDED.iter().find(|(name, _)| *name == path).map(|(_, bytes)| Cow::Borrowed(*bytes))
}

/// Whether there is a page.
pub fn exists() -> bool {
    on_disk() || !EMBEDDED.is_empty()
}

fn on_disk() -> bool {
    Path::new(FOLDER).join("index.html").exists()
}

/// What a browser is to take a file for.
pub fn media_type(path: &str) -> &'static str {
    match path.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "glb" => "model/gltf-binary",
        "toml" => "application/toml",
        "webmanifest" => "application/manifest+json",
        "txt" | "md" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
