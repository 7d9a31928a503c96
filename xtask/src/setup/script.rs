//! Small programs that stand in front of others.

use std::fs;
use std::path::Path;

use crate::error::{Error, Result};

/// Writes an executable script.
pub(crate) fn write(dir: &Path, name: &str, text: &str) -> Result<()> {
    let path = dir.join(name);
    fs::create_dir_all(dir).map_err(|e| Error::io("create", dir, &e))?;
    fs::write(&path, text).map_err(|e| Error::io("write", &path, &e))?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755))
            .map_err(|e| Error::io("make executable", &path, &e))?;
    }
    Ok(())
}

/// Links a folder.
#[cfg(unix)]
pub(crate) fn symlink(original: &Path, link: &Path) -> Result<()> {
    std::os::unix::fs::symlink(original, link).map_err(|e| Error::io("link", link, &e))
}

/// Links a folder.
#[cfg(not(unix))]
pub(crate) fn symlink(_original: &Path, link: &Path) -> Result<()> {
    let link = link.display();
    Err(Error::Failed(format!("cannot link {link} on this system")))
}
