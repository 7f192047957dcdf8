//! The `strands` command.

mod args;
mod bench;
mod check;
mod drawing;
mod ending;
mod interrupt;
mod many;
mod new;
mod overrides;
mod page;
mod progress;
mod simulate;
mod solve;
mod source;
mod summary;
mod units;
mod validate;
mod view;

use std::io::{IsTerminal, Write, stderr, stdout};
use std::process::ExitCode;

use args::{Arguments, Command};
use clap::{CommandFactory, Parser};
use strands::math::SimdLevel;

/// Why a command did not do what it was asked for.
#[derive(Debug)]
pub enum Failure {
    /// A bad scene, a bad argument, a file that cannot be read or written: what to tell the person.
    Bad(String),
    /// A solve found no equilibrium, or none within the tolerance, or a comparison failed; the answer has been printed.
    Unsolved,
    /// Someone ended the command; what there was until then has been printed.
    Interrupted,
}

impl Failure {
    fn bad(message: impl std::fmt::Display) -> Self {
        Self::Bad(format!("error: {message}"))
    }

    /// What went wrong with a file, and a mend.
    fn file(name: impl std::fmt::Display, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;
        Self::bad(match error.kind() {
            ErrorKind::NotFound => format!("{name}: there is no such file or folder"),
            ErrorKind::IsADirectory => format!("{name} is a folder; name a file in it"),
            ErrorKind::AlreadyExists => format!("{name} is there already; choose another name, or remove it"),
            ErrorKind::InvalidData => format!("{name} is no UTF-8 text; save it as UTF-8"),
            ErrorKind::PermissionDenied => format!("{name}: permission denied; choose another place"),
            _ => format!("{name}: {error}"),
        })
    }
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to standard output and are no failure. clap's own 2 here means a failed solve.
            let code = if error.use_stderr() { ExitCode::from(1) } else { ExitCode::SUCCESS };
            return if error.print().is_ok() { code } else { ExitCode::from(1) };
        }
    };
    match run(arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Unsolved) => ExitCode::from(2),
        Err(Failure::Interrupted) => ExitCode::from(interrupt::STATUS),
        Err(Failure::Bad(message)) => {
            tell(message.trim_end());
            ExitCode::from(1)
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Solve(options) => solve::run(&options),
        Command::Simulate(options) => simulate::run(&options),
        Command::Check(options) => check::run(&options),
        Command::New(options) => new::run(&options),
        Command::View(options) => view::run(&options),
        Command::Validate(options) => validate::run(&options),
        Command::Bench { kernel: Some(kernel), times, .. } => {
            bench::run(&kernel, times.unwrap_or(1)).map_err(Failure::bad)
        }
        Command::Bench { json, instructions, .. } => {
            let (figures, level) = if instructions {
                (bench::count(), SimdLevel::Avx2.min(SimdLevel::detect()))
            } else {
                (bench::measure(), SimdLevel::detect())
            };
            let figures = figures.map_err(Failure::bad)?;
            if json {
                say(&serde_json::json!({ "figures": figures }).to_string())
            } else {
                say(bench::table(&figures, level).trim_end())
            }
        }
        Command::Schema => say(&source::schema()),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "strands", &mut text);
            say(String::from_utf8_lossy(&text).trim_end())
        }
    }
}

/// Prints to standard output. A reader that has gone away, as `head` does, ends the command without a complaint.
fn say(text: &str) -> Result<(), Failure> {
    match writeln!(stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::bad(error)),
        _ => Ok(()),
    }
}

/// Prints to standard error, whether somebody reads it or not.
fn tell(text: &str) {
    let _ = writeln!(stderr(), "{text}");
}

/// Whether standard output takes colours.
fn colour_out() -> bool {
    stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Whether standard error takes colours.
fn colour_err() -> bool {
    stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}
