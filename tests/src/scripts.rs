//! Finds the conformance scripts and parses their first lines.
//!
//! A script begins with a comment: its source, a colon and a space, and then its rule up to the end
//! of the comment. One more comment line, `# Devices: gxmm eam_mt`, names the devices on which a
//! script without a `device` line is run.

use std::fs;
use std::path::{Path, PathBuf};

/// Allowed sources of a rule, as the first words of a source.
pub const SOURCES: [&str; 9] = [
    "Manual 000",
    "Manual 001",
    "Manual 003",
    "CiA 301",
    "CiA 302",
    "CiA 401",
    "CiA 402",
    "CiA case",
    "MANUALS.md",
];

const DEVICES: &str = "Devices:";

/// The folder of all scripts.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance")
}

/// One script.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct File {
    /// Path relative to the folder of all scripts, with `/`.
    pub name: String,
    /// Path of the script.
    pub path: PathBuf,
}

/// All scripts, by name.
///
/// # Panics
/// If the folder cannot be read.
pub fn all() -> Vec<File> {
    all_in(&root())
}

/// All scripts of another folder, by name.
///
/// # Panics
/// If the folder cannot be read.
pub fn all_in(folder: &Path) -> Vec<File> {
    let mut found = Vec::new();
    collect(folder, "", &mut found);
    found.sort();
    found
}

fn collect(folder: &Path, prefix: &str, found: &mut Vec<File>) {
    let entries = fs::read_dir(folder).expect("the folder of the conformance scripts");
    for entry in entries {
        let path = entry.expect("an entry of the folder").path();
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{prefix}{file}");
        if path.is_dir() {
            collect(&path, &format!("{name}/"), found);
        } else if name.ends_with(".script") {
            found.push(File { name, path });
        }
    }
}

/// The first lines of a script, parsed.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Header {
    /// The manual and the place in it.
    pub source: String,
    /// The rule that the script shows.
    pub rule: String,
    /// The devices on which it is run; empty if it has a `device` line.
    pub devices: Vec<String>,
}

impl Header {
    /// Reads the comment at the start of a script.
    ///
    /// # Errors
    /// The missing line, with an example.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut devices = Vec::new();
        let mut words = Vec::new();
        for line in text.lines().map_while(|line| line.strip_prefix('#')) {
            match line.trim().strip_prefix(DEVICES) {
                Some(names) => devices.extend(names.split_whitespace().map(String::from)),
                None => words.push(line.trim()),
            }
        }
        let words = words.join(" ");
        let example = "# Manual 000, object 1003h: the last eight, newest first";
        let Some((source, rule)) = words.split_once(": ") else {
            return Err(format!(
                "the script begins with its source and its rule: `{example}`"
            ));
        };
        if !SOURCES.iter().any(|known| source.starts_with(known)) {
            return Err(format!(
                "`{source}` is not a source; a source begins with {}: `{example}`",
                SOURCES.join(", ")
            ));
        }
        Ok(Self {
            source: String::from(source.trim()),
            rule: String::from(rule.trim()),
            devices,
        })
    }
}

/// Text for a cell of a Markdown table.
pub fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}

/// Compares a generated page of `docs/` with the existing one, or writes it.
///
/// # Errors
/// The first line that differs, and the command that writes the page again.
pub fn compare_page(name: &str, generated: &str) -> Result<(), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../docs")
        .join(name);
    if std::env::var_os("ODKIT_ACCEPT").is_some() {
        return fs::write(&path, generated).map_err(|error| format!("docs/{name}: {error}"));
    }
    let there = fs::read_to_string(&path).unwrap_or_default();
    if there == generated {
        return Ok(());
    }
    let mut lines = generated.lines();
    let differs = there.lines().zip(&mut lines).position(|(a, b)| a != b);
    let line = differs.unwrap_or(there.lines().count().min(generated.lines().count())) + 1;
    Err(format!(
        "docs/{name} is out of date from line {line} on; write it again with\n  \
         ODKIT_ACCEPT=1 cargo test -p od-tests"
    ))
}
