//! Other targets of the pinned toolchain, which rustup adds.

use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::console::{Console, ask_in};
use crate::error::{Error, Result};
use crate::repo::Repo;

/// The browser.
pub(crate) const WASM: &str = "wasm32-unknown-unknown";
/// A microcontroller without an operating system: shows that a crate is `no_std`.
pub(crate) const BARE: &str = "thumbv7m-none-eabi";
/// The smallest microcontroller: without atomic read-modify-write and division.
pub(crate) const SMALLEST: &str = "thumbv6m-none-eabi";
/// A microcontroller with a floating point unit and a soft-float ABI.
pub(crate) const FLOAT: &str = "thumbv7em-none-eabi";
/// A microcontroller that is not an Arm: the ESP32-C3.
pub(crate) const RISC_V: &str = "riscv32imc-unknown-none-elf";
/// The other systems that people develop on.
pub(crate) const HOSTS: [&str; 2] = ["x86_64-pc-windows-gnu", "aarch64-apple-darwin"];

/// rustup does not wait for another rustup, and stages run in parallel.
static ONE: Mutex<()> = Mutex::new(());

/// Installs the target if the toolchain lacks it, or returns the command to type.
pub(crate) fn add(repo: &Repo, console: &Console, target: &str) -> Result<()> {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    if is_there(repo, target)? {
        return Ok(());
    }
    let mut add = Command::new("rustup");
    add.args(["target", "add", target]).current_dir(&repo.root);
    let added = console.run(&format!("adding the target {target}"), &mut add);
    if added.is_ok() && is_there(repo, target)? {
        return Ok(());
    }
    Err(Error::Failed(format!(
        "Rust cannot build for {target}: run `rustup target add {target}` with a network connection"
    )))
}

/// Returns whether the pinned toolchain has the target's library.
fn is_there(repo: &Repo, target: &str) -> Result<bool> {
    let sysroot = ask_in(&repo.root, "rustc", &["--print", "sysroot"])
        .ok_or_else(|| Error::Missing(String::from("`rustc` does not run; see rustup.rs")))?;
    let library = PathBuf::from(sysroot).join("lib/rustlib").join(target);
    Ok(library.join("lib").is_dir())
}
