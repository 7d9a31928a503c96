//! Origin of odkit's crates in a new crate: copies, the registry, or a checkout.

use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;

/// Paths and contents of the embedded crates; empty if this program was built from the
/// registry.
const VENDORED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/vendored.rs"));

/// Folder of the vendored crates in the new crate.
const VENDOR: &str = "vendor";

/// Origin of odkit's crates.
pub(super) enum Origin {
    /// Copies in the folder `vendor` of the new crate.
    Vendor,
    /// The published crates of this version.
    Registry,
    /// The crates of a checkout, or of copies that lie side by side, by the path relative to the new crate.
    Checkout(String),
}

impl Origin {
    /// The published crates with `registry`, the folder `checkout` if it is given, and otherwise copies if this
    /// program has them. `folder` is the folder of the new crate.
    ///
    /// # Errors
    /// `checkout` is not a checkout of odkit.
    pub(super) fn new(
        registry: bool,
        checkout: Option<&Path>,
        folder: &Path,
    ) -> Result<Self, Failure> {
        let Some(checkout) = checkout else {
            let has_copies = !registry && !VENDORED.is_empty();
            return Ok(if has_copies {
                Self::Vendor
            } else {
                Self::Registry
            });
        };
        let mut crates = checkout.join("crates");
        if !crates.is_dir() {
            crates = checkout.to_path_buf();
        }
        let is_missing = |name: &&str| !crates.join(name).join("Cargo.toml").is_file();
        let missing = ["odkit", "od-sim"].into_iter().find(is_missing);
        if let Some(name) = missing {
            return Err(Failure::Failed(format!(
                "{} is not a checkout of odkit: it has no crate `{name}`",
                checkout.display()
            )));
        }
        let relative = from_to(folder, &crates)?;
        // Cargo reads `/` on every system.
        let path = relative.display().to_string().replace('\\', "/");
        Ok(Self::Checkout(path))
    }

    /// The value of a dependency in a manifest of the root folder; `features` is empty, or the text that
    /// follows the version.
    pub(super) fn dependency(&self, name: &str, features: &str) -> String {
        let path = match self {
            Self::Vendor => format!("{VENDOR}/{name}"),
            Self::Checkout(path) => format!("{path}/{name}"),
            Self::Registry => {
                let version = env!("CARGO_PKG_VERSION");
                return format!("{name} = {{ version = \"{version}\"{features} }}");
            }
        };
        format!("{name} = {{ path = {}{features} }}", toml(&path))
    }

    /// The copies, by their paths in the new crate.
    pub(super) fn files(&self) -> Vec<(String, Vec<u8>)> {
        let all = match self {
            Self::Vendor => VENDORED,
            _ => &[],
        };
        let file = |(path, content): &(&str, &[u8])| (format!("{VENDOR}/{path}"), content.to_vec());
        all.iter().map(file).collect()
    }

    /// Lines for the table `[workspace]` of the root folder: the copies are a workspace of their own.
    pub(super) const fn exclude(&self) -> &'static str {
        match self {
            Self::Vendor => "exclude = [\"vendor\"]\n",
            _ => "",
        }
    }

    /// A sentence for the README.
    pub(super) fn about(&self) -> String {
        let version = env!("CARGO_PKG_VERSION");
        match self {
            Self::Vendor => format!(
                "- `vendor/`: the sources of odkit {version}, so that nothing else is needed; \
                 `odkit new --registry` writes versions instead\n"
            ),
            _ => String::new(),
        }
    }
}

/// A literal string of TOML can hold any path without an apostrophe.
fn toml(text: &str) -> String {
    if text.contains('\'') {
        format!("{text:?}")
    } else {
        format!("'{text}'")
    }
}

/// The relative path from a folder, which need not exist, to an existing one; the absolute path if it is on
/// another drive.
fn from_to(folder: &Path, to: &Path) -> Result<PathBuf, Failure> {
    let absolute = std::path::absolute(folder)?;
    // Only an existing path has a canonical form. Missing folders keep their names.
    let mut from = PathBuf::new();
    for ancestor in absolute.ancestors() {
        if let Ok(known) = ancestor.canonicalize() {
            from = known.join(absolute.strip_prefix(ancestor).unwrap_or(&absolute));
            break;
        }
    }
    let to = to.canonicalize()?;
    Ok(relative(&from, &to).unwrap_or(to))
}

/// The relative path from one absolute path to another, if they have a common root.
fn relative(from: &Path, to: &Path) -> Option<PathBuf> {
    let common = from.components().zip(to.components());
    let common = common.take_while(|(one, other)| one == other).count();
    if common == 0 {
        return None;
    }
    let up = from.components().skip(common).map(|_| Component::ParentDir);
    Some(up.chain(to.components().skip(common)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkout_is_named_by_its_relative_path() {
        let way = |from: &str, to: &str| relative(Path::new(from), Path::new(to));
        let path = |text: &str| Some(PathBuf::from(text));
        assert_eq!(way("/home/me/gate", "/home/me/odkit"), path("../odkit"));
        assert_eq!(way("/a/b/c", "/d"), path("../../../d"));
        assert_eq!(way("/a/odkit/x", "/a/odkit"), path(".."));
        assert_eq!(toml("/a b"), "'/a b'");
        assert_eq!(toml("it's"), "\"it's\"");
    }

    #[test]
    fn all_crates_that_a_device_needs_are_embedded() {
        for path in [
            "Cargo.toml",
            "LICENSE-MIT",
            "odkit/src/lib.rs",
            "od-sim/Cargo.toml",
            "od-eds/src/rules/mod.rs",
        ] {
            assert!(VENDORED.iter().any(|(at, _)| *at == path), "{path}");
        }
        assert!(!VENDORED.iter().any(|(at, _)| at.contains("/tests")));
    }
}
