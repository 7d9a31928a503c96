//! The stage that tests a clone in an empty folder, as CI and other users have it.

use std::env;
use std::process::Command;

use crate::console::{ask_in, cargo};
use crate::error::Result;
use crate::files;
use crate::test::context::Context;

/// Stages that once needed files from outside the repository.
const ONCE_RED: &str = "interop,python,tests,fuzz,unit";

/// A clone of the last commit passes `--quick` and the stages that read many device files; with `--long` all of an
/// ordinary run. Its environment has `PATH`, `HOME` and `CI=true`, and nothing is beside the clone.
pub(super) fn alone(context: &Context<'_>) -> Result<()> {
    let (repo, console) = (context.repo, context.console);
    if ask_in(&repo.root, "git", &["status", "--porcelain"]).is_some_and(|text| !text.is_empty()) {
        console.note("changes that are not committed are not in the clone");
    }
    let folder = repo.cache().join("alone");
    files::fresh(&folder)?;
    let clone = folder.join("odkit");
    let mut git = Command::new("git");
    git.args(["clone", "--quiet", "--no-hardlinks"]);
    git.arg(&repo.root).arg(&clone);
    console.run("a clone in an empty folder", &mut git)?;
    let quick: &[&[&str]] = &[&["--quick"], &["--only", ONCE_RED]];
    let whole: &[&[&str]] = &[&[]];
    for args in if context.long { whole } else { quick } {
        let mut test = cargo(&clone, &["xtask", "test"]);
        test.args(*args);
        for (name, _) in env::vars_os() {
            if name != "PATH" && name != "HOME" {
                test.env_remove(name);
            }
        }
        test.env("CI", "true");
        console.run("the tests of the clone", &mut test)?;
    }
    // It is as large as the target directory of this repository.
    files::remove(&folder)
}
