//! Files of the disk and project settings, for the language server.

use std::fs;
use std::path::Path;

use od_eds::Finding;
use od_lsp::Host;

use crate::config::Config;

/// Reads files from the disk.
pub(super) struct Disk;

impl Host for Disk {
    fn read(&self, path: &str) -> Option<Vec<u8>> {
        fs::read(path).ok()
    }

    fn beside(&self, path: &str) -> Vec<String> {
        let Some(folder) = Path::new(path).parent() else {
            return Vec::new();
        };
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<String> = entries
            .map(|entry| entry.path().display().to_string())
            .collect();
        paths.sort();
        paths
    }

    fn judge(&self, path: &str, findings: &mut Vec<Finding>) -> Result<(), String> {
        let config = Config::of(path).map_err(|failure| failure.to_string())?;
        config.apply(path, findings);
        Ok(())
    }
}
