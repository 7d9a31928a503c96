//! The output of `cargo xtask test`.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::counts::Counts;
use super::running::running;
use crate::console::{say, seconds};
use crate::processes::processor_time;
use crate::repo::is_ci;

/// Number of lines that a failing stage shows at most; the log has all of them.
const SHOWN: usize = 2000;

/// The end of a stage.
#[derive(Debug)]
pub(super) enum Outcome {
    /// Everything passed. A check has no tests and counts as one.
    Passed(Option<Counts>),
    /// Something failed, in the tests or before them.
    Failed(Counts, String),
    /// A tool or an input is missing, and this is not CI.
    Skipped(String),
    /// An optional input is missing; the stage does not count.
    LeftOut(String),
}

/// The running totals.
#[derive(Debug)]
pub(super) struct Report {
    live: bool,
    started: Instant,
    running: Vec<&'static str>,
    totals: Counts,
    failed: Vec<&'static str>,
    skipped: Vec<&'static str>,
}

impl Report {
    /// A report without entries.
    pub(super) fn new() -> Report {
        Report {
            live: !is_ci() && std::io::stdout().is_terminal(),
            started: Instant::now(),
            running: Vec::new(),
            totals: Counts::default(),
            failed: Vec::new(),
            skipped: Vec::new(),
        }
    }

    /// On a terminal, shows which stages are running.
    pub(super) fn start(&mut self, name: &'static str) {
        self.running.push(name);
        self.show();
    }

    fn show(&self) {
        if self.live && !self.running.is_empty() {
            let mut out = std::io::stdout().lock();
            let _ = write!(out, "  ...      {:<70}\r", self.running.join(", "));
            let _ = out.flush();
        }
    }

    /// Prints one line for a stage that ended. A failed stage is followed by its output and the
    /// commands that repeat it: `used` is its processor time, `log` its text and path, `command` the last one that ran.
    pub(super) fn finish(
        &mut self,
        name: &'static str,
        outcome: &Outcome,
        (took, used): (Duration, Duration),
        (log, place): (&str, &Path),
        command: &str,
    ) {
        self.running.retain(|running| *running != name);
        say(&line(name, outcome, took, used));
        match outcome {
            Outcome::Passed(counts) => self.totals.join(counts.unwrap_or(Counts {
                passed: 1,
                ..Counts::default()
            })),
            Outcome::Failed(counts, why) => {
                // The stage failed before its tests began.
                let failed = counts.failed.max(1);
                self.totals.join(Counts { failed, ..*counts });
                self.failed.push(name);
                explain(name, why, (log, place), command);
            }
            Outcome::Skipped(_) => {
                self.totals.skipped += 1;
                self.skipped.push(name);
            }
            Outcome::LeftOut(_) => {}
        }
        self.show();
    }

    /// The closing lines, and the exit code.
    pub(super) fn close(&self) -> ExitCode {
        say("");
        for (what, names) in [("failed", &self.failed), ("skipped", &self.skipped)] {
            if !names.is_empty() {
                say(&format!("{what} stages: {}", names.join(", ")));
            }
        }
        let took = seconds(self.started.elapsed());
        say(&match processor_time("self") {
            Some(time) => format!("finished in {took}, {} of processor time", seconds(time)),
            None => format!("finished in {took}"),
        });
        say(&closing(self.totals));
        if self.failed.is_empty() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        }
    }
}

fn explain(name: &str, why: &str, (log, place): (&str, &Path), command: &str) {
    let (lines, place) = (log.lines().collect::<Vec<_>>(), place.display());
    let hidden = lines.len().saturating_sub(SHOWN);
    say("");
    if hidden > 0 {
        say(&format!("    [{hidden} earlier lines are in {place}]"));
    }
    for line in &lines[hidden..] {
        say(&format!("    {line}"));
    }
    let ci = if is_ci() { "CI=true " } else { "" };
    say(&format!("\n  {name}: {why}"));
    for test in running(&lines) {
        say(&format!("  did not end: {test}"));
    }
    for line in matters(&lines) {
        say(&format!("  | {line}"));
    }
    say(&format!("  log:    {place}"));
    say(&format!("  repeat: {ci}cargo xtask test --only {name}"));
    if !command.is_empty() {
        say(&format!("  or:     {command}"));
    }
    say("");
}

