//! `odkit lesson list`: a line for each lesson.

use std::path::PathBuf;

use super::builtin::{self, Language};
use super::file::{files, show_problems};
use crate::failure::Failure;
use crate::output::Output;
use crate::report;

#[derive(clap::Args)]
pub(super) struct Args {
    /// Lessons, or folders with lessons [default: the lessons that come with odkit]
    paths: Vec<PathBuf>,
    /// Language of titles, where a lesson is translated
    #[arg(long, value_enum, value_name = "CODE", default_value_t)]
    lang: Language,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut paths = args.paths.clone();
    if paths.is_empty() {
        paths.extend(builtin::LESSONS.iter().map(|(name, _)| PathBuf::from(name)));
    }
    let mut output = Output::new();
    let mut bad = false;
    let files = files(&paths, args.lang)?;
    let width = files.iter().map(|file| file.path.chars().count()).max();
    let width = width.unwrap_or(0);
    for file in files {
        match &file.lesson {
            Ok(lesson) => {
                let steps = report::plural(lesson.steps.len(), "step");
                let line = format!(
                    "{:width$}  level {}, {:>2} min, {steps}  {}",
                    file.path, lesson.level, lesson.minutes, lesson.title
                );
                if !output.line(&line)? {
                    return Ok(());
                }
            }
            Err(problems) => {
                show_problems(&file.path, problems);
                bad = true;
            }
        }
    }
    output.flush()?;
    if bad {
        Err(Failure::Reported(1))
    } else {
        Ok(())
    }
}
