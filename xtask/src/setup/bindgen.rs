//! wasm-bindgen, built from `xtask/bindgen` in the version that Cargo.lock has.

use std::path::PathBuf;

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::repo::{Repo, program};

/// Builds the command line tool, or lets cargo find that it is built; its path.
pub(crate) fn get(repo: &Repo, console: &Console) -> Result<PathBuf> {
    check_versions(repo)?;
    let target = repo.tools().join("bindgen");
    let tool = target.join("debug").join(program("odkit-wasm-bindgen"));
    let what = if tool.is_file() {
        "checking wasm-bindgen"
    } else {
        "building wasm-bindgen (once, about half a minute)"
    };
    let mut build = cargo(&repo.root, &["build", "--quiet", "--locked"]);
    build
        .args([
            "--manifest-path",
            "xtask/bindgen/Cargo.toml",
            "--target-dir",
        ])
        .arg(&target);
    console.run(what, &mut build)?;
    Ok(tool)
}

/// The generated JavaScript fits the crate only if both are of one version.
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
