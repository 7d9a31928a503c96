//! `cargo xtask test`: every check there is, one line each.

mod counts;
mod report;
mod stages;

use std::fs::{self, File};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use crate::console::{Console, say};
use crate::error::{Error, Result};
use crate::repo::{Repo, is_ci};
use counts::Counts;
use report::{Outcome, Report};
use stages::{STAGES, Stage};

/// No single program of a stage may run longer.
const LIMIT: Duration = Duration::from_secs(30 * 60);

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
        let mut args = args.iter();
        while let Some(arg) = args.next() {
            match arg.split_once('=').unwrap_or((arg, "")) {
                ("--quick", "") => options.quick = true,
                ("--long", "") => options.long = true,
                ("--list", "") => options.list = true,
                ("--only", value) => {
                    let value = if arg.contains('=') {
                        value
                    } else {
                        args.next().map_or("", String::as_str)
                    };
                    for name in value.split(',') {
                        options.only.push(known(name)?);
                    }
                }
                _ => return Err(Error::Usage(format!("test takes no `{arg}`"))),
            }
        }
        Ok(options)
    }

    fn selects(&self, stage: &Stage) -> bool {
        if self.only.is_empty() {
            !self.quick || stage.quick
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
    Err(Error::Usage(format!(
        "no stage `{name}`; there are {}",
        names.join(", ")
    )))
}

/// What a stage gets to work with.
#[derive(Debug)]
struct Context<'a> {
    repo: &'a Repo,
    console: &'a Console,
    quick: bool,
    long: bool,
}

/// Runs the selected stages, all of them, and says how it went.
pub(crate) fn run(repo: &Repo, options: &Options) -> Result<ExitCode> {
    if options.list {
        for stage in STAGES {
            let quick = if stage.quick { "quick" } else { "" };
            say(&format!("{:<12} {quick:<6} {}", stage.name, stage.about));
        }
        return Ok(ExitCode::SUCCESS);
    }
    let logs = repo.cache().join("logs");
    fs::create_dir_all(&logs).map_err(|e| Error::io("create", &logs, &e))?;
    let mut report = Report::new(is_ci());
    for stage in STAGES.iter().filter(|stage| options.selects(stage)) {
        let path = logs.join(format!("{}.log", stage.name));
        let log = File::create(&path).map_err(|e| Error::io("create", &path, &e))?;
        let console = Console::to_log(log, LIMIT);
        let context = Context {
            repo,
            console: &console,
            quick: options.quick,
            long: options.long,
        };
        report.start(stage.name);
        let started = Instant::now();
        let result = (stage.run)(&context);
        let text = fs::read(&path).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let outcome = judge(stage, result, Counts::read(&text));
        let command = console.last_command();
        report.finish(stage.name, &outcome, started.elapsed());
        if let Outcome::Failed { why, .. } = &outcome {
            report.explain(stage.name, why, &text, &path, &command);
        }
    }
    Ok(report.close())
}

/// Puts together what a stage returned and what its log counts.
fn judge(stage: &Stage, result: Result<()>, mut counts: Counts) -> Outcome {
    match result {
        // A check without tests of its own is one.
        Ok(()) if counts.passed == 0 && !stage.counts => {
            counts.passed = 1;
            Outcome::Passed {
                counts,
                tests: false,
            }
        }
        Ok(()) if counts.passed == 0 && counts.failed == 0 => Outcome::Failed {
            counts,
            why: String::from("the stage ran no test"),
        },
        Ok(()) if counts.failed == 0 => Outcome::Passed {
            counts,
            tests: true,
        },
        Ok(()) => Outcome::Failed {
            why: format!("{} failed", counts.failed),
            counts,
        },
        Err(Error::Missing(why)) if !is_ci() => Outcome::Skipped { why },
        Err(error) => Outcome::Failed {
            counts,
            why: String::from(error.message()),
        },
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
        assert_eq!(names("").len(), STAGES.len());
        assert_eq!(names("--only doc,fmt"), ["fmt", "doc"]);
        assert!(names("--quick").contains(&"unit"));
        assert!(!names("--quick").contains(&"browser"));
    }
}