/// The lines of a log that name the first failures and their reasons, at most five.
fn matters<'a>(lines: &[&'a str]) -> Vec<&'a str> {
    const MOST: usize = 5;
    // By rustc and xtask; by a Rust test and the line after it; by Node; by unittest and pytest.
    let begins = ["error", "not ok ", "E  ", "FAIL:", "ERROR:", "FAILED "];
    let is_reason = |line: &str| {
        let line = line.trim_start();
        begins.iter().any(|begin| line.starts_with(begin)) || line.contains("panicked at")
    };
    let mut found = Vec::new();
    let mut is_next = false;
    for line in lines.iter().filter(|line| !line.trim().is_empty()) {
        if is_next || is_reason(line) {
            found.push(*line);
        }
        is_next = line.contains("panicked at");
    }
    found.truncate(MOST);
    if found.is_empty() {
        found = lines.to_vec();
        found.retain(|line| !line.trim().is_empty());
        found.drain(..found.len().saturating_sub(MOST));
    }
    found
}

fn line(name: &str, outcome: &Outcome, took: Duration, used: Duration) -> String {
    let (mark, what) = match outcome {
        Outcome::Passed(None) => ("ok", String::from("check")),
        Outcome::Passed(Some(counts)) => ("ok", tests(*counts)),
        Outcome::Failed(counts, _) if counts.passed + counts.failed > 0 => {
            ("FAILED", tests(*counts))
        }
        Outcome::Failed(..) => ("FAILED", String::from("-")),
        Outcome::Skipped(why) => return format!("  skipped  {name:<12} skipped: {why}"),
        Outcome::LeftOut(why) => return format!("  left out {name:<12} {why}"),
    };
    let used = if used.is_zero() {
        String::new()
    } else {
        format!("   processor {:>12}", seconds(used))
    };
    format!(
        "  {mark:<8} {name:<12} {what:<34} {:>12}{used}",
        seconds(took)
    )
}

fn tests(counts: Counts) -> String {
    let all = counts.passed + counts.failed;
    let mut text = format!("{all} test{}", if all == 1 { "" } else { "s" });
    for (number, what) in [(counts.failed, "failed"), (counts.skipped, "skipped")] {
        if number > 0 {
            text.push_str(&format!(", {number} {what}"));
        }
    }
    text
}

fn closing(totals: Counts) -> String {
    let text = format!("{} passed, {} failed", totals.passed, totals.failed);
    match totals.skipped {
        0 => text,
        skipped => format!("{text}, {skipped} skipped"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Counts, Outcome, closing, line, matters};
    use std::time::Duration;

    #[test]
    fn the_lines_that_matter_are_reasons() {
        let log = "   Compiling a v1\nrunning 2 tests\ntest x ... FAILED\n\n---- x stdout ----\n\
                   thread 'x' panicked at a.rs:3:5:\nleft is 1\n\nnote: run with `RUST_BACKTRACE=1`\n\
                   test result: FAILED. 1 passed; 1 failed\nerror: test failed, to rerun pass `-p a`\n";
        let lines: Vec<&str> = log.lines().collect();
        assert_eq!(matters(&lines), [lines[5], lines[6], lines[10]]);
        let python = "Ran 3 tests\nFAIL: test_a (b)\nTraceback\nE   assert 1 == 2\n";
        let lines: Vec<&str> = python.lines().collect();
        assert_eq!(matters(&lines), [lines[1], lines[3]]);
        let quiet = ["a", "b", "", "c", "d", "e", "f"];
        assert_eq!(matters(&quiet), ["b", "c", "d", "e", "f"]);
    }

    #[test]
    fn lines() {
        let mut counts = Counts::default();
        assert_eq!(closing(counts), "0 passed, 0 failed");
        (counts.passed, counts.skipped) = (3, 1);
        assert_eq!(closing(counts), "3 passed, 0 failed, 1 skipped");
        let (two, three) = (Duration::from_secs(2), Duration::from_secs(3));
        let passed = Outcome::Passed(Some(counts));
        let words = |used| {
            let shown = line("unit", &passed, two, used);
            shown.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(words(Duration::ZERO), "ok unit 3 tests, 1 skipped 2.0 s");
        assert_eq!(
            words(three),
            "ok unit 3 tests, 1 skipped 2.0 s processor 3.0 s"
        );
        let skipped = Outcome::Skipped(String::from("no browser"));
        let shown = line("browser", &skipped, Duration::ZERO, Duration::ZERO);
        assert!(shown.ends_with("skipped: no browser"), "{shown}");
    }
}
