//! Embeds the lessons, the sources of the crates that a device of `odkit new` needs, so that the
//! device builds without other files, and the page that `odkit class` serves.
//!
//! A checkout has these sources. A packaged `od-cli` lacks them and does not need them: it was built with
//! the published crates, and so is a device. The list is then empty.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the embedded crates, if they exist. In a new crate they lie side by side.
const CRATES: [&str; 10] = [
    "crates/od-board",
    "crates/od-client",
    "crates/od-eds",
    "crates/od-runtime",
    "crates/od-sim",
    "crates/od-thumb",
    "crates/od-wire",
    "crates/odkit",
    "od-macros",
    "od-model",
];

fn main() {
    let var = |name: &str| PathBuf::from(std::env::var_os(name).unwrap_or_default());
    let own = var("CARGO_MANIFEST_DIR");
    let root = own.join("../..");
    println!("cargo::rerun-if-changed=build.rs");
    for (folder, list) in [("lessons", "lessons.rs"), ("lessons/de", "lessons_de.rs")] {
        let list = var("OUT_DIR").join(list);
        fs::write(list, lessons(&own.join(folder))).expect("OUT_DIR can be written");
    }
    let mut list = String::from("&[\n");
    if root.join("crates/odkit/Cargo.toml").is_file() {
        let crates: Vec<&str> = CRATES
            .into_iter()
            .filter(|name| root.join(name).is_dir())
            .collect();
        for name in &crates {
            let folder = root.join(name);
            let name = copy(name);
            let manifest = folder.join("Cargo.toml");
            println!("cargo::rerun-if-changed={}", manifest.display());
            let text = fs::read_to_string(manifest).unwrap_or_default();
            let text = without_tests(&text);
            let _ = writeln!(list, "(\"{name}/Cargo.toml\", {text:?}.as_bytes()),");
            // The documentation of a crate may include its README.
            add(&mut list, &root, &folder.join("README.md"));
            println!("cargo::rerun-if-changed={}", folder.join("src").display());
            sources(&mut list, &root, &folder.join("src"));
        }
        for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
            add(&mut list, &root, &root.join(licence));
        }
        let manifest = root.join("Cargo.toml");
        println!("cargo::rerun-if-changed={}", manifest.display());
        let text = fs::read_to_string(manifest).unwrap_or_default();
        let text = workspace(&text, &crates);
        let _ = writeln!(list, "(\"Cargo.toml\", {text:?}.as_bytes()),");
    }
    list.push(']');
    let out = var("OUT_DIR").join("vendored.rs");
    fs::write(out, list).expect("OUT_DIR can be written");
    fs::write(var("OUT_DIR").join("page.rs"), page()).expect("OUT_DIR can be written");
}

/// The files of the page for `odkit class`, if `ODKIT_PAGE` names their folder: the programs of a release contain them.
fn page() -> String {
    println!("cargo::rerun-if-env-changed=ODKIT_PAGE");
    let mut list = String::from("&[\n");
    if let Some(folder) = std::env::var_os("ODKIT_PAGE") {
        let folder = PathBuf::from(folder);
        println!("cargo::rerun-if-changed={}", folder.display());
        for file in files(&folder).iter().filter(|file| file.is_file()) {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let file = file.canonicalize().expect("a file of the page");
            let _ = writeln!(list, "({name:?}, include_bytes!({file:?})),");
        }
    }
    list.push(']');
    list
}

/// The lessons of a folder by the numbers of their files: `01-name.md` is `name`.
fn lessons(folder: &Path) -> String {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut list = String::from("&[\n");
    for path in files(folder) {
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.and_then(|name| name.strip_suffix(".md")?.get(3..));
        if let (Some(name), Ok(file)) = (name, path.canonicalize()) {
            let _ = writeln!(list, "({name:?}, include_str!({file:?})),");
        }
    }
    list + "]"
}

/// The paths in a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// The path of a copy: this repository has most crates in a folder.
fn copy(path: &str) -> &str {
    path.strip_prefix("crates/").unwrap_or(path)
}

/// Lists a file by the path of its copy.
fn add(list: &mut String, root: &Path, file: &Path) {
    let Ok(below) = file.strip_prefix(root) else {
        return;
    };
    if let Ok(file) = file.canonicalize() {
        let below = below.display().to_string().replace('\\', "/");
        let below = copy(&below);
        let _ = writeln!(list, "({below:?}, include_bytes!({file:?})),");
    }
}

/// Lists all files of a folder except those of its tests.
fn sources(list: &mut String, root: &Path, folder: &Path) {
    for path in files(folder) {
        if path.file_stem().is_some_and(|name| name == "tests") {
            continue;
        }
        if path.is_dir() {
            sources(list, root, &path);
        } else {
            add(list, root, &path);
        }
    }
}

/// The manifest of a crate without the parts that are not embedded: tests, examples, and their dependencies.
fn without_tests(manifest: &str) -> String {
    let mut keep = true;
    let is_kept = |line: &&str| {
        if line.starts_with('[') {
            let table = line.trim_matches(['[', ']']);
            let is_test = ["example", "test", "bench"].contains(&table);
            keep = !is_test && !table.ends_with("dev-dependencies");
        }
        keep
    };
    let lines: Vec<&str> = manifest.lines().filter(is_kept).collect();
    lines.join("\n") + "\n"
}

/// The manifest of the vendored crates: a workspace with the versions of this one. Its crates
/// give no warnings, since they are not edited.
fn workspace(root: &str, crates: &[&str]) -> String {
    let tables = root
        .find("[workspace.package]")
        .zip(root.find("[workspace.lints"));
    let tables = tables.map_or("", |(start, end)| &root[start..end]);
    // Other crates of the workspace are not embedded.
    let path = |line: &str| {
        line.split_once("path = \"")
            .map(|(_, rest)| rest.to_owned())
    };
    let is_there = |line: &&str| {
        path(line).is_none_or(|path| path.split('"').next().is_some_and(|p| crates.contains(&p)))
    };
    let tables: Vec<&str> = tables.lines().filter(is_there).collect();
    let tables = tables.join("\n").replace("path = \"crates/", "path = \"");
    let members: Vec<&str> = crates.iter().map(|path| copy(path)).collect();
    let members = members.join("\", \"");
    format!(
        "# Sources of odkit, written by `odkit new`.\n[workspace]\nresolver = \"3\"\n\
         members = [\"{members}\"]\n\n{}\n\n\
         [workspace.lints.rust]\nwarnings = \"allow\"\n\n[workspace.lints.clippy]\nall = \"allow\"\n",
        tables.trim_end()
    )
}
