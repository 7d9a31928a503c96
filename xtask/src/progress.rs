//! Steps that run in parallel, with one line about them: what is done, what runs, what comes next, and the time.

use std::fs::{self, File};
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::console::{Console, say, seconds};
use crate::error::{Error, Result};
use crate::repo::Repo;

/// Lines of its log that a failed step shows.
const SHOWN: usize = 40;

/// The steps of a command. Their programs write into logs, so that a terminal has one line.
#[derive(Debug)]
pub(crate) struct Progress {
    logs: PathBuf,
    started: Instant,
    live: bool,
    steps: Mutex<Vec<Step>>,
    /// Set by the first step that fails: the programs of the others are stopped.
    stop: Arc<AtomicBool>,
}

#[derive(Debug)]
struct Step {
    name: &'static str,
    state: State,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Waiting,
    Running,
    Done,
}

impl Progress {
    /// Steps by their names, in the order in which they are shown.
    pub(crate) fn new(repo: &Repo, names: &[&'static str]) -> Result<Progress> {
        let logs = repo.cache().join("logs");
        fs::create_dir_all(&logs).map_err(|e| Error::io("create", &logs, &e))?;
        let waiting = |name: &&'static str| Step {
            name,
            state: State::Waiting,
        };
        Ok(Progress {
            logs,
            started: Instant::now(),
            live: std::io::stdout().is_terminal(),
            steps: Mutex::new(names.iter().map(waiting).collect()),
            stop: Arc::default(),
        })
    }

    /// Calls `work`, and shows the line on a terminal until it returns.
    pub(crate) fn show<T>(&self, work: impl FnOnce() -> T) -> T {
        let ended = AtomicBool::new(!self.live);
        thread::scope(|scope| {
            scope.spawn(|| {
                while !ended.load(Ordering::Relaxed) {
                    let mut out = std::io::stdout().lock();
                    // Erases the rest of a line that was longer.
                    let _ = write!(out, "\r{}\u{1b}[K", self.line());
                    let _ = out.flush();
                    drop(out);
                    thread::sleep(Duration::from_millis(200));
                }
            });
            let result = work();
            ended.store(true, Ordering::Relaxed);
            result
        })
    }

    /// Runs a step.
    ///
    /// # Errors
    ///
    /// Those of `work`. The first error also shows the end of the step's log, and stops the other steps.
    pub(crate) fn step<T>(
        &self,
        name: &'static str,
        work: impl FnOnce(&Console) -> Result<T>,
    ) -> Result<T> {
        let path = self.logs.join(format!("{}.log", name.replace(' ', "-")));
        let log = File::create(&path).map_err(|e| Error::io("create", &path, &e))?;
        let console = Console::to_log(log, Duration::MAX, false).stopped_by(&self.stop);
        self.set(name, State::Running);
        let started = Instant::now();
        let result = work(&console);
        self.set(name, State::Done);
        match &result {
            Ok(_) => self.say(&format!("  {name}: {}", seconds(started.elapsed()))),
            Err(_) if self.stop.swap(true, Ordering::Relaxed) => {}
            Err(_) => {
                let text = fs::read(&path).unwrap_or_default();
                let text = String::from_utf8_lossy(&text);
                let lines: Vec<&str> = text.lines().collect();
                for line in &lines[lines.len().saturating_sub(SHOWN)..] {
                    self.say(&format!("    {line}"));
                }
                self.say(&format!("  {name} failed; log: {}", path.display()));
            }
        }
        result
    }

    /// Whether a step failed. The errors of the others say only that they were stopped.
    pub(crate) fn failed(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn set(&self, name: &str, state: State) {
        let mut steps = self.steps();
        for step in steps.iter_mut().filter(|step| step.name == name) {
            step.state = state;
        }
    }

    fn steps(&self) -> MutexGuard<'_, Vec<Step>> {
        self.steps.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A line that stays, above the one about the steps.
    fn say(&self, line: &str) {
        say(&if self.live {
            format!("\r{line}\u{1b}[K")
        } else {
            String::from(line)
        });
    }

    fn line(&self) -> String {
        let steps = self.steps();
        let names = |state| -> Vec<&str> {
            let found = steps.iter().filter(|step| step.state == state);
            found.map(|step| step.name).collect()
        };
        let mut line = format!("  {:>4} s", self.started.elapsed().as_secs());
        for (what, state) in [("now", State::Running), ("next", State::Waiting)] {
            let names = names(state);
            if !names.is_empty() {
                line += &format!("  {what}: {}", names.join(", "));
            }
        }
        line
    }
}

#[cfg(test)]
mod tests {
    use super::{Progress, State};
    use crate::error::{Error, Result};
    use crate::repo::Repo;

    #[test]
    fn the_line_says_what_runs_and_what_comes() -> Result<()> {
        let target = std::env::temp_dir().join(format!("xtask-progress-{}", std::process::id()));
        let root = target.clone();
        let repo = Repo { root, target };
        let progress = Progress::new(&repo, &["module", "packages", "page"])?;
        progress.step("module", |_| Ok(()))?;
        progress.set("packages", State::Running);
        assert!(progress.line().ends_with("s  now: packages  next: page"));
        let fails = |_: &_| Err::<(), _>(Error::Failed(String::from("no network")));
        assert!(!progress.failed());
        assert!(progress.step("packages", fails).is_err() && progress.failed());
        let _ = std::fs::remove_dir_all(&repo.target);
        Ok(())
    }
}
