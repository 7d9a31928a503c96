//! `cargo xtask wasm-pack`: wasm-pack with everything it looks for on PATH.
//!
//! wasm-pack wants `wasm-bindgen` in the locked version and `wasm-opt`; what it does not
//! find it downloads from GitHub. Folders in front of PATH give it ours, so the same tools
//! make the page and the package.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::bundle::OPT_LEVEL;
use crate::console::{Console, ask, cargo, which};
use crate::error::{Error, Result};
use crate::lock::SetupLock;
use crate::repo::{Repo, program};
use crate::setup::{binaryen, bindgen, node, target};

/// The version that is built when there is none on PATH.
const VERSION: &str = "0.15.1";

/// What `cargo xtask wasm-pack` does without arguments.
const DEFAULT: [&str; 4] = ["build", "playground", "--target", "web"];

/// Runs wasm-pack in the repository's root.
pub(crate) fn run(repo: &Repo, console: &Console, args: &[String]) -> Result<()> {
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    target::add(repo, console, target::WASM)?;
    let mut command = Command::new(install(repo, console)?);
    command
        .current_dir(&repo.root)
        .env(OPT_LEVEL.0, OPT_LEVEL.1);
    if args.is_empty() {
        command.args(DEFAULT);
    } else {
        command.args(args);
    }
    // wasm-bindgen under its usual name, and wasm-opt.
    let bin = repo.tools().join("bin");
    fs::create_dir_all(&bin).map_err(|e| Error::io("create", &bin, &e))?;
    let to = bin.join(program("wasm-bindgen"));
    fs::copy(bindgen::get(repo, console)?, &to).map_err(|e| Error::io("write", &to, &e))?;
    let mut path = vec![bin, binaryen::get(repo, console)?];
    path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let path = env::join_paths(path).map_err(|e| Error::Failed(format!("PATH: {e}")))?;
    console.run("wasm-pack", command.env("PATH", path))
}

/// wasm-pack on PATH, in `.xtask`, or built there.
fn install(repo: &Repo, console: &Console) -> Result<PathBuf> {
    if let Some(found) = which("wasm-pack") {
        return Ok(found);
    }
    let root = repo.tools().join("wasm-pack");
    let tool = root.join("bin").join(program("wasm-pack"));
    let wanted = format!("wasm-pack {VERSION}");
    if ask(&tool, &["--version"]).as_deref() == Some(&*wanted) {
        return Ok(tool);
    }
    // It only starts other programs: an unoptimised build takes half the time.
    let mut install = cargo(&repo.root, &["install", "--quiet", "--locked", "--debug"]);
    install
        .args(["wasm-pack", "--force", "--version", VERSION, "--root"])
        .arg(&root);
    console.run("building wasm-pack (once, some two minutes)", &mut install)?;
    Ok(tool)
}
