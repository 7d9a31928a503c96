//! A fixed file: shown as a diff, or written.

use std::fs;
use std::path::Path;
use std::time::Duration;

use similar::TextDiff;

/// Time after which a diff of many lines shows more lines than it must.
const DIFF_TIME: Duration = Duration::from_millis(500);

/// A unified diff between two texts; empty if they are equal.
pub(super) fn difference(path: &str, before: &str, after: &str) -> String {
    let mut config = TextDiff::configure();
    let diff = config.timeout(DIFF_TIME).diff_lines(before, after);
    let shown = diff
        .unified_diff()
        .context_radius(3)
        .header(path, path)
        .to_string();
    // A carriage return would move the cursor of a terminal back.
    shown.replace('\r', "")
}

/// Replaces a file in one step: other programs see the old file or the new one.
pub(crate) fn write(path: &str, bytes: &[u8]) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("it cannot be written: {error}");
    // A link leads to the file to replace.
    let path = fs::canonicalize(path).map_err(failed)?;
    if fs::metadata(&path).is_ok_and(|meta| meta.permissions().readonly()) {
        return Err("it cannot be written: it is read only".to_owned());
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let beside = path.parent().unwrap_or(Path::new("")).join(name);
    let written = fs::write(&beside, bytes)
        .and_then(|()| {
            let permissions = fs::metadata(&path)?.permissions();
            fs::set_permissions(&beside, permissions)
        })
        .and_then(|()| fs::rename(&beside, &path));
    if written.is_err() {
        // If this fails, too, nothing more can be done.
        let _ = fs::remove_file(&beside);
    }
    written.map_err(failed)
}
