//! The command line for each system, statically linked.

use std::path::Path;

use super::dist::Dist;
use super::notices;
use super::systems::{SYSTEMS, System};
use crate::bundle;
use crate::console::{cargo, which, without_paths};
use crate::error::Result;
use crate::files;
use crate::packages::CLI;
use crate::setup::{apt, target};

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    let (repo, console) = (dist.repo, dist.console);
    // `odkit class` serves it.
    bundle::page(repo, console)?;
    for System { linker, .. } in &SYSTEMS {
        if let Some((program, Some(package))) = linker
            && which(program).is_none()
        {
            let why = format!("{program} is missing, which links programs for Windows");
            apt::install(console, &[package], &why)?;
        }
    }
    for System {
        triple,
        ending,
        linker,
    } in &SYSTEMS
    {
        target::add(repo, console, triple)?;
        let mut build = cargo(&repo.root, &["build", "--release", "--locked"]);
        build.args(["--package", CLI.0, "--bin", CLI.1, "--target", triple]);
        build.env("ODKIT_PAGE", repo.dist());
        build.env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root));
        if let Some((program, _)) = linker {
            let name = triple.to_uppercase().replace('-', "_");
            build.env(format!("CARGO_TARGET_{name}_LINKER"), program);
        }
        console.run(&format!("odkit for {triple}"), &mut build)?;
        let built = repo.target.join(triple).join("release");
        let name = format!("{}-{}-{triple}{ending}", CLI.1, dist.version);
        files::copy(
            &built.join(format!("{}{ending}", CLI.1)),
            &folder.join(name),
        )?;
    }
    notices::write(dist, "bin", folder)?;
    Ok(())
}
