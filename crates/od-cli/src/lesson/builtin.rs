//! The embedded lessons; they are available without the repository.

/// Language of the text of a lesson.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, clap::ValueEnum)]
pub(crate) enum Language {
    #[default]
    En,
    De,
}

impl Language {
    /// The folder beside a lesson that has its translation; `None` for the language of the lesson itself.
    pub(super) fn folder(self) -> Option<&'static str> {
        match self {
            Self::En => None,
            Self::De => Some("de"),
        }
    }
}

/// Name and text of each lesson of `playground/lessons`, in order; `build.rs` lists them.
pub(super) const LESSONS: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/lessons.rs"));

/// Name and German translation of each lesson that has one.
const GERMAN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/lessons_de.rs"));

/// Returns the translation of the lesson with this name, if there is one in this language.
pub(super) fn translation(name: &str, language: Language) -> Option<&'static str> {
    let all = match language {
        Language::En => &[],
        Language::De => GERMAN,
    };
    let (_, text) = all.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

/// Returns the text of the lesson with this name.
pub(super) fn find(name: &str) -> Option<&'static str> {
    let (_, text) = LESSONS.iter().find(|(known, _)| *known == name)?;
    Some(text)
}
