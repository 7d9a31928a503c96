//! The licences of third-party components in a part: MIT, BSD and others require that their texts are included.
//!
//! The texts come from the packages. A component without a text stops the release.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::bill::{self, Component, Licence};
use super::dist::Dist;
use crate::console::ask_in;
use crate::error::{Error, Result};
use crate::files;

/// Name of the file in every package: npm, Python and Visual Studio Code include files that begin with `LICENSE`.
pub(super) const NAME: &str = "LICENSE.THIRD-PARTY.txt";

/// Packages without a text, and a package of the same authors that has it.
const SAME: [(&str, &str); 2] = [
    ("winapi-x86_64-pc-windows-gnu", "winapi"),
    ("@lit-labs/ssr-dom-shim", "lit"),
];

const HEAD: &str =
    "This product has parts of the packages below. Their authors allow that under these terms.\n";

/// Packages and licence expressions, by the text.
type Texts = BTreeMap<String, BTreeSet<String>>;

/// Writes the texts that a part needs into a folder.
pub(super) fn write(dist: &Dist<'_>, part: &str, folder: &Path) -> Result<PathBuf> {
    let bill = bill::of(dist, part)?;
    let mut texts = Texts::new();
    for one in bill.components.iter().skip(1) {
        let label = format!("{} {} ({})", one.name, one.version, one.expression);
        if one.name == "rust-std" {
            library(dist, &label, &mut texts)?;
        }
        for text in of(one, &bill.components)? {
            texts.entry(text).or_default().insert(label.clone());
        }
    }
    let file = folder.join(NAME);
    files::write(&file, &written(&texts))?;
    Ok(file)
}

/// Writes the file into the folder that a tool packs, runs the tool, and removes the file.
pub(super) fn within(
    dist: &Dist<'_>,
    part: &str,
    folder: &Path,
    pack: impl FnOnce() -> Result<()>,
) -> Result<()> {
    let file = write(dist, part, folder)?;
    let packed = pack();
    std::fs::remove_file(&file).map_err(|e| Error::io("remove", &file, &e))?;
    packed
}

fn written(texts: &Texts) -> String {
    let mut texts: Vec<_> = texts.iter().collect();
    texts.sort_by_key(|(_, packages)| packages.first());
    let mut out = String::from(HEAD);
    for (text, packages) in texts {
        out.push_str(&format!("\n{}\n", "=".repeat(80)));
        for package in packages {
            out.push_str(&format!("{package}\n"));
        }
        out.push_str(&format!("\n{text}\n"));
    }
    out
}

/// The texts of a component.
fn of(one: &Component, all: &[Component]) -> Result<Vec<String>> {
    let folder = match &one.licence {
        Licence::Own => return Ok(Vec::new()),
        Licence::Text(text) => return Ok(vec![tidy(text)]),
        Licence::Folder(folder) => folder,
    };
    let mut found = Vec::new();
    for path in files::entries(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if is_licence(&name) && path.is_file() {
            found.push((name.to_lowercase(), files::read(&path)?));
        }
    }
    let texts = chosen(found);
    if !texts.is_empty() {
        return Ok(texts);
    }
    let other = SAME.iter().find(|(name, _)| *name == one.name);
    let other = other.and_then(|(_, other)| all.iter().find(|one| one.name == *other));
    match other {
        Some(other) => of(other, all),
        None => Err(Error::Failed(format!(
            "{} {} has no text of its licence in {}",
            one.name,
            one.version,
            folder.display()
        ))),
    }
}

fn is_licence(name: &str) -> bool {
    let name = name.to_lowercase();
    let starts = ["licen", "copying", "copyright", "notice"];
    let is_code = [".rs", ".js", ".ts"].iter().any(|end| name.ends_with(end));
    starts.iter().any(|start| name.starts_with(start)) && !is_code
}

/// The texts of files. If there is a choice of licences, those of the shorter licence.
fn chosen(files: Vec<(String, String)>) -> Vec<String> {
    let is_short = |name: &str| name.contains("mit") || name.contains("bsd");
    let has_short = files.iter().any(|(name, _)| is_short(name));
    let is_left = |name: &str| {
        let is_other = ["apache", "mpl", "copying"]
            .iter()
            .any(|it| name.contains(it));
        has_short && is_other && !is_short(name)
    };
    let kept = files.iter().filter(|(name, _)| !is_left(name));
    kept.map(|(_, text)| tidy(text)).collect()
}

/// Text with the line ends of this system, without empty lines at its ends.
fn tidy(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    String::from(lines.join("\n").trim_matches('\n'))
}

