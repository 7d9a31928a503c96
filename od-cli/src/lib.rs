//! `odkit`: CANopen devices from EDS files, on the command line.
//!
//! The library is the program; nothing else of it than [`main`] is meant to be called.
//!
//! One file for each subcommand. What they share: `source` finds a device, `output`
//! writes to a pipe that may close, `report` shows diagnostics.

mod check;
mod convert;
mod diff;
mod dump;
mod explain;
mod export;
mod lesson;
mod live;
mod new;
mod output;
mod report;
mod run;
mod sim;
mod source;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

/// CANopen devices from EDS files.
#[derive(Parser)]
#[command(name = "odkit", version, max_term_width = 100)]
#[command(about = "Run, check and look into CANopen devices that are described by EDS files")]
#[command(subcommand_required = true, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Sim(sim::Args),
    Run(run::Args),
    Lesson(lesson::Args),
    Check(check::Args),
    Explain(explain::Args),
    Dump(dump::Args),
    Export(export::Args),
    Convert(convert::Args),
    Diff(diff::Args),
    New(new::Args),
}

/// Why a subcommand did not do what it was asked for.
enum Failure {
    /// It was asked for something that cannot be: exit code 2.
    Usage(String),
    /// It tried and could not, or what it looked at is not as it should be: exit code 1.
    Failed(String),
    /// What there is to say stands there already; this is the exit code.
    Reported(u8),
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Usage(message) | Self::Failed(message) => f.write_str(message),
            Self::Reported(code) => write!(f, "exit code {code}"),
        }
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

impl From<od_bench::serve::Failure> for Failure {
    fn from(failure: od_bench::serve::Failure) -> Self {
        match failure {
            od_bench::serve::Failure::Usage(message) => Self::Usage(message),
            other => Self::Failed(other.to_string()),
        }
    }
}

/// The program `odkit`: reads the command line, does it, answers with the exit code.
pub fn main() -> ExitCode {
    let command = Cli::command().after_help(source::device_list());
    let matches = match command.try_get_matches() {
        Ok(matches) => matches,
        // `--help` and `--version` come this way too, with exit code 0; a mistake has 2.
        Err(error) => {
            output::print_or_ignore(&error);
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let cli = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => {
            output::print_or_ignore(&error);
            return ExitCode::from(2);
        }
    };
    let result = match cli.command {
        Command::Sim(args) => sim::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Lesson(args) => lesson::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Dump(args) => dump::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::New(args) => new::run(&args),
    };
    exit(result)
}

/// Says what went wrong, if anything did.
fn exit(result: Result<(), Failure>) -> ExitCode {
    let (message, code) = match result {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Failure::Reported(code)) => return ExitCode::from(code),
        Err(Failure::Usage(message)) => (message, 2),
        Err(Failure::Failed(message)) => (message, 1),
    };
    output::error(&message);
    ExitCode::from(code)
}
