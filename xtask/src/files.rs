//! Files and folders, with errors that name the path.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|e| Error::io("read", path, &e))
}

/// Writes a file, and makes its folder.
pub(crate) fn write(path: &Path, text: &str) -> Result<()> {
    create(path.parent().unwrap_or(path))?;
    fs::write(path, text).map_err(|e| Error::io("write", path, &e))
}

/// Copies a file, and makes the target folder.
pub(crate) fn copy(from: &Path, to: &Path) -> Result<()> {
    create(to.parent().unwrap_or(to))?;
    fs::copy(from, to).map_err(|e| Error::io("copy", from, &e))?;
    Ok(())
}

/// Copies all files of a folder and its subfolders.
pub(crate) fn copy_tree(from: &Path, to: &Path) -> Result<()> {
    for name in tree(from)? {
        copy(&from.join(&name), &to.join(&name))?;
    }
    Ok(())
}

/// A folder, made if it is missing.
pub(crate) fn create(dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(|e| Error::io("create", dir, &e))
}

/// Removes a folder with all that is in it, if it exists.
pub(crate) fn remove(dir: &Path) -> Result<()> {
    if dir.exists() {
        fs::remove_dir_all(dir).map_err(|e| Error::io("remove", dir, &e))?;
    }
    Ok(())
}

/// An empty folder.
pub(crate) fn fresh(dir: &Path) -> Result<()> {
    remove(dir)?;
    create(dir)
}

/// The content of a folder, by name.
pub(crate) fn entries(dir: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(dir).map_err(|e| Error::io("read", dir, &e))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

/// The files of a folder and its subfolders, as relative paths with `/`.
pub(crate) fn tree(dir: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    let mut folders = vec![dir.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for path in entries(&folder)? {
            if path.is_dir() {
                folders.push(path);
            } else {
                let own = path.strip_prefix(dir).unwrap_or(&path);
                let names: Vec<_> = own.iter().map(|name| name.to_string_lossy()).collect();
                found.push(names.join("/"));
            }
        }
    }
    found.sort();
    Ok(found)
}
