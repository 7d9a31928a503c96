//! The report as one JSON object; `version` counts changes that break its readers.

use od_eds::fix::{Applicability, TextEdit};
use od_eds::{Eds, Finding, Label, Severity, Span, say};
use serde::Serialize;

use super::checked::{Checked, Summary};

#[derive(Serialize)]
struct Report<'a> {
    version: u32,
    odkit: &'static str,
    files: Vec<File<'a>>,
    summary: &'a Summary,
}

#[derive(Serialize)]
struct File<'a> {
    path: &'a str,
    failed: Option<&'a str>,
    fixed: usize,
    /// The name that readers of version 1 know.
    #[serde(rename = "diagnostics")]
    findings: Vec<Reported>,
}

/// Bytes are counted from 0 in the text as UTF-8, lines and columns from 1.
#[derive(Serialize)]
struct Reported {
    code: &'static str,
    severity: Severity,
    message: String,
    help: String,
    object: Option<String>,
    index: Option<u16>,
    sub: Option<u8>,
    span: Option<Span>,
    labels: Vec<Label>,
    fix: Option<Fix>,
}

#[derive(Serialize)]
struct Fix {
    applicability: Applicability,
    edits: Vec<TextEdit>,
}

pub(super) fn report(checked: &[Checked], summary: &Summary) -> String {
    let report = Report {
        version: 2,
        odkit: env!("CARGO_PKG_VERSION"),
        files: checked.iter().map(file).collect(),
        summary,
    };
    // Keys in the order of the alphabet. None of these types can fail.
    let value = serde_json::to_value(report).unwrap_or_default();
    format!("{value:#}")
}

fn file(checked: &Checked) -> File<'_> {
    let text = checked.file.text();
    File {
        path: &checked.file.path,
        failed: checked.failed.as_deref(),
        fixed: checked.fixed,
        findings: checked
            .findings
            .iter()
            .map(|finding| reported(finding, text))
            .collect(),
    }
}

fn reported(finding: &Finding, text: &str) -> Reported {
    let finding = say(finding, &Eds);
    let fix = finding.fix.as_ref();
    Reported {
        code: finding.code,
        severity: finding.severity,
        object: finding.address.map(|address| address.to_string()),
        index: finding.address.map(|address| address.index),
        sub: finding.address.map(|address| address.sub),
        span: finding.span,
        fix: fix.and_then(|fix| {
            Some(Fix {
                applicability: fix.applicability,
                edits: fix.text_edits(text)?,
            })
        }),
        message: finding.message,
        help: finding.help,
        labels: finding.labels,
    }
}
