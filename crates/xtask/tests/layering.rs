//! Lower crates never depend on upper ones.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;

/// The crates from the bottom up. A crate may depend on those in lines above its own, and on none beside it.
const LAYERS: [&[&str]; 4] = [
    &["strands"],
    &["strands-scene", "strands-cases"],
    &["strands-cli", "strands-wasm"],
    &["xtask", "xtask-bindgen"],
];

/// What only tests and benches use may lie one layer beside, never above.
fn allowed(crate_layer: usize, dependency_layer: usize, for_tests: bool) -> bool {
    dependency_layer < crate_layer || (for_tests && dependency_layer == crate_layer)
}

#[test]
fn lower_crates_never_depend_on_upper_ones() {
    let layers: BTreeMap<&str, usize> =
        LAYERS.iter().enumerate().flat_map(|(i, names)| names.iter().map(move |name| (*name, i))).collect();
    let mut wrong = Vec::new();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("packages");
    for package in packages {
        let name = package["name"].as_str().expect("a name");
        let Some(&layer) = layers.get(name) else {
            wrong.push(format!("{name} has no layer: add it to LAYERS"));
            continue;
        };
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let other = dependency["name"].as_str().expect("a name");
            let for_tests = dependency["kind"] == "dev";
            if layers.get(other).is_some_and(|&below| !allowed(layer, below, for_tests)) {
                wrong.push(format!("{name} depends on {other}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(packages.len(), layers.len(), "a crate in LAYERS is gone");
}

/// The physics needs no file, no format, no thread: only arithmetic and its errors.
#[test]
fn the_physics_has_few_dependencies() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("packages");
    let physics = packages.iter().find(|package| package["name"] == "strands").expect("strands");
    let dependencies = physics["dependencies"].as_array().expect("dependencies").iter();
    let normal: Vec<&str> =
        dependencies.filter(|d| d["kind"].is_null()).filter_map(|d| d["name"].as_str()).collect();
    assert_eq!(normal, ["fastrand", "libm", "thiserror"]);
}

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON")
}
