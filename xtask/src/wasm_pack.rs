//! `cargo xtask wasm-pack`: wasm-pack with everything it looks for on PATH.
//!
//! wasm-pack asks `rustc` for its sysroot and wants `wasm-bindgen` in the locked
//! version and `wasm-opt`; what it does not find it downloads from GitHub. A folder
//! in front of PATH gives it ours, so the same tools make the page and the package.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::bundle::OPT_LEVEL;
use crate::console::{Console, ask, cargo, which};
use crate::error::{Error, Result};
use crate::lock::SetupLock;
use crate::repo::Repo;
use crate::setup::target::{self, Compiler};
use crate::setup::{binaryen, bindgen, node, script};

/// The version that is built when there is none on PATH.
const VERSION: &str = "0.15.1";

/// What `cargo xtask wasm-pack` does without arguments.
const DEFAULT: [&str; 4] = ["build", "playground", "--target", "web"];

/// Runs wasm-pack in the repository's root.
pub(crate) fn run(repo: &Repo, console: &Console, args: &[String]) -> Result<()> {
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    let compiler = Compiler::get(repo, console, target::WASM)?;
    let wasm_pack = install(repo, console)?;
    let bin = bin(repo, console)?;
    let mut command = Command::new(wasm_pack);
    command
        .current_dir(&repo.root)
        .env(OPT_LEVEL.0, OPT_LEVEL.1);
    if args.is_empty() {
        command.args(DEFAULT);
    } else {
        command.args(args);
    }
    compiler.apply(&mut command)?;
    command.env(
        "PATH",
        path(&[Some(bin), compiler.bin().map(PathBuf::from)])?,
    );
    console.run("wasm-pack", &mut command)
}

/// wasm-pack on PATH, in `.xtask`, or built there.
fn install(repo: &Repo, console: &Console) -> Result<PathBuf> {
    if let Some(found) = which("wasm-pack") {
        return Ok(found);
    }
    let root = repo.tools().join("wasm-pack");
    let name = format!("wasm-pack{}", std::env::consts::EXE_SUFFIX);
    let tool = root.join("bin").join(name);
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

/// A folder with `wasm-bindgen` and `wasm-opt` under their usual names.
fn bin(repo: &Repo, console: &Console) -> Result<PathBuf> {
    let dir = repo.tools().join("bin");
    fs::create_dir_all(&dir).map_err(|e| Error::io("create", &dir, &e))?;
    let from = bindgen::get(repo, console)?;
    let to = dir.join(format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX));
    fs::copy(&from, &to).map_err(|e| Error::io("write", &to, &e))?;
    let opt = binaryen::WasmOpt::get(repo, console)?;
    let text = format!("#!/bin/sh\nexec node '{}' \"$@\"\n", opt.script().display());
    script::write(&dir, "wasm-opt", &text)?;
    Ok(dir)
}

fn path(dirs: &[Option<PathBuf>]) -> Result<OsString> {
    let mut all: Vec<PathBuf> = dirs.iter().flatten().cloned().collect();
    let old = std::env::var_os("PATH").unwrap_or_default();
    all.extend(std::env::split_paths(&old));
    std::env::join_paths(all).map_err(|e| Error::Failed(format!("PATH: {e}")))
}
