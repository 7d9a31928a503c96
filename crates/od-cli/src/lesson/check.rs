//! `odkit lesson check`: reads lessons and proves their steps.

use std::path::{Path, PathBuf};

use od_sim::lesson::{Lesson, Problem, prove};

use super::builtin::Language;
use super::file::{File, files, show_problems, translated};
use crate::failure::Failure;
use crate::output::note;
use crate::report;
use crate::terminal::Terminal;

#[derive(clap::Args)]
pub(super) struct Args {
    /// Lessons, or folders with lessons
    #[arg(required = true, value_name = "FILE")]
    paths: Vec<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let files = files(&args.paths, Language::En)?;
    let mut bad = 0;
    for file in &files {
        let path = Path::new(&file.path);
        let problems = match &file.lesson {
            Ok(lesson) => {
                let mut problems = prove(lesson, &mut Terminal::beside(path, ("gxmm", None)));
                problems.extend(dead_links(lesson, path));
                problems
            }
            Err(problems) => problems.clone(),
        };
        show_problems(&file.path, &problems);
        let mut is_bad = !problems.is_empty();
        if let Some(File {
            path,
            lesson: Err(problems),
        }) = translated(path)?
        {
            show_problems(&path, &problems);
            is_bad = true;
        }
        bad += usize::from(is_bad);
    }
    let count = report::plural(files.len(), "lesson");
    if bad > 0 {
        note!("{count}, {bad} with mistakes");
        return Err(Failure::Reported(1));
    }
    note!("{count}, no mistakes");
    Ok(())
}

/// Linked files that do not exist.
fn dead_links(lesson: &Lesson, path: &Path) -> Vec<Problem> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let dead = |(_, file): &(u32, &str)| !folder.join(file).exists();
    lesson
        .files()
        .filter(dead)
        .map(|(line, file)| {
            let message = format!("the linked file {file} does not exist");
            Problem::new(line, message, "write the path relative to the lesson")
        })
        .collect()
}
