//! The stage that makes a release and uses it without the repository. Only with `--long`.

use std::env;

use crate::console::{ask_in, which};
use crate::error::Result;
use crate::release::{self, Options};
use crate::setup::browser::chromium;
use crate::setup::{apt, node};
use crate::test::context::Context;

/// Emulators for the programs of other systems, and their Debian packages. If they cannot be
/// installed, the tests of these programs are skipped.
const EMULATORS: [(&str, &[&str]); 2] = [
    ("qemu-aarch64-static", &["qemu-user-static"]),
    ("wine", &["wine", "wine64"]),
];

/// Installs and uses each part of a release from its folder only. `ODKIT_DIST` names a release; otherwise it makes one.
pub(super) fn dist(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    node::check()?;
    let chromium = chromium(console)?;
    let browser = repo.root.join("tests/browser");
    node::ci(
        console,
        &browser,
        "fetching the browser tests' npm packages",
    )?;
    for (program, packages) in EMULATORS {
        if which(program).is_none()
            && let Err(why) = apt::install(console, packages, &format!("{program} is missing"))
        {
            console.note(why.message());
        }
    }
    let given = env::var_os("ODKIT_DIST").map(|dir| repo.root.join(dir));
    let folder = given.clone().unwrap_or_else(|| repo.cache().join("dist"));
    if given.is_none() {
        release::run(repo, console, &Options::whole(&folder))?;
    }
    let mut tests = node::tests(repo, &repo.root.join("tests/dist"));
    tests.env("ODKIT_DIST", &folder).env("CHROMIUM", chromium);
    // The packages are built with the compiler that packed them.
    let rustc = ask_in(&repo.root, "rustup", &["show", "active-toolchain"]);
    if let Some(name) = rustc.as_deref().and_then(|text| text.split(' ').next()) {
        tests.env("RUSTUP_TOOLCHAIN", name);
    }
    console.run("a release, installed and used", &mut tests)
}
