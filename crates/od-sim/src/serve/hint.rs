//! Shows the long hint of the start once in each session of a terminal.

use std::io::IsTerminal;

#[cfg(unix)]
use super::process;

/// Returns whether to print the hint: once per session of a terminal, and always to a pipe.
/// `to_error`: it is printed to standard error.
pub(super) fn is_due(to_error: bool) -> bool {
    let is_terminal = if to_error {
        std::io::stderr().is_terminal()
    } else {
        std::io::stdout().is_terminal()
    };
    !is_terminal || begin(stamp().as_deref())
}

/// Leaves a stamp; `false` if it exists already. Without a folder for stamps the hint is always shown.
fn begin(stamp: Option<&std::path::Path>) -> bool {
    let Some(stamp) = stamp else {
        return true;
    };
    let created = std::fs::OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(stamp);
    !created.is_err_and(|error| error.kind() == std::io::ErrorKind::AlreadyExists)
}

/// The stamp file of this session, named after its leading process and the start time of that process.
#[cfg(unix)]
fn stamp() -> Option<std::path::PathBuf> {
    let leader = nix::unistd::getsid(None).ok()?;
    let user = nix::unistd::Uid::current();
    let start = process::started(u32::try_from(leader.as_raw()).ok()?).unwrap_or(0);
    let folder = std::env::var_os("XDG_RUNTIME_DIR").map(std::path::PathBuf::from);
    let folder = folder.filter(|folder| folder.is_absolute());
    let folder = folder.unwrap_or_else(std::env::temp_dir);
    Some(folder.join(format!("odkit-{user}-{leader}-{start}")))
}

#[cfg(not(unix))]
fn stamp() -> Option<std::path::PathBuf> {
    None
}

#[cfg(test)]
mod tests {
    use super::begin;

    #[test]
    fn a_hint_is_shown_once_where_a_stamp_can_be_left() {
        let stamp = std::env::temp_dir().join(format!("odkit-once-{}", std::process::id()));
        assert!(begin(Some(&stamp)));
        assert!(!begin(Some(&stamp)));
        std::fs::remove_file(&stamp).expect("it is there");
        let nowhere = stamp.join("nowhere");
        assert!(begin(Some(&nowhere)) && begin(Some(&nowhere)) && begin(None));
    }
}
