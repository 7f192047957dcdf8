//! The WebAssembly module that the page calls: built by cargo, given its JavaScript side, made smaller.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::tools::{apt_install, cargo, output, root, run, target_folder, up_to_date};

const TARGET: &str = "wasm32-unknown-unknown";
/// What Debian calls its compiler for the web, its sources and its linker.
const DEBIAN: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "lld-19"];

/// Builds `web/src/wasm/strands_wasm.js` and what belongs to it.
///
/// # Errors
/// Where the target is missing and may not be installed, or a step fails.
pub fn build() -> Result<(), String> {
    let folder = root().join("web/src/wasm");
    let written =
        ["strands_wasm.js", "strands_wasm.d.ts", "strands_wasm_bg.wasm"].map(|name| folder.join(name));
    let module = compile()?;
    if up_to_date(&written, &[module.clone(), root().join("Cargo.lock")]) {
        println!("{} is up to date", folder.display());
        return Ok(());
    }
    run(cargo().args(["run", "--quiet", "--package", "xtask-bindgen", "--"]).args([&module, &folder]))?;
    shrink(&written[2])
}

/// Compiles the crate and gives where the module lies.
fn compile() -> Result<PathBuf, String> {
    let arguments = ["build", "--release", "--package", "strands-wasm", "--target", TARGET];
    // Vector instructions, which every browser of the last years has.
    let flags = "-C target-feature=+simd128";
    let folder = match toolchain()? {
        Toolchain::Own => {
            run(cargo().env("RUSTFLAGS", flags).args(arguments))?;
            target_folder()
        }
        // Debian ships the standard library of this target as source only. Its compiler has a target folder of its own, so that the two do not
        // build each other's dependencies anew.
        Toolchain::Debian => {
            let folder = target_folder().join("debian");
            run(Command::new("/usr/bin/cargo")
                .current_dir(root())
                .env("RUSTC", "/usr/bin/rustc")
                .env("RUSTC_BOOTSTRAP", "1")
                .env("RUSTFLAGS", format!("{flags} -C linker=wasm-ld-19"))
                .env("CARGO_TARGET_DIR", &folder)
                .args(arguments)
                .arg("-Zbuild-std=std,panic_abort"))?;
            folder
        }
    };
    Ok(folder.join(TARGET).join("release/strands_wasm.wasm"))
}

enum Toolchain {
    /// The one that builds everything else.
    Own,
    /// Debian's, beside it.
    Debian,
}

/// A toolchain with the target, installed where that is possible.
fn toolchain() -> Result<Toolchain, String> {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let installed = || {
        output(&rustc, &["--print", "sysroot"])
            .is_some_and(|sysroot| Path::new(&sysroot).join("lib/rustlib").join(TARGET).join("lib").exists())
    };
    if installed() || (run(Command::new("rustup").args(["target", "add", TARGET])).is_ok() && installed()) {
        return Ok(Toolchain::Own);
    }
    let debian = || Path::new("/usr/bin/cargo").exists() && Path::new("/usr/bin/wasm-ld-19").exists();
    if !debian() {
        println!("rustup does not give the target {TARGET}; trying Debian's compiler");
        apt_install(&DEBIAN).map_err(|error| {
            format!(
                "the target {TARGET} is missing; type `rustup target add {TARGET}` (without rustup: {error})"
            )
        })?;
    }
    Ok(Toolchain::Debian)
}

/// Runs binaryen's optimiser over the module, where the page's packages bring it.
fn shrink(module: &Path) -> Result<(), String> {
    let optimiser = root().join("web/node_modules/.bin/wasm-opt");
    if !optimiser.exists() {
        return Ok(());
    }
    let mut command = Command::new(optimiser);
    command.arg("-O3").args(["--enable-simd", "--enable-bulk-memory", "--enable-nontrapping-float-to-int"]);
    command.args([
        "--enable-sign-ext",
        "--enable-mutable-globals",
        "--enable-reference-types",
        "--enable-multivalue",
    ]);
    run(command.arg(module).arg("-o").arg(module))
}
