//! `cargo xtask test`: all checks, one line each.

mod context;
mod counts;
mod report;
mod running;
mod stages;

use std::fs::{self, File};
use std::path::Path;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use crate::console::{Console, say};
use crate::error::{Error, Result};
use crate::repo::{Repo, is_ci};
use context::Context;
use counts::Counts;
use report::{Outcome, Report};
use stages::{Kind, Lane, STAGES, Stage};

/// Time without output after which a program of a stage is stopped, because it hangs; with `--long`, four times as long. The
/// whole time of a program has no limit: a cold build on a slow computer takes long, but it prints each crate, and a test
/// program prints each result. The longest silence on two cores is 2 minutes, while a module is linked with LTO.
const LIMIT: Duration = Duration::from_secs(12 * 60);

/// The command line of `test`.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    quick: bool,
    long: bool,
    only: Vec<String>,
    list: bool,
}

impl Options {
    /// Reads the arguments after `test`.
    pub(crate) fn parse(args: &[String]) -> Result<Options> {
        let mut options = Options::default();
        // `--only=fmt` is `--only fmt`.
        let mut words = args.iter().flat_map(|arg| arg.split('='));
        while let Some(word) = words.next() {
            match word {
                "--quick" => options.quick = true,
                "--long" => options.long = true,
                "--list" => options.list = true,
                "--only" => {
                    for name in words.next().unwrap_or_default().split(',') {
                        options.only.push(known(name)?);
                    }
                }
                _ => return Err(Error::Usage(format!("test has no option `{word}`"))),
            }
        }
        Ok(options)
    }

    fn selects(&self, stage: &Stage) -> bool {
        if self.only.is_empty() {
            (stage.quick || !self.quick) && (self.long || !stage.long)
        } else {
            self.only.iter().any(|name| name == stage.name)
        }
    }
}

fn known(name: &str) -> Result<String> {
    if STAGES.iter().any(|stage| stage.name == name) {
        return Ok(String::from(name));
    }
    let names: Vec<&str> = STAGES.iter().map(|stage| stage.name).collect();
    let text = format!("no stage is named `{name}`; stages: {}", names.join(", "));
    Err(Error::Usage(text))
}

/// Runs all selected stages, and returns the result.
pub(crate) fn run(repo: &Repo, options: &Options) -> Result<ExitCode> {
    if options.list {
        for stage in STAGES {
            let quick = match stage {
                Stage { quick: true, .. } => "quick",
                Stage { long: true, .. } => "long",
                _ => "",
            };
            say(&format!("{:<12} {quick:<6} {}", stage.name, stage.about));
        }
        return Ok(ExitCode::SUCCESS);
    }
    let logs = repo.cache().join("logs");
    fs::create_dir_all(&logs).map_err(|e| Error::io("create", &logs, &e))?;
    let report = Mutex::new(Report::new());
    let work = |stage: &Stage| one(repo, options, stage, &logs, &report);
    thread::scope(|scope| {
        let work = &work;
        let mut lanes = Lane::BESIDE.map(|lane| {
            let (queue, waiting) = mpsc::channel::<&Stage>();
            let worker = scope.spawn(move || waiting.iter().try_for_each(work));
            (lane, queue, worker)
        });
        for stage in STAGES.iter().filter(|stage| options.selects(stage)) {
            match lanes.iter_mut().find(|(lane, ..)| *lane == stage.lane) {
                // A worker that failed is joined below, which reports the reason.
                Some((_, queue, _)) => drop(queue.send(stage)),
                None => work(stage)?,
            }
        }
        lanes.into_iter().try_for_each(|(_, queue, worker)| {
            drop(queue);
            let panicked = |_| Err(Error::Failed(String::from("a stage panicked")));
            worker.join().unwrap_or_else(panicked)
        })
    })?;
    let report = report.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(report.close())
}

/// Runs one stage.
fn one(
    repo: &Repo,
    options: &Options,
    stage: &Stage,
    logs: &Path,
    report: &Mutex<Report>,
) -> Result<()> {
    let report = || report.lock().unwrap_or_else(PoisonError::into_inner);
    let path = logs.join(format!("{}.log", stage.name));
    let log = File::create(&path).map_err(|e| Error::io("create", &path, &e))?;
    // Tests in a browser or on a bus depend on time; computing tests wait for them.
    let limit = if options.long { LIMIT * 4 } else { LIMIT };
    let console = Console::to_log(log, limit, !stage.lane.looks_at_the_time());
    let context = Context {
        repo,
        console: &console,
        quick: options.quick,
        long: options.long,
    };
    report().start(stage.name);
    let started = Instant::now();
    let result = (stage.run)(&context);
    let text = fs::read(&path).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let outcome = judge(stage, result, Counts::read(&text));
    let took = (started.elapsed(), console.processor_time());
    let command = console.last_command();
    report().finish(stage.name, &outcome, took, (&text, &path), &command);
    Ok(())
}

/// Combines the result of a stage with the counts in its log.
fn judge(stage: &Stage, result: Result<()>, counts: Counts) -> Outcome {
    match result {
        Ok(()) if counts.failed > 0 => Outcome::Failed(counts, format!("{} failed", counts.failed)),
        Ok(()) if counts.passed > 0 => Outcome::Passed(Some(counts)),
        Ok(()) if stage.kind == Kind::Check => Outcome::Passed(None),
        Ok(()) => Outcome::Failed(counts, String::from("the stage ran no test")),
        Err(Error::LeftOut(why)) => Outcome::LeftOut(why),
        Err(Error::Missing(why)) if !is_ci() => Outcome::Skipped(why),
        Err(error) => Outcome::Failed(counts, String::from(error.message())),
    }
}

#[cfg(test)]
mod tests {
    use super::Options;
    use super::stages::STAGES;

    fn parse(line: &str) -> Option<Options> {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        Options::parse(&args).ok()
    }

    #[test]
    fn command_lines() {
        assert_eq!(parse(""), Some(Options::default()));
        let quick = parse("--quick").expect("it is an option");
        assert!(quick.quick && !quick.long);
        let only = parse("--only fmt,unit --only=doc").expect("these are stages");
        assert_eq!(only.only, ["fmt", "unit", "doc"]);
        for wrong in ["--only", "--only=", "--only nonsense", "--quik", "fmt"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn selection() {
        let names = |line: &str| -> Vec<&str> {
            let options = parse(line).expect("it is a command line");
            let selected = STAGES.iter().filter(|stage| options.selects(stage));
            selected.map(|stage| stage.name).collect()
        };
        assert_eq!(names("--long").len(), STAGES.len());
        assert!(!names("").contains(&"editor") && names("--only editor") == ["editor"]);
        assert_eq!(names("--only doc,fmt"), ["fmt", "doc"]);
        assert!(names("--quick").contains(&"unit"));
        assert!(!names("--quick").contains(&"browser"));
    }
}
