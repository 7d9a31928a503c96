//! How many tests a log reports: cargo's, Node's and Python's closing lines.

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
        // Python says how many ran first, and how many of them failed after that.
        let mut python_ran = None;
        for line in log.lines() {
            // trybuild colours its lines, terminal or not, and resets the colour in the next.
            let line = without_colours(line);
            let line = line.trim();
            if let Some(rest) = line.strip_prefix("test result: ") {
                sum.add(cargo(rest));
            } else if let Some(rest) = line.strip_prefix("test ") {
                sum.add(trybuild(rest));
            } else if let Some(rest) = node_line(line) {
                sum.add(node(rest));
            } else if let Some(rest) = line.strip_prefix("Ran ") {
                python_ran = first_number(rest).filter(|_| rest.contains(" test"));
            } else if let Some(ran) = python_ran
                && let Some(counts) = python(line, ran)
            {
                python_ran = None;
                sum.add(counts);
            }
        }
        sum
    }

    /// Adds another result.
    pub(super) fn add(&mut self, other: Counts) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

/// `ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s`
fn cargo(line: &str) -> Counts {
    let mut counts = Counts::default();
    for part in line.split(['.', ';']) {
        let mut words = part.split_whitespace();
        let number = words.next().and_then(|word| word.parse().ok());
        match (number, words.next()) {
            (Some(n), Some("passed")) => counts.passed = n,
            (Some(n), Some("failed")) => counts.failed = n,
            (Some(n), Some("ignored")) => counts.skipped = n,
            _ => {}
        }
    }
    counts
}

/// `ui/wrong_type.rs ... ok`: trybuild's files, which cargo counts as one test together.
fn trybuild(line: &str) -> Counts {
    let mut counts = Counts::default();
    if let Some((file, result)) = line.split_once(" ... ")
        && (file.ends_with(".rs") || file.ends_with(".rs [should pass]"))
    {
        if result == "ok" {
            counts.passed = 1;
        } else {
            counts.failed = 1;
        }
    }
    counts
}

/// The text without `ESC [ ... m`.
fn without_colours(text: &str) -> String {
    let mut parts = text.split('\u{1b}');
    let mut plain = String::from(parts.next().unwrap_or_default());
    for part in parts {
        plain.push_str(part.split_once('m').map_or("", |(_, rest)| rest));
    }
    plain
}

/// Node marks its closing lines with `#` (TAP) or `ℹ` (for people).
fn node_line(line: &str) -> Option<&str> {
    line.strip_prefix("# ").or_else(|| line.strip_prefix("ℹ "))
}

/// `pass 3`, `fail 1`, `cancelled 0`, `skipped 0`, `todo 0`
fn node(line: &str) -> Counts {
    let mut counts = Counts::default();
    if let Some((name, number)) = line.split_once(' ')
        && let Ok(n) = number.parse::<u64>()
    {
        match name {
            "pass" => counts.passed = n,
            "fail" | "cancelled" => counts.failed = n,
            "skipped" | "todo" => counts.skipped = n,
            _ => {}
        }
    }
    counts
}

/// `OK`, `OK (skipped=1)`, `FAILED (failures=1, errors=2)`
fn python(line: &str, ran: u64) -> Option<Counts> {
    let failed_line = line.starts_with("FAILED (");
    if !failed_line && line != "OK" && !line.starts_with("OK (") && !line.starts_with("NO TESTS") {
        return None;
    }
    let number = |name: &str| {
        line.split(['(', ')', ','])
            .find_map(|part| part.trim().strip_prefix(name)?.parse().ok())
            .unwrap_or(0)
    };
    let failed = number("failures=") + number("errors=") + number("unexpected successes=");
    let skipped = number("skipped=");
    let passed = ran.saturating_sub(failed + skipped);
    Some(Counts {
        passed,
        failed,
        skipped,
    })
}

fn first_number(text: &str) -> Option<u64> {
    text.split_whitespace().next()?.parse().ok()
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
    fn nothing_counts_nothing() {
        check("", 0, 0, 0);
        check("error: could not compile\n# a remark\nOK\n", 0, 0, 0);
    }

    #[test]
    fn cargo_test() {
        check(
            "running 3 tests\n\
             test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s\n\
             test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 4 filtered out; finished in 1.50s\n",
            15,
            2,
            1,
        );
    }

    #[test]
    fn trybuild() {
        check(
            "test ui/wrong_type.rs ... ok\n\
             test \u{1b}[0m\u{1b}[1mui/b.rs\u{1b}[0m [should pass] ... \u{1b}[32mok\u{1b}[0m\n\
             \u{1b}[0mtest \u{1b}[0m\u{1b}[1mui/d.rs\u{1b}[0m ... \u{1b}[0m\u{1b}[32mok\n\
             test ui/c.rs ... mismatch\n\
             test module::name ... ok\n\
             test src/lib.rs - Thing (line 3) ... ok\n\
             test result: ok. 1 passed; 0 failed; 0 ignored\n",
            4,
            1,
            0,
        );
    }

    #[test]
    fn node_test() {
        let tap = "# tests 5\n# suites 0\n# pass 3\n# fail 1\n# cancelled 0\n# skipped 1\n\
                   # todo 0\n# duration_ms 51.2\n";
        check(tap, 3, 1, 1);
        check("ℹ tests 2\nℹ pass 1\nℹ fail 0\nℹ cancelled 1\n", 1, 1, 0);
    }

    #[test]
    fn python_unittest() {
        check("Ran 12 tests in 3.4s\n\nOK\n", 12, 0, 0);
        check("Ran 12 tests in 3.4s\n\nOK (skipped=2)\n", 10, 0, 2);
        check(
            "Ran 9 tests in 3.4s\n\nFAILED (failures=1, errors=2, skipped=3)\n",
            3,
            3,
            3,
        );
        check("Ran 0 tests in 0.000s\n\nOK\n", 0, 0, 0);
        check("Ran 0 tests in 0.000s\n\nNO TESTS RAN\n", 0, 0, 0);
    }

    #[test]
    fn a_log_may_have_several_kinds() {
        check(
            "test result: ok. 1 passed; 0 failed; 0 ignored\n# pass 2\nRan 3 tests in 1s\nOK\n",
            6,
            0,
            0,
        );
    }
}
