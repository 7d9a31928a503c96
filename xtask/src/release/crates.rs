//! The package of each crate.

use std::fs;
use std::path::{Path, PathBuf};

use super::dist::Dist;
use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::files;
use crate::packages::UNPUBLISHED;
use crate::repo::Repo;

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    for file in pack(dist.repo, dist.console)? {
        let name = file.file_name().unwrap_or_default();
        files::copy(&file, &folder.join(name))?;
    }
    Ok(())
}

/// Packs every published crate and returns the files.
pub(crate) fn pack(repo: &Repo, console: &Console) -> Result<Vec<PathBuf>> {
    let packed = repo.target.join("package");
    // Files of an earlier run would count as packed.
    let _ = fs::remove_dir_all(&packed);
    let mut command = cargo(&repo.root, &["package", "--workspace", "--no-verify"]);
    command.args(["--allow-dirty", "--quiet"]);
    command.args(UNPUBLISHED.iter().flat_map(|name| ["--exclude", name]));
    console.run("packages", &mut command)?;
    let mut files = files::entries(&packed)?;
    files.retain(|path| path.extension().is_some_and(|ending| ending == "crate"));
    if files.is_empty() {
        return Err(Error::Failed(String::from("cargo packed no crate")));
    }
    Ok(files)
}
