//! SARIF 2.1.0: what code scanning services read.

use od_eds::check::RULES;
use od_eds::fix::TextEdit;
use od_eds::{Eds, Finding, Severity, Span, say};
use serde_json::{Value, json};

use super::checked::{Checked, about, end_column};

const SCHEMA: &str =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json";

pub(super) fn report(checked: &[Checked]) -> String {
    let rules: Vec<Value> = RULES
        .iter()
        .map(|rule| {
            json!({
                "id": rule.code,
                "shortDescription": { "text": rule.title },
                "fullDescription": { "text": rule.why },
                "help": { "text": format!("{} ({})", rule.why, rule.source) },
                "defaultConfiguration": { "level": level(rule.severity) },
            })
        })
        .collect();
    let results: Vec<Value> = checked
        .iter()
        .flat_map(|file| file.findings.iter().map(|finding| result(file, finding)))
        .collect();
    let failed: Vec<Value> = checked
        .iter()
        .filter_map(|file| {
            let why = file.failed.as_ref()?;
            Some(json!({
                "level": "error",
                "message": { "text": format!("{}: {why}", file.file.path) },
            }))
        })
        .collect();
    let report = json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "odkit",
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "invocations": [{
                "executionSuccessful": failed.is_empty(),
                "toolExecutionNotifications": failed,
            }],
            "results": results,
        }],
    });
    format!("{report:#}")
}

const fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "note",
    }
}

fn result(file: &Checked, finding: &Finding) -> Value {
    let finding = say(finding, &Eds);
    let text = file.file.text();
    let mut message = about(&finding);
    if !finding.help.is_empty() {
        message = format!("{message} ({})", finding.help);
    }
    let mut result = json!({
        "ruleId": finding.code,
        "ruleIndex": RULES.iter().position(|rule| rule.code == finding.code),
        "level": level(finding.severity),
        "message": { "text": message },
        "locations": [location(file, finding.span, None)],
    });
    if !finding.labels.is_empty() {
        let related = finding
            .labels
            .iter()
            .map(|label| location(file, Some(label.span), Some(&label.text)));
        result["relatedLocations"] = related.collect();
    }
    if let Some(fix) = &finding.fix
        && let Some(edits) = fix.text_edits(text)
    {
        let replacements: Vec<Value> = edits.iter().map(|edit| replacement(text, edit)).collect();
        result["fixes"] = json!([{
            "description": { "text": finding.help },
            "artifactChanges": [{
                "artifactLocation": { "uri": uri(&file.file.path) },
                "replacements": replacements,
            }],
        }]);
    }
    result
}

fn location(file: &Checked, span: Option<Span>, what: Option<&str>) -> Value {
    let mut place = json!({ "artifactLocation": { "uri": uri(&file.file.path) } });
    if let Some(span) = span {
        place["region"] = json!({
            "startLine": span.line,
            "startColumn": span.column,
            "endLine": span.line,
            "endColumn": end_column(file.file.text(), span),
        });
    }
    let mut location = json!({ "physicalLocation": place });
    if let Some(what) = what {
        location["message"] = json!({ "text": what });
    }
    location
}

/// An edit by characters from the start of the file, as SARIF counts them.
fn replacement(text: &str, edit: &TextEdit) -> Value {
    let (start, end) = (edit.start as usize, edit.end as usize);
    let count = |range| text.get(range).map_or(0, |part: &str| part.chars().count());
    json!({
        "deletedRegion": { "charOffset": count(0..start), "charLength": count(start..end) },
        "insertedContent": { "text": edit.text },
    })
}

/// A path as a relative or `file:` reference.
fn uri(path: &str) -> String {
    let path = path.replace('\\', "/");
    let mut uri = String::new();
    if path.starts_with('/') {
        uri.push_str("file://");
    }
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' => uri.push(char::from(byte)),
            b'/' | b'-' | b'.' | b'_' | b'~' => uri.push(char::from(byte)),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_references() {
        assert_eq!(uri("eds/a b.eds"), "eds/a%20b.eds");
        assert_eq!(uri("/x/µ.eds"), "file:///x/%C2%B5.eds");
        assert_eq!(uri("eds\\a.eds"), "eds/a.eds");
    }
}
