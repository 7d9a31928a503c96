//! Finds Node.js and npm; it does not install them.

use std::path::Path;
use std::process::Command;

use crate::console::{Console, ask};
use crate::error::{Error, Result};
use crate::stamp::{Fingerprint, Stamp};

/// The oldest Node.js that was tested.
const OLDEST: u32 = 20;

/// npm is a script; Windows starts it only by its full name.
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Checks that Node.js and npm exist and that Node.js is new enough.
pub(crate) fn check() -> Result<()> {
    let how = "please install Node.js 20 or newer with npm (https://nodejs.org)";
    let version = ask("node", &["--version"])
        .ok_or_else(|| Error::Missing(format!("`node` is not on PATH: {how}")))?;
    if major(&version).is_none_or(|major| major < OLDEST) {
        return Err(Error::Missing(format!(
            "Node.js {version} is too old: {how}"
        )));
    }
    if ask(NPM, &["--version"]).is_none() {
        return Err(Error::Missing(format!("`npm` is not on PATH: {how}")));
    }
    Ok(())
}

/// An npm command that runs in `dir`.
pub(crate) fn npm(dir: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(NPM);
    command.args(args).current_dir(dir);
    command
}

/// `npm ci` in `dir`, if package-lock.json changed since the last time.
pub(crate) fn ci(console: &Console, dir: &Path, what: &str) -> Result<()> {
    let modules = dir.join("node_modules");
    let inputs = Fingerprint::new()
        .file(&dir.join("package.json"))?
        .file(&dir.join("package-lock.json"))?;
    let stamp = Stamp::new(modules.join(".xtask-stamp"), inputs);
    if stamp.is_current(&[]) {
        return Ok(());
    }
    // No package here needs an install script, and scripts that do not run do no harm.
    let args = ["ci", "--ignore-scripts", "--no-audit", "--no-fund"];
    console.run(what, &mut npm(dir, &args))?;
    stamp.set()
}

/// The major number of `v20.20.2`.
fn major(version: &str) -> Option<u32> {
    version.strip_prefix('v')?.split_once('.')?.0.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::major;

    #[test]
    fn node_versions() {
        assert_eq!(major("v20.20.2"), Some(20));
        assert_eq!(major("v9.1.0"), Some(9));
        assert_eq!(major("20"), None);
        assert_eq!(major(""), None);
    }
}
