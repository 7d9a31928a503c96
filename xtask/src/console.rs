//! Runs programs: in `play` with their output on the terminal, in `test` in a log.

use std::cell::{Cell, RefCell};
use std::env;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::error::{Error, Result};
use crate::processes::{self, processor_time};
use crate::repo::is_ci;

/// The variable that names a folder of device files, which tests read instead of `tests/corpus`.
pub(crate) const CORPUS: &str = "ODKIT_CORPUS";

/// Writes a line to standard output. A closed pipe is not an error.
pub(crate) fn say(line: &str) {
    let mut out = std::io::stdout().lock();
    let _ = writeln!(out, "{line}");
    let _ = out.flush();
}

/// Runs programs, and directs their output to the terminal or into a log.
#[derive(Debug)]
pub(crate) struct Console {
    log: Option<File>,
    /// Time without output after which a program is stopped.
    limit: Duration,
    /// Whether its programs run with low priority.
    yields: bool,
    /// Set by another thread: running programs have to stop.
    stop: Arc<AtomicBool>,
    last: RefCell<String>,
    /// Processor time of the programs that ended.
    used: Cell<Duration>,
}

impl Console {
    /// Announces steps; programs write to the terminal.
    pub(crate) fn terminal() -> Console {
        Console {
            log: None,
            limit: Duration::MAX,
            yields: false,
            stop: Arc::default(),
            last: RefCell::default(),
            used: Cell::default(),
        }
    }

    /// Writes everything to `log`, and stops a program that writes nothing there for `limit`. With
    /// `yields`, programs run with low priority.
    pub(crate) fn to_log(log: File, limit: Duration, yields: bool) -> Console {
        Console {
            log: Some(log),
            limit,
            yields,
            stop: Arc::default(),
            last: RefCell::default(),
            used: Cell::default(),
        }
    }

    /// Its programs stop as soon as `stop` is set.
    pub(crate) fn stopped_by(self, stop: &Arc<AtomicBool>) -> Console {
        Console {
            stop: Arc::clone(stop),
            ..self
        }
    }

    /// A remark between the steps.
    pub(crate) fn note(&self, text: &str) {
        match &self.log {
            None => say(&format!("  {text}")),
            Some(log) => append(log, &format!("# {text}")),
        }
    }

    /// The last command line that was run, as a user would type it.
    pub(crate) fn last_command(&self) -> String {
        self.last.borrow().clone()
    }

    /// The processor time of the programs that ended; zero where the system has no `/proc`.
    pub(crate) fn processor_time(&self) -> Duration {
        self.used.get()
    }

    /// Runs a program to its end; `what` describes it in messages. The program sees `ODKIT_CORPUS` only
    /// if the command sets it, so that no other stage depends on files outside the repository.
    pub(crate) fn run(&self, what: &str, command: &mut Command) -> Result<()> {
        if command.get_envs().all(|(name, _)| name != CORPUS) {
            command.env_remove(CORPUS);
        }
        let started = Instant::now();
        let shown = shown(command);
        self.last.replace(shown.clone());
        let mut outputs = None;
        match &self.log {
            None => say(&format!("» {what}")),
            Some(log) => {
                append(log, &format!("\n$ {shown}"));
                let copy = || {
                    log.try_clone()
                        .map_err(|e| Error::Failed(format!("cannot write the log: {e}")))
                };
                outputs = Some((copy()?, copy()?));
            }
        }
        let mut nice = nice(command).filter(|_| self.yields);
        let command = nice.as_mut().unwrap_or(command);
        if let Some((out, err)) = outputs {
            command.stdout(out).stderr(err);
        }
        let mut child = command
            .stdin(Stdio::null())
            .spawn()
            .map_err(|e| Error::Missing(format!("cannot start `{shown}`: {e}")))?;
        let status = self.wait(&mut child, started, &shown)?;
        if !status.success() {
            let text = format!("{what}: `{shown}` ended with {status}");
            return Err(Error::Failed(text));
        }
        if self.log.is_none() {
            say(&format!("  done in {}", seconds(started.elapsed())));
        }
        Ok(())
    }

