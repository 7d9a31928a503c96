//! A line for each finding: `my.eds:14:3: warning[W0445] 2001h "Gain": …`.

use od_eds::{Eds, Finding, say};

use super::checked::Checked;
use crate::report::plural;

fn line(checked: &Checked, finding: &Finding) -> String {
    let sentence = say(finding, &Eds);
    let level = sentence.severity.name();
    let object = finding
        .object
        .map(|address| match checked.names.get(&address) {
            Some(name) => format!("{name}: "),
            None => format!("{address}: "),
        });
    let fixable = if finding.fix.is_some() {
        " [fixable]"
    } else {
        ""
    };
    // Quoted text of a file may contain other line ends.
    let message = sentence.message.replace(['\r', '\n'], " ");
    let object = object.unwrap_or_default();
    format!("{level}[{}]{fixable} {object}{message}", sentence.code)
}

fn place(finding: &Finding) -> String {
    match finding.span() {
        Some(span) => format!("{}:{}:", span.line, span.column),
        None => "1:1:".to_owned(),
    }
}

/// Path, line and column before each finding.
pub(super) fn concise(checked: &Checked, findings: Vec<Finding>) -> String {
    let mut out = String::new();
    for part in checked.file.parts(findings) {
        for finding in &part.findings {
            let (path, place) = (part.path, place(finding));
            out.push_str(&format!("{path}:{place} {}\n", line(checked, finding)));
        }
    }
    out
}

/// The path on its own line, with the number of findings.
pub(super) fn grouped(checked: &Checked, findings: Vec<Finding>) -> String {
    let mut out = String::new();
    for part in checked.file.parts(findings) {
        if part.findings.is_empty() {
            continue;
        }
        let count = plural(part.findings.len(), "finding");
        out.push_str(&format!("{} ({count})\n", part.path));
        for finding in &part.findings {
            out.push_str(&format!(
                "  {} {}\n",
                place(finding),
                line(checked, finding)
            ));
        }
        out.push('\n');
    }
    out
}
