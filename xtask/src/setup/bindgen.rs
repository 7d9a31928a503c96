//! Builds wasm-bindgen and wasm-pack from `xtask/bindgen` in the locked versions.

use std::path::PathBuf;

use crate::console::{Console, ask, cargo, which};
use crate::error::{Error, Result};
use crate::repo::{Repo, program};

/// Builds wasm-bindgen if it is out of date, and returns its path.
pub(crate) fn get(repo: &Repo, console: &Console) -> Result<PathBuf> {
    check_versions(repo)?;
    build(repo, console, "odkit-wasm-bindgen", "wasm-bindgen")
}

/// A wasm-bindgen of the right version on PATH, or the one of [`get`]; its path.
pub(crate) fn any(repo: &Repo, console: &Console) -> Result<PathBuf> {
    let version = format!("wasm-bindgen {}", repo.locked_version("wasm-bindgen")?);
    match which("wasm-bindgen") {
        Some(path) if ask(&path, &["--version"]).as_ref() == Some(&version) => Ok(path),
        _ => get(repo, console),
    }
}

/// Builds wasm-pack without its downloader; its path.
pub(crate) fn wasm_pack(repo: &Repo, console: &Console) -> Result<PathBuf> {
    build(repo, console, "odkit-wasm-pack", "wasm-pack")
}

fn build(repo: &Repo, console: &Console, package: &str, what: &str) -> Result<PathBuf> {
    let target = repo.tools().join("bindgen");
    let tool = target.join("debug").join(program(package));
    let doing = if tool.is_file() {
        format!("checking {what}")
    } else {
        format!("building {what} (once, about half a minute)")
    };
    let mut build = cargo(&repo.root, &["build", "--locked"]);
    build.args(["--package", package, "--target-dir"]);
    build.arg(&target);
    build.args(["--manifest-path", "xtask/bindgen/Cargo.toml"]);
    console.run(&doing, &mut build)?;
    Ok(tool)
}

/// The generated JavaScript needs the same version of the crate.
fn check_versions(repo: &Repo) -> Result<()> {
    let locked = repo.locked_version("wasm-bindgen")?;
    let path = repo.root.join("xtask/bindgen/Cargo.toml");
    let manifest = std::fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
    if manifest.contains(&format!("wasm-bindgen-cli-support = \"={locked}\"")) {
        Ok(())
    } else {
        Err(Error::Failed(format!(
            "Cargo.lock has wasm-bindgen {locked}: pin the same version in xtask/bindgen"
        )))
    }
}
