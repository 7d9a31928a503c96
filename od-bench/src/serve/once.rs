//! The long hint at the start: once in each session of a terminal.

use std::io::IsTerminal;

/// Whether the hint is to be printed: not to a terminal that has seen it, but always to a pipe.
/// `to_error`: it goes to standard error.
pub(super) fn is_due(to_error: bool) -> bool {
    let is_terminal = if to_error {
        std::io::stderr().is_terminal()
    } else {
        std::io::stdout().is_terminal()
    };
    !is_terminal || begin(stamp().as_deref())
}

/// Leaves a stamp; `false` if it is there already. Without a place for it every time is the first.
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

/// A file for this session: by the process that leads it, and when that one was started.
#[cfg(unix)]
fn stamp() -> Option<std::path::PathBuf> {
    let leader = nix::unistd::getsid(None).ok()?;
    let user = nix::unistd::Uid::current();
    let status = std::fs::read_to_string(format!("/proc/{leader}/stat")).unwrap_or_default();
    // The name of the program is in parentheses, with any characters; field 22 is the start.
    let rest = status.rsplit(')').next().unwrap_or_default();
    let start = rest.split_whitespace().nth(19).unwrap_or("0");
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
    fn a_hint_is_due_once_where_it_can_be_noted() {
        let stamp = std::env::temp_dir().join(format!("odkit-once-{}", std::process::id()));
        assert!(begin(Some(&stamp)));
        assert!(!begin(Some(&stamp)));
        std::fs::remove_file(&stamp).expect("it is there");
        let nowhere = stamp.join("nowhere");
        assert!(begin(Some(&nowhere)) && begin(Some(&nowhere)) && begin(None));
    }
}
