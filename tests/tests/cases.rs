//! EDS in, diagnostics out: one folder of `tests/cases` is one case.
//!
//! `ODKIT_ACCEPT=1` writes the findings into `diagnostics.txt`; read it before
//! committing it. `tests/corpus` has files with one trait of real files each;
//! `ODKIT_CORPUS` names another folder to read instead.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use od_eds::{Document, Eds, Severity, say};
use od_fuzz::targets::eds::read_again;
use od_tests::corpus;

#[test]
fn diagnostics_are_as_accepted() {
    let mut wrong = Vec::new();
    let cases = cases();
    for case in &cases {
        let found = rendered(&case.document);
        let path = case.folder.join("diagnostics.txt");
        if env::var_os("ODKIT_ACCEPT").is_some() {
            fs::write(&path, &found).expect("the case's folder is writable");
            continue;
        }
        let accepted = fs::read_to_string(&path).unwrap_or_default();
        if accepted.replace("\r\n", "\n") != found {
            wrong.push(format!("{}:\n{}", case.name, difference(&accepted, &found)));
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\n`ODKIT_ACCEPT=1 cargo test -p od-tests --test cases` accepts them",
        wrong.join("\n")
    );
    assert!(cases.len() >= 25, "{} cases", cases.len());
}

#[test]
fn every_case_is_read_again_from_its_own_text() {
    for case in cases() {
        println!("{}", case.name);
        read_again(&case.document);
    }
}

#[test]
fn the_corpus_is_read_and_written_again() {
    let files = corpus::files(&corpus::folder(), corpus::ALL);
    assert!(files.len() >= 60, "{} files", files.len());
    let mut by_code: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for file in &files {
        let bytes = fs::read(file).expect("a file of the corpus is readable");
        let document = Document::new(bytes);
        let name = file.display();
        println!("{name}");
        let loaded = read_again(&document);
        assert!(!loaded.description.objects.is_empty(), "{name}: no objects");
        let mut codes = BTreeMap::new();
        for finding in &loaded.findings {
            *codes.entry(finding.code()).or_insert(0) += 1;
        }
        if env::var_os("ODKIT_VERBOSE").is_some() {
            let entries = loaded.description.entries().count();
            println!("{name}: {entries} entries {codes:?}");
        }
        for (code, count) in codes {
            let (files, findings) = by_code.entry(code).or_default();
            *files += 1;
            *findings += count;
        }
    }
    println!("{} files; by code: files, findings", files.len());
    for (code, (files, findings)) in by_code {
        println!("{code} {files:4} {findings:6}");
    }
}

/// The first lines of each file in `tests/corpus` name its trait, and the codes that odkit reports for it.
#[test]
fn each_file_of_our_corpus_shows_its_trait() {
    let mut wrong = Vec::new();
    let mut traits = BTreeSet::new();
    for file in corpus::files(&corpus::own(), corpus::ALL) {
        let bytes = fs::read(&file).expect("a file of the corpus is readable");
        let document = Document::new(bytes).named(file.display().to_string());
        let line = |name: &str| {
            let mut lines = document.text().lines().take(3);
            let text = lines
                .find_map(|line| line.split_once(name))
                .map(|(_, text)| text);
            text.map(|text| text.trim_end_matches("-->").trim().to_owned())
        };
        let name = file.file_name().unwrap_or_default().display().to_string();
        let (Some(trait_), Some(expected)) = (line("Trait: "), line("Reports: ")) else {
            wrong.push(format!(
                "{name}: the first lines lack `Trait: ` or `Reports: `"
            ));
            continue;
        };
        if !traits.insert(trait_) {
            wrong.push(format!("{name}: another file has the same trait"));
        }
        let loaded = document.load();
        let codes: BTreeSet<&str> = loaded.findings.iter().map(|found| found.code()).collect();
        let found = if codes.is_empty() {
            "nothing".to_owned()
        } else {
            Vec::from_iter(codes).join(", ")
        };
        if expected != found {
            wrong.push(format!(
                "{name}: odkit reports {found}, the file says {expected}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(traits.len() >= 60, "{} files", traits.len());
}

fn rendered(document: &Document) -> String {
    let mut out = String::new();
    for finding in &document.load().findings {
        let finding = say(finding, &Eds);
        let place = match finding.span {
            Some(span) => format!("{}:{}", span.line, span.column),
            None => "-".into(),
        };
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Info => "info",
        };
        let address = finding.address.map(|a| format!(" {a}")).unwrap_or_default();
        let code = finding.code;
        let _ = writeln!(
            out,
            "{place}: {code} {severity}{address} {}",
            finding.message
        );
        for label in finding.labels {
            let (line, column) = (label.span.line, label.span.column);
            let _ = writeln!(out, "    {line}:{column}: {}", label.text);
        }
        let _ = writeln!(out, "    help: {}", finding.help);
    }
    out
}

/// The lines that only one of two texts has.
fn difference(accepted: &str, found: &str) -> String {
    let mut out = String::new();
    for (sign, a, b) in [('-', accepted, found), ('+', found, accepted)] {
        let other: Vec<&str> = b.lines().collect();
        for line in a.lines().filter(|line| !other.contains(line)) {
            let _ = writeln!(out, "{sign}{line}");
        }
    }
    out
}

struct Case {
    name: String,
    folder: PathBuf,
    document: Document,
}

/// Every folder of `tests/cases` with an `input.eds` or `input.xdd`, by name.
fn cases() -> Vec<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut cases = Vec::new();
    for entry in fs::read_dir(root).expect("tests/cases is there") {
        let folder = entry.expect("a folder can be listed").path();
        let inputs = ["input.eds", "input.xdd"].map(|name| folder.join(name));
        let Some(bytes) = inputs.iter().find_map(|path| fs::read(path).ok()) else {
            continue;
        };
        cases.push(Case {
            name: folder.file_name().unwrap_or_default().display().to_string(),
            folder,
            document: Document::new(bytes),
        });
    }
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}
