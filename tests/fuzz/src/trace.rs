//! The steps of an input that is replayed, as text.

use std::sync::atomic::{AtomicBool, Ordering};

/// Set while an input is replayed.
static TRACE: AtomicBool = AtomicBool::new(false);

/// From now on the targets print their steps.
pub fn begin() {
    TRACE.store(true, Ordering::Relaxed);
}

/// Prints a step of an input that is replayed.
pub fn trace(step: impl FnOnce() -> String) {
    if TRACE.load(Ordering::Relaxed) {
        println!("{}", step());
    }
}
