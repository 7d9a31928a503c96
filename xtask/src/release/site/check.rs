//! Checks that each link of the site leads to an existing file and anchor.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::links::join;
use crate::error::{Error, Result};
use crate::files;

/// Links and anchors of a page.
#[derive(Debug, Default)]
struct Found {
    links: Vec<String>,
    places: BTreeSet<String>,
}

/// Fails with the list of all broken links of a folder's pages.
pub(super) fn check(site: &Path) -> Result<()> {
    let names = files::tree(site)?;
    let mut pages = BTreeMap::new();
    for name in names.iter().filter(|name| name.ends_with(".html")) {
        pages.insert(name.as_str(), read(&files::read(&site.join(name))?));
    }
    let mut broken = Vec::new();
    for (page, found) in &pages {
        for link in &found.links {
            if !leads(page, link, &names, &pages) {
                broken.push(format!("{page}: {link}"));
            }
        }
    }
    match broken.len() {
        0 => Ok(()),
        number => {
            let list = broken.join("\n  ");
            Err(Error::Failed(format!(
                "{number} links of the site lead nowhere:\n  {list}"
            )))
        }
    }
}

fn leads(page: &str, link: &str, names: &[String], pages: &BTreeMap<&str, Found>) -> bool {
    let link = link.replace("&amp;", "&");
    if link.contains("://") || link.starts_with("mailto:") || link.starts_with("data:") {
        return true;
    }
    let (rest, place) = link.split_once('#').unwrap_or((&link, ""));
    let path = rest.split('?').next().unwrap_or_default();
    let mut file = match path {
        "" => String::from(page),
        path => join(page, &path.replace("%20", " ")),
    };
    if file.is_empty() || path.ends_with('/') {
        file = format!("{file}/index.html");
    }
    let file = file.trim_start_matches('/');
    names.iter().any(|name| name == file)
        && (place.is_empty()
            || pages
                .get(file)
                .is_none_or(|found| found.places.contains(place)))
}

/// Reads the links and the anchors of a page.
fn read(html: &str) -> Found {
    let mut found = Found::default();
    let mut rest = html;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        let hidden = [
            ("<!--", "-->"),
            ("<script>", "</script>"),
            ("<style>", "</style>"),
        ];
        if let Some((_, end)) = hidden.iter().find(|(begin, _)| rest.starts_with(begin)) {
            rest = rest.find(end).map_or("", |at| &rest[at + end.len()..]);
            continue;
        }
        let end = tag(rest);
        let is_base = rest.starts_with("<base ");
        for (name, value) in attributes(&rest[..end]) {
            match name {
                "href" | "src" if !is_base => found.links.push(String::from(value)),
                "id" => drop(found.places.insert(String::from(value))),
                _ => {}
            }
        }
        rest = &rest[end..];
    }
    found
}

/// Length of the tag at the start of the text.
fn tag(text: &str) -> usize {
    let mut quote = None;
    for (at, sign) in text.char_indices().skip(1) {
        match (quote, sign) {
            (None, '>') => return at,
            (None, '"' | '\'') => quote = Some(sign),
            (Some(open), sign) if open == sign => quote = None,
            _ => {}
        }
    }
    text.len()
}

/// The attributes of a tag that are in quotes.
fn attributes(tag: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let mut rest = tag;
    while let Some(at) = rest.find("=\"") {
        let name = rest[..at]
            .rsplit([' ', '\n', '\t'])
            .next()
            .unwrap_or_default();
        let value = &rest[at + 2..];
        let end = value.find('"').unwrap_or(value.len());
        found.push((name, &value[..end]));
        rest = value.get(end + 1..).unwrap_or_default();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::files;

    #[test]
    fn a_link_that_leads_nowhere_is_named() {
        let dir = std::env::temp_dir().join(format!("xtask-links-{}", std::process::id()));
        let page = "<p id=\"top\"><a title=\"a > b\" href=\"a/b.html#x\">b</a><a href=\"#top\">t</a>\
                    <img src=\"p.png\"><a href='?' href=\"https://example.com/\">e</a>&lt;a href=\"no\"\
                    <script>f('<a href=\"no\">')</script><a href=\"a/\">a</a><a href=\"a/b.html?q&amp;r\">b</a>";
        let other = "<a id=\"x\" href=\"../index.html\">up</a>";
        for (name, text) in [
            ("index.html", page),
            ("a/b.html", other),
            ("a/index.html", ""),
            ("p.png", ""),
        ] {
            files::write(&dir.join(name), text).expect("a temporary folder is writable");
        }
        assert_eq!(check(&dir), Ok(()));
        let wrong = "<a href=\"b.html#y\">1</a><a href=\"gone.html\">2</a><img src=\"/q.png\"><a href=\"#z\">";
        files::write(&dir.join("a/index.html"), wrong).expect("a temporary folder is writable");
        let why = check(&dir).expect_err("four links are wrong");
        let lines: Vec<&str> = why.message().lines().map(str::trim).collect();
        let wanted =
            ["b.html#y", "gone.html", "/q.png", "#z"].map(|link| format!("a/index.html: {link}"));
        assert!(lines[0].starts_with("4 links"));
        assert_eq!(lines[1..], wanted);
        let _ = std::fs::remove_dir_all(&dir);
    }
}
