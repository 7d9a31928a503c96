//! The stage of the Python package.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::rust::{long, odkit};
use crate::error::{Error, Result};
use crate::packages::CLI;
use crate::repo::program;
use crate::setup::python;
use crate::test::context::Context;

/// Folder with the metadata of the package, as pip makes it: python-can and pytest find the package by it.
const INFO: &str = "odkit-0.1.0.dist-info";
const METADATA: &str = "Metadata-Version: 2.1\nName: odkit\nVersion: 0.1.0\n";

/// The tests of the Python package, in the environment of the stage `interop`; a long run also installs the
/// package with pip.
pub(super) fn python(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let (python, site) = package(context)?;
    tests(context, &python, Some(&site))?;
    if !context.long {
        return Ok(());
    }
    let fresh = repo.cache().join("python-venv");
    let _ = fs::remove_dir_all(&fresh);
    let mut venv = Command::new(&python);
    venv.args(["-m", "venv"]).arg(&fresh);
    console.run("making a Python environment", &mut venv)?;
    let python = fresh.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let python = python.join("python");
    let mut pip = Command::new(&python);
    pip.args(["-m", "pip", "install", "--quiet", "./python[test]"]);
    console.run("pip install ./python", pip.current_dir(&repo.root))?;
    tests(context, &python, None)
}

/// A Python with what the tests need, and a folder with the package.
pub(super) fn package(context: &Context<'_>) -> Result<(PathBuf, PathBuf)> {
    let (repo, console) = (context.repo, context.console);
    let requirements = repo.root.join("tests/interop/requirements.txt");
    let python = python::environment(repo, console, &requirements)?;
    let built = odkit(context)?;
    let site = repo.cache().join("python");
    lay(&repo.root.join("python"), &site, &built)?;
    Ok((python, site))
}

/// Installs the package in the layout of pip.
fn lay(package: &Path, site: &Path, built: &Path) -> Result<()> {
    let _ = fs::remove_dir_all(site);
    let (code, info) = (site.join("odkit"), site.join(INFO));
    for dir in [&code, &info] {
        fs::create_dir_all(dir).map_err(|e| Error::io("create", dir, &e))?;
    }
    let from = package.join("odkit");
    let files = fs::read_dir(&from).map_err(|e| Error::io("read", &from, &e))?;
    for file in files.flatten().filter(|file| file.path().is_file()) {
        copy(&file.path(), &code.join(file.file_name()))?;
    }
    let library = format!(
        "{}_odkit{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    copy(&built.join(library), &code.join("_odkit.abi3.so"))?;
    write(&info.join("METADATA"), METADATA)?;
    let manifest = package.join("pyproject.toml");
    let manifest = fs::read_to_string(&manifest).map_err(|e| Error::io("read", &manifest, &e))?;
    write(&info.join("entry_points.txt"), &entry_points(&manifest))
}

/// The sections of entry points of a `pyproject.toml`, as a package has them.
fn entry_points(manifest: &str) -> String {
    let mut found = String::new();
    let mut is_inside = false;
    for line in manifest.lines() {
        if line.starts_with('[') {
            let section = line.strip_prefix("[project.entry-points.");
            let name = section.map(|name| name.trim_end_matches(']').trim_matches('"'));
            is_inside = name.is_some();
            found.extend(name.map(|name| format!("[{name}]\n")));
        } else if is_inside {
            found.push_str(&line.replace('"', ""));
            found.push('\n');
        }
    }
    found
}

fn copy(from: &Path, to: &PathBuf) -> Result<()> {
    fs::copy(from, to).map_err(|e| Error::io("copy", from, &e))?;
    Ok(())
}

fn write(path: &PathBuf, text: &str) -> Result<()> {
    fs::write(path, text).map_err(|e| Error::io("write", path, &e))
}

/// pytest, with the package of a folder if it is not installed.
fn tests(context: &Context<'_>, python: &Path, site: Option<&Path>) -> Result<()> {
    // A test plays scripts of a bench with the command.
    let odkit = odkit(context)?.join(program(CLI.1));
    // Not started in `python/`, whose folder `odkit` lacks the module. With `-v` the log names the test that runs.
    let mut pytest = Command::new(python);
    pytest
        .args(["-m", "pytest", "-v", "-p", "no:cacheprovider"])
        .args(["python/tests", "examples/python-ci/tests"])
        .arg("examples/campaign/tests")
        .current_dir(&context.repo.root)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("ODKIT_BINARY", odkit);
    if let Some(site) = site {
        pytest.env("PYTHONPATH", site);
    }
    long(context, &mut pytest);
    context.console.run("the Python tests", &mut pytest)
}

#[cfg(test)]
mod tests {
    use super::entry_points;

    #[test]
    fn entry_points_of_a_manifest() {
        let manifest = "[project]\nname = \"a\"\n\n[project.entry-points.\"can.interface\"]\nodkit = \"a:B\"\n[tool]\nx = 1\n";
        assert_eq!(entry_points(manifest), "[can.interface]\nodkit = a:B\n");
    }
}
