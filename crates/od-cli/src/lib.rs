//! `odkit`: CANopen devices from EDS files, on the command line.
//!
//! The library is the program; only [`main`] is meant to be called.
//!
//! There is a file for each subcommand. They share `source`, which finds a device, `output`, which
//! writes to a pipe that may close, and `report`, which shows findings.

mod backup;
mod bridge;
mod bus;
mod campaign;
mod check;
mod class;
mod clock;
mod config;
mod conform;
mod convert;
mod ctl;
mod decode;
mod diagnose;
mod diff;
mod dump;
mod explain;
mod export;
mod failure;
mod files;
mod get;
mod learn;
mod lesson;
mod live;
mod lsp;
mod lss;
mod monitor;
mod network;
mod new;
mod nmt;
mod output;
mod record;
mod report;
mod run;
mod save;
mod scan;
mod set;
mod sim;
mod source;
mod terminal;
mod watch;
mod workers;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::failure::Failure;

/// CANopen devices from EDS files.
#[derive(Parser)]
#[command(name = "odkit", version, max_term_width = 100)]
#[command(
    about = "Check, convert and simulate CANopen devices; look at them and set them up on a bus"
)]
#[command(subcommand_required = true, arg_required_else_help = true)]
struct Cli {
    /// Settings of the project; otherwise the nearest `odkit.toml` above each file
    #[arg(long, global = true, value_name = "FILE")]
    config: Option<std::path::PathBuf>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Sim(sim::Args),
    Bridge(bridge::Args),
    Ctl(ctl::Args),
    Run(run::Args),
    Campaign(campaign::Args),
    Lesson(lesson::Args),
    Class(class::Args),
    Check(check::Args),
    Explain(explain::Args),
    Lsp(lsp::Args),
    Dump(dump::Args),
    Export(export::Args),
    Convert(convert::Args),
    Diff(diff::Args),
    Conform(conform::Args),
    Network(network::Args),
    Learn(learn::Args),
    New(new::Args),
    Scan(scan::Args),
    Get(get::Args),
    Set(set::Args),
    Nmt(nmt::Args),
    /// Save the values of a node in its memory (1010h)
    Save(save::Args),
    /// Restore the default values of a node (1011h)
    ///
    /// They take effect with the next reset.
    Restore(save::Args),
    Lss(lss::Args),
    Backup(backup::Args),
    Apply(backup::Apply),
    Monitor(monitor::Args),
    Watch(watch::Args),
    Record(record::Args),
    Replay(record::Replay),
    Decode(decode::Args),
    Diagnose(diagnose::Args),
}

/// Commands in groups, as `--help` lists them.
const GROUPS: [(&str, &[&str]); 4] = [
    (
        "Simulate and learn",
        &[
            "sim", "bridge", "ctl", "run", "campaign", "lesson", "class", "new",
        ],
    ),
    (
        "Device files",
        &[
            "check", "explain", "dump", "export", "convert", "diff", "network", "lsp",
        ],
    ),
    (
        "Look at a bus, set up nodes",
        &[
            "scan", "get", "set", "nmt", "save", "restore", "lss", "backup", "apply", "watch",
            "conform", "learn",
        ],
    ),
    (
        "Frames",
        &["monitor", "record", "replay", "decode", "diagnose"],
    ),
];

/// The grouped list of commands, for `--help`.
fn groups(command: &clap::Command) -> String {
    let line = |name: &&str| {
        let about = command
            .find_subcommand(name)
            .and_then(clap::Command::get_about);
        format!(
            "  {name:<8}  {}\n",
            about.map(ToString::to_string).unwrap_or_default()
        )
    };
    let group = |(title, names): (&str, &[&str])| {
        format!("{title}:\n{}\n", names.iter().map(line).collect::<String>())
    };
    GROUPS.into_iter().map(group).collect()
}

