//! Finds files, and works on many of them in parallel.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// The named files, and the files of the named folders, sorted by name.
pub(super) fn find(named: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for path in named {
        let before = found.len();
        if Path::new(path).is_dir() {
            folder(Path::new(path), &mut found);
        }
        if found.len() == before {
            // A file. A missing file is reported when it is read.
            found.push(path.clone());
        }
    }
    found
}

fn folder(path: &Path, found: &mut Vec<String>) {
    let Ok(entries) = std::fs::read_dir(path) else {
        return;
    };
    let mut entries: Vec<_> = entries.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        // Links to folders are not followed: they may form a circle.
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            folder(&path, found);
        } else if is_description(&path) && path.is_file() {
            found.push(path.display().to_string());
        }
    }
}

fn is_description(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["eds", "dcf", "xdd", "xdc"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

/// Results of `check` for each path, in order; one thread for each processor.
pub(super) fn at_once<T: Send>(paths: &[String], check: impl Fn(&str) -> T + Sync) -> Vec<T> {
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(paths.len()));
    let work = || {
        while let Some((at, path)) = {
            let at = next.fetch_add(1, Ordering::Relaxed);
            paths.get(at).map(|path| (at, path))
        } {
            let result = check(path);
            // A poisoned lock means that a thread panicked at another file; this result is valid.
            let mut done = done.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            done.push((at, result));
        }
    };
    thread::scope(|scope| {
        for _ in 1..workers.min(paths.len()) {
            scope.spawn(work);
        }
        work();
    });
    let mut done = done
        .into_inner()
        .unwrap_or_else(|poisoned| poisoned.into_inner());
    done.sort_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_paths() {
        let paths: Vec<String> = (0..500).map(|n| n.to_string()).collect();
        assert_eq!(at_once(&paths, str::to_owned), paths);
        assert_eq!(at_once(&[], str::len), [0; 0]);
    }
}
