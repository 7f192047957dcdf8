//! Other programs: how they are run, found and installed.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The folder of the repository.
pub fn root() -> PathBuf {
    // This crate lies two folders below it.
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).map_or_else(PathBuf::new, Path::to_path_buf)
}

/// Where cargo puts what it builds.
pub fn target_folder() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |folder| root().join(folder))
}

/// The cargo that runs this.
pub fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Prints a command and runs it with its output on the terminal.
///
/// # Errors
/// Where it cannot be started or does not succeed.
pub fn run(command: &mut Command) -> Result<(), String> {
    println!("$ {}", shown(command));
    let status = command.stdin(Stdio::null()).status().map_err(|error| not_started(command, &error))?;
    if status.success() { Ok(()) } else { Err(format!("`{}` ended with {status}", shown(command))) }
}

/// The same, and hands each line of its standard output to `line` as it is printed. Gives whether the command succeeded.
///
/// # Errors
/// Where it cannot be started.
pub fn run_and_read(command: &mut Command, mut line: impl FnMut(&str)) -> Result<bool, String> {
    println!("$ {}", shown(command));
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| not_started(command, &error))?;
    if let Some(out) = child.stdout.take() {
        for text in BufReader::new(out).lines() {
            let text = text.map_err(|error| format!("`{}`: {error}", shown(command)))?;
            println!("{text}");
            line(&text);
        }
    }
    let status = child.wait().map_err(|error| format!("`{}`: {error}", shown(command)))?;
    Ok(status.success())
}

/// Whether a program answers to `--version`.
pub fn has(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Installs packages of the system where that is Debian and we are root.
///
/// # Errors
/// Elsewhere, with the command for a person to type; and where apt fails.
pub fn apt_install(packages: &[&str]) -> Result<(), String> {
    let typed = format!("apt-get install -y {}", packages.join(" "));
    if !(Path::new("/etc/debian_version").exists() && has("apt-get")) {
        return Err(format!("this needs {}; on Debian: `{typed}`", packages.join(", ")));
    }
    if !is_root() {
        return Err(format!("this needs {}; type `sudo {typed}`", packages.join(", ")));
    }
    let apt = || {
        let mut apt = Command::new("apt-get");
        apt.env("DEBIAN_FRONTEND", "noninteractive");
        apt
    };
    run(apt().args(["update", "-qq"]))?;
    run(apt().args(["install", "-y", "-qq"]).args(packages))
}

/// The output of a short command, without the line's end.
pub fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let out = Command::new(program).args(arguments).stdin(Stdio::null()).output().ok()?;
    out.status.success().then(|| String::from_utf8_lossy(&out.stdout).trim().to_owned())
}

/// Whether every one of `outputs` is there and younger than every file in `sources`.
pub fn up_to_date(outputs: &[PathBuf], sources: &[PathBuf]) -> bool {
    let age = |path: &Path| path.metadata().and_then(|data| data.modified()).ok();
    let Some(oldest) = outputs.iter().map(|path| age(path)).min().flatten() else {
        return false;
    };
    let mut folders = sources.to_vec();
    while let Some(path) = folders.pop() {
        if let Ok(entries) = path.read_dir() {
            folders.extend(entries.flatten().map(|entry| entry.path()));
        } else if age(&path).is_some_and(|time| time > oldest) {
            return false;
        }
    }
    true
}

fn is_root() -> bool {
    output("id", &["-u"]).as_deref() == Some("0")
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

fn not_started(command: &Command, error: &std::io::Error) -> String {
    format!("`{}` cannot be started: {error}", command.get_program().to_string_lossy())
}
