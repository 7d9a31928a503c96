//! Files of the product under 40 lines. A file is one idea, and a short one usually belongs to its
//! neighbour. The start of a crate or program, the index of a folder and a rule with a check may be
//! short; their names show what they are. Any other short file has a line in [`REASONS`].

use std::collections::BTreeMap;

/// Files with fewer lines are short.
const SHORT: usize = 40;

/// The short files, or folders of short files (with `/` at the end), each with the reason against a
/// merge.
#[rustfmt::skip] // a row is a row
const REASONS: [(&str, &str); 23] = [
    ("crates/od-capi/src/answer.rs", "the codes that C sees, in one list"),
    ("crates/od-capi/src/frame.rs", "the only conversion between frames of C and of Rust"),
    ("crates/od-cli/src/bridge.rs", "a subcommand"),
    ("crates/od-cli/src/clock.rs", "two subcommands need the date"),
    ("crates/od-cli/src/export.rs", "a subcommand"),
    ("crates/od-client/src/nmt.rs", "a service"),
    ("crates/od-eds/src/codes.rs", "rules, tools and `odkit-allow` use it"),
    ("crates/od-runtime/src/blank.rs", "each type in the arrays of a node implements it"),
    ("crates/od-runtime/src/number.rs", "services, store and storage need it"),
    ("crates/od-runtime/src/storage/image/cob_id.rs", "save and load share it"),
    ("crates/od-sim/src/cursor.rs", "scripts and logs are read with it"),
    ("crates/od-sim/src/diagnose/rule.rs", "the list of rules and each rule need the type"),
    ("crates/od-sim/src/serve/error.rs", "the error of all that a bench in real time does"),
    ("crates/od-sim/src/serve/terminal.rs", "the one way to print, for ten files"),
    ("crates/od-tools/src/replay.rs", "the work of a command on a bus"),
    ("playground/src/pins.rs", "a feature that the first module of the page lacks"),
    ("python/src/filter.rs", "listeners and ports share it"),
    ("xtask/src/corpus.rs", "a command"),
    ("xtask/src/error.rs", "the error of the crate"),
    ("xtask/src/release/", "a part of a release is a file"),
    ("xtask/src/setup/", "a tool is a file"),
    ("xtask/src/shots.rs", "a command"),
    ("xtask/src/test/context.rs", "the list of stages and each stage need the type"),
];

/// Violations: short files without a reason, and reasons without a short file.
pub(crate) fn faults(files: &BTreeMap<String, String>) -> Vec<String> {
    let short: Vec<&str> = files
        .iter()
        .filter(|(path, text)| text.lines().count() < SHORT && !is_short_by_kind(path, files))
        .map(|(path, _)| path.as_str())
        .collect();
    let without_reason = short.iter().filter(|path| reason(path).is_none()).map(|path| {
        format!(
            "{path} has fewer than {SHORT} lines: move its code into the file whose idea it is, or give the reason \
             in REASONS (tests/tests/house/small.rs)"
        )
    });
    let without_file = REASONS
        .iter()
        .filter(|(place, _)| !short.iter().any(|path| is_in(path, place)))
        .map(|(place, _)| {
            format!("no short file is in {place}: remove its line from REASONS (tests/tests/house/small.rs)")
        });
    without_reason.chain(without_file).collect()
}

fn reason(path: &str) -> Option<&'static str> {
    let mut reasons = REASONS.iter();
    reasons.find_map(|(place, reason)| is_in(path, place).then_some(*reason))
}

/// Returns whether a place of [`REASONS`] is this file, or the folder that contains it.
fn is_in(path: &str, place: &str) -> bool {
    match path.strip_prefix(place) {
        Some(rest) => rest.is_empty() || (place.ends_with('/') && !rest.contains('/')),
        None => false,
    }
}

/// Returns whether files of this kind are often short: a test, the start of a crate or program, the
/// index of a folder, or a rule with a check.
fn is_short_by_kind(path: &str, files: &BTreeMap<String, String>) -> bool {
    let Some(stem) = path.strip_suffix(".rs") else {
        return true;
    };
    let folders: Vec<&str> = path.split('/').collect();
    let name = stem.rsplit('/').next().unwrap_or(stem);
    let inside = format!("{stem}/");
    let is_index = || {
        files
            .range(inside.clone()..)
            .next()
            .is_some_and(|(next, _)| next.starts_with(&inside))
    };
    ["tests", "examples", "bin"]
        .iter()
        .any(|folder| folders.contains(folder))
        || ["lib", "main", "mod", "build", "tests"].contains(&name)
        || is_rule(name)
        || is_index()
}

/// Returns whether this is the name of a rule's file, such as `w0464_what_it_says`.
fn is_rule(name: &str) -> bool {
    let mut letters = name.bytes();
    let is_severity = letters
        .next()
        .is_some_and(|letter| b"eiw".contains(&letter));
    is_severity
        && letters.by_ref().take(4).filter(u8::is_ascii_digit).count() == 4
        && letters.next() == Some(b'_')
}

#[test]
fn a_short_file_needs_a_reason() {
    let file = |path: &str| (path.to_owned(), "fn f() {}\n".to_owned());
    let files: BTreeMap<_, _> = [
        "x/src/lib.rs",
        "x/src/a.rs",
        "x/src/a/b.rs",
        "x/src/bin/c.rs",
        "x/src/w0464_long_name.rs",
        "x/src/w04_no_rule.rs",
        "x/src/page.ts",
        "x/tests/d.rs",
    ]
    .map(file)
    .into();
    let all = faults(&files);
    let found: Vec<_> = all
        .iter()
        .filter(|fault| fault.contains("fewer than"))
        .filter_map(|fault| fault.split(' ').next())
        .collect();
    assert_eq!(found, ["x/src/a/b.rs", "x/src/w04_no_rule.rs"]);
}
