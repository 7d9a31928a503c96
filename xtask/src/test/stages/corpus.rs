//! The stage that reads a folder of third-party device files. The repository has only its own, in `tests/corpus`.

use std::env;
use std::path::absolute;
use std::process::Command;

use super::python::package;
use super::rust::{ALL, long, odkit};
use crate::console::{CORPUS, cargo};
use crate::error::{Error, Result};
use crate::repo::program;
use crate::test::context::Context;

/// Test targets with tests that read a folder of device files; the names of these tests contain `corpus`.
const TARGETS: [&str; 5] = ["cases", "catalogue", "oracle", "mutations", "all"];

/// Runs these tests on the folder that `ODKIT_CORPUS` names.
pub(super) fn corpus(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let Some(folder) = env::var_os(CORPUS).filter(|folder| !folder.is_empty()) else {
        let text = format!("{CORPUS} names no folder with device files of others");
        return Err(Error::LeftOut(text));
    };
    let folder = absolute(&folder).map_err(|e| Error::Failed(format!("{CORPUS}: {e}")))?;
    if !folder.is_dir() {
        let text = format!("{CORPUS} names {}, which is not a folder", folder.display());
        return Err(Error::Failed(text));
    }
    let mut rust = cargo(&repo.root, &["test"]);
    rust.args(ALL);
    rust.args(TARGETS.iter().flat_map(|name| ["--test", name]));
    rust.args(["--no-fail-fast", "--", "corpus"]);
    long(context, &mut rust);
    console.run("odkit on the folder", rust.env(CORPUS, &folder))?;

    let reader = odkit(context)?.join("examples").join(program("corpus"));
    let (python, site) = package(context)?;
    let on_folder = |args: &[&str]| {
        let mut command = Command::new(&python);
        command.args(args).current_dir(&repo.root);
        command.env(CORPUS, &folder).env("ODKIT_READING", &reader);
        command.env("PYTHONPATH", &site);
        command.env("PYTHONDONTWRITEBYTECODE", "1");
        command
    };
    let differences = ["-m", "unittest", "discover", "-s", "tests/interop"];
    let differences = [&differences[..], &["-p", "test_differences.py", "-v"]].concat();
    console.run(
        "differences from python-canopen",
        &mut on_folder(&differences),
    )?;
    let package = [
        "-m",
        "pytest",
        "-v",
        "-p",
        "no:cacheprovider",
        "-k",
        "corpus",
    ];
    let package = [&package[..], &["python/tests/test_canopen.py"]].concat();
    console.run("odkit.to_canopen", &mut on_folder(&package))
}
