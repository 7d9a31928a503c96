//! The records of a run as a report: text, JSON, JUnit, Markdown, HTML.

mod html;
mod json;
mod junit;
mod markdown;
mod run;
mod text;

pub use run::{About, Counts, Report};

/// The formats, by the extension of a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// One line per case.
    Text,
    /// One JSON object.
    Json,
    /// JUnit XML, for a build server.
    JUnit,
    /// Tables.
    Markdown,
    /// One page that needs no other file, with every frame.
    Html,
}

impl Format {
    /// The extensions and their formats.
    pub const ALL: [(&str, Self); 5] = [
        ("txt", Self::Text),
        ("json", Self::Json),
        ("xml", Self::JUnit),
        ("md", Self::Markdown),
        ("html", Self::Html),
    ];

    /// The format of a file with this extension.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }
}

impl Report {
    /// Writes the report in a format.
    pub fn render(&self, format: Format) -> String {
        match format {
            Format::Text => text::render(self),
            Format::Json => json::render(self),
            Format::JUnit => junit::render(self),
            Format::Markdown => markdown::render(self),
            Format::Html => html::render(self),
        }
    }
}
