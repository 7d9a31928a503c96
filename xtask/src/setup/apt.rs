//! Packages of Debian and Ubuntu, where we are allowed to install them.

use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::console::{Console, ask, which};
use crate::error::{Error, Result};
use crate::repo::is_ci;

/// One at a time: stages run beside each other.
static ONE: Mutex<()> = Mutex::new(());

/// Installs packages, or says in one line what to install and how.
pub(crate) fn install(console: &Console, packages: &[&str], why: &str) -> Result<()> {
    let list = packages.join(" ");
    let is_root = ask("id", &["-u"]).as_deref() == Some("0");
    // A computer of a CI service is there to be changed; those of people are asked by their owners.
    let is_lent = is_ci() && ask("sudo", &["-n", "true"]).is_some();
    if which("apt-get").is_none() || !(is_root || is_lent) {
        return Err(Error::Missing(format!(
            "{why}: please install it, on Debian with `sudo apt-get install {list}`"
        )));
    }
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut update = apt_get(is_root, &["update"]);
    console.run("fetching the package lists (apt-get update)", &mut update)?;
    let mut install = apt_get(is_root, &["install", "-y", "--no-install-recommends"]);
    install.args(packages);
    console.run(&format!("installing {list} with apt-get"), &mut install)
}

fn apt_get(is_root: bool, args: &[&str]) -> Command {
    let mut command = Command::new(if is_root { "env" } else { "sudo" });
    command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get", "-q"]);
    command.args(args);
    command
}
