//! Paths of the repository: its root, and folders that commands use.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Whether `CI` is set. A missing tool is then an error; otherwise the stage is skipped.
pub(crate) fn is_ci() -> bool {
    env::var("CI").is_ok_and(|value| value == "true" || value == "1")
}

/// The name of a program's file.
pub(crate) fn program(name: &str) -> String {
    format!("{name}{}", env::consts::EXE_SUFFIX)
}

/// The repository's folders.
#[derive(Debug, Clone)]
pub(crate) struct Repo {
    /// The workspace's root.
    pub(crate) root: PathBuf,
    /// Cargo's target directory.
    pub(crate) target: PathBuf,
}

impl Repo {
    /// Finds the workspace that this program was built from.
    pub(crate) fn locate() -> Result<Repo> {
        let manifest = env::var_os("CARGO_MANIFEST_DIR")
            .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
        let root = manifest
            .parent()
            .filter(|root| root.join("Cargo.toml").is_file())
            .ok_or_else(|| Error::Failed(String::from("run this with `cargo xtask`")))?
            .to_path_buf();
        let target = match env::var_os("CARGO_TARGET_DIR") {
            Some(dir) if !dir.is_empty() => std::path::absolute(PathBuf::from(dir))
                .map_err(|e| Error::Failed(format!("CARGO_TARGET_DIR: {e}")))?,
            _ => root.join("target"),
        };
        Ok(Repo { root, target })
    }

    /// Tools that xtask fetched or built; they outlive `cargo clean`.
    pub(crate) fn tools(&self) -> PathBuf {
        self.root.join(".xtask")
    }

    /// Files that xtask itself makes: logs, the Python environment.
    pub(crate) fn cache(&self) -> PathBuf {
        self.target.join("xtask")
    }

    /// The TypeScript page.
    pub(crate) fn web(&self) -> PathBuf {
        self.root.join("playground").join("web")
    }

    /// The output of wasm-bindgen, which the page's bundle reads.
    pub(crate) fn bindings(&self) -> PathBuf {
        self.web().join("src").join("wasm")
    }

    /// The bundled page.
    pub(crate) fn dist(&self) -> PathBuf {
        self.web().join("dist")
    }

    /// The version of a package in the workspace's Cargo.lock.
    pub(crate) fn locked_version(&self, package: &str) -> Result<String> {
        let path = self.root.join("Cargo.lock");
        let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
        lock_version(&text, package)
            .map(String::from)
            .ok_or_else(|| Error::Failed(format!("Cargo.lock has no package {package}")))
    }

    /// The oldest Rust that the workspace promises: `rust-version` in its Cargo.toml.
    pub(crate) fn oldest_rust(&self) -> Result<String> {
        let path = self.root.join("Cargo.toml");
        let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
        let line = text
            .lines()
            .find_map(|line| line.strip_prefix("rust-version = "));
        let version = line.map(|value| String::from(value.trim_matches('"')));
        version.ok_or_else(|| Error::Failed(String::from("Cargo.toml has no rust-version")))
    }

    /// `path` as seen from the root, for messages.
    pub(crate) fn short<'a>(&self, path: &'a Path) -> std::path::Display<'a> {
        path.strip_prefix(&self.root).unwrap_or(path).display()
    }
}

/// The `version` line that follows `name = "package"` in a Cargo.lock.
fn lock_version<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let name = format!("name = \"{package}\"");
    let mut lines = lock.lines().skip_while(|line| *line != name);
    lines.next()?;
    lines
        .next()?
        .strip_prefix("version = \"")?
        .strip_suffix('"')
}

#[cfg(test)]
mod tests {
    use super::lock_version;

    #[test]
    fn version_is_read_from_the_lock_file() {
        let lock = "[[package]]\nname = \"wasm-bindgen-macro\"\nversion = \"9.9.9\"\n\n\
                    [[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.130\"\n";
        assert_eq!(lock_version(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(lock_version(lock, "wasm"), None);
        assert_eq!(lock_version("", "wasm-bindgen"), None);
    }
}
