//! Files of lessons, and the lessons that come with odkit.

use std::fs;
use std::path::{Path, PathBuf};

use od_sim::lesson::{Lesson, Problem, is_translation, translate};

use super::builtin::{self, Language};
use crate::failure::{Failure, read_error};
use crate::output::note;
use crate::report;

/// A file with its lesson, or with its errors.
pub(super) struct File {
    pub(super) path: String,
    pub(super) lesson: Result<Lesson, Vec<Problem>>,
}

impl File {
    /// Reads a lesson; one without a translation into this language is in its own, and a note says so.
    pub(super) fn read(path: &Path, language: Language) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let builtin = builtin::find(&shown).filter(|_| !path.is_file());
        let text = match builtin {
            Some(text) => text.to_owned(),
            None => text(path)?,
        };
        let Some(folder) = language.folder() else {
            return Ok(Self {
                path: shown,
                lesson: lesson_of(path, &text),
            });
        };
        let words = match builtin {
            Some(_) => builtin::translation(&shown, language).map(str::to_owned),
            None => translation(path, folder)?,
        };
        let Some(words) = words else {
            note!("{shown}: no translation in `{folder}`; this is the lesson in its own language");
            return Self::read(path, Language::En);
        };
        let lesson = translate(&text, &words).and_then(|text| Lesson::parse(&text));
        let path = match builtin {
            Some(_) => shown,
            None => beside(path, folder).display().to_string(),
        };
        Ok(Self { path, lesson })
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

fn text(path: &Path) -> Result<String, Failure> {
    let failed = |why: &str| Failure::Usage(format!("{}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| failed(&read_error(&error)))?;
    String::from_utf8(bytes).map_err(|_| failed("the file is not UTF-8"))
}

/// Reads a lesson of its own. A translation is named with the original that it belongs to.
fn lesson_of(path: &Path, text: &str) -> Result<Lesson, Vec<Problem>> {
    let lesson = Lesson::parse(text);
    if lesson.is_ok() || !is_translation(text) {
        return lesson;
    }
    let name = path.file_name().unwrap_or_default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let original = match folder.parent() {
        Some(above) => above.join(name),
        None => Path::new("..").join(name),
    };
    let shown = original.display();
    let (message, help) = if original.is_file() {
        (
            format!("this is the translation of {shown}"),
            format!("give {shown}: the translation is read with it"),
        )
    } else {
        (
            format!("this is a translation, and its original {shown} does not exist"),
            String::from("put the original there, with the translation in a folder `de` beside it"),
        )
    };
    Err(vec![Problem::new(1, message, &help)])
}

/// The place of the translation of a lesson: `lessons/de/01-name.md` for `lessons/01-name.md`.
fn beside(path: &Path, folder: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default();
    path.with_file_name(folder).join(name)
}

/// The translation of a lesson, if there is one.
fn translation(path: &Path, folder: &str) -> Result<Option<String>, Failure> {
    let path = beside(path, folder);
    path.is_file().then(|| text(&path)).transpose()
}

/// The German translation beside the file of a lesson, with set-up, conditions and solutions of the lesson; `None` if that
/// file does not exist.
pub(super) fn translated(path: &Path) -> Result<Option<File>, Failure> {
    let language = Language::De;
    let is_there = |folder| beside(path, folder).is_file();
    match language.folder() {
        Some(folder) if is_there(folder) => File::read(path, language).map(Some),
        _ => Ok(None),
    }
}

pub(super) fn show_problems(path: &str, problems: &[Problem]) {
    for problem in problems {
        note!("{path}:{problem}");
    }
}

/// The lessons of files and folders, in order; in a folder the files that end in `.md`.
pub(super) fn files(paths: &[PathBuf], language: Language) -> Result<Vec<File>, Failure> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            all.push(File::read(path, language)?);
            continue;
        }
        for path in in_folder(path)? {
            all.push(File::read(&path, language)?);
        }
    }
    Ok(all)
}

/// The Markdown files of a folder, in order.
fn in_folder(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let shown = folder.display();
    let entries = fs::read_dir(folder).map_err(|error| {
        let why = read_error(&error);
        Failure::Usage(format!("{shown}: {why}"))
    })?;
    let mut found: Vec<_> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|kind| kind == "md"))
        .collect();
    found.sort();
    if found.is_empty() {
        return Err(Failure::Usage(format!(
            "{shown}: the folder contains no lesson (*.md)"
        )));
    }
    Ok(found)
}

/// A lesson of a file with the texts that a page reads.
pub(crate) struct Texts {
    pub(crate) path: PathBuf,
    /// The lesson, and its text.
    pub(crate) own: (Lesson, String),
    /// The same in German, if there is a translation.
    pub(crate) german: Option<(Lesson, String)>,
}

/// The lessons of files and folders for a page. In a folder, a Markdown file that does not begin with the front matter of a
/// lesson is ignored.
///
/// # Errors
/// A file cannot be read, or has mistakes, which are printed.
pub(crate) fn texts(paths: &[PathBuf]) -> Result<Vec<Texts>, Failure> {
    let mut all = Vec::new();
    let mut bad = 0;
    for path in paths {
        let is_folder = path.is_dir();
        let files = if is_folder {
            in_folder(path)?
        } else {
            vec![path.clone()]
        };
        for path in files {
            let own = text(&path)?;
            if is_folder
                && !own
                    .trim_start_matches('\u{feff}')
                    .trim_start()
                    .starts_with("+++")
            {
                continue;
            }
            let words = translation(&path, "de")?;
            let lesson = |path: &Path, text: Result<String, Vec<Problem>>| {
                let read = text.and_then(|text| Ok((lesson_of(path, &text)?, text)));
                read.map_err(|problems| show_problems(&path.display().to_string(), &problems))
            };
            let german = words.map(|words| lesson(&beside(&path, "de"), translate(&own, &words)));
            match (lesson(&path, Ok(own)), german.transpose()) {
                (Ok(own), Ok(german)) => all.push(Texts { path, own, german }),
                _ => bad += 1,
            }
        }
    }
    if bad > 0 {
        let count = report::plural(bad, "lesson");
        return Err(Failure::Usage(format!(
            "{count} with mistakes; see LESSONS.md"
        )));
    }
    Ok(all)
}
