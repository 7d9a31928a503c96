//! Installs packages of Debian and Ubuntu where that is allowed.

use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::console::{Console, ask, which};
use crate::error::{Error, Result};
use crate::repo::is_ci;

/// One installation at a time: stages run in parallel.
static ONE: Mutex<()> = Mutex::new(());

/// Installs packages, or returns one line with the command to type.
pub(crate) fn install(console: &Console, packages: &[&str], why: &str) -> Result<()> {
    let list = packages.join(" ");
    let is_root = ask("id", &["-u"]).as_deref() == Some("0");
    // A CI computer may be changed; on others the user decides.
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