/// The program `odkit`: parses the command line, runs the command, returns the exit code.
pub fn main() -> ExitCode {
    od_sim::serve::files::survive_limit();
    let command = Cli::command().after_help(source::device_list());
    let groups = groups(&command);
    let template = format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}{{after-help}}"
    );
    let command = command.help_template(template);
    let matches = match command.try_get_matches() {
        Ok(matches) => matches,
        // `--help` and `--version` arrive here too, with exit code 0; an error has 2.
        Err(error) => {
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            output::print_or_ignore(&about_number(error));
            return ExitCode::from(code);
        }
    };
    let cli = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => {
            output::print_or_ignore(&error);
            return ExitCode::from(2);
        }
    };
    if let Some(path) = cli.config {
        config::use_file(path);
    }
    let result = match cli.command {
        Command::Sim(args) => sim::run(&args),
        Command::Bridge(args) => bridge::run(&args),
        Command::Ctl(args) => ctl::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Campaign(args) => campaign::run(&args),
        Command::Lesson(args) => lesson::run(&args),
        Command::Class(args) => class::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Lsp(args) => lsp::run(&args),
        Command::Dump(args) => dump::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Conform(args) => conform::run(&args),
        Command::Network(args) => network::run(&args),
        Command::Learn(args) => learn::run(&args),
        Command::New(args) => new::run(&args),
        Command::Scan(args) => scan::run(&args),
        Command::Get(args) => get::run(&args),
        Command::Set(args) => set::run(&args),
        Command::Nmt(args) => nmt::run(&args),
        Command::Save(args) => save::save(&args),
        Command::Restore(args) => save::restore(&args),
        Command::Lss(args) => lss::run(&args),
        Command::Backup(args) => backup::backup(&args),
        Command::Apply(args) => backup::apply(&args),
        Command::Monitor(args) => monitor::run(&args),
        Command::Watch(args) => watch::run(&args),
        Command::Record(args) => record::record(&args),
        Command::Replay(args) => record::replay(&args),
        Command::Decode(args) => decode::run(&args),
        Command::Diagnose(args) => diagnose::run(&args),
    };
    exit(result)
}

/// The error in words that say what to write, if an argument is not the number that it should be.
fn about_number(error: clap::Error) -> clap::Error {
    use clap::error::ContextKind;
    use std::num::{IntErrorKind, ParseFloatError, ParseIntError};
    let Some(source) = std::error::Error::source(&error) else {
        return error;
    };
    let right = match source
        .downcast_ref::<ParseIntError>()
        .map(ParseIntError::kind)
    {
        Some(IntErrorKind::PosOverflow) => "the number is too large",
        Some(IntErrorKind::NegOverflow) => "the number is too small",
        Some(_) => "write a whole number, such as 100",
        None if source.is::<ParseFloatError>() => "write a number, such as 0.5",
        None => return error,
    };
    let of = |kind| error.get(kind).map(ToString::to_string).unwrap_or_default();
    let (argument, value) = (of(ContextKind::InvalidArg), of(ContextKind::InvalidValue));
    clap::Error::raw(
        error.kind(),
        format!(
            "invalid value '{value}' for '{argument}': {right}\n\nFor more information, try '--help'.\n"
        ),
    )
}

/// Prints the error, if there is one.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_lists_each_command_once() {
        let mut listed: Vec<&str> = GROUPS
            .iter()
            .flat_map(|(_, names)| *names)
            .copied()
            .collect();
        let command = Cli::command();
        let mut all: Vec<&str> = command
            .get_subcommands()
            .map(clap::Command::get_name)
            .collect();
        listed.sort_unstable();
        all.sort_unstable();
        assert_eq!(listed, all, "the names in GROUPS, and the commands");
    }

    #[test]
    fn every_command_and_argument_has_a_help_text() {
        fn missing(path: &str, command: &clap::Command, found: &mut Vec<String>) {
            if command.get_about().is_none() {
                found.push(path.to_owned());
            }
            let silent = command.get_arguments().filter(|one| {
                one.get_help()
                    .is_none_or(|help| help.to_string().is_empty())
            });
            found.extend(silent.map(|argument| format!("{path} {argument}")));
            for one in command.get_subcommands() {
                missing(&format!("{path} {}", one.get_name()), one, found);
            }
        }
        let mut found = Vec::new();
        missing("odkit", &Cli::command(), &mut found);
        assert!(found.is_empty(), "no help text: {found:#?}");
    }
}
