//! Packages of Debian and Ubuntu, where we are allowed to install them.

use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::console::{Console, ask, which};
use crate::error::{Error, Result};

/// One at a time: stages run beside each other.
static ONE: Mutex<()> = Mutex::new(());

/// Installs packages, or says in one line what to install and how.
pub(crate) fn install(console: &Console, packages: &[&str], why: &str) -> Result<()> {
    let list = packages.join(" ");
    if which("apt-get").is_none() || ask("id", &["-u"]).as_deref() != Some("0") {
        return Err(Error::Missing(format!(
            "{why}: please install it, on Debian with `sudo apt-get install {list}`"
        )));
    }
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut update = apt_get(&["update"]);
    console.run("fetching the package lists (apt-get update)", &mut update)?;
    let mut install = apt_get(&["install", "-y", "--no-install-recommends"]);
    install.args(packages);
    console.run(&format!("installing {list} with apt-get"), &mut install)
}

fn apt_get(args: &[&str]) -> Command {
    let mut command = Command::new("apt-get");
    command.arg("-q").args(args);
    command.env("DEBIAN_FRONTEND", "noninteractive");
    command
}
