//! The pages in their order: what the repository has, by the path that it has there.

use std::path::Path;

use super::lesson;
use super::markdown::{self, anchor, sections};
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

/// Documents and folders of documents by part; those that README.md has sections for are not here.
#[rustfmt::skip]
const PARTS: [(&str, &[&str]); 4] = [
    ("Devices", &["docs/datasheets/", "docs/MANUALS.md"]),
    ("Device files", &[RULES, "docs/COMPATIBILITY.md", "docs/DIFFERENCES.md", "docs/CORPUS.md"]),
    ("Scripts, lessons, tests", &["od-cli/SCRIPTS.md", "od-cli/LESSONS.md", "od-bus/CASES.md", "docs/RULES.md", "docs/CIA.md"]),
    ("Packages", &["python/README.md", "examples/python-ci/README.md", "playground/README.md", "od-capi/README.md", "editors/README.md"]),
];
const README: &str = "README.md";
pub(super) const RULES: &str = "docs/RULES-EDS.md";
const LESSONS: &str = "playground/lessons";
/// Sections of README.md that stay on its first page, and those that its part "How to" is made of.
const FIRST: [&str; 2] = ["", "Two commands"];
const HOW_TO: &str = "How to …";

/// Links of the first page beside the documents.
const LINKS: &str = "\n[Open the playground](playground/index.html)\n\n\
                     [Licences of what this site contains](LICENSE.THIRD-PARTY.txt)\n";

/// All pages; `rules` has the code and the text of each rule.
pub(super) fn all(root: &Path, rules: &[(String, String)]) -> Result<Vec<Page>> {
    let mut pages = readme(&files::read(&root.join(README))?);
    let at_end = pages.iter().position(|page| page.part == Some("odkit"));
    let about = pages.split_off(at_end.unwrap_or(pages.len()));
    let mut part = Some("Lessons");
    for file in files::entries(&root.join(LESSONS))? {
        let page = lesson::page(&files::read(&file)?, &file).map(|(name, title, text)| Page {
            part: part.take(),
            title,
            source: format!("{LESSONS}/{}", file_name(&file)),
            section: None,
            target: format!("lessons/{name}.md"),
            text,
            depth: 0,
        });
        pages.extend(page);
    }
    for (part, documents) in PARTS {
        let mut part = Some(part);
        for source in documents.iter().copied() {
            if let Some(folder) = source.strip_suffix('/') {
                for file in files::entries(&root.join(folder))? {
                    let source = format!("{folder}/{}", file_name(&file));
                    pages.push(document(root, part.take(), &source)?);
                }
                continue;
            }
            pages.push(document(root, part.take(), source)?);
            if source == RULES {
                pages.extend(rules.iter().map(|(code, text)| Page {
                    part: None,
                    title: code.clone(),
                    source: String::from(RULES),
                    section: Some(code.clone()),
                    target: format!("rules/{code}.md"),
                    text: text.clone(),
                    depth: 1,
                }));
            }
        }
    }
    pages.extend(about);
    for source in ["tests/bench/README.md", "ARCHITECTURE.md", "CHANGELOG.md"] {
        pages.push(document(root, None, source)?);
    }
    Ok(pages)
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

/// README.md, a page for each section and for each thing to do.
fn readme(text: &str) -> Vec<Page> {
    let page = |part, title: &str, section: &str, target: String, body: &str| Page {
        part,
        title: String::from(title),
        source: String::from(README),
        section: Some(String::from(section)),
        target,
        text: format!("# {title}\n{body}"),
        depth: 0,
    };
    let mut first = String::new();
    let (mut tasks, mut others) = (Vec::new(), Vec::new());
    for section in sections(text, 2) {
        if FIRST.contains(&section.title) {
            if !section.title.is_empty() {
                first.push_str(&format!("## {}\n", section.title));
            }
            first.push_str(&section.body);
        } else if section.title == HOW_TO {
            for task in sections(&section.body, 3)
                .iter()
                .filter(|task| !task.title.is_empty())
            {
                let part = tasks.is_empty().then_some("How to");
                let words = task.title.trim_start_matches(['…', ' ']);
                let target = format!("how-to/{}.md", anchor(words));
                let title = capital(words);
                tasks.push(page(part, &title, task.title, target, &task.body));
            }
        } else {
            let part = others.is_empty().then_some("odkit");
            let target = format!("{}.md", anchor(section.title));
            others.push(page(
                part,
                section.title,
                section.title,
                target,
                &section.body,
            ));
        }
    }
    let mut pages = vec![Page {
        part: None,
        title: String::from("odkit"),
        source: String::from(README),
        section: None,
        target: String::from("index.md"),
        text: format!("{first}{LINKS}"),
        depth: 0,
    }];
    pages.append(&mut tasks);
    pages.append(&mut others);
    pages
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
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

    use super::{LINKS, Page, all, find, readme, summary};
    use crate::files;

    const TEXT: &str = "# odkit\nHello.\n## Two commands\nTwo.\n## How to …\n### … run it\nRun.\n\
                        ### … check an EDS\nCheck.\n## How fast\nFast.\n";

    #[test]
    fn the_readme_is_taken_apart() {
        let pages = readme(TEXT);
        let list: Vec<(&str, &str)> = pages
            .iter()
            .map(|page| (page.title.as_str(), page.target.as_str()))
            .collect();
        let wanted = [
            ("odkit", "index.md"),
            ("Run it", "how-to/run-it.md"),
            ("Check an EDS", "how-to/check-an-eds.md"),
            ("How fast", "how-fast.md"),
        ];
        assert_eq!(list, wanted);
        assert_eq!(
            pages[0].text,
            format!("# odkit\nHello.\n## Two commands\nTwo.\n{LINKS}")
        );
        assert_eq!(pages[2].text, "# Check an EDS\nCheck.\n");
        let target = |heading| find(&pages, "README.md", heading).map(|page| &*page.target);
        assert_eq!(target(Some("how-fast")), Some("how-fast.md"));
        assert_eq!(target(Some("-run-it")), Some("how-to/run-it.md"));
        assert_eq!(target(Some("two-commands")), Some("index.md"));
        assert_eq!(target(None), Some("index.md"));
        assert_eq!(find(&pages, "other.md", None), None);
        let list = "[odkit](index.md)\n\n# How to\n\n- [Run it](how-to/run-it.md)\n";
        assert!(summary(&pages).contains(list), "{}", summary(&pages));
    }

    #[test]
    fn every_document_of_the_repository_is_a_page() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let pages = all(&root, &[]).expect("the documents can be read");
        let is_there = |source: &str| pages.iter().any(|page: &Page| page.source == source);
        let folders = [
            "docs",
            "docs/datasheets",
            "playground/lessons",
            "od-cli",
            "od-bus",
            ".",
        ];
        for folder in folders {
            let mut seen = 0;
            for name in files::tree(&root.join(folder)).into_iter().flatten() {
                let is_here = !name.contains('/') && name.ends_with(".md");
                // Of the crates' own READMEs the registry makes pages.
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
