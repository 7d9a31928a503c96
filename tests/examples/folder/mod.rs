//! A folder of device files.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Returns the files below a folder with one of these endings, by name. Case does not count.
///
/// # Errors
/// Those of a folder that cannot be read.
pub(crate) fn files(folder: &Path, endings: &[&str]) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let ending = path.extension().unwrap_or_default();
        if path.is_dir() {
            found.extend(files(&path, endings)?);
        } else if endings
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
        {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}
