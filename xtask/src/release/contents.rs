//! Files that describe the release: a README, licences and checksums.

use std::fmt::Write as _;
use std::path::Path;

use super::dist::Dist;
use crate::console::ask_in;
use crate::error::{Error, Result};
use crate::files;

/// The checksums of all files, as `sha256sum --check` reads them.
pub(super) const SUMS: &str = "SHA256SUMS";
const README: &str = "README.md";
const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];
/// Maximum number of files of a folder that the README lists one by one; a folder with more has one line.
const NAMED: usize = 20;

/// Writes README, licences and checksums for the existing parts; each part has a name and a content.
pub(super) fn write(
    dist: &Dist<'_>,
    out: &Path,
    of: &[(&'static str, &'static str)],
) -> Result<()> {
    for name in LICENCES {
        files::copy(&dist.repo.root.join(name), &out.join(name))?;
    }
    let mut parts = Vec::new();
    for (name, about) in of.iter().copied() {
        let folder = out.join(name);
        if folder.is_dir() {
            parts.push((name, about, files::tree(&folder)?));
        }
    }
    let git = |args: &[&str]| ask_in(&dist.repo.root, "git", args);
    let mut commit = git(&["rev-parse", "HEAD"]).unwrap_or_default();
    if git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|it| !it.is_empty()) {
        commit.push_str(", with changes that are not committed");
    }
    files::write(&out.join(README), &readme(&dist.version, &commit, &parts))?;
    let mut names = files::tree(out)?;
    names.retain(|name| name != SUMS);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mut sums = String::new();
    // A command line has a maximum length.
    for names in names.chunks(500) {
        let lines = ask_in(out, "sha256sum", &[&["--"], names].concat());
        let missing = "`sha256sum` does not run: please install it, on Debian `coreutils` has it";
        sums.push_str(&lines.ok_or_else(|| Error::Missing(String::from(missing)))?);
        sums.push('\n');
    }
    files::write(&out.join(SUMS), &sums)
}

/// The text of the README.
fn readme(version: &str, commit: &str, parts: &[(&str, &str, Vec<String>)]) -> String {
    let mut text = format!("# odkit {version}\n\n");
    if !commit.is_empty() {
        let _ = writeln!(text, "Made by `cargo xtask dist` from commit {commit}.\n");
    }
    text.push_str("`sha256sum --check SHA256SUMS` checks all files.\n");
    for (name, about, files) in parts {
        let _ = writeln!(text, "\n## {name}\n\n{}.\n", sentence(about));
        if files.len() > NAMED {
            let _ = writeln!(text, "- `{name}/`: {} files", files.len());
        } else {
            for file in files {
                let _ = writeln!(text, "- `{name}/{file}`");
            }
        }
    }
    text
}

/// The text with a capital at its start.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::readme;

    #[test]
    fn the_readme_names_files_but_not_thousands() {
        let few = vec![String::from("odkit-1.2.3.whl")];
        let many = (0..1000).map(|n| format!("{n}.html")).collect();
        let parts = [
            ("python", "the wheel: `pip install FILE`", few),
            ("site", "pages", many),
        ];
        let text = readme("1.2.3", "abc", &parts);
        assert!(text.starts_with("# odkit 1.2.3\n"));
        assert!(text.contains("from commit abc."));
        assert!(text.contains(
            "\n## python\n\nThe wheel: `pip install FILE`.\n\n- `python/odkit-1.2.3.whl`\n"
        ));
        assert!(text.contains("- `site/`: 1000 files\n") && !text.contains("17.html"));
    }
}
