//! Writes the JavaScript and TypeScript side of a WebAssembly module: what the `wasm-bindgen` command does, from its own library.
//!
//! A program apart from `xtask`, which it would make slow to build. Its version is the workspace's one version of wasm-bindgen, so
//! nothing needs to be installed and the two sides always agree.

use std::path::PathBuf;
use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder] = arguments.as_slice() else {
        eprintln!("usage: xtask-bindgen MODULE.wasm OUTPUT_FOLDER");
        return ExitCode::from(2);
    };
    match write(module, folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Writes `strands_wasm.js`, `strands_wasm.d.ts` and `strands_wasm_bg.wasm` into the folder, as an ES module for the browser.
fn write(module: &PathBuf, folder: &PathBuf) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).out_name("strands_wasm").typescript(true);
    bindgen.web(true).map_err(|error| format!("{error:#}"))?;
    bindgen.generate(folder).map_err(|error| format!("{}: {error:#}", module.display()))
}
