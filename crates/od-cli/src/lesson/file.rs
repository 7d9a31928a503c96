//! Files of lessons, and the lessons that come with odkit.

use std::fs;
use std::path::{Path, PathBuf};

use od_sim::lesson::{Lesson, Problem};

use super::builtin;
use crate::failure::{Failure, read_error};
use crate::output::note;
use crate::report;

/// A file with its lesson, or with its errors.
pub(super) struct File {
    pub(super) path: String,
    pub(super) lesson: Result<Lesson, Vec<Problem>>,
}

impl File {
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        if let Some(text) = builtin::find(&shown).filter(|_| !path.is_file()) {
            return Ok(Self {
                path: shown,
                lesson: Lesson::parse(text),
            });
        }
        let failed = |why: &str| Failure::Usage(format!("{shown}: {why}"));
        let bytes = fs::read(path).map_err(|error| failed(&read_error(&error)))?;
        let text = String::from_utf8(bytes).map_err(|_| failed("the file is not UTF-8"))?;
        Ok(Self {
            path: shown,
            lesson: Lesson::parse(&text),
        })
    }

    /// Returns the lesson, or prints its mistakes.
    pub(super) fn usable(self) -> Result<Lesson, Failure> {
        self.lesson.map_err(|problems| {
            show_problems(&self.path, &problems);
            let count = report::plural(problems.len(), "mistake");
            Failure::Usage(format!("{}: {count}; see LESSONS.md", self.path))
        })
    }
}

pub(super) fn show_problems(path: &str, problems: &[Problem]) {
    for problem in problems {
        note!("{path}:{problem}");
    }
}

/// The lessons of files and folders, in order; in a folder the files that end in `.md`.
pub(super) fn files(paths: &[PathBuf]) -> Result<Vec<File>, Failure> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            all.push(File::read(path)?);
            continue;
        }
        let entries = fs::read_dir(path).map_err(|error| {
            let why = read_error(&error);
            Failure::Usage(format!("{}: {why}", path.display()))
        })?;
        let mut found: Vec<_> = entries
            .filter_map(|entry| entry.ok().map(|entry| entry.path()))
            .filter(|path| path.extension().is_some_and(|kind| kind == "md"))
            .collect();
        found.sort();
        if found.is_empty() {
            let shown = path.display();
            return Err(Failure::Usage(format!(
                "{shown}: the folder contains no lesson (*.md)"
            )));
        }
        for path in found {
            all.push(File::read(&path)?);
        }
    }
    Ok(all)
}
