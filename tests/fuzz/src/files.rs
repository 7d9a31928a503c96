//! Files of the repository: seeds, and inputs that failed.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// A file or folder of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

/// The inputs of a target in `tests/fuzz/found` or `tests/fuzz/corpus`, in the order of their names.
pub fn inputs(folder: &str, target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new("tests/fuzz").join(folder).join(target);
    let Ok(files) = fs::read_dir(repository("").join(folder)) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = files.flatten().map(|file| file.path()).collect();
    paths.sort();
    let read = paths.iter().map(fs::read);
    read.map(|input| input.expect("a file of the repository"))
        .collect()
}

/// Writes an input to the folder of its target in `tests/fuzz/found`, under a name that follows from its
/// bytes. Returns its path in the repository.
///
/// # Errors
/// The folder or the file cannot be written.
pub fn keep(target: &str, input: &[u8]) -> io::Result<String> {
    let folder = format!("tests/fuzz/found/{target}");
    fs::create_dir_all(repository(&folder))?;
    let sum = input.iter().fold(0xCBF2_9CE4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3)
    });
    let path = format!("{folder}/{sum:016x}.input");
    fs::write(repository(&path), input)?;
    Ok(path)
}

/// The text files of a folder with these endings, its own folders included, up to a length.
///
/// # Panics
/// If the folder or one of its files cannot be read.
pub fn files(folder: &str, endings: &[&str], longest: usize) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut folders = vec![repository(folder)];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).expect("a folder of the repository");
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push((name, fs::read(&path).expect("a file of the repository")));
            }
        }
    }
    // The order of folder entries differs between systems.
    found.sort();
    let short = found.into_iter().map(|(_, bytes)| bytes);
    short.filter(|bytes| bytes.len() <= longest).collect()
}
