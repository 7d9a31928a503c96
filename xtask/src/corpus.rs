//! `cargo xtask corpus DIR`: reads a folder of device files and reports the findings.
//!
//! An example of the tests does the work, because xtask does not depend on the crates of odkit. With `--nodes` another example
//! simulates a node of each file, learns its EDS and tests it.

use std::path::{Path, absolute};

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::packages::TESTS;
use crate::repo::Repo;

/// Builds the example and lets it read the folder that the first argument names.
pub(crate) fn run(repo: &Repo, console: &Console, args: &[String]) -> Result<()> {
    let (folder, docs, nodes) = match args {
        [folder] => (folder, None, false),
        [folder, option] if option == "--nodes" => (folder, None, true),
        [folder, option, file] if option == "--docs" => (folder, Some(file), false),
        _ => {
            let text = "corpus needs a folder, and accepts `--docs FILE` or `--nodes`";
            return Err(Error::Usage(String::from(text)));
        }
    };
    // The example runs in the root of the repository; the arguments are the caller's.
    let place =
        |path: &str| absolute(Path::new(path)).map_err(|e| Error::io("find", Path::new(path), &e));
    let example = if nodes { "slaves" } else { "corpus" };
    let args = ["run", "--quiet", "--release", "--package", TESTS];
    let mut command = cargo(&repo.root, &args);
    command.args(["--example", example]);
    command.arg("--");
    command.arg(place(folder)?);
    if let Some(file) = docs {
        command.arg("--docs").arg(place(file)?);
    }
    console.run("reading the corpus", &mut command)
}
