//! Stages that need Node.js, a browser or Python.

use std::path::Path;
use std::process::Command;

use crate::bundle;
use crate::console::cargo;
use crate::error::{Error, Result};
use crate::repo::is_ci;
use crate::serve::Server;
use crate::setup::{browser as chromium, node, python};
use crate::test::Context;

/// The module as the page uses it, and the package's tests on it.
pub(super) fn wasm(context: &Context<'_>) -> Result<()> {
    let package = bundle::bindings(context.repo, context.console)?;
    package_tests(context, &package)
}

/// The page's own checks, on the bundle that `play` would serve.
pub(super) fn page(context: &Context<'_>) -> Result<()> {
    bundle::page(context.repo, context.console)?;
    let web = context.repo.web();
    for (script, what) in [
        ("check", "type check"),
        ("test", "page tests"),
        ("size", "download size"),
    ] {
        let mut npm = node::npm(&web, &["run", "--silent", "--if-present", script]);
        context.console.run(what, &mut npm)?;
    }
    Ok(())
}

/// The packages as npm users get them, the same tests on the one for pages, and the
/// example of its README from the packed tarballs.
pub(super) fn wasm_pack(context: &Context<'_>) -> Result<()> {
    crate::wasm_pack::run(context.repo, context.console, &[])?;
    let bundler = ["build", "playground", "--target", "bundler", "--out-dir"];
    let mut bundler: Vec<String> = bundler.map(String::from).into();
    bundler.push(String::from("pkg/bundler"));
    crate::wasm_pack::run(context.repo, context.console, &bundler)?;
    let package = context.repo.root.join("playground").join("pkg");
    let bundler = package.join("bundler");
    for made in [&package, &bundler] {
        for name in [
            "package.json",
            "od_playground.d.ts",
            "od_playground_bg.wasm",
        ] {
            if !made.join(name).is_file() {
                let made = context.repo.short(made);
                return Err(Error::Failed(format!("wasm-pack made no {made}/{name}")));
            }
        }
    }
    package_tests(context, &package)?;
    let mut command = Command::new("node");
    command.args(["--test", "--test-reporter=tap", "tarball.mjs"]);
    command.current_dir(folder(context, "playground/package-test", "tarball.mjs")?);
    command.env("ODKIT_PKG", &package);
    command.env("ODKIT_PKG_BUNDLER", &bundler);
    context.console.run("the packed tarballs", &mut command)
}

/// The page in a browser, served as `play` serves it.
pub(super) fn browser(context: &Context<'_>) -> Result<()> {
    let tests = folder(context, "tests/browser", "package.json")?;
    node::check()?;
    let chromium = chromium::chromium(context.console)?;
    bundle::page(context.repo, context.console)?;
    node::ci(context.console, &tests, "fetching npm packages")?;
    let url = Server::bind(context.repo.dist(), Some(0))?.spawn();
    let mut command = node_test(context, &tests);
    command.env("ODKIT_URL", url).env("CHROMIUM", chromium);
    context.console.run("browser tests", &mut command)
}

/// A foreign CANopen master against `odkit`.
pub(super) fn interop(context: &Context<'_>) -> Result<()> {
    let tests = folder(context, "tests/interop", "requirements.txt")?;
    let requirements = tests.join("requirements.txt");
    let python = python::environment(context.repo, context.console, &requirements)?;
    let mut build = cargo(&context.repo.root, &["build", "--package", "od-cli"]);
    context.console.run("building odkit", &mut build)?;
    let name = format!("odkit{}", std::env::consts::EXE_SUFFIX);
    let odkit = context.repo.target.join("debug").join(name);
    let mut command = Command::new(python);
    command
        .args(["-m", "unittest", "discover", "-s", "tests/interop", "-v"])
        .current_dir(&context.repo.root)
        .env("ODKIT", odkit)
        .env("PYTHONDONTWRITEBYTECODE", "1");
    long(context, &mut command);
    context.console.run("python-canopen", &mut command)
}

/// `playground/package-test` on the package in a folder, which `ODKIT_PKG` names.
fn package_tests(context: &Context<'_>, package: &Path) -> Result<()> {
    let tests = match folder(context, "playground/package-test", "") {
        Ok(tests) => tests,
        Err(error) if is_ci() => return Err(error),
        Err(error) => {
            context.console.note(error.message());
            return Ok(());
        }
    };
    if tests.join("package-lock.json").is_file() {
        node::ci(context.console, &tests, "fetching npm packages")?;
    }
    let mut command = node_test(context, &tests);
    command.env("ODKIT_PKG", package);
    context.console.run("package tests", &mut command)
}

fn node_test(context: &Context<'_>, dir: &Path) -> Command {
    let mut command = Command::new("node");
    command.args(["--test", "--test-reporter=tap"]);
    command.current_dir(dir);
    long(context, &mut command);
    command
}

fn long(context: &Context<'_>, command: &mut Command) {
    if context.long {
        command.env("ODKIT_LONG", "1");
    }
}

/// A folder of the repository that a stage cannot do without.
fn folder(context: &Context<'_>, dir: &str, file: &str) -> Result<std::path::PathBuf> {
    let path = context.repo.root.join(dir);
    if path.join(file).exists() {
        Ok(path)
    } else {
        let missing = Path::new(dir).join(file);
        let missing = missing.display();
        Err(Error::Missing(format!("there is no {missing}")))
    }
}
