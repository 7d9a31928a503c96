//! Programs that cargo installs into `.xtask`, each in a pinned version.

use std::path::PathBuf;

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::repo::{Repo, program};

/// A package of crates.io with one program of the same name.
pub(crate) struct Package {
    pub(crate) name: &'static str,
    pub(crate) version: &'static str,
    /// Further arguments of `cargo install`.
    pub(crate) args: &'static [&'static str],
}

/// The program of a package, installed if it is missing.
pub(crate) fn get(repo: &Repo, console: &Console, package: &Package) -> Result<PathBuf> {
    let Package {
        name,
        version,
        args,
    } = package;
    let place = repo.tools().join(name).join(version);
    let tool = place.join("bin").join(program(name));
    if tool.is_file() {
        return Ok(tool);
    }
    let mut install = cargo(&repo.root, &["install", "--locked", name]);
    install.args(["--version", version]).args(*args);
    install.arg("--root").arg(&place);
    // Only this program needs the crates that are compiled there.
    let compiled = repo.tools().join(name).join("target");
    install.arg("--target-dir").arg(&compiled);
    let what = format!("installing {name} (once, some minutes)");
    let built = console.run(&what, &mut install);
    let _ = std::fs::remove_dir_all(compiled);
    match built {
        Ok(()) => Ok(tool),
        Err(why) => Err(Error::Missing(format!(
            "{name} {version} is missing: run `cargo install --locked {name} --version {version} \
             --root {}` with a network connection ({})",
            repo.short(&place),
            why.message()
        ))),
    }
}
