//! Processes: whether one still runs; the signals of this one when a file is full or the terminal closes.

/// Returns the start time of a process; `None`: it does not run, or the system does not tell.
///
/// In clock ticks since the start of the computer, from `/proc/PID/stat`.
#[cfg(target_os = "linux")]
pub(super) fn started(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // A program name may contain blanks and parentheses; the start time is field 22.
    let (_, fields) = status.rsplit_once(')')?;
    fields.split_whitespace().nth(19)?.parse().ok()
}

#[cfg(not(target_os = "linux"))]
pub(super) fn started(_: u32) -> Option<u64> {
    None
}

/// Returns whether the process with this number and start time still runs; 0: its start time is unknown.
pub(super) fn runs(process: u64, start: u64) -> bool {
    let Some(number) = u32::try_from(process).ok().filter(|number| *number > 0) else {
        return false;
    };
    is_there(number) && started(number).is_none_or(|own| start == 0 || own == start)
}

#[cfg(unix)]
fn is_there(process: u32) -> bool {
    // Signal 0 sends nothing: it only tests whether a signal could be sent.
    let id = i32::try_from(process).map(nix::unistd::Pid::from_raw);
    id.is_ok_and(|id| nix::sys::signal::kill(id, None).is_ok())
}

#[cfg(not(unix))]
fn is_there(_: u32) -> bool {
    true
}

/// Keeps SIGHUP ignored if it was ignored at the start, as `nohup` sets it; otherwise closing the terminal ends the bench.
#[cfg(unix)]
pub(super) fn respect_nohup() {
    use nix::sys::signal::{SigSet, Signal};

    if ignores_hangup().unwrap_or(false) {
        // ctrlc would handle the signal in any case; a blocked signal never reaches it.
        let mut signals = SigSet::empty();
        signals.add(Signal::SIGHUP);
        let _ = signals.thread_block();
    }
}

/// Other systems have no such signal.
#[cfg(not(unix))]
pub(super) fn respect_nohup() {}

/// SIGHUP is the first bit of the set of ignored signals.
#[cfg(target_os = "linux")]
fn ignores_hangup() -> Option<bool> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mut lines = status.lines();
    let set = lines.find_map(|line| line.strip_prefix("SigIgn:"))?;
    Some(u64::from_str_radix(set.trim(), 16).ok()? & 1 != 0)
}

/// Asking the system directly would need `unsafe`.
#[cfg(all(unix, not(target_os = "linux")))]
fn ignores_hangup() -> Option<bool> {
    let id = std::process::id().to_string();
    let mut ps = std::process::Command::new("ps");
    let output = ps.args(["-o", "sigignore=", "-p", &id]).output().ok()?;
    let set = String::from_utf8(output.stdout).ok()?;
    Some(u64::from_str_radix(set.trim(), 16).ok()? & 1 != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_is_identified_by_number_and_start_time() {
        let own = std::process::id();
        let start = started(own).unwrap_or(0);
        assert!(runs(own.into(), start) && runs(own.into(), 0));
        assert!(!runs(0, 0) && !runs(u64::MAX, 0));
        if start > 0 {
            assert!(!runs(own.into(), start + 1));
        }
    }
}
