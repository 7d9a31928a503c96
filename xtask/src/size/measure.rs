//! Builds a program of `firmware/`, runs it on the emulator, and reads what it reports.

use std::path::{Path, PathBuf};

use crate::console::{Console, cargo, clean, which};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::setup::{apt, target};

/// The optimisation of a firmware.
pub(super) const SMALL: &str = "s";
const EMULATOR: &str = "qemu-system-arm";

/// Report of a program: bytes, and instructions from an input until its last frame is sent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cost {
    pub(super) flash: u64,
    /// Flash with the optimisation `z`.
    pub(super) flash_z: u64,
    pub(super) ram: u64,
    pub(super) stack: u64,
    pub(super) instructions: [u64; 5],
}

/// Inputs that are measured in instructions.
pub(super) const COUNTS: [&str; 5] = ["power_on", "upload", "sync", "foreign", "idle"];

/// Installs the target and the emulator, if they are missing.
pub(crate) fn prepare(repo: &Repo, console: &Console) -> Result<()> {
    target::add(repo, console, target::BARE)?;
    let why = "the emulator of the Cortex-M3 is missing";
    match which(EMULATOR) {
        Some(_) => Ok(()),
        None => apt::install(console, &[EMULATOR], why),
    }
}

/// Builds programs with an optimisation and features. Returns the folder that they are in.
pub(super) fn build(
    repo: &Repo,
    programs: &[&str],
    level: &str,
    features: &[&str],
) -> Result<PathBuf> {
    let folder = repo.root.join("firmware");
    let mut build = cargo(&folder, &["build", "--quiet", "--release"]);
    build.args(programs.iter().flat_map(|name| ["--bin", *name]));
    build
        .args(["--target", target::BARE, "--target-dir"])
        .arg(&repo.target);
    build
        .arg("--config")
        .arg(format!("profile.release.opt-level=\"{level}\""));
    build.arg("--features").arg(features.join(","));
    let output = build
        .output()
        .map_err(|e| Error::Missing(format!("cargo: {e}")))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(Error::Failed(format!(
            "the firmware does not compile:\n{text}"
        )));
    }
    Ok(repo.target.join(target::BARE).join("release"))
}

/// Sends a program to the boot loader and starts it.
pub(super) fn boot(program: &Path) -> Result<()> {
    let text = emulate(program)?;
    if text.lines().any(|line| line == "the program runs") {
        Ok(())
    } else {
        Err(failed(program, &text))
    }
}

fn failed(program: &Path, text: &str) -> Error {
    Error::Failed(format!("{} has failed:\n{text}", program.display()))
}

pub(super) fn play(program: &Path) -> Result<Cost> {
    let text = emulate(program)?;
    read(&text).ok_or_else(|| failed(program, &text))
}

/// Runs a program on the emulator, with a clock that counts its instructions. Returns its
/// output.
fn emulate(program: &Path) -> Result<String> {
    let folder = program.parent().unwrap_or(Path::new("."));
    let mut command = clean(
        Path::new(EMULATOR),
        folder,
        &["-M", "lm3s6965evb", "-nographic"],
    );
    command.args([
        "-monitor",
        "none",
        "-serial",
        "none",
        "-icount",
        "shift=10,sleep=off",
    ]);
    command
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(program);
    let output = command.stdin(std::process::Stdio::null()).output();
    let output = output.map_err(|e| Error::Missing(format!("{EMULATOR}: {e}")))?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() {
        Ok(text)
    } else {
        Err(failed(program, &text))
    }
}

/// The lines of a report: a name, and a number in hex.
fn read(text: &str) -> Option<Cost> {
    let number = |wanted: &str| {
        let mut pairs = text.lines().filter_map(|line| line.split_once(' '));
        let (_, number) = pairs.find(|(name, _)| *name == wanted)?;
        u64::from_str_radix(number, 16).ok()
    };
    // 12.8 ticks of the clock are one instruction.
    let overhead = number("overhead")?;
    let count = |name| Some(((number(name)?.saturating_sub(overhead)) * 10 + 64) / 128);
    let mut instructions = [0; COUNTS.len()];
    for (to, name) in instructions.iter_mut().zip(COUNTS) {
        *to = count(name)?;
    }
    let (flash, ram, stack) = (number("flash")?, number("ram")?, number("stack")?);
    Some(Cost {
        flash,
        flash_z: flash,
        ram,
        stack,
        instructions,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_read_in_instructions() {
        let text = "Timer\nflash 0000b9f8\nram 10\nstack 20\noverhead 1a\npower_on 2c480\n\
                    upload 1f8d\nsync 2d74\nforeign 190d\nidle 188d\n";
        let cost = read(text).unwrap();
        assert_eq!((cost.flash, cost.ram, cost.stack), (0xB9F8, 16, 32));
        assert_eq!(cost.instructions[1], 629);
        assert_eq!(read("flash 1\n"), None);
    }
}
