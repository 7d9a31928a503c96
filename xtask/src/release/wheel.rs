//! The Python package: a wheel for each system, and its sources for the others.

use std::env;
use std::path::Path;
use std::process::Command;

use super::dist::Dist;
use super::notices;
use super::sbom;
use super::systems::{MINGW, WHEELS};
use crate::console::{clean, which, without_paths};
use crate::error::{Error, Result};
use crate::setup::{apt, python, target};

/// The tested versions of the builder and of its linker for Linux.
const REQUIREMENTS: &str = "xtask/tools/wheel.txt";

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    let (repo, console) = (dist.repo, dist.console);
    let requirements = repo.root.join(REQUIREMENTS);
    let python = python::venv(repo, console, "wheel-venv", &requirements)?;
    if which(MINGW.0).is_none() {
        let why = format!("{} is missing, which links the module for Windows", MINGW.0);
        apt::install(console, &[MINGW.1], &why)?;
    }
    // maturin finds zig as a module of the first Python on PATH.
    let bin = python.parent().map(Path::to_path_buf);
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(bin.into_iter().chain(env::split_paths(&others)));
    let path =
        path.map_err(|e| Error::Failed(format!("PATH has a folder that it cannot name: {e}")))?;
    let maturin = |args: &[&str]| -> Command {
        let mut command = clean(&python, &repo.root, &["-m", "maturin"]);
        command.args(args).arg("--out").arg(folder);
        command.args(["--manifest-path", "python/Cargo.toml"]);
        command.env("SOURCE_DATE_EPOCH", &dist.epoch);
        command.env("PATH", &path);
        command
    };
    // A build with its own settings would contain the folders of this computer.
    let bill = repo.cache().join("odkit.cdx.json");
    sbom::write(dist, "python", &bill)?;
    notices::within(dist, "python", &repo.root.join("python"), || {
        for (triple, oldest) in WHEELS {
            target::add(repo, console, triple)?;
            let mut wheel = maturin(&["build", "--release", "--locked", "--target", triple]);
            if let Some(oldest) = oldest {
                wheel.args(["--zig", "--compatibility", oldest]);
            }
            wheel.env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root));
            wheel.arg("--target-dir").arg(repo.target.join("wheel"));
            wheel.arg("--sbom-include").arg(&bill);
            console.run(&format!("the wheel for {triple}"), &mut wheel)?;
        }
        Ok(())
    })?;
    console.run("its sources", &mut maturin(&["sdist"]))
}
