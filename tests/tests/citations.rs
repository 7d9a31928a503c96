//! Every decision that is cited, such as `U-37`, is in docs/MANUALS.md.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Groups of decisions: the letters of an id before its number.
const GROUPS: [&str; 5] = ["C-GX-", "C-EAM-", "C-EN-", "C-X-", "U-"];
/// Endings of files that can cite a decision.
const TEXTS: [&str; 12] = [
    "rs", "script", "py", "ts", "mjs", "md", "txt", "toml", "eds", "c", "h", "yml",
];
/// Folders with generated files or with files of others.
const MADE: [&str; 6] = [
    "target",
    "node_modules",
    "dist",
    "pkg",
    "__pycache__",
    "vendor",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All texts below a folder.
fn texts(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
    let entries = fs::read_dir(folder).expect("a folder of the repository");
    for entry in entries {
        let path = entry.expect("an entry of a folder").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_symlink() || name.starts_with('.') || MADE.contains(&&*name) {
            continue;
        }
        if path.is_dir() {
            texts(&path, found);
        } else if TEXTS
            .iter()
            .any(|ending| path.extension().is_some_and(|own| own == *ending))
        {
            // A file of a test may have another encoding; it cites nothing.
            if let Ok(text) = fs::read_to_string(&path) {
                found.push((path, text));
            }
        }
    }
}

/// The ids in a text: a group and two digits, with no letter, digit or hyphen beside them.
fn ids(text: &str) -> BTreeSet<&str> {
    let mut found = BTreeSet::new();
    for group in GROUPS {
        for (at, _) in text.match_indices(group) {
            let id = text.get(at..at + group.len() + 2).unwrap_or_default();
            let is_number = id.len() > 2 && id[group.len()..].bytes().all(|b| b.is_ascii_digit());
            let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            let before = text[..at].chars().next_back();
            let after = text[at + id.len()..].chars().next();
            if is_number && !before.is_some_and(is_part) && !after.is_some_and(is_part) {
                found.insert(id);
            }
        }
    }
    found
}

/// The ids that docs/MANUALS.md has a row for.
fn decided(page: &str) -> BTreeSet<String> {
    page.lines()
        .filter_map(|line| line.strip_prefix("| <a id=\"")?.split_once("\"></a>"))
        .map(|(anchor, rest)| {
            let id = rest.split(' ').next().unwrap_or_default();
            assert_eq!(anchor, id.to_lowercase(), "the anchor of {id} is its name");
            String::from(id)
        })
        .collect()
}

#[test]
fn every_cited_decision_is_in_manuals_md() {
    let page = fs::read_to_string(root().join("docs/MANUALS.md")).expect("docs/MANUALS.md");
    let decided = decided(&page);
    let mut all = Vec::new();
    texts(&root(), &mut all);
    let mut wrong = Vec::new();
    let mut cited = 0;
    for (path, text) in &all {
        let ids = ids(text);
        cited += ids.len();
        for id in ids.iter().filter(|id| !decided.contains(**id)) {
            wrong.push(format!(
                "{}: {id} is not in docs/MANUALS.md",
                path.display()
            ));
        }
        if !ids.is_empty() && !text.contains("MANUALS.md") && !path.ends_with("docs/MANUALS.md") {
            let example = "write `MANUALS.md` before the first id";
            wrong.push(format!(
                "{}: does not say where its ids are: {example}",
                path.display()
            ));
        }
    }
    assert!(cited > 300, "only {cited} ids were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn an_id_is_found_between_other_words() {
    let text = "(U-08, C-GX-36): BAU-12 is not one, U-1 neither, nor C-EN-123; MANUALS.md C-X-02.";
    assert_eq!(ids(text), BTreeSet::from(["C-GX-36", "C-X-02", "U-08"]));
}
