//! `cargo xtask wasm-pack`: wasm-pack, with the programs that it needs on PATH.
//!
//! wasm-pack needs `wasm-bindgen` in the locked version, and `wasm-opt`. Folders in
//! front of PATH contain ours, so the page and the package are made with the same tools.

use std::env;
use std::fs;
use std::process::Command;

use crate::bundle::RELEASE;
use crate::console::{Console, which, without_paths};
use crate::error::{Error, Result};
use crate::repo::{Repo, program};
use crate::setup::{SetupLock, binaryen, bindgen, node, target};

/// The arguments of wasm-pack if none are given.
const DEFAULT: [&str; 4] = ["build", "playground", "--target", "web"];

/// Runs wasm-pack in the repository's root.
pub(crate) fn run(repo: &Repo, console: &Console, args: &[String]) -> Result<()> {
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    target::add(repo, console, target::WASM)?;
    let mut command = Command::new(match which("wasm-pack") {
        Some(found) => found,
        None => bindgen::wasm_pack(repo, console)?,
    });
    command
        .current_dir(&repo.root)
        .env(RELEASE.0, RELEASE.1)
        .env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root))
        .env("ODKIT_TOOLS", repo.tools());
    if args.is_empty() {
        command.args(DEFAULT);
    } else {
        command.args(args);
    }
    // wasm-bindgen and wasm-opt under their usual names.
    let bin = repo.tools().join("bin");
    fs::create_dir_all(&bin).map_err(|e| Error::io("create", &bin, &e))?;
    for (from, name) in [
        (bindgen::get(repo, console)?, program("wasm-bindgen")),
        (
            repo.root.join(binaryen::REMEMBERS),
            String::from("wasm-opt"),
        ),
    ] {
        let to = bin.join(name);
        fs::copy(from, &to).map_err(|e| Error::io("write", &to, &e))?;
    }
    let mut path = vec![bin, binaryen::get(repo, console)?];
    path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let path = env::join_paths(path).map_err(|e| Error::Failed(format!("PATH: {e}")))?;
    console.run("wasm-pack", command.env("PATH", path))
}
