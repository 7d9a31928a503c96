//! The stage that packs every crate.

use std::fs;
use std::process::Command;

use crate::console::cargo;
use crate::error::{Error, Result};
use crate::files::entries;
use crate::release::crates;
use crate::test::context::Context;

/// Files that every package contains.
const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Every crate is packed with its licences and without tests; with `--long` it compiles from the package.
///
/// `cargo package` would build each crate and its dependencies separately; here all are
/// checked together, with the dependencies that clippy has already checked.
pub(super) fn package(context: &Context<'_>) -> Result<()> {
    let (root, packed) = (&context.repo.root, context.repo.target.join("package"));
    let files = crates::pack(context.repo, context.console)?;
    let dir = packed.join("unpacked");
    fs::create_dir_all(&dir).map_err(|e| Error::io("create", &dir, &e))?;
    for file in files {
        let mut tar = Command::new("tar");
        tar.arg("-xzf").arg(&file).arg("-C").arg(&dir);
        context.console.run("unpacking", &mut tar)?;
    }
    let mut manifest = String::from("[workspace]\nresolver = \"3\"\nmembers = [\"*\"]\n");
    manifest.push_str("[patch.crates-io]\n");
    for folder in entries(&dir)? {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        if let Some(missing) = LICENCES.iter().find(|text| !folder.join(text).is_file()) {
            return Err(Error::Failed(format!("{name} has no {missing}")));
        }
        if folder.join("tests").exists() {
            return Err(Error::Failed(format!(
                "{name} has tests, which need the checkout"
            )));
        }
        let (krate, _) = name.rsplit_once('-').unwrap_or((&name, ""));
        manifest.push_str(&format!("{krate} = {{ path = \"{name}\" }}\n"));
    }
    if !context.long {
        return Ok(());
    }
    let write = dir.join("Cargo.toml");
    fs::write(&write, manifest).map_err(|e| Error::io("write", &write, &e))?;
    let lock = dir.join("Cargo.lock");
    fs::copy(root.join("Cargo.lock"), &lock).map_err(|e| Error::io("write", &lock, &e))?;
    let mut check = cargo(&dir, &["check", "--workspace", "--all-features"]);
    check.args(["--offline", "--target-dir"]);
    check.arg(&context.repo.target);
    context.console.run("what was packed", &mut check)
}
