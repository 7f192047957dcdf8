//! `cargo xtask COMMAND`: every chore of the project, the same at home and in CI.

mod checks;
mod demo;
mod report;
mod tools;
mod wasm;
mod web;

use std::process::ExitCode;

use report::Report;

const HELP: &str = "\
Chores of the Strands project

Usage: cargo xtask COMMAND

  demo    Build what is missing and show the suture in the browser
  test    Every check: format, lints, tests, documentation, WebAssembly, page
  wasm    Build the WebAssembly module into web/src/wasm
  web     Build the page into web/dist
  bench   The solver's speed in the browser beside that without one
  docs    Build the library's documentation into target/doc
  lint    Format and lints only

Each installs what it needs and may install, and names what it may not.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["demo", rest @ ..] => finish(demo::run(rest)),
        ["test"] => test().print(),
        ["lint"] => lint().print(),
        ["wasm"] => finish(wasm::build()),
        ["web"] => finish(wasm::build().and_then(|()| web::build())),
        ["bench"] => finish(wasm::build().and_then(|()| web::bench())),
        ["docs"] => finish(checks::documentation().map(drop)),
        [] | ["help" | "--help" | "-h"] => {
            println!("{HELP}");
            ExitCode::SUCCESS
        }
        [other, ..] => {
            eprintln!("error: there is no `{other}`\n\n{HELP}");
            ExitCode::from(1)
        }
    }
}

fn finish(result: Result<(), String>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn lint() -> Report {
    let mut report = Report::default();
    report.step("format", checks::format);
    report.step("lints", checks::lints);
    report
}

fn test() -> Report {
    let mut report = lint();
    // The page before the tests: `strands view` is tested with what it serves.
    if report.step("wasm", || wasm::build().map(|()| report::ONE)) {
        web::steps(&mut report);
    }
    report.step("tests", checks::tests);
    report.step("documentation", checks::documentation);
    checks::dependencies(&mut report);
    report
}
