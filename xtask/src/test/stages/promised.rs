//! Stages about what odkit promises to those who depend on it: compilers, versions, licences; and spelling.

use std::process::Command;

use crate::console::ask;
use crate::error::Result;
use crate::files;
use crate::packages::UNPUBLISHED;
use crate::setup::installed::{self, Package};
use crate::setup::{python, toolchain};
use crate::test::context::Context;

/// Program that checks advisories, licences and sources; `.cargo/deny.toml` has the settings.
const DENY: Package = Package {
    name: "cargo-deny",
    version: "0.20.2",
    args: &[],
};

/// The packages for crates.io, with each of their features.
fn published() -> Vec<&'static str> {
    let mut args = vec!["--workspace", "--all-features"];
    args.extend(UNPUBLISHED.iter().flat_map(|name| ["--exclude", *name]));
    args
}

/// Every package for crates.io compiles with the Rust that `rust-version` in Cargo.toml names.
pub(super) fn msrv(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let version = repo.oldest_rust()?;
    toolchain::add(repo, console, &version)?;
    let mut check = Command::new("rustup");
    check.args(["run", &version, "cargo", "check", "--locked"]);
    check.args(published()).current_dir(&repo.root);
    check.arg("--target-dir").arg(repo.target.join("msrv"));
    console.run(
        &format!("what is published, with Rust {version}"),
        &mut check,
    )
}

/// The same packages compile with the oldest versions of their dependencies that they ask for.
pub(super) fn minimal(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    toolchain::add(repo, console, "nightly")?;
    let folder = repo.cache().join("minimal");
    files::fresh(&folder)?;
    let lock = folder.join("Cargo.lock").display().to_string();
    // The versions are written beside the workspace's own lock file.
    let place = format!("resolver.lockfile-path={lock:?}");
    let cargo = |args: &[&str]| {
        let mut command = Command::new("rustup");
        command.args(["run", "nightly", "cargo"]).args(args);
        command.args(["-Z", "lockfile-path", "--config", &place]);
        command.current_dir(&repo.root);
        command
    };
    let mut oldest = cargo(&["generate-lockfile", "-Z", "direct-minimal-versions"]);
    console.run("the oldest versions that Cargo.toml allows", &mut oldest)?;
    let mut check = cargo(&["check", "--locked"]);
    check.args(published());
    check.arg("--target-dir").arg(repo.target.join("minimal"));
    console.run("what is published, with them", &mut check)
}

/// Database of the advisories for cargo-deny.
const ADVISORIES: &str = "https://github.com/rustsec/advisory-db";

/// Licences and sources of all dependencies, and advisories about them where these can be fetched.
pub(super) fn deny(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let tool = installed::get(repo, console, &DENY)?;
    let mut check = Command::new(tool);
    check.args(["--locked", "check", "bans", "licenses", "sources"]);
    if ask("git", &["ls-remote", "--exit-code", ADVISORIES, "HEAD"]).is_some() {
        check.arg("advisories");
    } else {
        console.note(&format!(
            "advisories are not checked: {ADVISORIES} cannot be read"
        ));
    }
    console.run("dependencies", check.current_dir(&repo.root))
}

/// Spelling of code and documents; `.typos.toml` has the words that are right here.
pub(super) fn typos(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    let requirements = repo.root.join("xtask/tools/typos.txt");
    let python = python::venv(repo, console, "typos", &requirements)?;
    let mut check = Command::new(python.with_file_name("typos"));
    check.args(["--format", "brief"]).current_dir(&repo.root);
    console.run("spelling", &mut check)
}
