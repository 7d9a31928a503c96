//! Compares how tools read a file with how odkit reads it.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::allow::Allows;
use crate::description::Description;
use crate::document::{Document, is_xml};
use crate::finding::{Finding, Place, Severity, sort};
use crate::scan::lines::is_too_large;
use crate::tools::compare::Compare;
use crate::tools::shared;
use crate::tools::tool::{Input, Reading, Tool};

/// Verdict of a tool on a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The tool reads all of it in the same way as odkit.
    Accepts,
    /// The tool drops content, or reads it differently.
    Differs,
    /// The tool rejects it.
    Rejects,
}

impl Verdict {
    /// One or two words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Accepts => "accepts",
            Self::Differs => "reads differently",
            Self::Rejects => "rejects",
        }
    }
}

/// The verdict that follows from the findings of one tool.
pub fn verdict(findings: &[Finding]) -> Verdict {
    match findings {
        [] => Verdict::Accepts,
        _ if findings
            .iter()
            .any(|finding| finding.rule.severity == Severity::Error) =>
        {
            Verdict::Rejects
        }
        _ => Verdict::Differs,
    }
}

/// Reads a file as a tool does.
pub fn reading(document: &Document, tool: &Tool) -> Reading {
    let mark: &[u8] = b"\xEF\xBB\xBF";
    let bytes = document.bytes();
    let body = bytes.strip_prefix(mark).unwrap_or(bytes);
    let input = Input {
        text: core::str::from_utf8(body).ok(),
        bytes: body,
        decoded: document.text(),
        has_mark: body.len() < bytes.len(),
    };
    let is_placed = input.text == Some(document.text());
    let mut reading = (tool.read)(&input);
    for finding in &mut reading.findings {
        if !is_placed {
            finding.place = Place::Nowhere;
            finding.related.clear();
        }
        if !is_placed || is_xml(document.text()) {
            finding.fix = None;
        }
    }
    reading
}

/// Returns whether odkit reads a file as the tools do. A file with so many lines or sections that odkit does not read all of
/// it describes no device, and the tools take minutes for it.
pub fn is_compared(document: &Document) -> bool {
    !is_too_large(document.text())
}

/// Returns findings about content that these tools reject, drop or read differently, in file order, without
/// findings that the text allows. A fix is right for all of the tools.
///
/// `description` is the description that odkit read. A file that [is not compared](is_compared) has no findings.
pub fn check(
    document: &Document,
    description: &Description,
    tools: &[&'static Tool],
) -> Vec<Finding> {
    let mut found = Vec::new();
    let tools = if is_compared(document) { tools } else { &[] };
    for tool in tools {
        let reading = reading(document, tool);
        let mut own = Vec::new();
        if let Some(rules) = tool.differences.filter(|_| !reading.is_rejected()) {
            let mut compare = Compare {
                text: document.text(),
                tools,
                rules,
                node_id: reading.node_id.unwrap_or(shared::NODE_ID),
                found: Vec::new(),
            };
            compare.all(description, &reading);
            own = compare.found;
        }
        let rejected = reading.is_rejected();
        let of_text = reading.findings.into_iter();
        own.extend(of_text.filter(|finding| !rejected || finding.is_error()));
        // Sub-objects of CompactSubObj come from one section, and some tools check a value twice.
        let mut known = BTreeSet::new();
        own.retain(|finding| {
            let is_name = |fact: &&(&str, _)| finding.object.is_none() && fact.0 == "name";
            let name = finding.facts.iter().find(is_name);
            let facts = name.map_or(String::new(), |name| format!("{name:?}"));
            let at = finding.span();
            at.is_none() || known.insert((finding.code(), at, facts))
        });
        found.extend(
            own.into_iter()
                .map(|finding| finding.fact("tool", tool.name)),
        );
    }
    Allows::of(document.text()).filter(&mut found);
    sort(&mut found);
    found
}
