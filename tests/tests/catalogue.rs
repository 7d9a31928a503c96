//! Every rule has a pair of files: one with the error, and the same one fixed.
//!
//! `crates/od-eds/cases/CODE/bad.eds` has the finding, `fixed.eds` has none; for rules about
//! XDD they end in `.xdd`. `odkit explain CODE` shows the lines in which the two differ. Rules
//! about edits of a macro call have their cases in `compile/ui`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use od_eds::Document;
use od_eds::check::{Fixability, RULES, Rule};
use od_eds::fix::{Applicability, fix};
use od_eds::{Description, Eds, Finding, say};
use od_tests::corpus;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/od-eds/cases")
}

/// `bad` or `fixed`, an EDS or an XDD.
fn file(rule: &Rule, name: &str) -> Document {
    let path = folder().join(rule.code).join(name);
    let found = ["eds", "xdd"]
        .iter()
        .find_map(|kind| fs::read(path.with_extension(kind)).ok());
    Document::new(found.unwrap_or_else(|| panic!("{} does not exist", path.display())))
}

fn of_files() -> impl Iterator<Item = &'static Rule> {
    RULES.iter().copied().filter(|rule| rule.example.is_empty())
}

#[track_caller]
fn all(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_rule_has_a_pair() {
    let mut faults = Vec::new();
    for rule in of_files() {
        let bad = file(rule, "bad").load().findings;
        if !bad.iter().any(|finding| finding.code() == rule.code) {
            let codes: Vec<_> = bad.iter().map(|finding| finding.code()).collect();
            faults.push(format!("{}: bad has only {codes:?}", rule.code));
        }
        for left in file(rule, "fixed").load().findings {
            let (code, line) = (left.code(), left.span().map_or(0, |span| span.line));
            faults.push(format!(
                "{}: fixed:{line} has {code}: {}",
                rule.code,
                say(&left, &Eds).message
            ));
        }
    }
    all(&faults);
}

#[test]
fn no_pair_is_left_over() {
    let known: BTreeSet<_> = of_files().map(|rule| rule.code.to_owned()).collect();
    let found: BTreeSet<_> = fs::read_dir(folder())
        .expect("the folder of pairs")
        .map(|entry| entry.expect("a folder").file_name().display().to_string())
        .collect();
    assert_eq!(known, found);
}

#[test]
fn rules_about_edits_are_shown_by_rustc() {
    let ui = Path::new(env!("CARGO_MANIFEST_DIR")).join("compile/ui");
    let mut told = String::new();
    for entry in fs::read_dir(ui).expect("the compile-fail cases") {
        let path = entry.expect("a file").path();
        if path
            .extension()
            .is_some_and(|extension| extension == "stderr")
        {
            told.push_str(&fs::read_to_string(path).expect("readable"));
        }
    }
    for rule in RULES.iter().filter(|rule| rule.code.starts_with("E07")) {
        assert!(told.contains(rule.code), "no case of {}", rule.code);
        assert!(!rule.example.is_empty(), "{}", rule.code);
    }
}

fn find(document: &Document) -> Vec<Finding> {
    document.load().findings
}

/// The findings of a rule have fixes exactly if the rule says so.
#[test]
fn fixes_are_those_that_the_rule_announces() {
    let mut faults = Vec::new();
    for rule in of_files() {
        let bad = file(rule, "bad");
        let findings = find(&bad);
        let own = findings
            .iter()
            .filter(|finding| finding.code() == rule.code);
        let levels: BTreeSet<_> = own
            .filter_map(|finding| finding.fix.as_ref())
            .map(|fix| fix.applicability)
            .collect();
        let expected = match rule.fixability {
            Fixability::None => levels.is_empty(),
            Fixability::Safe => levels == BTreeSet::from([Applicability::Safe]),
            Fixability::Unsafe => levels == BTreeSet::from([Applicability::Unsafe]),
            Fixability::Either => !levels.is_empty(),
        };
        if !expected {
            faults.push(format!(
                "{}: {:?}, but {levels:?}",
                rule.code, rule.fixability
            ));
        }
        let Some(level) = levels.last() else { continue };
        let fixed = fix(&bad, *level, find);
        if fixed
            .findings
            .iter()
            .any(|finding| finding.code() == rule.code)
        {
            faults.push(format!("{}: it stays", rule.code));
        }
        if fix(&fixed.document, *level, find).edits > 0 {
            faults.push(format!("{}: more findings can be fixed", rule.code));
        }
    }
    all(&faults);
}

/// Safe fixes change no object, and a second run of fixes changes nothing.
#[test]
fn fixes_of_the_corpus_keep_the_objects() {
    let mut files = corpus::files(&folder().join(".."), corpus::TEXTS);
    files.extend(corpus::files(&corpus::folder(), corpus::TEXTS));
    assert!(files.len() >= 150);
    corpus::each(&files, |path| {
        let name = path.display();
        // Without optimisation, the large devices take minutes and add no case.
        let large = fs::metadata(path).is_ok_and(|meta| meta.len() > 40_000);
        if cfg!(debug_assertions) && large {
            return;
        }
        let document = Document::new(fs::read(path).expect("readable"));
        let safe = fix(&document, Applicability::Safe, find);
        let (before, after) = (document.parse(), safe.document.parse());
        same_values(&before.description, &after.description, path);
        let guessed = fix(&document, Applicability::Unsafe, find);
        let errors = |all: &[Finding]| all.iter().filter(|d| d.is_error()).count();
        let at_first = errors(&find(&document));
        for (fixed, level) in [
            (&safe, Applicability::Safe),
            (&guessed, Applicability::Unsafe),
        ] {
            let again = fix(&fixed.document, level, find);
            assert_eq!(again.edits, 0, "{name}: {level:?}");
            assert_eq!(
                again.document.bytes(),
                fixed.document.bytes(),
                "{name}: {level:?}"
            );
            assert!(errors(&fixed.findings) <= at_first, "{name}: {level:?}");
            assert_eq!(fixed.document.encoding(), document.encoding(), "{name}");
        }
        if safe.edits == 0 {
            assert_eq!(safe.document.bytes(), document.bytes(), "{name}");
        }
    });
}

#[track_caller]
fn same_values(before: &Description, after: &Description, path: &Path) {
    let before: Vec<_> = before.entries().collect();
    let after: Vec<_> = after.entries().collect();
    assert_eq!(before.len(), after.len(), "{}", path.display());
    for (before, after) in before.iter().zip(&after) {
        assert_eq!(before, after, "{}", path.display());
    }
}