/// The texts of Rust's standard library and its components, from the toolchain.
fn library(dist: &Dist<'_>, label: &str, texts: &mut Texts) -> Result<()> {
    let sysroot = ask_in(&dist.repo.root, "rustc", &["--print", "sysroot"]).unwrap_or_default();
    let folder = PathBuf::from(sysroot).join("share/doc/rust");
    let mit = files::read(&folder.join("licenses/MIT.txt"))?;
    let holder = "The Rust Project Developers (see https://thanks.rust-lang.org)";
    let mit = mit.replace("<year> <copyright holders>", holder);
    let unicode = files::read(&folder.join("licenses/Unicode-3.0.txt"))?;
    for text in [&mit, &unicode] {
        let packages = texts.entry(tidy(text)).or_default();
        packages.insert(String::from(label));
    }
    let html = files::read(&folder.join("COPYRIGHT-library.html"))?;
    for (package, files) in within_library(&html) {
        for text in chosen(files) {
            texts.entry(text).or_default().insert(package.clone());
        }
    }
    Ok(())
}

/// The packages of the standard library, with the names and texts of their licence files.
fn within_library(html: &str) -> Vec<(String, Vec<(String, String)>)> {
    let mut found = Vec::new();
    for section in html.split("<h3>📦 ").skip(1) {
        let name = section.split('<').next().unwrap_or_default();
        let (name, version) = versioned(name);
        let terms = between(section, "<b>License:</b> ", "</p>").unwrap_or_default();
        let label = format!("{name} {version} ({})", plain(terms));
        let files = section.split("<summary><code>").skip(1).filter_map(|file| {
            let name = file.split('<').next()?.to_lowercase();
            let text = between(file, "<pre>", "</pre>")?;
            is_licence(&name).then(|| (name, plain(text)))
        });
        found.push((label, files.collect()));
    }
    found
}

/// Name and version of `cfg-if-1.0.4`.
fn versioned(name: &str) -> (&str, &str) {
    let is_version = |at: &usize| name[at + 1..].starts_with(|c: char| c.is_ascii_digit());
    let mut dashes = name.match_indices('-').map(|(at, _)| at);
    let at = dashes.find(is_version).unwrap_or(name.len());
    (&name[..at], name.get(at + 1..).unwrap_or_default())
}

fn between<'a>(text: &'a str, start: &str, end: &str) -> Option<&'a str> {
    Some(text.split_once(start)?.1.split_once(end)?.0)
}

/// Converts HTML to plain text.
fn plain(html: &str) -> String {
    let signs = [
        ("#60", "<"),
        ("#62", ">"),
        ("#34", "\""),
        ("#39", "'"),
        ("#38", "&"),
    ];
    signs.iter().fold(String::from(html), |text, (code, sign)| {
        text.replace(&format!("&{code};"), sign)
    })
}

#[cfg(test)]
mod tests {
    use super::{Texts, chosen, is_licence, plain, versioned, within_library, written};

    #[test]
    fn a_choice_is_the_short_licence_with_its_further_texts() {
        let files = |names: &[&str]| {
            let all = names
                .iter()
                .map(|name| (String::from(*name), format!("\r\n{name} \r\n")));
            chosen(all.collect())
        };
        let names = ["license-apache", "license-mit", "license-unicode"];
        assert_eq!(files(&names), ["license-mit", "license-unicode"]);
        assert_eq!(files(&["license-apache"]), ["license-apache"]);
        assert_eq!(files(&["copying", "license-mit"]), ["license-mit"]);
        assert_eq!(
            files(&["license", "license-mpl"]),
            ["license", "license-mpl"]
        );
        for name in ["LICENCE", "License.txt", "COPYRIGHT", "license-mit"] {
            assert!(is_licence(name), "{name}");
        }
        assert!(!is_licence("README.md") && !is_licence("license.rs"));
    }

    #[test]
    fn the_library_names_its_packages() {
        let html = "<h3>📦 cfg-if-1.0.4</h3><p><b>License:</b> MIT OR Apache-2.0</p><details><summary><code>LICENSE-MIT</code>\
                    </summary><pre>A &#60;b&#62; &#38;#34;</pre></details><h3>📦 wasi-0.11.1+wasi-snapshot</h3>";
        let found = within_library(html);
        let text = (String::from("license-mit"), String::from("A <b> &#34;"));
        let wanted = [
            (String::from("cfg-if 1.0.4 (MIT OR Apache-2.0)"), vec![text]),
            (String::from("wasi 0.11.1+wasi-snapshot ()"), Vec::new()),
        ];
        assert_eq!(found, wanted);
        assert_eq!(versioned("r-efi"), ("r-efi", ""));
        assert_eq!(plain("&#39;"), "'");
    }

    #[test]
    fn packages_with_one_text_have_it_once() {
        let mut texts = Texts::new();
        for (package, text) in [("c 1", "Free."), ("a 1", "Free."), ("b 1", "As is.")] {
            let packages = texts.entry(String::from(text)).or_default();
            packages.insert(String::from(package));
        }
        let text = written(&texts);
        let (head, rest) = text
            .split_once("===\na 1\nc 1\n\nFree.\n\n===")
            .expect("both");
        assert!(head.starts_with("This product") && rest.ends_with("===\nb 1\n\nAs is.\n"));
    }
}
