//! Inputs that failed once, kept for ever.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The inputs of a target that failed once, in the order of their names.
pub fn load(folder: &Path, target: &str) -> Vec<Vec<u8>> {
    let Ok(files) = fs::read_dir(folder.join(target)) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = files.flatten().map(|file| file.path()).collect();
    paths.sort();
    paths
        .iter()
        .filter_map(|path| fs::read(path).ok())
        .collect()
}

/// Writes an input to the folder of its target, under a name that follows from its bytes.
///
/// # Errors
/// The folder or the file cannot be written.
pub fn keep(folder: &Path, target: &str, input: &[u8]) -> io::Result<PathBuf> {
    let folder = folder.join(target);
    fs::create_dir_all(&folder)?;
    let sum = input.iter().fold(0xCBF2_9CE4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3)
    });
    let path = folder.join(format!("{sum:016x}.input"));
    fs::write(&path, input)?;
    Ok(path)
}
