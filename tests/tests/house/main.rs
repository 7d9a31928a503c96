//! The order of the workspace: no files that import each other in a cycle, no dependency on a
//! higher layer, no import of a name through `lib.rs`, no file that is not compiled, and no short file without
//! a reason. The test
//! reads the files as text.

mod graph;
mod rooms;
mod rust;
mod small;
mod tokens;
mod typescript;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::graph::{Arrow, Arrows};
use crate::rooms::ROOMS;
use crate::rust::Modules;

#[test]
fn the_house_is_in_order() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = BTreeMap::new();
    for room in ROOMS {
        collect(&root, room.name, &mut files);
    }
    assert!(files.len() > 500, "only {} files found", files.len());
    let faults = faults(&files);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// All violations, each with its correction.
fn faults(files: &BTreeMap<String, String>) -> Vec<String> {
    let modules = Modules::of(files);
    let mut arrows = Arrows::default();
    modules.arrows(&mut arrows);
    typescript::arrows(files, &mut arrows);
    let mut found = Vec::new();
    found.extend(arrows.circles().into_iter().map(|Arrow { from, to, line, name }| {
        format!(
            "{from}:{line} takes `{name}` from {to}, and a way leads back: move what both need into \
             a file below them"
        )
    }));
    found.extend(rooms::arrows_up(files).into_iter().map(|(from, to)| {
        format!("{from} may not depend on {to}: see ROOMS in tests/tests/house/rooms.rs")
    }));
    found.extend(modules.through_the_root().into_iter().map(|(file, line, name)| {
        format!(
            "{file}:{line} takes `{name}` from lib.rs that another file defines: write the path of that \
             file, as `crate::frame::Frame`"
        )
    }));
    found.extend(modules.undeclared(files).into_iter().map(|file| {
        format!(
            "{file} is not compiled: no file of its crate has its `mod`; declare it, or remove it"
        )
    }));
    found.extend(small::faults(files));
    found
}

/// The texts of a folder that are code or a manifest.
fn collect(root: &Path, folder: &str, files: &mut BTreeMap<String, String>) {
    const MADE: [&str; 6] = ["target", "node_modules", "dist", "pkg", "results", ".git"];
    let Ok(entries) = fs::read_dir(root.join(folder)) else {
        return;
    };
    for entry in entries {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{folder}/{name}");
        if entry.file_type().unwrap().is_dir() {
            if !MADE.contains(&name.as_str()) {
                collect(root, &path, files);
            }
        } else if rooms::is_code(&name) || name == "Cargo.toml" {
            let text = fs::read_to_string(root.join(&path)).unwrap();
            files.insert(path, text);
        }
    }
}
