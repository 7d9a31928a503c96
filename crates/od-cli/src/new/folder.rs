//! Writes the files of a new crate: all of them, or none.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::output;

/// Checks that a folder can be created, or is empty.
pub(super) fn check(folder: &Path) -> Result<(), Failure> {
    let shown = folder.display();
    match fs::read_dir(folder).map(|mut entries| entries.next().is_some()) {
        Ok(true) => Err(Failure::Failed(format!(
            "{shown} exists and is not empty; choose another `--name` or `--path`"
        ))),
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(Failure::Failed(format!("{shown} cannot be used: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes files by their paths below `folder`, and makes the folders that they need.
///
/// # Errors
/// A file or folder cannot be written; those that were created are removed.
pub(super) fn write(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Failure> {
    let mut made = Made(Vec::new());
    for (path, content) in files {
        let path = folder.join(path);
        made.parents(&path)?;
        output::write(&path, content)?;
        made.0.push(path);
    }
    made.0.clear();
    Ok(())
}

/// Files and folders in the order in which they were created; when this is dropped, it removes them.
struct Made(Vec<PathBuf>);

impl Made {
    fn parents(&mut self, path: &Path) -> Result<(), Failure> {
        let missing = path.ancestors().skip(1).take_while(|one| !one.exists());
        let missing: Vec<&Path> = missing.filter(|one| !one.as_os_str().is_empty()).collect();
        for folder in missing.into_iter().rev() {
            fs::create_dir(folder).map_err(|error| {
                let shown = folder.display();
                Failure::Failed(format!("{shown} cannot be made: {error}"))
            })?;
            self.0.push(folder.to_path_buf());
        }
        Ok(())
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        for path in self.0.iter().rev() {
            // A file that cannot be removed stays; the message is about the first failure.
            let _ = if path.is_dir() {
                fs::remove_dir(path)
            } else {
                fs::remove_file(path)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_no_file() {
        let parent = std::env::temp_dir().join(format!("odkit-folder-{}", std::process::id()));
        let folder = parent.join("new");
        let file = |path: &str| (path.to_owned(), b"text".to_vec());
        assert!(write(&folder, &[file("a/b"), file("c"), file("c/d")]).is_err());
        assert!(!parent.exists());
        // A run does not write a file twice, so this is another folder.
        let folder = parent.join("another");
        assert!(write(&folder, &[file("a/b"), file("c")]).is_ok());
        assert!(check(&folder).is_err() && folder.join("a/b").is_file());
        fs::remove_dir_all(parent).unwrap();
    }
}
