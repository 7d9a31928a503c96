//! mdBook, which makes a site of Markdown files: the pinned version, built into `.xtask`.

use std::path::PathBuf;

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::repo::{Repo, program};

/// Checked in November 2026: released every few weeks by the Rust project.
pub(crate) const VERSION: &str = "0.5.4";

/// The program, installed if it is missing.
pub(crate) fn get(repo: &Repo, console: &Console) -> Result<PathBuf> {
    let place = repo.tools().join("mdbook").join(VERSION);
    let tool = place.join("bin").join(program("mdbook"));
    if tool.is_file() {
        return Ok(tool);
    }
    let mut install = cargo(&repo.root, &["install", "--locked", "--quiet", "mdbook"]);
    install.args(["--version", VERSION, "--no-default-features"]);
    install.args(["--features", "search", "--root"]).arg(&place);
    // The build files are not needed afterwards.
    install
        .arg("--target-dir")
        .arg(repo.tools().join("mdbook/target"));
    let built = console.run("installing mdBook (once, some minutes)", &mut install);
    let _ = std::fs::remove_dir_all(repo.tools().join("mdbook/target"));
    match built {
        Ok(()) => Ok(tool),
        Err(why) => Err(Error::Missing(format!(
            "mdBook {VERSION} is missing: run `cargo install --locked mdbook --version {VERSION} \
             --root {}` with a network connection ({})",
            repo.short(&place),
            why.message()
        ))),
    }
}
