//! Finds Node.js and npm; it does not install them.

use std::path::Path;
use std::process::Command;

use crate::console::{Console, ask};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::stamp::{Fingerprint, Stamp};

/// The oldest Node.js that has all that is used here: the first with `--test-concurrency`. package.json of the browser tests
/// and of the page name it as well.
const OLDEST: (u32, u32) = (20, 10);

/// npm is a script; Windows starts it only by its full name.
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Checks that Node.js and npm exist and that Node.js is new enough.
pub(crate) fn check() -> Result<()> {
    let oldest = format!("{}.{}", OLDEST.0, OLDEST.1);
    let how = format!("install Node.js {oldest} or newer with npm (https://nodejs.org)");
    let found = ask("node", &["--version"])
        .ok_or_else(|| Error::Missing(format!("`node` is not on PATH: {how}")))?;
    if version(&found).is_none_or(|version| version < OLDEST) {
        return Err(Error::Missing(format!(
            "`node` on PATH is {found}, and {oldest} is the oldest that works here: {how}"
        )));
    }
    if ask(NPM, &["--version"]).is_none() {
        return Err(Error::Missing(format!("`npm` is not on PATH: {how}")));
    }
    Ok(())
}

/// `node --test` in `dir`, which also names the tests that take long.
pub(crate) fn tests(repo: &Repo, dir: &Path) -> Command {
    let long = repo.root.join("xtask/tools/long.mjs");
    let mut command = Command::new("node");
    command.arg("--test").current_dir(dir);
    for reporter in [Path::new("tap"), &long] {
        command.arg("--test-reporter").arg(reporter);
        command.arg("--test-reporter-destination=stdout");
    }
    command
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

/// Major and minor number of `v20.20.2`.
fn version(text: &str) -> Option<(u32, u32)> {
    let mut numbers = text.strip_prefix('v')?.split('.');
    let mut next = || numbers.next()?.parse().ok();
    Some((next()?, next()?))
}

#[cfg(test)]
mod tests {
    use super::{OLDEST, version};
    use crate::files;

    #[test]
    fn node_versions() {
        assert_eq!(version("v20.20.2"), Some((20, 20)));
        assert_eq!(version("v9.1.0"), Some((9, 1)));
        for wrong in ["20.1.0", "v20", "v", ""] {
            assert_eq!(version(wrong), None, "{wrong}");
        }
        assert!(version("v20.9.0") < Some(OLDEST) && version("v20.10.0") >= Some(OLDEST));
        assert!(version("v22.0.0") > Some(OLDEST));
    }

    #[test]
    fn packages_name_the_oldest_node() {
        let (major, minor) = OLDEST;
        let wanted = format!("\"node\": \">={major}.{minor}\"");
        for name in ["tests/browser", "playground/web"] {
            for file in ["package.json", "package-lock.json"] {
                let path = format!("{}/../{name}/{file}", env!("CARGO_MANIFEST_DIR"));
                let text = files::read(path.as_ref()).expect("it can be read");
                assert!(text.contains(&wanted), "{name}/{file}");
            }
        }
    }
}
