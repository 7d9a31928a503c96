//! Other toolchains than the one of rust-toolchain.toml.

use std::process::Command;

use crate::console::{Console, ask};
use crate::error::{Error, Result};
use crate::repo::Repo;

/// Installs a toolchain if it is missing, or returns the command to type.
pub(crate) fn add(repo: &Repo, console: &Console, name: &str) -> Result<()> {
    let is_there = || ask("rustup", &["run", name, "rustc", "--version"]).is_some();
    if is_there() {
        return Ok(());
    }
    let mut add = Command::new("rustup");
    add.args(["toolchain", "install", name, "--profile", "minimal"]);
    let added = console.run(
        &format!("installing Rust {name} (once)"),
        add.current_dir(&repo.root),
    );
    if added.is_ok() && is_there() {
        return Ok(());
    }
    Err(Error::Missing(format!(
        "Rust {name} is missing: run `rustup toolchain install {name} --profile minimal` with a network connection"
    )))
}
