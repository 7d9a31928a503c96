//! Stages that need Node.js, a browser or Python.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::rust::{long, odkit};
use crate::bundle;
use crate::console::cargo;
use crate::error::{Error, Result};
use crate::packages::{CLI, PAGE};
use crate::repo::program;
use crate::serve::Server;
use crate::setup::browser::{chromium, engines};
use crate::setup::{node, python};
use crate::test::context::Context;

/// The page's own checks, on the bundle that `play` would serve.
pub(super) fn page(context: &Context<'_>) -> Result<()> {
    bundle::page(context.repo, context.console)?;
    let web = context.repo.web();
    for (script, what) in [
        ("check", "type check"),
        ("test", "page tests"),
        ("size", "download size"),
    ] {
        let mut npm = node::npm(&web, &["run", "--silent", script]);
        context.console.run(what, &mut npm)?;
    }
    Ok(())
}

/// The page in a browser, served as `play` serves it.
pub(super) fn browser(context: &Context<'_>) -> Result<()> {
    let tests = context.repo.root.join("tests/browser");
    node::check()?;
    let chromium = chromium(context.console)?;
    if context.long {
        engines(context.console)?;
    }
    bundle::page(context.repo, context.console)?;
    // The bus that the page connects to.
    let built = odkit(context)?;
    node::ci(context.console, &tests, "fetching npm packages")?;
    let server = Server::start(context.repo, Some(0))?;
    // Two processes side by side: the tests mostly wait, and one browser serves all files of a process.
    let halves = ["--test-concurrency=2", "first.mjs", "second.mjs"];
    let mut command = node_test(context, &tests, &halves);
    command
        .env("ODKIT_URL", &server.url)
        .env("ODKIT", built.join(program(CLI.1)))
        .env("CHROMIUM", chromium);
    context.console.run("browser tests", &mut command)
}

/// The module as the page uses it, and the tests of the package with it.
pub(super) fn wasm(context: &Context<'_>) -> Result<()> {
    let package = bundle::bindings(context.repo, context.console)?;
    package_tests(context, &package)
}

/// The packages as npm users get them: the same tests with the package for pages, and the
/// example of its README from the packed tarballs.
pub(super) fn wasm_pack(context: &Context<'_>) -> Result<()> {
    let package = context.repo.root.join("playground/pkg");
    let bundler = package.join("bundler");
    let build = ["build", "playground", "--target"];
    for (args, made) in [
        (&["web"][..], &package),
        (&["bundler", "--out-dir", "pkg/bundler"], &bundler),
    ] {
        let args: Vec<String> = build.iter().chain(args).map(|&arg| arg.into()).collect();
        crate::wasm_pack::run(context.repo, context.console, &args)?;
        let module = format!("{}_bg.wasm", PAGE.1);
        for name in ["package.json", "LICENSE.MIT", "LICENSE.APACHE", &module] {
            if !made.join(name).is_file() {
                let made = context.repo.short(made);
                return Err(Error::Failed(format!("wasm-pack made no {made}/{name}")));
            }
        }
    }
    package_tests(context, &package)?;
    let tests = context.repo.root.join("playground/package-test");
    let mut command = node_test(context, &tests, &["tarball.mjs"]);
    command
        .env("ODKIT_PKG", &package)
        .env("ODKIT_PKG_BUNDLER", &bundler);
    context.console.run("the packed tarballs", &mut command)
}

/// A foreign CANopen master against `odkit`.
pub(super) fn interop(context: &Context<'_>) -> Result<()> {
    let built = odkit(context)?;
    let requirements = context.repo.root.join("tests/interop/requirements.txt");
    let python = python::environment(context.repo, context.console, &requirements)?;
    let example = |name| built.join("examples").join(program(name));
    let mut command = Command::new(&python);
    command
        .args(["-m", "unittest", "discover", "-s", "tests/interop", "-v"])
        .current_dir(&context.repo.root)
        .env("ODKIT", built.join(program(CLI.1)))
        .env("ODKIT_READING", example("corpus"))
        .env("ODKIT_TOOLS", example("tools"))
        .env("PYTHONDONTWRITEBYTECODE", "1");
    if context.long {
        other_tools(context, &python, &mut command)?;
    }
    long(context, &mut command);
    context.console.run("python-canopen", &mut command)
}

/// Arguments with which `tests/interop/test_tools.py` compares odkit's findings with other tools than python-canopen.
fn other_tools(context: &Context<'_>, python: &Path, command: &mut Command) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let mut pip = Command::new(python);
    pip.args(["-m", "pip", "install", "--quiet", "dcf-tools==2.4.2"]);
    console.run("installing dcf-tools", &mut pip)?;
    let modules = repo.cache().join("npm-canopen");
    fs::create_dir_all(&modules).map_err(|e| Error::io("create", &modules, &e))?;
    let mut install = node::npm(
        &modules,
        &[
            "install",
            "--silent",
            "--no-audit",
            "--no-fund",
            "canopen@6.2.1",
        ],
    );
    console.run("installing the package canopen of npm", &mut install)?;
    let manifest = [
        "build",
        "--quiet",
        "--manifest-path",
        "tests/interop/tools/canopen-rs/Cargo.toml",
    ];
    let mut build = cargo(&repo.root, &manifest);
    console.run(
        "building canopen-rs",
        build.arg("--target-dir").arg(&repo.target),
    )?;
    let reader = repo.target.join("debug").join(program("read-canopen-rs"));
    command.env("ODKIT_CANOPEN_RS", reader);
    command.env("NODE_PATH", modules.join("node_modules"));
    Ok(())
}

/// `playground/package-test` on the package in a folder, which `ODKIT_PKG` names.
fn package_tests(context: &Context<'_>, package: &Path) -> Result<()> {
    let tests = context.repo.root.join("playground/package-test");
    let mut command = node_test(context, &tests, &[]);
    command.env("ODKIT_PKG", package);
    context.console.run("package tests", &mut command)
}

fn node_test(context: &Context<'_>, dir: &Path, args: &[&str]) -> Command {
    let mut command = node::tests(context.repo, dir);
    command.args(args);
    long(context, &mut command);
    command
}
