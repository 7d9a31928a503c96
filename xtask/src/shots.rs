//! `cargo xtask shots`: pictures of the page, for the documentation and for our eyes.

use std::fs;
use std::process::Command;

use crate::bundle;
use crate::console::Console;
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::serve::Server;
use crate::setup::{browser, node};

/// Builds and serves the page and lets `tests/browser/shots.mjs` photograph it.
pub(crate) fn run(repo: &Repo, console: &Console) -> Result<()> {
    let tests = repo.root.join("tests").join("browser");
    if !tests.join("shots.mjs").is_file() {
        let text = "there is no tests/browser/shots.mjs";
        return Err(Error::Missing(String::from(text)));
    }
    node::check()?;
    let chromium = browser::chromium(console)?;
    bundle::page(repo, console)?;
    node::ci(console, &tests, "fetching the browser tests' npm packages")?;
    let out = repo.target.join("shots");
    fs::create_dir_all(&out).map_err(|e| Error::io("create", &out, &e))?;
    let url = Server::bind(repo.dist(), Some(0))?.spawn();
    let mut shots = Command::new("node");
    shots
        .arg("shots.mjs")
        .current_dir(&tests)
        .env("ODKIT_URL", url)
        .env("ODKIT_SHOTS", &out)
        .env("CHROMIUM", chromium);
    console.run("taking pictures of the page", &mut shots)?;
    console.note(&format!("they are in {}", repo.short(&out)));
    Ok(())
}
