//! Files of the repository, as seeds.

use std::path::{Path, PathBuf};

/// A file or folder of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

/// A path as seen from the root of the repository, if it is in there.
pub fn short(path: &Path) -> PathBuf {
    let root = repository("");
    let inside = path.strip_prefix(&root).map(PathBuf::from);
    inside.unwrap_or_else(|_| path.into())
}

/// The text files of a folder with these endings, its own folders included, up to a length.
///
/// # Panics
/// If the folder or one of its files cannot be read.
pub fn files(folder: &str, endings: &[&str], longest: usize) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut folders = vec![repository(folder)];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("a folder of the repository");
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push((
                    name,
                    std::fs::read(&path).expect("a file of the repository"),
                ));
            }
        }
    }
    // The order of a folder is not the same everywhere.
    found.sort();
    let short = found.into_iter().map(|(_, bytes)| bytes);
    short.filter(|bytes| bytes.len() <= longest).collect()
}
