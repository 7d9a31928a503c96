//! Findings as Python objects.

use od_eds::fix::Applicability;
use od_eds::{Eds, Severity, say, tools};
use pyo3::prelude::*;

use crate::files::source::Source;

/// One finding about a description: what is wrong, where, and what to write instead.
///
/// `str(finding)` is the line that `odkit check --output-format concise` prints.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Finding {
    /// The code of its rule, such as `E0412`; `odkit explain E0412` explains it.
    code: &'static str,
    /// `error`, `warning` or `info`.
    severity: &'static str,
    /// The problem, one clause.
    message: String,
    /// Help: what to write instead; empty if the message contains it.
    help: String,
    /// The consequence for a master or a tool.
    why: &'static str,
    /// Standard and clause.
    source: &'static str,
    /// The file of the finding, base or overlay; `None` for a text.
    path: Option<String>,
    /// Line, from 1; `None` if something is missing.
    line: Option<u32>,
    /// Column in characters, from 1; `None` if something is missing.
    column: Option<u32>,
    /// Index of the object, if it is about one.
    index: Option<u16>,
    /// Sub-index of the object, if it is about one.
    sub: Option<u8>,
    /// The fix that odkit has: `safe`, `unsafe`, or `None`.
    fix: Option<&'static str>,
    /// The tool that reads the file in this way, for a check with `for_`; otherwise `None`.
    tool: Option<&'static str>,
}

impl Finding {
    /// A finding of a text.
    pub(crate) fn of(source: &Source, finding: &od_eds::Finding) -> Self {
        let (path, placed) = source.place(finding.clone());
        let said = say(&placed, &Eds);
        Self {
            code: said.code,
            severity: match said.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Info => "info",
            },
            help: said.help,
            why: finding.rule.why,
            source: finding.rule.source,
            path: path.map(str::to_owned),
            line: said.span.map(|span| span.line),
            column: said.span.map(|span| span.column),
            index: said.address.map(|address| address.index),
            sub: said.address.map(|address| address.sub),
            fix: said.fix.as_ref().map(|fix| match fix.applicability {
                Applicability::Safe => "safe",
                Applicability::Unsafe => "unsafe",
            }),
            tool: tools::tool_of(said.code).map(|tool| tool.name),
            message: said.message,
        }
    }

    /// All findings of a text.
    pub(crate) fn all(source: &Source, findings: &[od_eds::Finding]) -> Vec<Self> {
        findings.iter().map(|one| Self::of(source, one)).collect()
    }
}

#[pymethods]
impl Finding {
    fn __str__(&self) -> String {
        let path = self.path.as_deref().unwrap_or("text");
        let level = match self.severity {
            "info" => "remark",
            other => other,
        };
        let fixable = if self.fix.is_some() { " [fixable]" } else { "" };
        let object = match (self.index, self.sub) {
            (Some(index), Some(0)) => format!("{index:04X}h: "),
            (Some(index), Some(sub)) => format!("{index:04X}h:{sub:02X}: "),
            _ => String::new(),
        };
        let (line, column) = (self.line.unwrap_or(1), self.column.unwrap_or(1));
        let message = self.message.replace(['\r', '\n'], " ");
        format!(
            "{path}:{line}:{column}: {level}[{}]{fixable} {object}{message}",
            self.code
        )
    }

    fn __repr__(&self) -> String {
        format!("<odkit.Finding {}>", self.__str__())
    }
}
