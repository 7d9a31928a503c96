//! `odkit lesson`: lists, shows, runs and checks lessons without the page.

pub(crate) mod builtin;
mod case;
mod check;
pub(crate) mod file;
mod list;
mod play;
mod progress;
mod show;

use crate::failure::Failure;

/// List, show, take and check lessons, and read the progress of a class
///
/// A lesson is a Markdown file, or the name of one that comes with odkit (`odkit lesson list`);
/// LESSONS.md describes the format. Exit code 0: no mistakes, or all steps done; 1: a checkpoint is
/// not reached, or a lesson has mistakes; 2: wrong usage, or a file that cannot be read.
#[derive(clap::Args)]
#[command(subcommand_required = true, arg_required_else_help = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// List lessons: file, level, minutes, steps, title
    List(list::Args),
    /// Show a lesson as text, without its solution
    Show(show::Args),
    /// Take a lesson in virtual time: script lines come from standard input
    Run(play::Args),
    /// Check lessons: no checkpoint holds at the start, the solution reaches every checkpoint,
    /// and each of its lines is needed
    Check(check::Args),
    /// Take a fault case: a symptom, probes, and a mark for the cause that you name
    Case(case::Args),
    /// Make a table of a class from the codes that learners export from the page
    Progress(progress::Args),
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::List(args) => list::run(args),
        Command::Show(args) => show::run(args),
        Command::Run(args) => play::run(args),
        Command::Check(args) => check::run(args),
        Command::Case(args) => case::run(args),
        Command::Progress(args) => progress::run(args),
    }
}
