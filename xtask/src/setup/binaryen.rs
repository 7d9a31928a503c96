//! wasm-opt, from the npm package `binaryen`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::node;
use crate::console::Console;
use crate::error::{Error, Result};
use crate::repo::Repo;

/// What rustc emits for wasm32 since 1.87 and every current browser runs.
pub(crate) const FLAGS: [&str; 7] = [
    "-Os",
    "--enable-bulk-memory",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-mutable-globals",
    "--enable-reference-types",
    "--enable-multivalue",
];

/// wasm-opt as a JavaScript program for Node.js.
#[derive(Debug)]
pub(crate) struct WasmOpt {
    script: PathBuf,
}

impl WasmOpt {
    /// Installs the locked version into `.xtask/node`, if it is not there yet.
    pub(crate) fn get(repo: &Repo, console: &Console) -> Result<WasmOpt> {
        let from = repo.root.join("xtask").join("tools");
        let dir = repo.tools().join("node");
        fs::create_dir_all(&dir).map_err(|e| Error::io("create", &dir, &e))?;
        for name in ["package.json", "package-lock.json"] {
            let path = dir.join(name);
            fs::copy(from.join(name), &path).map_err(|e| Error::io("write", &path, &e))?;
        }
        node::ci(console, &dir, "fetching wasm-opt (npm package binaryen)")?;
        let script = dir.join("node_modules/binaryen/bin/wasm-opt");
        if !script.is_file() {
            let script = repo.short(&script);
            return Err(Error::Failed(format!("binaryen brought no {script}")));
        }
        Ok(WasmOpt { script })
    }

    /// The script, for `node`.
    pub(crate) fn script(&self) -> &Path {
        &self.script
    }

    /// The command that optimises `input` into `output`.
    pub(crate) fn command(&self, input: &Path, output: &Path) -> Command {
        let mut command = Command::new("node");
        command.arg(&self.script).args(FLAGS);
        command.arg(input).arg("-o").arg(output);
        command
    }
}
