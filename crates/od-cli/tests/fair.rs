//! A flood of one client does not disturb another, and uses no extra memory.
//!
//! `ODKIT_LONG=600 cargo test -p od-cli --test fair -- --nocapture` runs ten minutes with the limits
//! of a release and prints a table; `ODKIT` names another binary to measure.

mod support;

use std::time::{Duration, Instant};

use support::crowd::{Measured, measure};
use support::sim::Sim;

/// Runs a crowd until `enough` returns true.
fn crowd(silent: usize, enough: impl FnMut(usize) -> bool) -> Measured {
    let measured = measure(&Sim::start(&["gxmm"]), silent, enough);
    println!("{}", measured.row(silent));
    measured
}

#[test]
fn a_polite_client_is_served_beside_a_flood() {
    // Every request gets its response, within the time limit of the client.
    let measured = crowd(60, |answers| answers == 100);
    assert_eq!(measured.answers.len(), 100);
    if let Some(memory) = measured.memory {
        assert!(memory.peak < 50_000, "{} kB", memory.peak);
        assert!(memory.threads <= 3, "{} threads", memory.threads);
    }
}

/// `--long` makes it a test of ten minutes; a number sets the seconds.
#[test]
fn a_soak_stays_within_its_limits() {
    let Some(long) = std::env::var_os("ODKIT_LONG") else {
        println!("skipped: a soak of ten minutes; set ODKIT_LONG=1");
        return;
    };
    let seconds = long.to_str().and_then(|text| text.parse().ok());
    let seconds = seconds.filter(|seconds| *seconds > 1).unwrap_or(600);
    let half = Duration::from_secs(seconds) / 2;
    // A debug build is ten times slower than a release.
    let slow = if cfg!(debug_assertions) { 10 } else { 1 };
    let crowds = [0, 500].map(|silent| {
        let start = Instant::now();
        crowd(silent, |_| start.elapsed() > half)
    });
    for (measured, (median, max)) in crowds.iter().zip([(5, 100), (20, 200)]) {
        let millis = |limit: u64| Duration::from_millis(limit * slow);
        assert!(
            measured.median() < millis(median),
            "{:?}",
            measured.median()
        );
        assert!(measured.max() < millis(max), "{:?}", measured.max());
        assert!(measured.memory.is_none_or(|memory| memory.peak < 50_000));
    }
}
