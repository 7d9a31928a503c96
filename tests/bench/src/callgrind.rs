//! Instructions per operation, which do not depend on the load of the machine.

use std::env;
use std::process::Command;

use crate::discipline::Discipline;

/// Operations in the shorter of the two runs.
const COUNT: u64 = 2_000;

/// Returns whether valgrind can be called.
pub fn available() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok()
}

/// Instructions per operation of one contender.
///
/// This program is run twice under callgrind, with N and with 2 N operations, so
/// that the difference is free of set-up. It must take the arguments
/// `count CONTENDER DISCIPLINE N`.
pub fn instructions(name: &str, discipline: Discipline) -> f64 {
    let once = collected(name, discipline, COUNT);
    let twice = collected(name, discipline, 2 * COUNT);
    (twice - once) as f64 / COUNT as f64
}

/// All instructions of one run.
fn collected(name: &str, discipline: Discipline, count: u64) -> u64 {
    let program = env::current_exe().expect("the system knows what it runs");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["count", name, &discipline.to_string(), &count.to_string()])
        .output()
        .expect("valgrind was there a moment ago");
    let report = String::from_utf8_lossy(&output.stderr);
    report
        .lines()
        .find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok())
        .unwrap_or_else(|| panic!("callgrind counted nothing:\n{report}"))
}
