//! The stage that drives Neovim, packages the extension, and tests hooks and action. Only with `--long`.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::console::{cargo, which};
use crate::error::{Error, Result};
use crate::packages::CLI;
use crate::repo::program;
use crate::setup::{apt, node};
use crate::test::context::Context;
use crate::test::stages::rust::ALL;

/// The recording of the session, as it is in the repository.
const RECORDING: &str = "docs/NEOVIM.txt";
/// The version of the hooks in the test.
const PRE_COMMIT: &str = "pre-commit==4.7.0";

pub(super) fn editor(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let mut build = cargo(&repo.root, &["build", "--bin", CLI.1]);
    console.run("the command line", build.args(ALL))?;
    let odkit = repo.target.join("debug").join(program(CLI.1));
    neovim(context, &odkit)?;
    let extension = repo.root.join("editors/vscode");
    node::check()?;
    node::ci(console, &extension, "fetching npm packages")?;
    for (script, what) in [("test", "the grammar"), ("package", "the extension")] {
        let mut npm = node::npm(&extension, &["run", "--silent", script]);
        console.run(what, &mut npm)?;
    }
    repository(context, &odkit)
}

/// Plays the session and compares the screen of Neovim with the recording.
fn neovim(context: &Context<'_>, odkit: &Path) -> Result<()> {
    if which("nvim").is_none() {
        apt::install(context.console, &["neovim"], "Neovim is missing")?;
    }
    let (root, folder) = (&context.repo.root, context.repo.cache().join("editor"));
    fs::create_dir_all(&folder).map_err(|e| Error::io("create", &folder, &e))?;
    let file = folder.join("thermometer.eds");
    let from = root.join("tests/editor/thermometer.eds");
    fs::copy(from, &file).map_err(|e| Error::io("write", &file, &e))?;
    let record = folder.join("record.txt");
    let mut nvim = Command::new("nvim");
    nvim.args(["--headless", "--clean", "-S"]);
    nvim.arg(root.join("tests/editor/neovim.lua"));
    nvim.env("ODKIT", odkit).env("ODKIT_FILE", &file);
    context
        .console
        .run("a session in Neovim", nvim.env("ODKIT_RECORD", &record))?;
    let own = root.join(RECORDING);
    if env::var_os("ODKIT_ACCEPT").is_some() {
        fs::copy(&record, &own).map_err(|e| Error::io("write", &own, &e))?;
    }
    let mut diff = Command::new("diff");
    diff.arg("-u").args([&own, &record]);
    context
        .console
        .run("the recording of the session", &mut diff)
}

/// The hooks for pre-commit and the step of the action, on a small repository.
fn repository(context: &Context<'_>, odkit: &Path) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let venv = repo.cache().join("pre-commit");
    let bin = venv.join("bin");
    if !bin.join("pre-commit").is_file() {
        let mut make = Command::new("python3");
        console.run(
            "making a Python environment",
            make.args(["-m", "venv"]).arg(&venv),
        )?;
        let mut pip = Command::new(bin.join("pip"));
        pip.args(["install", "--quiet", PRE_COMMIT]);
        console.run("installing pre-commit", &mut pip)?;
    }
    let folder = repo.cache().join("editor/repository");
    let mut path = bin.into_os_string();
    path.push(":");
    path.push(env::var_os("PATH").unwrap_or_default());
    let mut script = Command::new(repo.root.join("tests/editor/repository.sh"));
    script
        .arg(&repo.root)
        .arg(odkit)
        .arg(&folder)
        .env("PATH", path);
    console.run("hooks and action on a repository", &mut script)
}
