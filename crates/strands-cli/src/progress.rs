//! How far a command is, for a person who waits.

use std::io::{IsTerminal, stderr, stdout};

use indicatif::{ProgressBar, ProgressStyle};

/// The length of a bar.
pub const WHOLE: u64 = 1000;

/// A bar on standard error, where a person looks at both outputs; in a pipe, nothing.
pub fn bar() -> ProgressBar {
    if !(stdout().is_terminal() && stderr().is_terminal()) {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("  [{bar:40}] {percent}%, {eta} left");
    let style = style.unwrap_or_else(|error| unreachable!("the template is right: {error}"));
    ProgressBar::new(WHOLE).with_style(style.progress_chars("=> "))
}
