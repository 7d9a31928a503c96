//! Python environments for the tests with other CANopen masters, and for building a wheel.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::apt;
use crate::console::{Console, ask};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::stamp::{Fingerprint, Stamp};

/// The Python program of an environment for the tests, with exactly the packages of `requirements`.
pub(crate) fn environment(repo: &Repo, console: &Console, requirements: &Path) -> Result<PathBuf> {
    venv(repo, console, "venv", requirements)
}

/// The Python program of the environment `name`.
pub(crate) fn venv(
    repo: &Repo,
    console: &Console,
    name: &str,
    requirements: &Path,
) -> Result<PathBuf> {
    let dir = repo.cache().join(name);
    let bin = dir.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let python = bin.join("python");
    let base = base(console)?;
    let inputs = Fingerprint::new()
        .text(&ask(&base, &["-VV"]).unwrap_or_default())
        .file(requirements)?;
    let stamp = Stamp::new(dir.join(".xtask-stamp"), inputs);
    if stamp.is_current(&[&python]) {
        return Ok(python);
    }
    if dir.exists() {
        fs::remove_dir_all(&dir).map_err(|e| Error::io("remove", &dir, &e))?;
    }
    let mut venv = Command::new(&base);
    venv.args(["-m", "venv"]).arg(&dir);
    console.run("making a Python environment", &mut venv)?;
    let mut pip = Command::new(&python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ])
    .arg("--requirement")
    .arg(requirements);
    console.run("installing the pinned Python packages", &mut pip)?;
    stamp.set()?;
    Ok(python)
}

/// A Python 3 with the module `venv`, which Debian has in a package of its own.
fn base(console: &Console) -> Result<PathBuf> {
    let candidates = ["python3", "python"];
    let complete = |python: &&str| ask(python, &["-c", "import venv, ensurepip"]).is_some();
    if let Some(python) = candidates.iter().find(|python| complete(python)) {
        return Ok(PathBuf::from(python));
    }
    let packages = ["python3", "python3-venv"];
    apt::install(console, &packages, "Python 3 with `venv` is missing")?;
    // The first python3 on PATH may not be Debian's.
    ["python3", "/usr/bin/python3"]
        .iter()
        .find(|python| complete(python))
        .map(PathBuf::from)
        .ok_or_else(|| Error::Missing(String::from("no Python 3 here has `venv` and `ensurepip`")))
}
