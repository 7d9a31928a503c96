//! The report as one JSON object; `version` counts what breaks its readers.

use od_eds::{Eds, Finding, say};
use serde_json::{Value, json};

use super::{Checked, Summary};

pub(super) fn report(checked: &[Checked], summary: &Summary) -> String {
    let files: Vec<Value> = checked.iter().map(file).collect();
    let report = json!({
        "version": 1,
        "odkit": env!("CARGO_PKG_VERSION"),
        "files": files,
        "summary": {
            "files": summary.files,
            "failed": summary.failed,
            "mended": summary.mended,
            "errors": summary.errors,
            "warnings": summary.warnings,
            "remarks": summary.remarks,
        },
    });
    format!("{report:#}")
}

fn file(checked: &Checked) -> Value {
    let text = checked.document.text();
    let findings: Vec<Value> = checked.findings.iter().map(|d| finding(d, text)).collect();
    json!({
        "path": checked.path,
        "failed": checked.failed,
        "mended": checked.mended,
        "diagnostics": findings,
    })
}

/// Bytes are counted from 0 in the text as UTF-8, lines and columns from 1.
fn finding(finding: &Finding, text: &str) -> Value {
    let finding = say(finding, &Eds);
    let labels: Vec<Value> = finding
        .labels
        .iter()
        .map(|label| json!({ "span": label.span, "text": label.text }))
        .collect();
    let fix = finding.fix.as_ref().and_then(|fix| {
        let edits = fix.text_edits(text)?;
        Some(json!({ "applicability": fix.applicability, "edits": edits }))
    });
    json!({
        "code": finding.code,
        "severity": finding.severity,
        "message": finding.message,
        "help": finding.help,
        "object": finding.address.map(|address| address.to_string()),
        "index": finding.address.map(|address| address.index),
        "sub": finding.address.map(|address| address.sub),
        "span": finding.span,
        "labels": labels,
        "fix": fix,
    })
}
