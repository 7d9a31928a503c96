//! `odkit lesson`: lessons without a page: list, read, take and check them.

mod builtin;
mod check;
mod list;
mod play;
mod show;

use std::fs;
use std::path::{Path, PathBuf};

use od_bench::VirtualDevice;
use od_bench::lesson::{Lesson, Problem};
use od_bench::script::{Host, Origin};
use od_runtime::{Frame, Instant, NodeId};

use crate::output::{Output, note};
use crate::source::{self, Source};
use crate::{Failure, report};

/// List, read, take and check lessons
///
/// A lesson is a Markdown file, or the name of one that comes with odkit (`odkit lesson list`);
/// LESSONS.md says how to write one. Exit code 0: all is as it
/// should be; 1: a checkpoint is not reached, or a lesson has mistakes; 2: wrong usage, or a
/// file that cannot be read.
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
    /// Show a lesson as text, without what would give it away
    Show(show::Args),
    /// Take a lesson: lines of a script come from standard input, in virtual time
    Run(play::Args),
    /// Check lessons: nothing holds at the start, the solution reaches every checkpoint, and
    /// each of its lines is needed
    Check(check::Args),
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::List(args) => list::run(args),
        Command::Show(args) => show::run(args),
        Command::Run(args) => play::run(args),
        Command::Check(args) => check::run(args),
    }
}

/// A file with its lesson, or what is wrong with it.
struct File {
    path: String,
    lesson: Result<Lesson, Vec<Problem>>,
}

impl File {
    fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        if let Some(text) = builtin::find(&shown).filter(|_| !path.is_file()) {
            return Ok(Self {
                path: shown,
                lesson: Lesson::parse(text),
            });
        }
        let failed = |why: &str| Failure::Usage(format!("{shown}: {why}"));
        let bytes = fs::read(path).map_err(|error| failed(&source::read_error(&error)))?;
        let text = String::from_utf8(bytes).map_err(|_| failed("a lesson is UTF-8 text"))?;
        Ok(Self {
            path: shown,
            lesson: Lesson::parse(&text),
        })
    }

    /// The lesson; its mistakes are shown where it has some.
    fn usable(self) -> Result<Lesson, Failure> {
        self.lesson.map_err(|problems| {
            show_problems(&self.path, &problems);
            let count = report::plural(problems.len(), "mistake");
            Failure::Usage(format!("{}: {count}; see LESSONS.md", self.path))
        })
    }
}

fn show_problems(path: &str, problems: &[Problem]) {
    for problem in problems {
        note!("{path}:{problem}");
    }
}

/// The lessons of files and folders, in order; of a folder those that end in `.md`.
fn files(paths: &[PathBuf]) -> Result<Vec<File>, Failure> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            all.push(File::read(path)?);
            continue;
        }
        let entries = fs::read_dir(path).map_err(|error| {
            let why = source::read_error(&error);
            Failure::Usage(format!("{}: {why}", path.display()))
        })?;
        let mut found: Vec<_> = entries
            .filter_map(|entry| entry.ok().map(|entry| entry.path()))
            .filter(|path| path.extension().is_some_and(|kind| kind == "md"))
            .collect();
        found.sort();
        if found.is_empty() {
            let shown = path.display();
            return Err(Failure::Usage(format!("{shown}: no lesson (*.md) is here")));
        }
        for path in found {
            all.push(File::read(&path)?);
        }
    }
    Ok(all)
}

/// Makes devices, with EDS files beside the lesson, and shows frames.
struct Terminal {
    folder: PathBuf,
    /// Where frames go; none while nobody is to see them.
    output: Option<Output>,
    /// Frames of whoever takes the lesson, too.
    echo: bool,
}

impl Terminal {
    fn beside(path: &Path) -> Self {
        Self {
            folder: path.parent().map(Path::to_path_buf).unwrap_or_default(),
            output: None,
            echo: false,
        }
    }

    fn line(&mut self, line: &str) {
        // Who takes a lesson without reading what comes gets his exit code all the same.
        if let Some(output) = &mut self.output {
            let _ = output.line(line);
        }
    }
}

impl Host for Terminal {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, String> {
        let source = Source::find_in(name.unwrap_or("gxmm"), &self.folder);
        source
            .map_err(|failure| failure.to_string())?
            .device(node_id)
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        if self.echo || origin != Origin::Script {
            let line = od_bench::logs::candump::format_line(at, "can0", frame);
            self.line(&line);
        }
    }
}
