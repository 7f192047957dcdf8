//! How far a command is, for a person who waits.

use std::io::{IsTerminal, stderr, stdout};

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of so many steps on standard error, where a person looks at both outputs; in a pipe, nothing.
pub fn bar(steps: usize) -> ProgressBar {
    if !(stdout().is_terminal() && stderr().is_terminal()) {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("  [{bar:40}] {percent}% of {len} steps, {eta} left");
    let style = style.unwrap_or_else(|error| unreachable!("the template is right: {error}"));
    ProgressBar::new(steps as u64).with_style(style.progress_chars("=> "))
}
