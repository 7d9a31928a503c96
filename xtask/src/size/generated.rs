//! The firmware that `odkit new --firmware generic` makes of the 16 objects of `minimal`: its flash.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::packages::CLI;
use crate::repo::{Repo, program};
use crate::setup::target;

/// The names of the rows, and what each is. The second has the list of the device as the template proposes it.
pub(super) const ROWS: [(&str, &str); 2] = [
    (
        "new",
        "the same 16 objects as `odkit new --firmware generic` makes it, with every service of the file",
    ),
    (
        "new-small",
        "as `odkit new` makes it, without segmented, block, changes, behaviour and events",
    ),
];
const LIST: &str = "// without block, changes, behaviour, events;";
const SMALLER: &str = "without segmented, block, changes, behaviour, events;";

/// Makes the workspace and builds it twice. Returns the flash of both rows, in bytes.
pub(super) fn measure(repo: &Repo) -> Result<[u64; 2]> {
    let console = Console::terminal();
    let mut build = cargo(&repo.root, &["build", "--quiet", "--package", CLI.0]);
    console.run("odkit", build.args(["--bin", CLI.1]))?;
    let workspace = repo.cache().join("size").join("minimal");
    let _ = fs::remove_dir_all(&workspace);
    let odkit = repo.target.join("debug").join(program(CLI.1));
    let mut new = Command::new(odkit);
    new.args(["new", "firmware/eds/minimal.eds", "--firmware", "generic"]);
    new.args(["--odkit", ".", "--path"]).arg(&workspace);
    new.current_dir(&repo.root).stdout(Stdio::null());
    console.run("odkit new", &mut new)?;
    let (from, to) = (
        repo.root.join("tests/boards/Cargo.lock"),
        workspace.join("Cargo.lock"),
    );
    fs::copy(from, &to).map_err(|e| Error::io("write", &to, &e))?;
    let full = flash(repo, &console, &workspace)?;
    let device = workspace.join("device/src/lib.rs");
    let text = fs::read_to_string(&device).map_err(|e| Error::io("read", &device, &e))?;
    if !text.contains(LIST) {
        return Err(Error::Failed(format!("{} lacks {LIST}", device.display())));
    }
    fs::write(&device, text.replace(LIST, SMALLER)).map_err(|e| Error::io("write", &device, &e))?;
    Ok([full, flash(repo, &console, &workspace)?])
}

/// Builds the firmware. Returns the bytes that it puts into flash.
fn flash(repo: &Repo, console: &Console, workspace: &Path) -> Result<u64> {
    let firmware = workspace.join("firmware");
    let mut build = cargo(
        &firmware,
        &["build", "--quiet", "--release", "--target-dir"],
    );
    console.run("its firmware", build.arg(&repo.target))?;
    let folder = repo.target.join(target::BARE).join("release");
    let program = folder.join("minimal-firmware");
    let bytes = fs::read(&program).map_err(|e| Error::io("read", &program, &e))?;
    loaded(&bytes).ok_or_else(|| Error::Failed(format!("{} is not a program", program.display())))
}

/// Bytes of the segments that are loaded, of a program for a 32-bit processor.
fn loaded(elf: &[u8]) -> Option<u64> {
    const LOAD: u32 = 1;
    let word = |at: usize| Some(u32::from_le_bytes(*elf.get(at..)?.first_chunk()?));
    let half = |at: usize| Some(u16::from_le_bytes(*elf.get(at..)?.first_chunk()?));
    let class = elf.strip_prefix(b"\x7FELF")?.first()?;
    let (table, size, count) = (word(28)? as usize, half(42)?, half(44)?);
    if *class != 1 {
        return None;
    }
    (0..usize::from(count)).try_fold(0, |sum, at| {
        let segment = table + at * usize::from(size);
        let bytes = if word(segment)? == LOAD {
            word(segment + 16)?
        } else {
            0
        };
        Some(sum + u64::from(bytes))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flash_is_the_segments_that_are_loaded() {
        let mut elf = vec![0; 52 + 3 * 32];
        elf[..5].copy_from_slice(b"\x7FELF\x01");
        (elf[28], elf[42], elf[44]) = (52, 32, 3);
        for (at, (kind, bytes)) in [(1, 1024), (1, 18_000), (4, 777)].into_iter().enumerate() {
            let segment = 52 + at * 32;
            elf[segment] = kind;
            elf[segment + 16..segment + 20].copy_from_slice(&u32::to_le_bytes(bytes));
        }
        assert_eq!(loaded(&elf), Some(19_024));
        assert_eq!(loaded(&elf[..100]), None);
        assert_eq!(loaded(b"#!/bin/sh"), None);
    }
}
