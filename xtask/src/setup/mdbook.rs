//! mdBook, which makes a site of Markdown files: the pinned version, built into `.xtask`.

use std::path::PathBuf;

use super::installed::{self, Package};
use crate::console::Console;
use crate::error::Result;
use crate::repo::Repo;

/// Last looked at in November 2026: released every few weeks by the Rust project.
pub(crate) const VERSION: &str = "0.5.4";

const MDBOOK: Package = Package {
    name: "mdbook",
    version: VERSION,
    args: &["--no-default-features", "--features", "search"],
};

/// The program, installed if it is missing.
pub(crate) fn get(repo: &Repo, console: &Console) -> Result<PathBuf> {
    installed::get(repo, console, &MDBOOK)
}
