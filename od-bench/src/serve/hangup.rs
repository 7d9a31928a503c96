//! A terminal that closes ends the bench, unless it was started to outlive it.

/// Keeps SIGHUP ignored if it was at the start, as `nohup` does it.
#[cfg(unix)]
pub(super) fn respect() {
    use nix::sys::signal::{SigSet, Signal};

    if is_ignored().unwrap_or(false) {
        // ctrlc handles the signal whatever was before; a blocked one never reaches it.
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

/// To ask the system itself would need `unsafe`.
#[cfg(all(unix, not(target_os = "linux")))]
fn is_ignored() -> Option<bool> {
    let id = std::process::id().to_string();
    let mut ps = std::process::Command::new("ps");
    let output = ps.args(["-o", "sigignore=", "-p", &id]).output().ok()?;
    let set = String::from_utf8(output.stdout).ok()?;
    Some(u64::from_str_radix(set.trim(), 16).ok()? & 1 != 0)
}
