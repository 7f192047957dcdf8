//! The page: its packages, its build, its tests in a browser.

use std::path::Path;
use std::process::Command;

use crate::report::{ONE, Report};
use crate::tools::{apt_install, has, root, run, up_to_date};

/// Builds the page into `web/dist`. The WebAssembly module must be there.
///
/// # Errors
/// Where Node is missing or a step fails.
pub fn build() -> Result<(), String> {
    let web = root().join("web");
    let sources =
        ["src", "public", "index.html", "package-lock.json", "vite.config.ts"].map(|name| web.join(name));
    if up_to_date(&[web.join("dist/index.html")], &sources) {
        println!("{} is up to date", web.join("dist").display());
        return Ok(());
    }
    packages()?;
    script("build")
}

/// Type check, build and tests.
pub fn steps(report: &mut Report) {
    if !report.step("page packages", || packages().map(|()| ONE)) {
        return;
    }
    report.step("page types", || script("typecheck").map(|()| ONE));
    if report.step("page build", || script("build").map(|()| ONE)) {
        report.step("page tests", || browser().and_then(|()| script("test")).map(|()| ONE));
    }
}

/// Times the solver in a browser and without one.
///
/// # Errors
/// Where Node or a browser is missing or a step fails.
pub fn bench() -> Result<(), String> {
    packages()?;
    browser()?;
    script("bench")
}

/// Installs the packages that the lock file names, where they are not there yet.
fn packages() -> Result<(), String> {
    let web = root().join("web");
    if up_to_date(&[web.join("node_modules/.package-lock.json")], &[web.join("package-lock.json")]) {
        return Ok(());
    }
    if !has("npm") {
        return Err("the page needs Node 20 or newer with npm: https://nodejs.org".to_owned());
    }
    run(npm().args(["ci", "--no-audit", "--no-fund"]))
}

/// Makes sure that there is a Chromium for the tests.
fn browser() -> Result<(), String> {
    let known = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    if std::env::var_os("CHROMIUM").is_some() || known.iter().any(|path| Path::new(path).exists()) {
        return Ok(());
    }
    apt_install(&["chromium"]).map_err(|error| format!("{error}, or set CHROMIUM to a Chromium's path"))
}

fn script(name: &str) -> Result<(), String> {
    run(npm().args(["run", "--silent", name]))
}

fn npm() -> Command {
    let mut command = Command::new("npm");
    command.current_dir(root().join("web"));
    command
}