    fn wait(&self, child: &mut Child, started: Instant, shown: &str) -> Result<ExitStatus> {
        let lost = |e| Error::Failed(format!("`{shown}` was lost: {e}"));
        let before = self.used.get();
        let (mut length, mut wrote) = (0, started);
        while wrote.elapsed() < self.limit && !self.stop.load(Ordering::Relaxed) {
            // A program that ended keeps its times until `try_wait` takes note of it.
            if let Some(time) = processor_time(&child.id().to_string()) {
                self.used.set(before + time);
            }
            if let Some(status) = child.try_wait().map_err(lost)? {
                return Ok(status);
            }
            let log = self.log.as_ref().and_then(|log| log.metadata().ok());
            let now = log.map_or(0, |log| log.len());
            if now != length {
                (length, wrote) = (now, Instant::now());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        self.used.set(before + processes::stop(child));
        let time = seconds(started.elapsed());
        let mut text = format!("`{shown}` was stopped after {time}");
        if wrote.elapsed() >= self.limit {
            let _ = write!(text, ": it wrote nothing for {}", seconds(self.limit));
        }
        Err(Error::Failed(text))
    }
}

fn append(mut log: &File, line: &str) {
    let _ = writeln!(log, "{line}");
}

/// Returns the standard output of a program, or `None` if it is missing or fails.
pub(crate) fn ask(program: impl AsRef<Path>, args: &[&str]) -> Option<String> {
    ask_in(Path::new("."), program, args)
}

/// [`ask`] in a folder; rustup chooses the toolchain by the folder.
pub(crate) fn ask_in(dir: &Path, program: impl AsRef<Path>, args: &[&str]) -> Option<String> {
    let output = Command::new(program.as_ref())
        .args(args)
        .current_dir(dir)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| String::from(text.trim()))
}

/// The path of a program on PATH.
pub(crate) fn which(name: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    env::split_paths(&path)
        .flat_map(|dir| [dir.join(name), dir.join(format!("{name}.exe"))])
        .find(|file| file.is_file())
}

/// `cargo` in a folder.
pub(crate) fn cargo(dir: &Path, args: &[&str]) -> Command {
    clean(Path::new("cargo"), dir, args)
}

/// A program without the environment variables that `cargo run` has set.
pub(crate) fn clean(program: &Path, dir: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(program);
    for (name, _) in env::vars_os() {
        let name = name.to_string_lossy();
        if name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_") {
            command.env_remove(&*name);
        }
    }
    if is_ci() {
        // A CI run is not built again after an edit, and incremental files take longer.
        command.env("CARGO_INCREMENTAL", "0");
        command.env("CARGO_PROFILE_DEV_DEBUG", "0");
        // With this flag a workspace of `odkit new` shares compiled macros with this repository.
        command.env("CARGO_PROFILE_RELEASE_DEBUG", "0");
        // The other lanes use the processors, and each codegen unit has a cost.
        command.env("CARGO_PROFILE_DEV_CODEGEN_UNITS", "2");
        // The same for macros and their dependencies, which then share crates with the tests.
        command.env("CARGO_PROFILE_DEV_BUILD_OVERRIDE_CODEGEN_UNITS", "2");
        command.env("CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_CODEGEN_UNITS", "2");
    }
    command.args(args).current_dir(dir);
    command
}

/// Returns the same command, started by `nice` if it exists.
fn nice(command: &Command) -> Option<Command> {
    let mut nice = Command::new(which("nice")?);
    nice.args(["-n", "5"]).arg(command.get_program());
    nice.args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => nice.env(name, value),
            None => nice.env_remove(name),
        };
    }
    nice.current_dir(command.get_current_dir()?);
    Some(nice)
}

/// A duration as text: `1.2 s`, `2 min 05 s`.
pub(crate) fn seconds(duration: Duration) -> String {
    let whole = duration.as_secs();
    if whole < 60 {
        format!("{:.1} s", duration.as_secs_f64())
    } else {
        format!("{} min {:02} s", whole / 60, whole % 60)
    }
}

/// A command line that can be pasted into a shell at the repository's root.
fn shown(command: &Command) -> String {
    let mut line = String::new();
    for (name, value) in command.get_envs() {
        // Variables such as PATH would hide the command; the others are needed to repeat it.
        if let Some(value) = value.filter(|_| name != "PATH") {
            let value = quoted(&value.to_string_lossy());
            let _ = write!(line, "{}={value} ", name.to_string_lossy());
        }
    }
    line.push_str(&quoted(&command.get_program().to_string_lossy()));
    for arg in command.get_args() {
        line.push(' ');
        line.push_str(&quoted(&arg.to_string_lossy()));
    }
    match command.get_current_dir() {
        Some(dir) if !dir.join("Cargo.lock").is_file() => {
            format!("cd {} && {line}", quoted(&dir.to_string_lossy()))
        }
        _ => line,
    }
}

fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+/.,:@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        String::from(word)
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Flags for `CARGO_ENCODED_RUSTFLAGS` that make paths in messages independent of the build folder.
pub(crate) fn without_paths(root: &Path) -> String {
    let home = |name: &str, place: &str| {
        let path =
            env::var(name).or_else(|_| env::var("HOME").map(|home| format!("{home}/{place}")));
        path.unwrap_or_default()
    };
    let sysroot = ask_in(root, "rustc", &["--print", "sysroot"]).unwrap_or_default();
    [
        (root.display().to_string(), "odkit"),
        (home("CARGO_HOME", ".cargo"), "cargo"),
        (sysroot, "rust"),
    ]
    .iter()
    .filter(|(path, _)| !path.is_empty())
    .map(|(path, name)| format!("--remap-path-prefix={path}={name}"))
    .collect::<Vec<_>>()
    .join("\u{1f}")
}

#[cfg(test)]
mod tests {
    use super::{quoted, seconds, shown};
    use std::process::Command;
    use std::time::Duration;

    #[test]
    fn a_command_is_shown_as_one_would_type_it() {
        let mut command = Command::new("cargo");
        command.args(["doc", "--features", "a b"]);
        command.env("RUSTDOCFLAGS", "-D warnings").env("PATH", "/x");
        let line = "RUSTDOCFLAGS='-D warnings' cargo doc --features 'a b'";
        assert_eq!(shown(&command), line);
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
    }

    #[test]
    fn durations() {
        assert_eq!(seconds(Duration::from_millis(1240)), "1.2 s");
        assert_eq!(seconds(Duration::from_secs(125)), "2 min 05 s");
    }
}
