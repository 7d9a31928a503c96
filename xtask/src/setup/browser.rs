//! Chromium, for the tests of the page.

use std::env;
use std::path::PathBuf;

use super::apt;
use crate::console::{Console, which};
use crate::error::{Error, Result};
use crate::repo::is_ci;

/// Debian's Chromium without a window, in a package of its own: a sixth less work for the tests.
const SHELL: &str = "chromium-headless-shell";

/// The names that a Chromium goes by.
const NAMES: [&str; 5] = [
    SHELL,
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// The path of a Chromium: `CHROMIUM`, one on PATH, or one of Debian's, which root gets installed.
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
    // A computer of a CI service gets the one that is faster, if there is such a package.
    if which(SHELL).is_none() && (is_ci() || on_path().is_none()) {
        let _ = apt::install(console, &[SHELL, FONTS], why);
    }
    if let Some(path) = on_path() {
        return Ok(path);
    }
    apt::install(console, &["chromium", FONTS], why)?;
    on_path().ok_or_else(|| Error::Missing(String::from("apt-get installed no `chromium`")))
}

/// The package of the fonts that the page falls back to.
const FONTS: &str = "fonts-liberation";

/// The programs that start Firefox and WebKit for a long run, and Debian's package of each. WebKit's window needs a display.
const ENGINES: [(&str, &str); 3] = [
    ("firefox-esr", "firefox-esr"),
    ("WebKitWebDriver", "webkit2gtk-driver"),
    ("xvfb-run", "xvfb"),
];

/// Sees to it that the other engines are on PATH.
pub(crate) fn engines(console: &Console) -> Result<()> {
    let missing = |(name, _): &&(&str, &str)| which(name).is_none();
    let mut packages: Vec<&str> = ENGINES.iter().filter(missing).map(|(_, of)| *of).collect();
    if packages.is_empty() {
        return Ok(());
    }
    // `xvfb-run` calls it, and does not depend on it.
    packages.push("xauth");
    apt::install(console, &packages, "no Firefox or WebKit on PATH")
}
