//! Processes: which one a number means, and what limits ours.

/// Returns the start of a process; `None`: it does not run, or the system does not say.
///
/// In clock ticks since the computer started, as `/proc/PID/stat` has it.
#[cfg(target_os = "linux")]
pub(super) fn started(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of a program may have blanks and parentheses; the start is the 22nd field.
    let (_, fields) = status.rsplit_once(')')?;
    fields.split_whitespace().nth(19)?.parse().ok()
}

#[cfg(not(target_os = "linux"))]
pub(super) fn started(_: u32) -> Option<u64> {
    None
}

/// Returns whether the process runs that had this number and this start; 0: its start is not known.
pub(super) fn runs(process: u64, start: u64) -> bool {
    let Some(number) = u32::try_from(process).ok().filter(|number| *number > 0) else {
        return false;
    };
    is_there(number) && started(number).is_none_or(|own| start == 0 || own == start)
}

#[cfg(unix)]
fn is_there(process: u32) -> bool {
    // No signal: only whether one could be sent.
    let id = i32::try_from(process).map(nix::unistd::Pid::from_raw);
    id.is_ok_and(|id| nix::sys::signal::kill(id, None).is_ok())
}

#[cfg(not(unix))]
fn is_there(_: u32) -> bool {
    true
}

/// Makes a write beyond the limit of `ulimit -f` an error, which is a message, instead of a signal,
/// which ends the process. For this thread and those that it starts.
#[cfg(unix)]
pub(super) fn survive_file_limit() {
    use nix::sys::signal::{SigSet, Signal};

    let mut signals = SigSet::empty();
    signals.add(Signal::SIGXFSZ);
    let _ = signals.thread_block();
}

#[cfg(not(unix))]
pub(super) fn survive_file_limit() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_is_a_number_and_a_start() {
        let own = std::process::id();
        let start = started(own).unwrap_or(0);
        assert!(runs(own.into(), start) && runs(own.into(), 0));
        assert!(!runs(0, 0) && !runs(u64::MAX, 0));
        if start > 0 {
            assert!(!runs(own.into(), start + 1));
        }
    }
}
