//! The EDS file of a call with its overlay, if any: maps a place to one of the two files.

use od_eds::Span;
use od_eds::{Origin, Overlaid};

/// The paths as written in the call, for messages and documentation.
pub(crate) struct Files {
    eds: String,
    overlay: Option<(String, Overlaid)>,
}

impl Files {
    /// One file.
    pub(crate) fn one(eds: impl Into<String>) -> Self {
        Self {
            eds: eds.into(),
            overlay: None,
        }
    }

    /// A file with an overlay, and the result of the two.
    pub(crate) fn with_overlay(self, overlay: String, made: Overlaid) -> Self {
        Self {
            overlay: Some((overlay, made)),
            ..self
        }
    }

    /// All files in the form of the command line.
    pub(crate) fn shown(&self) -> String {
        match &self.overlay {
            Some((overlay, _)) => format!("{}+{overlay}", self.eds),
            None => self.eds.clone(),
        }
    }

    /// `file:line:column` of a place in the text.
    pub(crate) fn place(&self, span: Span) -> String {
        let (file, span) = self.of(span);
        format!("{file}:{}:{}", span.line, span.column)
    }

    /// `file:line`, the file without its folder.
    pub(crate) fn line(&self, span: Span) -> String {
        let (file, span) = self.of(span);
        let name = file.rsplit(['/', '\\']).next().unwrap_or_default();
        format!("{name}:{}", span.line)
    }

    fn of(&self, span: Span) -> (&str, Span) {
        match &self.overlay {
            Some((overlay, made)) => match made.locate(span) {
                (Origin::Base, span) => (&self.eds, span),
                (Origin::Overlay, span) => (overlay, span),
            },
            None => (&self.eds, span),
        }
    }
}
