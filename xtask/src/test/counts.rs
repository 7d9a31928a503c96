//! The number of tests in a log, from the closing lines of cargo, Node.js and Python.

/// Tests by result.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) passed: u64,
    pub(super) failed: u64,
    pub(super) skipped: u64,
}

impl Counts {
    /// Adds up every closing line in the log.
    pub(super) fn read(log: &str) -> Counts {
        let mut sum = Counts::default();
        // Python prints the number of tests first, and the failures after it.
        let mut ran = 0;
        for line in log.lines() {
            let line = without_colours(line);
            let words = words(&line);
            match *words {
                ["test", "result", ..] => sum.add(&words, -1, ["passed", "failed", "ignored"]),
                // A file of trybuild, which cargo counts as one test.
                ["test", .., "rs", "ok"] | ["test", .., "rs", "should", "pass", "ok"] => {
                    sum.passed += 1;
                }
                ["test", .., "rs", _] => sum.failed += 1,
                // Node.js marks its closing lines, which have one number each.
                ["pass" | "fail" | "cancelled" | "skipped" | "todo", _]
                    if line.starts_with(['#', 'ℹ']) =>
                {
                    sum.add(&words, 1, ["pass", "fail", "skipped"]);
                    sum.add(&words, 1, ["", "cancelled", "todo"]);
                }
                // pytest: `1 failed, 46 passed in 7.77s`, and `in 85.07s (0:01:25)` from a minute on.
                [
                    number,
                    "passed" | "failed" | "error" | "errors" | "skipped",
                    ..,
                ] if words.contains(&"in") && number.parse::<u64>().is_ok() => {
                    sum.add(&words, -1, ["passed", "failed", "skipped"]);
                    sum.add(&words, -1, ["", "error", ""]);
                    sum.add(&words, -1, ["", "errors", ""]);
                }
                ["Ran", number, "test" | "tests", ..] => ran = number.parse().unwrap_or(0),
                ["OK", ..] | ["FAILED", ..] if ran > 0 => {
                    let mut counts = Counts::default();
                    counts.add(&words, 1, ["", "failures", "skipped"]);
                    counts.add(&words, 1, ["", "errors", ""]);
                    counts.add(&words, 1, ["", "successes", ""]);
                    counts.passed = u64::saturating_sub(ran, counts.failed + counts.skipped);
                    sum.join(counts);
                    ran = 0;
                }
                _ => {}
            }
        }
        sum
    }

    /// Adds another result.
    pub(super) fn join(&mut self, other: Counts) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }

    /// Adds the numbers that are `by` words away from the words for passed, failed and skipped.
    fn add(&mut self, words: &[&str], by: isize, names: [&str; 3]) {
        let number = |name: &str| -> Option<u64> {
            let at = words.iter().position(|word| *word == name)?;
            words.get(at.checked_add_signed(by)?)?.parse().ok()
        };
        let [passed, failed, skipped] = names.map(|name| number(name).unwrap_or(0));
        self.join(Counts {
            passed,
            failed,
            skipped,
        });
    }
}

/// The words of letters and digits in a line.
fn words(line: &str) -> Vec<&str> {
    line.split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect()
}

/// The text without `ESC [ ... m`: trybuild colours its lines even without a terminal.
fn without_colours(text: &str) -> String {
    let mut parts = text.split('\u{1b}');
    let mut plain = String::from(parts.next().unwrap_or_default());
    for part in parts {
        plain.push_str(part.split_once('m').map_or("", |(_, rest)| rest));
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::Counts;

    fn check(log: &str, passed: u64, failed: u64, skipped: u64) {
        let expected = Counts {
            passed,
            failed,
            skipped,
        };
        assert_eq!(Counts::read(log), expected, "{log}");
    }

    #[test]
    fn an_empty_log_has_no_tests() {
        check("error: could not compile\n# a remark\nOK\n", 0, 0, 0);
        check("Ran 0 tests in 0.000s\n\nNO TESTS RAN\n", 0, 0, 0);
    }

    #[test]
    fn cargo_and_trybuild() {
        let log = "running 3 tests\n\
             test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s\n\
             test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 4 filtered out; finished in 1.50s\n";
        check(log, 15, 2, 1);
        let log = "test ui/wrong_type.rs ... ok\n\
             test \u{1b}[0m\u{1b}[1mui/b.rs\u{1b}[0m [should pass] ... \u{1b}[32mok\u{1b}[0m\n\
             \u{1b}[0mtest \u{1b}[0m\u{1b}[1mui/d.rs\u{1b}[0m ... \u{1b}[0m\u{1b}[32mok\n\
             test ui/c.rs ... mismatch\n\
             test module::name ... ok\n\
             test src/lib.rs - Thing (line 3) ... ok\n\
             test result: ok. 1 passed; 0 failed; 0 ignored\n";
        check(log, 4, 1, 0);
    }

    #[test]
    fn node_and_python() {
        let tap = "# tests 5\n# suites 0\n# pass 3\n# fail 1\n# cancelled 0\n# skipped 1\n\
                   # todo 0\n# duration_ms 51.2\n";
        check(tap, 3, 1, 1);
        check("ℹ tests 2\nℹ pass 1\nℹ fail 0\nℹ cancelled 1\n", 1, 1, 0);
        check("Ran 12 tests in 3.4s\n\nOK (skipped=2)\n", 10, 0, 2);
        check("====== 46 passed in 7.77s ======\n", 46, 0, 0);
        check("154 passed, 4 deselected in 85.07s (0:01:25)\n", 154, 0, 0);
        check("1 failed, 3 passed, 2 skipped, 1 error in 0.50s\n", 3, 2, 2);
        let python = "FAILED (failures=1, errors=2, skipped=3)\n";
        check(&format!("Ran 9 tests in 3.4s\n\n{python}"), 3, 3, 3);
        let all = "test result: ok. 1 passed; 0 failed\n# pass 2\nRan 3 tests in 1s\nOK\n";
        check(all, 6, 0, 0);
    }
}
