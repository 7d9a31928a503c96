//! A compiler for another target: the toolchain's own, rustup's, or one that is made
//! here from Debian's packages.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::debian_rustc;
use crate::console::{Console, path_with, which};
use crate::error::{Error, Result};
use crate::repo::Repo;

/// The browser.
pub(crate) const WASM: &str = "wasm32-unknown-unknown";
/// A microcontroller without an operating system: proof of `no_std`.
pub(crate) const BARE: &str = "thumbv7m-none-eabi";

/// A compiler that can build for the target.
#[derive(Debug)]
pub(crate) struct Compiler {
    /// The folder of the `rustc` to use instead of the one on PATH, and a linker.
    private: Option<(PathBuf, PathBuf)>,
    target: &'static str,
}

impl Compiler {
    /// Finds or makes a compiler for `target`.
    pub(crate) fn get(repo: &Repo, console: &Console, target: &'static str) -> Result<Compiler> {
        let ready = Compiler {
            private: None,
            target,
        };
        let sysroot = sysroot(repo)?;
        if std_of(&sysroot, target).is_dir() {
            return Ok(ready);
        }
        // What was made here before saves asking a server that did not answer then.
        let private = match debian_rustc::made_before(repo, target) {
            Some(bin) => bin,
            None if rustup_adds(repo, console, target) => return Ok(ready),
            None => {
                let text = format!("no {target} from rustup: building it with Debian's compiler");
                console.note(&text);
                debian_rustc::make(repo, console, target)?
            }
        };
        let host = host(repo)?;
        let linker = sysroot.join("lib/rustlib").join(host).join("bin/rust-lld");
        if !linker.is_file() {
            let linker = linker.display();
            return Err(Error::Missing(format!("the toolchain has no {linker}")));
        }
        Ok(Compiler {
            private: Some((private, linker)),
            target,
        })
    }

    /// Makes `command`, and what it starts, use this compiler.
    pub(crate) fn apply(&self, command: &mut Command) -> Result<()> {
        if let Some((bin, linker)) = &self.private {
            let name = self.target.to_uppercase().replace('-', "_");
            command
                .env("RUSTC", bin.join("rustc"))
                .env(format!("CARGO_TARGET_{name}_LINKER"), linker)
                .env("PATH", path_with(bin)?);
        }
        Ok(())
    }

    /// The folder that has to come first on PATH for tools that call `rustc` by name.
    pub(crate) fn bin(&self) -> Option<&Path> {
        self.private.as_ref().map(|(bin, _)| bin.as_path())
    }
}

fn sysroot(repo: &Repo) -> Result<PathBuf> {
    rustc(repo, &["--print", "sysroot"]).map(PathBuf::from)
}

fn host(repo: &Repo) -> Result<String> {
    let version = rustc(repo, &["-vV"])?;
    version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .map(String::from)
        .ok_or_else(|| Error::Failed(String::from("`rustc -vV` names no host")))
}

/// Asks the toolchain that rust-toolchain.toml pins.
fn rustc(repo: &Repo, args: &[&str]) -> Result<String> {
    let output = Command::new("rustc")
        .args(args)
        .current_dir(&repo.root)
        .output()
        .ok()
        .filter(|output| output.status.success())
        .ok_or_else(|| Error::Missing(String::from("`rustc` does not run; see rustup.rs")))?;
    Ok(String::from(String::from_utf8_lossy(&output.stdout).trim()))
}

/// Where a sysroot keeps the library for a target.
pub(super) fn std_of(sysroot: &Path, target: &str) -> PathBuf {
    sysroot.join("lib/rustlib").join(target).join("lib")
}

fn rustup_adds(repo: &Repo, console: &Console, target: &str) -> bool {
    if which("rustup").is_none() {
        return false;
    }
    let mut add = Command::new("rustup");
    add.args(["target", "add", target])
        .current_dir(&repo.root)
        .env("RUST_BACKTRACE", "0");
    let what = format!("adding the target {target} with rustup");
    console.run(&what, &mut add).is_ok()
        && sysroot(repo).is_ok_and(|sysroot| std_of(&sysroot, target).is_dir())
}
