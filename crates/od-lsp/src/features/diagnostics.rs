//! Findings as diagnostics of the protocol.

use od_eds::{Description, Eds, Finding, Severity, say};

use crate::file::{File, Seen};
use crate::layout::bytes;
use crate::types::{Diagnostic, Location, Range, RelatedInformation};
use crate::words;

/// The findings of a text.
pub(crate) fn of(file: &File, seen: &Seen) -> Vec<Diagnostic> {
    let findings = seen.findings.iter();
    let findings = findings.map(|finding| one(file, &seen.description, finding));
    let problems = seen.problems.iter().map(|(bytes, why)| Diagnostic {
        range: file.text.range(bytes.clone()),
        severity: severity(Severity::Error),
        code: "",
        source: "odkit",
        message: why.clone(),
        related_information: Vec::new(),
    });
    problems.chain(findings).collect()
}

/// One finding; a finding without a place is shown at the start of the text.
pub(crate) fn one(file: &File, description: &Description, finding: &Finding) -> Diagnostic {
    let said = say(finding, &Eds);
    let place = |span| file.text.range(bytes(span));
    let related = said.labels.iter().map(|label| RelatedInformation {
        location: Location {
            uri: file.uri.clone(),
            range: place(label.span),
        },
        message: label.text.clone(),
    });
    let about = said
        .address
        .map(|address| words::object(description, address));
    let mut message = match about {
        Some(about) => format!("{about}: {}", said.message),
        None => said.message,
    };
    if !said.help.is_empty() {
        message.push_str("\nhelp: ");
        message.push_str(&said.help);
    }
    Diagnostic {
        range: said.span.map_or(Range::default(), place),
        severity: severity(finding.severity()),
        code: said.code,
        source: "odkit",
        message,
        related_information: related.collect(),
    }
}

const fn severity(severity: Severity) -> u8 {
    match severity {
        Severity::Error => 1,
        Severity::Warning => 2,
        Severity::Info => 3,
    }
}
