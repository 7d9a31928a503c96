//! Device files: those of the corpus, and those of a folder.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Endings of EDS and DCF files.
pub const TEXTS: &[&str] = &["eds", "dcf"];

/// Endings of all files that odkit reads.
pub const ALL: &[&str] = &["eds", "dcf", "xdd", "xdc", "xpd"];

/// The folder of the corpus: `ODKIT_CORPUS`, or `shared/corpus` beside the workspace. `None`, with
/// a message, if it does not exist.
///
/// # Panics
///
/// If `CI` is set and the folder does not exist: a test must not pass without its input.
pub fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/corpus");
    let folder = env::var_os("ODKIT_CORPUS").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    let text = "no corpus: set ODKIT_CORPUS to a folder of device files";
    assert!(env::var_os("CI").is_none(), "{text}");
    println!("{text}");
    None
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
