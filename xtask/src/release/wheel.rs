//! The Python package: a wheel for this system, and its sources for the others.

use std::path::Path;
use std::process::Command;

use super::dist::Dist;
use super::notices;
use super::sbom;
use crate::console::{clean, without_paths};
use crate::error::Result;
use crate::setup::python;

/// The tested version of the builder.
const REQUIREMENTS: &str = "xtask/tools/wheel.txt";

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    let (repo, console) = (dist.repo, dist.console);
    let requirements = repo.root.join(REQUIREMENTS);
    let python = python::venv(repo, console, "wheel-venv", &requirements)?;
    let maturin = |args: &[&str]| -> Command {
        let mut command = clean(&python, &repo.root, &["-m", "maturin"]);
        command.args(args).arg("--out").arg(folder);
        command.args(["--manifest-path", "python/Cargo.toml"]);
        command.env("SOURCE_DATE_EPOCH", &dist.epoch);
        command
    };
    let mut wheel = maturin(&["build", "--release", "--locked"]);
    wheel.env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root));
    wheel.arg("--target-dir").arg(repo.target.join("wheel"));
    // A build with its own settings would contain the folders of this computer.
    let bill = repo.cache().join("odkit.cdx.json");
    sbom::write(dist, "python", &bill)?;
    wheel.arg("--sbom-include").arg(&bill);
    notices::within(dist, "python", &repo.root.join("python"), || {
        console.run("the wheel", &mut wheel)
    })?;
    console.run("its sources", &mut maturin(&["sdist"]))
}
