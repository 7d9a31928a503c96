//! What a check of files came to; every report is made of it.

use od_eds::{Finding, Sentence, Severity, Span};
use serde::Serialize;

use crate::source::Source;

/// What there is to say about one file.
#[derive(Default)]
pub(super) struct Checked {
    pub(super) file: Source,
    pub(super) findings: Vec<Finding>,
    /// What a text report shows of it, made where many can be made at once.
    pub(super) shown: String,
    /// Places that were mended.
    pub(super) mended: usize,
    /// Why the file could not be read or written.
    pub(super) failed: Option<String>,
}

impl Checked {
    pub(super) fn new(file: Source) -> Self {
        Self {
            file,
            ..Self::default()
        }
    }

    pub(super) fn unreadable(path: &str, why: String) -> Self {
        let mut checked = Self::default();
        checked.file.path = path.into();
        checked.failed = Some(why);
        checked
    }
}

/// The message, with the object that it is about before it.
pub(super) fn about(finding: &Sentence) -> String {
    match finding.address {
        Some(address) => format!("object {address}: {}", finding.message),
        None => finding.message.clone(),
    }
}

/// The column behind a span, in characters.
pub(super) fn end_column(text: &str, span: Span) -> usize {
    let part = text.get(span.start as usize..span.end as usize);
    span.column as usize + part.map_or(0, |part| part.chars().count())
}

/// What there is to say about all of them.
#[derive(Serialize)]
pub(super) struct Summary {
    pub(super) files: usize,
    pub(super) failed: usize,
    pub(super) mended: usize,
    pub(super) errors: usize,
    pub(super) warnings: usize,
    pub(super) remarks: usize,
}

impl Summary {
    pub(super) fn of(checked: &[Checked]) -> Self {
        let count = |severity| {
            let all = checked.iter().flat_map(|file| &file.findings);
            all.filter(|finding| finding.severity() == severity).count()
        };
        let failed = checked.iter().filter(|file| file.failed.is_some()).count();
        Self {
            files: checked.len() - failed,
            failed,
            mended: checked.iter().map(|file| file.mended).sum(),
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
            remarks: count(Severity::Info),
        }
    }
}
