//! wasm-opt, from the npm package `binaryen`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::node;
use crate::console::Console;
use crate::error::{Error, Result};
use crate::repo::Repo;

/// Options for the features that rustc emits for wasm32 since 1.87; every current browser
/// supports them.
pub(crate) const FLAGS: [&str; 6] = [
    "--enable-bulk-memory",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-mutable-globals",
    "--enable-reference-types",
    "--enable-multivalue",
];

/// A `wasm-opt` that optimises each module once: the page and the npm package contain the same module.
pub(crate) const REMEMBERS: &str = "xtask/tools/wasm-opt.cjs";

/// The folder with `wasm-opt`, after installing the locked version into `.xtask/node`.
pub(crate) fn get(repo: &Repo, console: &Console) -> Result<PathBuf> {
    let dir = repo.tools().join("node");
    fs::create_dir_all(&dir).map_err(|e| Error::io("create", &dir, &e))?;
    for name in ["package.json", "package-lock.json"] {
        let (from, to) = (repo.root.join("xtask/tools").join(name), dir.join(name));
        fs::copy(from, &to).map_err(|e| Error::io("write", &to, &e))?;
    }
    node::ci(console, &dir, "fetching wasm-opt (npm package binaryen)")?;
    Ok(dir.join("node_modules/.bin"))
}

/// The command that optimises `input` into `output`, with the options of `level`.
pub(crate) fn command(repo: &Repo, level: &str, input: &Path, output: &Path) -> Command {
    // A JavaScript program: Windows does not start it by its name.
    let mut command = Command::new("node");
    command.arg(REMEMBERS).current_dir(&repo.root);
    command
        .args(level.split_whitespace())
        .args(FLAGS)
        .arg(input)
        .arg("-o")
        .arg(output);
    command.env("ODKIT_TOOLS", repo.tools());
    command
}
