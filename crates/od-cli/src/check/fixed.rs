//! A fixed file: shown as a diff, or written.

use std::path::Path;
use std::time::Duration;

use od_sim::serve::files;
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
    let replaced = files::replace(&[(Path::new(path), bytes)]);
    replaced.map_err(|(_, error)| format!("it cannot be written: {error}"))
}
