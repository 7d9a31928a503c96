//! Chromium, for the tests of the page.

use std::env;
use std::path::PathBuf;

use super::apt;
use crate::console::{Console, which};
use crate::error::{Error, Result};
use crate::repo::is_ci;

/// Debian's package of Chromium without a window; the tests need a sixth less processor time with it.
const SHELL: &str = "chromium-headless-shell";

/// Program names of Chromium.
const NAMES: [&str; 5] = [
    SHELL,
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// Path of Chromium: `CHROMIUM`, one on PATH, or Debian's, which is installed if the user is root.
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
    let why = "no Chromium on PATH";
    // On a CI computer the faster package is installed, if it exists.
    if which(SHELL).is_none() && (is_ci() || on_path().is_none()) {
        let _ = apt::install(console, &[SHELL, FONTS], why);
    }
    if let Some(path) = on_path() {
        return Ok(path);
    }
    apt::install(console, &["chromium", FONTS], why)?;
    on_path().ok_or_else(|| Error::Missing(String::from("apt-get installed no `chromium`")))
}

/// Package with the fallback fonts of the page.
const FONTS: &str = "fonts-liberation";

/// The programs that start Firefox and WebKit for a long run, and Debian's package of each. WebKit's window needs a display.
const ENGINES: [(&str, &str); 3] = [
    ("firefox-esr", "firefox-esr"),
    ("WebKitWebDriver", "webkit2gtk-driver"),
    ("xvfb-run", "xvfb"),
];

/// Makes the other browsers available on PATH.
pub(crate) fn engines(console: &Console) -> Result<()> {
    let missing = |(name, _): &&(&str, &str)| which(name).is_none();
    let mut packages: Vec<&str> = ENGINES.iter().filter(missing).map(|(_, of)| *of).collect();
    if packages.is_empty() {
        return Ok(());
    }
    // `xvfb-run` calls it, but its package does not depend on it.
    packages.push("xauth");
    apt::install(console, &packages, "no Firefox or WebKit on PATH")
}
