//! Converts links of the repository to links of the site.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

use super::markdown::with_links;
use super::pages::{Page, find};
use crate::error::{Error, Result};
use crate::release::notices::NAME;

/// Folders of the repository, and the page about what is in them.
const FOLDERS: [(&str, &str); 2] = [
    ("tests/conformance", "docs/RULES.md"),
    (
        "playground/lessons",
        "playground/lessons/01-boot-up-and-heartbeat.md",
    ),
];
/// Folder of the site with files that are not pages.
const FILES: &str = "files";

/// Finds addresses on the site, and collects the files that the site needs for them.
pub(super) struct Places<'a> {
    root: &'a Path,
    pages: &'a [Page],
    /// Files of the repository, with their names on the site.
    pub(super) files: RefCell<BTreeSet<(String, String)>>,
}

impl<'a> Places<'a> {
    pub(super) fn new(root: &'a Path, pages: &'a [Page]) -> Places<'a> {
        let files = RefCell::default();
        Places { root, pages, files }
    }

    /// The text of a page with links that lead to the same things on the site.
    pub(super) fn rewritten(&self, page: &Page) -> Result<String> {
        // Links that xtask itself wrote are already right.
        let is_own = |address: &str| {
            let starts = ["../rules/", NAME];
            address.contains("playground/index.html")
                || starts.iter().any(|start| address.starts_with(start))
        };
        with_links(&page.text, |address| {
            if address.contains("://") || address.starts_with("mailto:") || is_own(address) {
                return Ok(Some(String::from(address).replace(".md", ".html")));
            }
            let place = self.place(page, address)?;
            Ok(place.map(|place| relative(&page.target, &place)))
        })
    }

    /// Returns the path on the site for an address in a page; `None` if the site does not have it.
    fn place(&self, page: &Page, address: &str) -> Result<Option<String>> {
        let (path, heading) = match address.split_once('#') {
            Some((path, heading)) => (path, Some(heading)),
            None => (address, None),
        };
        let source = match path {
            "" => page.source.clone(),
            path => join(&page.source, path.trim_end_matches('/')),
        };
        if let Some(found) = self.page(&source, heading) {
            return Ok(Some(found));
        }
        for (folder, about) in FOLDERS {
            if let Some(inner) = source
                .strip_prefix(folder)
                .filter(|_| self.root.join(&source).is_dir())
            {
                let heading = Some(inner.trim_start_matches('/')).filter(|inner| !inner.is_empty());
                return Ok(self.page(about, heading));
            }
        }
        let file = self.root.join(&source);
        if file.is_dir() {
            return Ok(None);
        }
        if !file.is_file() {
            let text = format!("{} links to {source}, which is not there", page.source);
            return Err(Error::Failed(text));
        }
        let is_picture = [".png", ".svg"]
            .iter()
            .any(|ending| source.ends_with(ending));
        // A server and a browser can show a text. mdBook replaces `.md` anywhere in a name.
        let name = if is_picture || source.ends_with(".txt") {
            format!("{FILES}/{source}")
        } else {
            format!("{FILES}/{}.txt", source.trim_end_matches(".md"))
        };
        self.files.borrow_mut().insert((source, name.clone()));
        Ok(Some(name))
    }

    fn page(&self, source: &str, heading: Option<&str>) -> Option<String> {
        let page = find(self.pages, source, heading)?;
        let target = page.target.replace(".md", ".html");
        let is_whole = page
            .section
            .as_deref()
            .map(super::markdown::anchor)
            .as_deref()
            == heading;
        Some(match heading.filter(|_| !is_whole) {
            Some(heading) => format!("{target}#{heading}"),
            None => target,
        })
    }
}

/// Resolves a relative path in a file.
pub(super) fn join(file: &str, path: &str) -> String {
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut names: Vec<&str> = Vec::new();
    let begin = if path.starts_with('/') { "" } else { folder };
    for name in begin.split('/').chain(path.split('/')) {
        match name {
            "" | "." => {}
            ".." => drop(names.pop()),
            name => names.push(name),
        }
    }
    names.join("/")
}

