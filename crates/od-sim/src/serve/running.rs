//! Live benches: each leaves a report in a folder where programs of the same user look for it.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::process;
use super::ready::Ready;

/// Beginning of the file names.
const NAME: &str = "odkit-sim-";

/// Reports this bench to programs of this user until the value is dropped. `None`: the
/// file cannot be written.
pub(super) fn enrol(report: &str) -> Option<Ready> {
    let path = folder().join(format!("{NAME}{}{}.json", user(), std::process::id()));
    let mut ready = Ready::at(&path).ok()?;
    ready.write(report).ok()?;
    Some(ready)
}

/// The best link of each running bench of this user, in the form of `--link`.
pub fn links() -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder()).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_one = name.starts_with(&format!("{NAME}{}", user())) && name.ends_with(".json");
        if is_one && is_own(&entry.path()) {
            let text = fs::read_to_string(entry.path()).unwrap_or_default();
            let report: Value = serde_json::from_str(&text).unwrap_or_default();
            let number = |key: &str| report[key].as_u64().unwrap_or(0);
            if process::runs(number("pid"), number("started")) {
                found.extend(link(&report))
            } else {
                // Its process was killed.
                drop(fs::remove_file(entry.path()))
            }
        }
    }
    found.sort();
    found
}

/// The link of a report that most programs can open.
fn link(report: &Value) -> Option<String> {
    let links = report["links"].as_array()?;
    let of = |kind: &str, place: &str| {
        let place = |link: &Value| {
            let place = (link["link"] == kind).then(|| link[place].as_str())??;
            Some(format!("{kind}:{place}"))
        };
        links.iter().find_map(place)
    };
    of("slcan", "address")
        .or_else(|| of("socketcand", "address"))
        .or_else(|| of("socketcan", "interface"))
        .or_else(|| of("slcan", "path"))
}

/// A folder of this user, otherwise the folder for temporary files.
fn folder() -> PathBuf {
    let folder = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    let folder = folder.filter(|folder| folder.is_absolute() && folder.is_dir());
    folder.unwrap_or_else(std::env::temp_dir)
}

#[cfg(unix)]
fn user() -> String {
    format!("{}-", nix::unistd::Uid::effective())
}

#[cfg(not(unix))]
fn user() -> String {
    String::new()
}

/// Other users can write into the folder for temporary files, so check the owner.
#[cfg(unix)]
fn is_own(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let file = fs::symlink_metadata(path);
    file.is_ok_and(|file| file.is_file() && file.uid() == nix::unistd::Uid::effective().as_raw())
}

#[cfg(not(unix))]
fn is_own(_: &Path) -> bool {
    true
}
