//! The report as one JSON object; `version` increases with each incompatible change.

use od_eds::fix::{self, Applicability, TextEdit};
use od_eds::{Eds, Finding, Label, Offsets, Severity, Span, say};
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
    /// The tools of `--for`, with the result of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tools: Vec<Outcome>,
    /// Fixes that would do harm.
    held: Vec<Held>,
    /// Name of the field in version 1.
    #[serde(rename = "diagnostics")]
    findings: Vec<Reported>,
}

/// Offsets count bytes of the file on the disk from 0, lines and columns count from 1; columns
/// count characters.
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

/// Result of a tool for the file.
#[derive(Serialize)]
struct Outcome {
    name: &'static str,
    version: &'static str,
    tried: bool,
    verdict: &'static str,
}

/// A fix that was not applied, because it would do harm.
#[derive(Serialize)]
struct Held {
    code: &'static str,
    object: Option<String>,
    line: Option<u32>,
    why: String,
}

#[derive(Serialize)]
struct Fix {
    applicability: Applicability,
    edits: Vec<TextEdit>,
}

pub(super) fn report(checked: &[Checked], summary: &Summary) -> String {
    let report = Report {
        version: 3,
        odkit: env!("CARGO_PKG_VERSION"),
        files: checked.iter().flat_map(files).collect(),
        summary,
    };
    // Keys in alphabetical order. None of these types can fail.
    let value = serde_json::to_value(report).unwrap_or_default();
    format!("{value:#}")
}

/// The files of a check; fixes and failures belong to the first.
fn files(checked: &Checked) -> Vec<File<'_>> {
    let parts = checked.parts().into_iter();
    let files = parts.enumerate().map(|(at, part)| {
        let (document, offsets) = (part.document, part.document.offsets());
        let findings = part.findings.iter();
        File {
            path: part.path,
            failed: checked.failed.as_deref().filter(|_| at == 0),
            tools: outcomes(checked, at == 0),
            fixed: if at == 0 { checked.fixed } else { 0 },
            held: match at {
                0 => checked.held.iter().map(held).collect(),
                _ => Vec::new(),
            },
            findings: findings
                .map(|finding| reported(finding, document.text(), &offsets))
                .collect(),
        }
    });
    files.collect()
}

fn outcomes(checked: &Checked, is_first: bool) -> Vec<Outcome> {
    let tools = checked
        .tools
        .iter()
        .filter(|_| is_first && checked.failed.is_none());
    let outcomes = tools.map(|tool| Outcome {
        name: tool.name,
        version: tool.version,
        tried: tool.tried,
        verdict: checked.verdict(tool),
    });
    outcomes.collect()
}

/// Converts edits of the text to edits of the file.
fn on_disk(mut edits: Vec<TextEdit>, offsets: &Offsets<'_>) -> Vec<TextEdit> {
    for edit in &mut edits {
        edit.start = offsets.byte(edit.start as usize) as u32;
        edit.end = offsets.byte(edit.end as usize) as u32;
    }
    edits
}

fn held(held: &fix::Held) -> Held {
    let finding = &held.finding;
    Held {
        code: finding.code(),
        object: finding.object.map(|address| address.to_string()),
        line: finding.span().map(|span| span.line),
        why: held.why.to_string(),
    }
}

fn reported(finding: &Finding, text: &str, offsets: &Offsets<'_>) -> Reported {
    let mut finding = say(finding, &Eds);
    for label in &mut finding.labels {
        label.span = offsets.span(label.span);
    }
    let fix = finding.fix.as_ref();
    Reported {
        code: finding.code,
        severity: finding.severity,
        object: finding.address.map(|address| address.to_string()),
        index: finding.address.map(|address| address.index),
        sub: finding.address.map(|address| address.sub),
        span: finding.span.map(|span| offsets.span(span)),
        fix: fix.and_then(|fix| {
            Some(Fix {
                applicability: fix.applicability,
                edits: on_disk(fix.text_edits(text)?, offsets),
            })
        }),
        message: finding.message,
        help: finding.help,
        labels: finding.labels,
    }
}
