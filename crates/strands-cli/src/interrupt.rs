//! Ctrl-C, for a command that has something to keep: the first asks it to end, the second ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::Failure;

/// What a shell says of a command that Ctrl-C ended: 128 and the signal's number.
pub const STATUS: u8 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C only asks.
///
/// # Errors
/// Where the system does not allow it.
pub fn catch() -> Result<(), Failure> {
    let handler = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(STATUS.into());
        }
    };
    ctrlc::set_handler(handler).map_err(|error| Failure::bad(format!("Ctrl-C cannot be caught: {error}")))
}

/// Whether someone has asked the command to end.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
