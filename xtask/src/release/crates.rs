//! The package of each crate.

use std::fs;
use std::path::{Path, PathBuf};

use super::dist::Dist;
use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::files;
use crate::packages::UNPUBLISHED;
use crate::repo::Repo;

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    for file in pack(dist.repo, dist.console)? {
        let name = file.file_name().unwrap_or_default();
        files::copy(&file, &folder.join(name))?;
    }
    Ok(())
}

/// Packs every published crate and returns the files.
pub(crate) fn pack(repo: &Repo, console: &Console) -> Result<Vec<PathBuf>> {
    let packed = repo.target.join("package");
    // Files of an earlier run would count as packed.
    let _ = fs::remove_dir_all(&packed);
    let mut command = cargo(&repo.root, &["package", "--workspace", "--no-verify"]);
    command.args(["--allow-dirty", "--quiet"]);
    command.args(UNPUBLISHED.iter().flat_map(|name| ["--exclude", name]));
    console.run("packages", &mut command)?;
    let mut files = files::entries(&packed)?;
    files.retain(|path| path.extension().is_some_and(|ending| ending == "crate"));
    if files.is_empty() {
        return Err(Error::Failed(String::from("cargo packed no crate")));
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// crates.io, docs.rs and `cargo binstall` read them.
    #[test]
    fn a_published_crate_names_repository_and_documentation() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let manifest =
            |folder: &Path| fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        let mut folders = files::entries(&root.join("crates")).unwrap_or_default();
        folders.extend(["od-model", "od-macros", "devices"].map(|name| root.join(name)));
        let mut count = 0;
        for folder in folders {
            let text = manifest(&folder);
            let has = |line: &str| text.contains(&format!("\n{line}"));
            assert!(has("repository.workspace = true\n"), "{}", folder.display());
            assert!(
                has("documentation = \"https://docs.rs/"),
                "{}",
                folder.display()
            );
            // docs.rs shows what needs a feature, and which one.
            if has("[features]\n") {
                let library = fs::read_to_string(folder.join("src/lib.rs")).unwrap_or_default();
                assert!(
                    has("[package.metadata.docs.rs]\nall-features = true\n"),
                    "{}",
                    folder.display()
                );
                assert!(
                    library.contains("#![cfg_attr(docsrs, feature(doc_cfg))]"),
                    "{}",
                    folder.display()
                );
            }
            count += 1;
        }
        assert!(count > 12);
        assert!(manifest(&root).contains("\nrepository = "));
    }
}
