//! The shortest way from a clone to a thread in the hand.

use crate::tools::{self, cargo};
use crate::{wasm, web};

/// Builds what is missing and serves the suture; further arguments go to `strands view`.
///
/// # Errors
/// Where something cannot be built.
pub fn run(arguments: &[&str]) -> Result<(), String> {
    wasm::build()?;
    web::build()?;
    tools::run(
        cargo()
            .args(["run", "--quiet", "--release", "--package", "strands-cli", "--", "view", "suture"])
            .args(arguments),
    )
}
