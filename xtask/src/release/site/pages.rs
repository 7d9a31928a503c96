//! The pages of the site in their order, with their paths in the repository.

use std::path::Path;

use super::lesson;
use super::markdown;
use crate::error::{Error, Result};
use crate::files;

/// A page of the site.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Page {
    /// The heading of the part in the list of pages, if this page begins one.
    pub(super) part: Option<&'static str>,
    /// The name in the list of pages.
    pub(super) title: String,
    /// The file in the repository, relative to which its links are.
    pub(super) source: String,
    /// The heading in that file, if the page is one section of it.
    pub(super) section: Option<String>,
    /// The file on the site, with `.md` at its end.
    pub(super) target: String,
    pub(super) text: String,
    /// Its depth in the list of pages.
    pub(super) depth: usize,
}

/// Documents, and folders of documents, by part. README.md is the first page.
#[rustfmt::skip]
const PARTS: [(&str, &[&str]); 9] = [
    ("Integrate a device", &[
        "docs/how-to/run-an-encoder.md",
        "docs/how-to/read-and-write-nodes.md",
        "docs/how-to/real-bus-in-the-page.md",
        "docs/how-to/set-up-new-encoders.md",
        "docs/how-to/test-your-code-in-ci.md",
        "docs/how-to/diagnose-a-log.md",
        "docs/how-to/check-a-network.md",
        "docs/how-to/get-an-eds-from-a-device.md",
    ]),
    ("Make a device", &[
        "docs/how-to/check-an-eds.md",
        "docs/how-to/findings-in-an-editor.md",
        "docs/how-to/new-device.md",
        "docs/how-to/new-firmware.md",
        "docs/how-to/device-in-rust.md",
        "docs/how-to/own-family.md",
        "docs/how-to/node-on-a-board.md",
        "docs/how-to/node-from-c.md",
        "docs/how-to/test-a-device.md",
        "docs/how-to/write-a-test.md",
        "docs/how-to/run-a-campaign.md",
        "docs/how-to/convert-a-description.md",
        "docs/how-to/derive-a-variant.md",
        "docs/how-to/compare-two-versions.md",
    ]),
    ("Learn CANopen", &[
        "docs/how-to/learn-canopen.md",
        "docs/how-to/teach-a-class.md",
        "docs/how-to/frames-in-the-page.md",
        "docs/how-to/edit-an-eds-in-the-page.md",
    ]),
    ("Lessons", &[LESSONS]),
    ("Devices", &["docs/DEVICES.md", "docs/datasheets/", "docs/MANUALS.md"]),
    ("Device files", &[RULES, "docs/COMPATIBILITY.md", "docs/DIFFERENCES.md", "docs/CORPUS.md"]),
    ("Scripts, lessons, tests", &["crates/od-cli/SCRIPTS.md", "crates/od-cli/LESSONS.md", "crates/od-tools/CASES.md", "docs/RULES.md", "docs/CIA.md", "docs/COMPLIANCE.md", "docs/CONFORMANCE.md"]),
    ("Packages", &["python/README.md", "examples/python-ci/README.md", "playground/README.md", "crates/od-capi/README.md", "editors/README.md"]),
    ("Project", &[
        "docs/PERFORMANCE.md",
        "docs/SCALE.md",
        "tests/bench/README.md",
        "docs/CONTRIBUTING.md",
        "ARCHITECTURE.md",
        "docs/decisions/",
        "docs/SECURITY.md",
        "docs/how-to/make-a-release.md",
        "docs/RELEASE.md",
        "docs/TESTING.md",
        "CHANGELOG.md",
    ]),
];
const README: &str = "README.md";
pub(super) const RULES: &str = "docs/RULES-EDS.md";
const LESSONS: &str = "playground/lessons/";

/// Links on the first page that do not lead to documents.
const LINKS: &str = "\n[Open the playground](playground/index.html)\n\n\
                     [Licences of what this site contains](LICENSE.THIRD-PARTY.txt)\n";

/// All pages; `rules` has the code and the text of each rule.
pub(super) fn all(root: &Path, rules: &[(String, String)]) -> Result<Vec<Page>> {
    let mut first = document(root, None, README)?;
    first.target = String::from("index.md");
    first.text.push_str(LINKS);
    let mut pages = vec![first];
    for (part, documents) in PARTS {
        let mut part = Some(part);
        for source in documents.iter().copied() {
            let Some(folder) = source.strip_suffix('/') else {
                pages.push(document(root, part.take(), source)?);
                if source == RULES {
                    pages.extend(rules.iter().map(|(code, text)| rule(code, text)));
                }
                continue;
            };
            // The folders in it have the translations of lessons.
            let entries = files::entries(&root.join(folder))?;
            for file in entries.into_iter().filter(|entry| entry.is_file()) {
                let path = format!("{folder}/{}", file_name(&file));
                if source == LESSONS {
                    pages.extend(lesson_page(&file, path, &mut part)?);
                } else {
                    pages.push(document(root, part.take(), &path)?);
                }
            }
        }
    }
    Ok(pages)
}