/// Returns the relative path from one file to another.
fn relative(from: &str, to: &str) -> String {
    let (mut from, mut to) = (from, to);
    while let (Some((folder, rest)), Some((other, end))) =
        (from.split_once('/'), to.split_once('/'))
    {
        if folder != other {
            break;
        }
        (from, to) = (rest, end);
    }
    "../".repeat(from.matches('/').count()) + to
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Places, join, relative};
    use crate::release::site::pages::all;

    #[test]
    fn paths() {
        assert_eq!(join("docs/a.md", "../tests/b"), "tests/b");
        assert_eq!(join("a.md", "./b/c.md"), "b/c.md");
        assert_eq!(join("x/y.md", "/z.md"), "z.md");
        assert_eq!(relative("index.md", "how-to/run.html"), "how-to/run.html");
        assert_eq!(relative("how-to/run.md", "how-to/walk.html"), "walk.html");
        assert_eq!(
            relative("docs/datasheets/gxmm.md", "docs/RULES.html#eam"),
            "../RULES.html#eam"
        );
        assert_eq!(
            relative("docs/a.md", "files/docs/b.txt"),
            "../files/docs/b.txt"
        );
    }

    #[test]
    fn links_of_the_repository_work_on_the_site() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let pages = all(&root, &[]).expect("the documents can be read");
        let places = Places::new(&root, &pages);
        let check = |source: &str, address: &str, wanted: Option<&str>| {
            let page = pages
                .iter()
                .find(|page| page.source == source)
                .expect("it is a page");
            let place = places
                .place(page, address)
                .expect("the address names something");
            assert_eq!(place.as_deref(), wanted, "{source}: {address}");
        };
        check(
            "README.md",
            "docs/RULES-EDS.md",
            Some("docs/RULES-EDS.html"),
        );
        check(
            "README.md",
            "#two-commands",
            Some("index.html#two-commands"),
        );
        check(
            "README.md",
            "docs/how-to/check-an-eds.md",
            Some("docs/how-to/check-an-eds.html"),
        );
        check("docs/MANUALS.md", "#u-37", Some("docs/MANUALS.html#u-37"));
        check(
            "docs/DEVICES.md",
            "../tests/conformance/bus-cover",
            Some("docs/RULES.html#bus-cover"),
        );
        check(
            "README.md",
            "docs/playground.png",
            Some("files/docs/playground.png"),
        );
        check(
            "docs/how-to/node-from-c.md",
            "../../crates/od-capi/examples/c",
            None,
        );
        check(
            "crates/od-cli/LESSONS.md",
            "../../playground/lessons",
            Some("lessons/boot-up-and-heartbeat.html"),
        );
        check(
            "crates/od-cli/LESSONS.md",
            "#checks",
            Some("crates/od-cli/LESSONS.html#checks"),
        );
        check("docs/CIA.md", "../README.md", Some("index.html"));
        let script = "tests/conformance/cia/sdo-01.script";
        check(
            "docs/CIA.md",
            &format!("../{script}"),
            Some(&format!("files/{script}.txt")),
        );
        let files = places.files.borrow();
        assert!(files.iter().any(|(source, _)| source == script));
        let gone = places
            .place(&pages[0], "docs/gone.md")
            .expect_err("the file does not exist");
        assert_eq!(
            gone.message(),
            "README.md links to docs/gone.md, which is not there"
        );
    }

    #[test]
    fn no_link_of_a_document_leads_nowhere() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let pages = all(&root, &[]).expect("the documents can be read");
        let places = Places::new(&root, &pages);
        for page in &pages {
            if let Err(error) = places.rewritten(page) {
                panic!("{}", error.message());
            }
        }
    }
}
