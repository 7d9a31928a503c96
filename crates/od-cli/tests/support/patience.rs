//! A limit for the time of a test.
//!
//! Without it, one test that waits for ever would stop the whole run, and nothing would name that test.

use std::collections::HashMap;
use std::io::Write;
use std::sync::{LazyLock, Mutex};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// Longest time of a test. The longest takes some 10 s on a quiet computer.
const PATIENCE: Duration = Duration::from_secs(600);

/// The tests that run, and since when.
static RUNNING: LazyLock<Mutex<HashMap<ThreadId, (String, Instant)>>> = LazyLock::new(|| {
    thread::spawn(watch);
    Mutex::default()
});

thread_local! {
    static TEST: Test = Test::begin();
}

/// The test of this thread; each test has a thread of its own.
struct Test;

impl Test {
    fn begin() -> Self {
        let thread = thread::current();
        let name = thread.name().unwrap_or("a thread of a test").to_owned();
        if let Ok(mut running) = RUNNING.lock() {
            running.insert(thread.id(), (name, Instant::now()));
        }
        Self
    }
}

impl Drop for Test {
    fn drop(&mut self) {
        if let Ok(mut running) = RUNNING.lock() {
            running.remove(&thread::current().id());
        }
    }
}

/// From now on, the test of this thread has a limit.
pub(crate) fn limit() {
    TEST.with(|_| ());
}

/// Ends the program if a test exceeds its limit.
fn watch() {
    loop {
        thread::sleep(Duration::from_secs(1));
        let Ok(running) = RUNNING.lock() else { return };
        for (name, begin) in running.values() {
            if begin.elapsed() > PATIENCE {
                // `eprintln` would print into the captured output of the test.
                let said = format!("\ntest {name} has not ended after {PATIENCE:?}\n");
                let _ = std::io::stderr().write_all(said.as_bytes());
                std::process::exit(101);
            }
        }
    }
}
