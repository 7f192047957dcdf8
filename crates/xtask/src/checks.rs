//! The checks of the Rust side.

use crate::report::{Count, ONE, Report};
use crate::tools::{cargo, has, run, run_and_read};

/// rustfmt has nothing to change.
pub fn format() -> Result<Count, String> {
    run(cargo().args(["fmt", "--all", "--check"])).map(|()| ONE)
}

/// Clippy and rustc have nothing to say.
pub fn lints() -> Result<Count, String> {
    run(cargo().args(["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"]))
        .map(|()| ONE)
}

/// Every test of the workspace, those in the documentation too.
pub fn tests() -> Result<Count, String> {
    let mut count = Count::default();
    let succeeded = run_and_read(cargo().args(["test", "--workspace", "--no-fail-fast"]), |line| {
        if let Some(one) = test_result(line) {
            count.passed += one.passed;
            count.failed += one.failed;
        }
    })?;
    match (succeeded, count.failed) {
        (true, _) | (false, 1..) => Ok(count),
        (false, 0) => Err("the tests did not build".to_owned()),
    }
}

/// The documentation builds without a warning.
pub fn documentation() -> Result<Count, String> {
    let mut command = cargo();
    command.env("RUSTDOCFLAGS", "-D warnings");
    run(command.args(["doc", "--workspace", "--no-deps", "--quiet"])).map(|()| ONE)
}

/// Licences and sources of the dependencies, where cargo-deny is installed.
pub fn dependencies(report: &mut Report) {
    if has("cargo-deny") {
        report.step("dependencies", || {
            // Advisories come from a repository of their own, which changes without us: they are for a person to look at.
            run(cargo().args(["deny", "check", "licenses", "bans", "sources"])).map(|()| ONE)
        });
    } else {
        report.skip("dependencies", "needs cargo-deny: `cargo install --locked cargo-deny`");
    }
}

/// Reads a line such as `test result: ok. 12 passed; 0 failed; …`.
fn test_result(line: &str) -> Option<Count> {
    let (_, counts) = line.strip_prefix("test result: ")?.split_once(". ")?;
    let number =
        |what: &str| counts.split("; ").find_map(|part| part.strip_suffix(what)?.trim().parse().ok());
    Some(Count { passed: number("passed")?, failed: number("failed")? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_that_closes_a_test_binary_is_read() {
        let line = "test result: FAILED. 12 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.02s";
        assert_eq!(test_result(line), Some(Count { passed: 12, failed: 3 }));
        assert_eq!(test_result("test rod::mesh ... ok"), None);
    }
}
