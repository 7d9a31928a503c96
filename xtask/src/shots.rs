//! `cargo xtask shots`: screenshots of the page, for the documentation and for reviews.

use std::process::Command;

use crate::bundle;
use crate::console::Console;
use crate::error::Result;
use crate::repo::Repo;
use crate::serve::Server;
use crate::setup::{browser, node};

/// Builds and serves the page and lets `tests/browser/shots.mjs` photograph it.
pub(crate) fn run(repo: &Repo, console: &Console) -> Result<()> {
    let tests = repo.root.join("tests/browser");
    node::check()?;
    let chromium = browser::chromium(console)?;
    bundle::page(repo, console)?;
    node::ci(console, &tests, "fetching the browser tests' npm packages")?;
    let server = Server::start(repo, Some(0))?;
    let mut shots = Command::new("node");
    shots.arg("shots.mjs").current_dir(&tests);
    shots
        .env("ODKIT_URL", &server.url)
        .env("CHROMIUM", chromium);
    console.run("taking pictures of the page", &mut shots)?;
    console.note("they are in target/shots");
    Ok(())
}
