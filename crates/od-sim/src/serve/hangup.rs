//! Closing the terminal ends the bench, unless the bench was started with `nohup` or the like.

/// Keeps SIGHUP ignored if it was ignored at the start, as `nohup` sets it.
#[cfg(unix)]
pub(super) fn respect() {
    use nix::sys::signal::{SigSet, Signal};

    if is_ignored().unwrap_or(false) {
        // ctrlc would handle the signal in any case; a blocked signal never reaches it.
        let mut signals = SigSet::empty();
        signals.add(Signal::SIGHUP);
        let _ = signals.thread_block();
    }
}

/// Other systems have no such signal.
#[cfg(not(unix))]
pub(super) fn respect() {}

/// SIGHUP is the first bit of the set of ignored signals.
#[cfg(target_os = "linux")]
fn is_ignored() -> Option<bool> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mut lines = status.lines();
    let set = lines.find_map(|line| line.strip_prefix("SigIgn:"))?;
    Some(u64::from_str_radix(set.trim(), 16).ok()? & 1 != 0)
}

/// Asking the system directly would need `unsafe`.
#[cfg(all(unix, not(target_os = "linux")))]
fn is_ignored() -> Option<bool> {
    let id = std::process::id().to_string();
    let mut ps = std::process::Command::new("ps");
    let output = ps.args(["-o", "sigignore=", "-p", &id]).output().ok()?;
    let set = String::from_utf8(output.stdout).ok()?;
    Some(u64::from_str_radix(set.trim(), 16).ok()? & 1 != 0)
}
