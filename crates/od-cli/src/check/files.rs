//! Finds the files of a command line.

use std::path::Path;

/// The named files, and the files of the named folders, sorted by name.
pub(super) fn find(named: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for path in named {
        let before = found.len();
        if Path::new(path).is_dir() {
            folder(Path::new(path), &mut found);
        }
        if found.len() == before {
            // A file. A missing file is reported when it is read.
            found.push(path.clone());
        }
    }
    found
}

fn folder(path: &Path, found: &mut Vec<String>) {
    let Ok(entries) = std::fs::read_dir(path) else {
        return;
    };
    let mut entries: Vec<_> = entries.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        // Links to folders are not followed: they may form a circle.
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            folder(&path, found);
        } else if is_description(&path) && path.is_file() {
            found.push(path.display().to_string());
        }
    }
}

fn is_description(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["eds", "dcf", "xdd", "xdc"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}
