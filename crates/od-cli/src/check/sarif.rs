//! SARIF 2.1.0, the format of code scanning services.

use od_eds::check::all;
use od_eds::fix::TextEdit;
use od_eds::{Eds, Finding, Offsets, Severity, Span, say};
use serde_json::{Value, json};

use super::checked::{Checked, end_column};
use crate::source::Part;

const SCHEMA: &str =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json";

pub(super) fn report(checked: &[Checked]) -> String {
    let rules: Vec<Value> = all()
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
        .flat_map(Checked::parts)
        .flat_map(|part| {
            let places = Places::of(&part);
            let results = part.findings.iter();
            results
                .map(|finding| result(&places, finding))
                .collect::<Vec<_>>()
        })
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

/// A file, and the places of its text.
struct Places<'a> {
    file: &'a Part<'a>,
    offsets: Offsets<'a>,
    /// Characters before each block of [`STEP`] bytes of the text.
    characters: Vec<usize>,
}

/// Bytes of a block.
const STEP: usize = 512;

impl<'a> Places<'a> {
    fn of(file: &'a Part<'a>) -> Self {
        let starts = |piece: &[u8]| piece.iter().filter(|byte| is_start(**byte)).count();
        let pieces = file.document.text().as_bytes().chunks(STEP);
        let mut before = 0;
        let counted = pieces.map(|piece| {
            let here = before;
            before += starts(piece);
            here
        });
        Self {
            file,
            offsets: file.document.offsets(),
            characters: counted.collect(),
        }
    }

    /// Number of characters before a byte of the text.
    fn characters(&self, at: usize) -> usize {
        let text = self.file.document.text().as_bytes();
        let at = at.min(text.len());
        let near = (at / STEP).min(self.characters.len().saturating_sub(1));
        let known = self.characters.get(near).copied().unwrap_or(0);
        let rest = text.get(near * STEP..at).unwrap_or_default();
        known + rest.iter().filter(|byte| is_start(**byte)).count()
    }

    /// The bytes of the file for a range of bytes of the text.
    fn bytes(&self, start: u32, end: u32) -> (usize, usize) {
        let [start, end] = [start, end].map(|at| self.offsets.byte(at as usize));
        (start, end - start)
    }
}

/// Returns whether a UTF-8 character begins with this byte.
const fn is_start(byte: u8) -> bool {
    byte & 0xC0 != 0x80
}

fn result(file: &Places<'_>, finding: &Finding) -> Value {
    let finding = say(finding, &Eds);
    let text = file.file.document.text();
    let mut message = finding.with_object();
    if !finding.help.is_empty() {
        message = format!("{message} ({})", finding.help);
    }
    let mut result = json!({
        "ruleId": finding.code,
        "ruleIndex": all().position(|rule| rule.code == finding.code),
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
        let replacements: Vec<Value> = edits.iter().map(|edit| replacement(file, edit)).collect();
        result["fixes"] = json!([{
            "description": { "text": finding.help },
            "artifactChanges": [{
                "artifactLocation": { "uri": uri(file.file.path) },
                "replacements": replacements,
            }],
        }]);
    }
    result
}

fn location(file: &Places<'_>, span: Option<Span>, what: Option<&str>) -> Value {
    let mut place = json!({ "artifactLocation": { "uri": uri(file.file.path) } });
    if let Some(span) = span {
        let (start, length) = file.bytes(span.start, span.end);
        place["region"] = json!({
            "startLine": span.line,
            "startColumn": span.column,
            "endLine": span.line,
            "endColumn": end_column(file.file.document.text(), span),
            "byteOffset": start,
            "byteLength": length,
        });
    }
    let mut location = json!({ "physicalLocation": place });
    if let Some(what) = what {
        location["message"] = json!({ "text": what });
    }
    location
}

/// An edit: in characters after a byte order mark, as SARIF counts them, and in bytes of the file.
fn replacement(file: &Places<'_>, edit: &TextEdit) -> Value {
    let [start, end] = [edit.start, edit.end].map(|at| file.characters(at as usize));
    let (byte, length) = file.bytes(edit.start, edit.end);
    json!({
        "deletedRegion": {
            "charOffset": start,
            "charLength": end - start,
            "byteOffset": byte,
            "byteLength": length,
        },
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
