//! Packages of Debian and Ubuntu, where we are allowed to install them.

use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::console::{Console, ask, which};
use crate::error::{Error, Result};

/// The package lists are fetched once per run.
static UPDATED: AtomicBool = AtomicBool::new(false);

/// Is this a system with apt on which we are root?
pub(crate) fn can_install() -> bool {
    which("apt-get").is_some() && ask("id", &["-u"]).as_deref() == Some("0")
}

/// Installs packages, or says in one line what to install and how.
pub(crate) fn install(console: &Console, packages: &[&str], why: &str) -> Result<()> {
    let list = packages.join(" ");
    if !can_install() {
        return Err(Error::Missing(format!(
            "{why}: please install it, on Debian with `sudo apt-get install {list}`"
        )));
    }
    update(console)?;
    let mut apt = apt_get();
    apt.args(["install", "-y", "--no-install-recommends"])
        .args(packages);
    console.run(&format!("installing {list} with apt-get"), &mut apt)
}

/// The version that apt-get would install, after fetching the package lists.
pub(crate) fn candidate(console: &Console, package: &str) -> Result<Option<String>> {
    update(console)?;
    Ok(ask("apt-cache", &["policy", package]).and_then(|policy| {
        policy
            .lines()
            .find_map(|line| line.trim().strip_prefix("Candidate: "))
            .filter(|version| *version != "(none)")
            .map(String::from)
    }))
}

fn update(console: &Console) -> Result<()> {
    if !UPDATED.swap(true, Ordering::Relaxed) {
        console.run(
            "fetching the package lists (apt-get update)",
            apt_get().arg("update"),
        )?;
    }
    Ok(())
}

fn apt_get() -> Command {
    let mut command = Command::new("apt-get");
    command.arg("-q").env("DEBIAN_FRONTEND", "noninteractive");
    command
}
