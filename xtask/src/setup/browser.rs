//! Chromium, for the tests of the page.

use std::env;
use std::path::PathBuf;

use super::apt;
use crate::console::{Console, which};
use crate::error::{Error, Result};

/// The names that a Chromium goes by.
const NAMES: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// The path of a Chromium: `CHROMIUM`, one on PATH, or Debian's, which root gets installed.
pub(crate) fn chromium(console: &Console) -> Result<PathBuf> {
    if let Some(path) = env::var_os("CHROMIUM").filter(|path| !path.is_empty()) {
        let path = PathBuf::from(path);
        let missing = Error::Missing(format!("CHROMIUM names no file: {}", path.display()));
        return if path.is_file() {
            Ok(path)
        } else {
            Err(missing)
        };
    }
    let on_path = || NAMES.iter().find_map(|name| which(name));
    if let Some(path) = on_path() {
        return Ok(path);
    }
    let packages = ["chromium", "fonts-liberation"];
    apt::install(console, &packages, "no Chromium on PATH")?;
    on_path().ok_or_else(|| Error::Missing(String::from("apt-get installed no `chromium`")))
}