/// The page of a rule for device files.
fn rule(code: &str, text: &str) -> Page {
    Page {
        part: None,
        title: String::from(code),
        source: String::from(RULES),
        section: Some(String::from(code)),
        target: format!("rules/{code}.md"),
        text: String::from(text),
        depth: 1,
    }
}

/// The page of a lesson; `None` for a file that is not one.
fn lesson_page(
    file: &Path,
    source: String,
    part: &mut Option<&'static str>,
) -> Result<Option<Page>> {
    let text = files::read(file)?;
    let page = lesson::page(&text, file).map(|(name, title, text)| Page {
        part: part.take(),
        title,
        source,
        section: None,
        target: format!("lessons/{name}.md"),
        text,
        depth: 0,
    });
    Ok(page)
}

/// A file of the repository as a page of its own.
fn document(root: &Path, part: Option<&'static str>, source: &str) -> Result<Page> {
    let text = files::read(&root.join(source))?;
    let title = text.lines().find_map(|line| line.strip_prefix("# "));
    let title = title.ok_or_else(|| Error::Failed(format!("{source} has no heading")))?;
    Ok(Page {
        part,
        title: String::from(title.trim()),
        source: String::from(source),
        section: None,
        target: String::from(source),
        text,
        depth: 0,
    })
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// The pages as mdBook lists them.
pub(super) fn summary(pages: &[Page]) -> String {
    let mut text = String::from("# Summary\n\n");
    for page in pages {
        if let Some(part) = page.part {
            text.push_str(&format!("\n# {part}\n\n"));
        }
        let title = page.title.replace(['[', ']'], "");
        let bullet = if page.target == "index.md" { "" } else { "- " };
        let indent = "  ".repeat(page.depth);
        text.push_str(&format!("{indent}{bullet}[{title}]({})\n", page.target));
    }
    text
}

/// The page of a file in the repository, or of a heading in it.
pub(super) fn find<'a>(pages: &'a [Page], source: &str, heading: Option<&str>) -> Option<&'a Page> {
    let mut of_file = pages.iter().filter(|page| page.source == source);
    let by_heading = |page: &&Page| {
        let own = page.section.as_deref().map(markdown::anchor);
        own.is_some() && own.as_deref() == heading
    };
    of_file.clone().find(by_heading).or_else(|| of_file.next())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{LINKS, Page, all, find, summary};
    use crate::files;

    #[test]
    fn the_readme_is_the_first_page() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let rules = [(String::from("E0101"), String::from("# E0101\n"))];
        let pages = all(&root, &rules).expect("the documents can be read");
        let target = |source, heading| find(&pages, source, heading).map(|page| &*page.target);
        assert!(pages[0].text.ends_with(LINKS));
        assert_eq!(target("README.md", None), Some("index.md"));
        assert_eq!(target("README.md", Some("two-commands")), Some("index.md"));
        assert_eq!(
            target("docs/RULES-EDS.md", Some("e0101")),
            Some("rules/E0101.md")
        );
        assert_eq!(target("other.md", None), None);
        let list = "[odkit](index.md)\n\n# Integrate a device\n\n\
                    - [Run an encoder for a CANopen master](docs/how-to/run-an-encoder.md)\n";
        assert!(summary(&pages).contains(list), "{}", summary(&pages));
        assert!(summary(&pages).contains("  - [E0101](rules/E0101.md)\n"));
    }

    /// A reader does not scroll through a long first page.
    #[test]
    fn the_readme_has_at_most_ten_kilobytes() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let text = files::read(&root.join("README.md")).expect("README.md");
        assert!(text.len() <= 10_000, "README.md has {} bytes", text.len());
    }

    #[test]
    fn every_document_of_the_repository_is_a_page() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let pages = all(&root, &[]).expect("the documents can be read");
        let is_there = |source: &str| pages.iter().any(|page: &Page| page.source == source);
        let folders = [
            "docs",
            "docs/how-to",
            "docs/decisions",
            "docs/datasheets",
            "playground/lessons",
            "crates/od-cli",
            "crates/od-tools",
            ".",
        ];
        for folder in folders {
            let mut seen = 0;
            for name in files::tree(&root.join(folder)).into_iter().flatten() {
                let is_here = !name.contains('/') && name.ends_with(".md");
                // docs.rs and crates.io show the READMEs of the crates.
                if is_here && (folder == "." || name != "README.md") {
                    let source = format!("{folder}/{name}");
                    let source = source.trim_start_matches("./");
                    assert!(is_there(source), "{source} is not on the site");
                    seen += 1;
                }
            }
            assert!(seen > 0, "{folder} has no document");
        }
        let mut targets: Vec<&str> = pages.iter().map(|page| page.target.as_str()).collect();
        targets.sort_unstable();
        targets.dedup();
        assert_eq!(targets.len(), pages.len(), "two pages have one address");
    }
}
