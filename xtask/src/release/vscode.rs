//! The extension for Visual Studio Code.

use std::path::Path;

use super::dist::Dist;
use super::notices;
use crate::error::Result;
use crate::setup::node;

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    node::check()?;
    let extension = dist.repo.root.join("editors/vscode");
    node::ci(dist.console, &extension, "fetching npm packages")?;
    let file = folder.join(format!("odkit-{}.vsix", dist.version));
    let mut package = node::npm(&extension, &["run", "--silent", "package", "--", "--out"]);
    package.arg(file).env("SOURCE_DATE_EPOCH", &dist.epoch);
    notices::within(dist, "vscode", &extension, || {
        dist.console.run("the extension", &mut package)
    })
}
