//! What the papers at the root say is there, is there.

use std::fs;
use std::path::{Path, PathBuf};

const PAPERS: [&str; 4] = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn paper(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_path_that_a_paper_names_exists() {
    let mut missing = Vec::new();
    let mut seen = 0;
    for name in PAPERS {
        for path in paths(&paper(name)) {
            seen += 1;
            if !root().join(&path).exists() {
                missing.push(format!("{name}: {path}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(
        seen > 40,
        "only {seen} paths found: is the papers' spelling of paths still what `paths` looks for?"
    );
}

#[test]
fn the_map_names_every_module_of_the_physics() {
    let map = paper("ARCHITECTURE.md");
    let folder = root().join("crates/strands/src");
    let modules = fs::read_dir(&folder).expect("the physics").flatten().filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        (name != "lib.rs").then_some(name)
    });
    let forgotten: Vec<String> =
        modules.filter(|name| !map.contains(&format!("`crates/strands/src/{name}`"))).collect();
    assert!(forgotten.is_empty(), "{forgotten:?}");
}

/// Paths in code quotes and the targets of links. A path is something with a slash or an ending, below a folder of the repository, that is
/// not made by a build.
fn paths(text: &str) -> Vec<String> {
    let quoted = text.split('`').skip(1).step_by(2);
    let linked = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    let ours = |path: &&str| {
        let first = path.split('/').next().unwrap_or_default();
        let folder =
            path.contains('/') && [".ci", ".cargo", "crates", "docs", "scenes", "web"].contains(&first);
        let file = !path.contains('/')
            && (path.ends_with(".md") || path.ends_with(".toml") || path.starts_with("LICENSE"));
        let built = path.starts_with("web/dist")
            || path.starts_with("web/src/wasm")
            || path.starts_with("web/node_modules");
        (folder || file) && !built && !path.contains(['*', ' ', '\n', '…'])
    };
    quoted.chain(linked).filter(ours).map(|path| path.split('#').next().unwrap_or(path).to_owned()).collect()
}
