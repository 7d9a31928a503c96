//! The tests in a log that began and did not end: one of them hangs if the program had to be stopped.

/// Text that libtest writes once a test takes long, and `xtask/tools/long.mjs` for Node.js.
const LONG: &str = " has been running for over 60 seconds";
/// Text that libtest and unittest write between the name of a test and its result.
const RESULT: &str = " ...";

/// The names of the tests of the last program in a log that did not end.
pub(super) fn running(lines: &[&str]) -> Vec<String> {
    let begin = lines.iter().rposition(|line| line.starts_with("$ "));
    let lines = &lines[begin.unwrap_or(0)..];
    let mut found: Vec<String> = Vec::new();
    for line in lines {
        // Node.js has it as a comment of its report.
        let line = line.strip_prefix("# ").unwrap_or(line);
        let line = line.strip_prefix("test ").unwrap_or(line);
        if let Some(name) = line.strip_suffix(LONG) {
            found.push(String::from(name));
        } else if let Some((name, _)) = line.rsplit_once(" ... ") {
            let name = name.strip_suffix(" - should panic").unwrap_or(name);
            found.retain(|known| known != name);
        }
    }
    found.extend(unfinished_line(lines));
    found
}

/// The test whose result is missing in the last line, where one test runs after another: libtest with one thread,
/// unittest, pytest.
fn unfinished_line(lines: &[&str]) -> Option<String> {
    let mut lines = lines.iter().rev().map(|line| line.trim_end());
    let last = lines.find(|line| !line.is_empty())?;
    // pytest: `tests/test_a.py::test_b PASSED [ 10%]`.
    if last.contains(".py::") && !last.ends_with("%]") && !last.contains(" - ") {
        return Some(String::from(last));
    }
    let name = last.strip_suffix(RESULT)?;
    // unittest writes the first line of a documentation string below the name.
    let name = match lines.next() {
        Some(above) if !name.starts_with("test") && above.starts_with("test") => above,
        _ => name,
    };
    let name = name.strip_prefix("test ").unwrap_or(name);
    Some(String::from(name))
}

#[cfg(test)]
mod tests {
    use super::running;

    #[track_caller]
    fn check(log: &str, names: &[&str]) {
        let lines: Vec<&str> = log.lines().collect();
        assert_eq!(running(&lines), names, "{log}");
    }

    #[test]
    fn cargo() {
        let log = "$ cargo test\nrunning 4 tests\ntest a::x ... ok\n\
                   test a::y has been running for over 60 seconds\n\
                   test b::z has been running for over 60 seconds\n\
                   test b::p has been running for over 60 seconds\n\
                   test a::y ... FAILED\ntest b::p - should panic ... ok\n";
        check(log, &["b::z"]);
        check(&format!("{log}\n$ cargo doc\nDocumenting a\n"), &[]);
        let doc = "test src/lib.rs - A (line 3) has been running for over 60 seconds\n";
        check(doc, &["src/lib.rs - A (line 3)"]);
        check("running 2 tests\ntest a ... ok\ntest b::c ... ", &["b::c"]);
        check("running 2 tests\ntest a ... ok\ntest b::c ... ok\n", &[]);
    }

    #[test]
    fn node() {
        let log = "# Subtest: a\nok 1 - a\n\n\
                   # the page: it opens has been running for over 60 seconds\n\
                   # b has been running for over 60 seconds\n# b ... ended\n";
        check(log, &["the page: it opens"]);
    }

    #[test]
    fn python() {
        let log = "test_a (t.A.test_a) ... ok\ntest_b (t.A.test_b)\nA line about it. ... ";
        check(log, &["test_b (t.A.test_b)"]);
        check(&format!("{log}ok\n\nRan 2 tests in 3 s\n\nOK\n"), &[]);
        check("test_a (t.A.test_a) ...", &["test_a (t.A.test_a)"]);
        let log = "collected 2 items\n\nt/test_a.py::test_a PASSED   [ 50%]\n";
        check(log, &[]);
        let name = "t/test_a.py::test_b[1 x]";
        check(&format!("{log}{name} "), &[name]);
    }
}
