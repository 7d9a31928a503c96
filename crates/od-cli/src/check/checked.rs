//! The result of a check, from which every report is made.

use od_eds::fix::Held;
use od_eds::tools::{Tool, is_compared, verdict};
use od_eds::{Finding, Severity, Span};
use serde::Serialize;

use crate::report::Names;
use crate::source::{Part, Source};

/// Result for one file.
#[derive(Default)]
pub(super) struct Checked {
    pub(super) file: Source,
    pub(super) findings: Vec<Finding>,
    /// The file's part of a text report, rendered while other files are checked.
    pub(super) shown: String,
    /// Number of edits by fixes.
    pub(super) fixed: usize,
    /// Fixes that were not applied.
    pub(super) held: Vec<Held>,
    /// Reason why the file could not be read or written.
    pub(super) failed: Option<String>,
    /// The objects that the findings are about, in words.
    pub(super) names: Names,
    /// Error in the project's settings.
    pub(super) misused: Option<String>,
    /// The tools of `--for`.
    pub(super) tools: Vec<&'static Tool>,
    /// Whether warnings of this file count as errors.
    pub(super) strict: bool,
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

impl Checked {
    /// The files of the findings: base and overlay, each with its own findings.
    pub(super) fn parts(&self) -> Vec<Part<'_>> {
        self.file.parts(self.findings.clone())
    }

    /// The verdict of one tool in words.
    pub(super) fn verdict(&self, tool: &Tool) -> &'static str {
        if is_compared(self.file.document()) {
            verdict(&self.of_tool(tool)).name()
        } else {
            "not compared, the file is too large"
        }
    }

    /// The findings of one tool.
    pub(super) fn of_tool(&self, tool: &Tool) -> Vec<Finding> {
        let is_its = |finding: &&Finding| tool.rules.contains(&finding.rule);
        self.findings.iter().filter(is_its).cloned().collect()
    }
}

/// The column after a span, in characters.
pub(super) fn end_column(text: &str, span: Span) -> usize {
    let part = text.get(span.start as usize..span.end as usize);
    span.column as usize + part.map_or(0, |part| part.chars().count())
}

/// Counts over all files.
#[derive(Serialize)]
pub(super) struct Summary {
    pub(super) files: usize,
    pub(super) failed: usize,
    pub(super) fixed: usize,
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
            fixed: checked.iter().map(|file| file.fixed).sum(),
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
            remarks: count(Severity::Info),
        }
    }
}
