//! The npm package, for `<script type="module">`.

use std::path::Path;

use super::dist::Dist;
use super::notices;
use crate::error::Result;
use crate::setup::node;
use crate::wasm_pack;

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    wasm_pack::run(dist.repo, dist.console, &[])?;
    let package = dist.repo.root.join("playground/pkg");
    let mut pack = node::npm(
        &package,
        &["pack", "--ignore-scripts", "--pack-destination"],
    );
    notices::within(dist, "npm", &package, || {
        dist.console.run("the npm package", pack.arg(folder))
    })
}
