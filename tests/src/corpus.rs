//! Device files: those of `tests/corpus`, or of the folder that `ODKIT_CORPUS` names.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Endings of EDS and DCF files.
pub const TEXTS: &[&str] = &["eds", "dcf"];

/// Endings of all files that odkit reads.
pub const ALL: &[&str] = &["eds", "dcf", "xdd", "xdc", "xpd"];

/// The corpus of this repository. Each file has one trait of files that are in use; its first lines name
/// the trait and the codes that odkit reports for it.
pub fn own() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")
}

/// The folder that tests of many files read: the one that `ODKIT_CORPUS` names, otherwise [`own`].
///
/// # Panics
///
/// If `ODKIT_CORPUS` names no folder: a test must not pass without its input.
pub fn folder() -> PathBuf {
    let folder = env::var_os("ODKIT_CORPUS").map_or_else(own, PathBuf::from);
    assert!(
        folder.is_dir(),
        "ODKIT_CORPUS does not name a folder: {}",
        folder.display()
    );
    folder
}

/// The files below a folder with one of these endings, in the order of their paths.
pub fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let (mut folders, mut files) = (vec![PathBuf::from(folder)], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|known| ending == *known) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// Looks at each of the files, on all processors.
pub fn each(files: &[PathBuf], look: impl Fn(&Path) + Sync) {
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
            look(file);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
}
