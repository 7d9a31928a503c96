//! Processor time and end of a program with all that it started, as far as Linux tells it in `/proc`.

use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A process in `/proc`.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Process {
    id: u32,
    parent: u32,
    /// Its processor time, and that of its children that ended.
    used: Duration,
}

impl Process {
    /// Reads `/proc/NAME/stat`; `None` if the process ended, or the system has no `/proc`.
    fn read(name: &str) -> Option<Process> {
        Process::parse(&fs::read_to_string(format!("/proc/{name}/stat")).ok()?)
    }

    /// Reads the fields of proc_pid_stat(5): 1 is the ID, 4 the parent, 14 to 17 are times in 1/100 s.
    fn parse(text: &str) -> Option<Process> {
        // Field 2 is the name in parentheses, which may contain anything.
        let (id, _) = text.split_once(' ')?;
        let (_, fields) = text.rsplit_once(')')?;
        let fields: Vec<&str> = fields.split_whitespace().collect();
        let times = fields.get(11..15)?.iter();
        let ticks: u64 = times.filter_map(|field| field.parse::<u64>().ok()).sum();
        Some(Process {
            id: id.parse().ok()?,
            parent: fields.get(1)?.parse().ok()?,
            used: Duration::from_millis(ticks * 10),
        })
    }

    /// All processes that run.
    fn all() -> Vec<Process> {
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        names.filter_map(|name| Process::read(&name)).collect()
    }
}

/// The processor time of a process (`self`, or its number) and of its children that ended; `None` where the system
/// has no `/proc`.
pub(crate) fn processor_time(process: &str) -> Option<Duration> {
    Some(Process::read(process)?.used)
}

/// Stops a program and what it started, such as the tests that cargo runs, which would continue without it.
/// Returns the processor time of all of them. Where the system has no `/proc`, only the program is stopped.
pub(crate) fn stop(child: &mut Child) -> Duration {
    let mut known: Vec<Process> = Vec::new();
    loop {
        let all = family(&Process::all(), child.id());
        let is_known = |one: &Process| known.iter().any(|other| other.id == one.id);
        if all.iter().all(is_known) {
            break;
        }
        // A process that is held starts nothing more; the next look finds what it started before.
        signal("-STOP", &all);
        known = all;
    }
    signal("-KILL", &known);
    let _ = child.kill();
    let _ = child.wait();
    known.iter().map(|process| process.used).sum()
}

/// Sends a signal to processes; to one that ended nothing happens.
fn signal(name: &str, processes: &[Process]) {
    let mut kill = Command::new("kill");
    kill.arg(name);
    kill.args(processes.iter().map(|process| process.id.to_string()));
    let _ = kill.stdout(Stdio::null()).stderr(Stdio::null()).status();
}

/// A process, and those that it started, directly or through others.
fn family(all: &[Process], id: u32) -> Vec<Process> {
    let own = all.iter().filter(|process| process.id == id);
    let mut found: Vec<Process> = own.cloned().collect();
    let mut at = 0;
    while let Some(parent) = found.get(at).map(|process| process.id) {
        let children = all.iter().filter(|process| process.parent == parent);
        found.extend(children.cloned());
        at += 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::path::Path;
    use std::process::{Command, Stdio};
    use std::time::Duration;

    use super::{Process, family, stop};

    #[test]
    fn fields_of_a_process() {
        let text = "7 (a) b (c) S 5 7 7 0 -1 4194304 100 0 0 0 3 1 20 6 20 0 1 0 99 1 2\n";
        let process = Process {
            id: 7,
            parent: 5,
            used: Duration::from_millis(300),
        };
        assert_eq!(Process::parse(text), Some(process));
        assert_eq!(Process::parse("7 (a) S 5"), None);
        assert_eq!(Process::parse(""), None);
    }

    #[test]
    fn a_family_has_no_strangers() {
        let all = [(2, 1), (3, 2), (4, 1), (5, 3), (6, 2)];
        let all = all.map(|(id, parent)| Process {
            id,
            parent,
            used: Duration::ZERO,
        });
        let mut ids: Vec<u32> = family(&all, 2).iter().map(|process| process.id).collect();
        ids.sort_unstable();
        assert_eq!(ids, [2, 3, 5, 6]);
    }

    #[test]
    fn the_processes_of_a_program_end_with_it() {
        if !Path::new("/proc/self/stat").exists() {
            return;
        }
        // The shell waits for two programs; their output ends when they end.
        let mut shell = Command::new("sh");
        shell.args(["-c", "(sleep 600; :) & sleep 600 & echo ready; wait"]);
        let mut child = shell.stdout(Stdio::piped()).spawn().expect("a shell");
        let mut output = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        assert!(matches!(output.next(), Some(Ok(line)) if line == "ready"));
        stop(&mut child);
        assert!(output.next().is_none());
    }
}
