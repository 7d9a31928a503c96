//! What `cargo xtask test` prints.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::counts::Counts;
use crate::console::{say, seconds};

/// A failing stage shows at most so many lines; the log has them all.
const SHOWN: usize = 2000;

/// How a stage ended.
#[derive(Debug)]
pub(super) enum Outcome {
    /// All is well. `tests` is false for a check that counts as one.
    Passed { counts: Counts, tests: bool },
    /// Something failed, in the tests or before them.
    Failed { counts: Counts, why: String },
    /// A tool or an input is missing, and this is not CI.
    Skipped { why: String },
}

/// The running totals.
#[derive(Debug)]
pub(super) struct Report {
    ci: bool,
    live: bool,
    started: Instant,
    totals: Counts,
    failed: Vec<String>,
    skipped: Vec<String>,
}

impl Report {
    /// A report without entries.
    pub(super) fn new(ci: bool) -> Report {
        Report {
            ci,
            live: !ci && std::io::stdout().is_terminal(),
            started: Instant::now(),
            totals: Counts::default(),
            failed: Vec::new(),
            skipped: Vec::new(),
        }
    }

    /// On a terminal, shows which stage is running.
    pub(super) fn start(&self, name: &str) {
        if self.live {
            let mut out = std::io::stdout().lock();
            let _ = write!(out, "  ...      {name}\r");
            let _ = out.flush();
        }
    }

    /// One line for a stage that ended.
    pub(super) fn finish(&mut self, name: &str, outcome: &Outcome, took: Duration) {
        say(&line(name, outcome, took));
        match outcome {
            Outcome::Passed { counts, .. } => self.totals.add(*counts),
            Outcome::Failed { counts, .. } => {
                let mut counts = *counts;
                // Something failed even if no test had the chance to.
                counts.failed = counts.failed.max(1);
                self.totals.add(counts);
                self.failed.push(String::from(name));
            }
            Outcome::Skipped { .. } => {
                self.totals.skipped += 1;
                self.skipped.push(String::from(name));
            }
        }
    }

    /// What a failed stage wrote, and how to repeat it alone.
    pub(super) fn explain(&self, name: &str, why: &str, log: &str, path: &Path, command: &str) {
        let lines: Vec<&str> = log.lines().collect();
        let hidden = lines.len().saturating_sub(SHOWN);
        say("");
        if hidden > 0 {
            say(&format!(
                "    [{hidden} earlier lines are in {}]",
                path.display()
            ));
        }
        for line in &lines[hidden..] {
            say(&format!("    {line}"));
        }
        say(&format!("\n  {name}: {why}"));
        say(&format!("  log:    {}", path.display()));
        let ci = if self.ci { "CI=true " } else { "" };
        say(&format!("  repeat: {ci}cargo xtask test --only {name}"));
        if !command.is_empty() {
            say(&format!("  or:     {command}"));
        }
        say("");
    }

    /// The closing lines, and the exit code.
    pub(super) fn close(&self) -> ExitCode {
        let took = seconds(self.started.elapsed());
        say("");
        if !self.failed.is_empty() {
            say(&format!("failed stages: {}", self.failed.join(", ")));
        }
        if !self.skipped.is_empty() {
            say(&format!("skipped stages: {}", self.skipped.join(", ")));
        }
        say(&format!("finished in {took}"));
        say(&closing(self.totals));
        if self.failed.is_empty() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        }
    }
}

fn line(name: &str, outcome: &Outcome, took: Duration) -> String {
    let took = seconds(took);
    let (mark, what) = match outcome {
        Outcome::Passed { tests: false, .. } => ("ok", String::from("check")),
        Outcome::Passed { counts, .. } => ("ok", tests(*counts)),
        Outcome::Failed { counts, .. } if counts.passed + counts.failed > 0 => {
            ("FAILED", tests(*counts))
        }
        Outcome::Failed { .. } => ("FAILED", String::from("-")),
        Outcome::Skipped { why } => return format!("  skipped  {name:<12} skipped: {why}"),
    };
    format!("  {mark:<8} {name:<12} {what:<34} {took:>12}")
}

fn tests(counts: Counts) -> String {
    let all = counts.passed + counts.failed;
    let mut text = format!("{all} {}", if all == 1 { "test" } else { "tests" });
    if counts.failed > 0 {
        text.push_str(&format!(", {} failed", counts.failed));
    }
    if counts.skipped > 0 {
        text.push_str(&format!(", {} skipped", counts.skipped));
    }
    text
}

fn closing(totals: Counts) -> String {
    let mut text = format!("{} passed, {} failed", totals.passed, totals.failed);
    if totals.skipped > 0 {
        text.push_str(&format!(", {} skipped", totals.skipped));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Counts, Outcome, closing, line};
    use std::time::Duration;

    #[test]
    fn lines() {
        let mut counts = Counts::default();
        assert_eq!(closing(counts), "0 passed, 0 failed");
        (counts.passed, counts.skipped) = (3, 1);
        assert_eq!(closing(counts), "3 passed, 0 failed, 1 skipped");
        let passed = Outcome::Passed {
            counts,
            tests: true,
        };
        let shown = line("unit", &passed, Duration::from_secs(2));
        let words: Vec<&str> = shown.split_whitespace().collect();
        assert_eq!(words.join(" "), "ok unit 3 tests, 1 skipped 2.0 s");
        let skipped = Outcome::Skipped {
            why: String::from("no browser"),
        };
        let shown = line("browser", &skipped, Duration::ZERO);
        assert!(shown.ends_with("skipped: no browser"), "{shown}");
    }
}
