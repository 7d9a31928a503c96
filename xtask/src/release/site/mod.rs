//! The page and all documents as one static site, which mdBook makes searchable.

mod check;
mod lesson;
mod links;
mod markdown;
mod pages;
mod rules;

use std::path::Path;
use std::process::Command;

use super::dist::Dist;
use super::notices;
use crate::bundle;
use crate::error::Result;
use crate::files;
use crate::setup::mdbook;
use links::Places;

/// Settings and style of the site.
const SETTINGS: &str = "docs/site";

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    let (repo, console) = (dist.repo, dist.console);
    let mdbook = mdbook::get(repo, console)?;
    bundle::page(repo, console)?;
    let rules = rules::pages(dist)?;
    let mut pages = pages::all(&repo.root, &rules)?;
    for page in pages.iter_mut().filter(|page| page.target == pages::RULES) {
        page.text = rules::linked(&page.text, &rules);
    }
    let book = repo.cache().join("site");
    files::fresh(&book)?;
    files::copy_tree(&repo.root.join(SETTINGS), &book)?;
    let source = book.join("src");
    let places = Places::new(&repo.root, &pages);
    for page in &pages {
        files::write(&source.join(&page.target), &places.rewritten(page)?)?;
    }
    files::write(&source.join("SUMMARY.md"), &pages::summary(&pages))?;
    for (from, to) in places.files.borrow().iter() {
        files::copy(&repo.root.join(from), &source.join(to))?;
    }
    let mut build = Command::new(mdbook);
    build.arg("build").arg(&book).arg("--dest-dir").arg(folder);
    console.run("the site", &mut build)?;
    files::copy_tree(&repo.dist(), &folder.join("playground"))?;
    notices::write(dist, "site", folder)?;
    check::check(folder)
}
