//! Tools that read device files: what each rejects, drops, or reads otherwise than the standard says.
//!
//! A tool reads text, not odkit's description of it. So each has a reader of its own here, which takes the lines
//! as they are and says what the tool makes of them; what it makes is compared with the description.
//!
//! ```
//! use od_eds::{Document, tools};
//!
//! let file = Document::new(b"[2000]\nParameterName=a\nDataType=0x5\nAccessType=rw\nDefaultValue=010\n");
//! let tool = tools::tool("python-canopen").unwrap();
//! let findings = tools::check(&file, &file.parse().description, &[tool]);
//! assert_eq!(findings[0].code(), "T0112");
//! assert_eq!(tools::verdict(&findings), tools::Verdict::Differs);
//! ```

mod canopen_rs;
mod canopennode_editor;
mod codesys;
mod compare;
mod configparser;
mod dcf_tools;
mod npm_canopen;
mod python;
mod python_canopen;
mod shared;
mod tool;
mod twincat;

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::allow::Allows;
use crate::description::Description;
use crate::document::Document;
use crate::finding::{Finding, Place, Rule, Severity, sort};
use crate::load::is_xml;
use crate::tools::compare::Compare;
use crate::tools::tool::Input;

pub use tool::{Read, ReadEntry, Reading, Tool};

/// Result of a tool for a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The tool reads all of it, as odkit does.
    Accepts,
    /// The tool drops something, or reads it as something else.
    Differs,
    /// The tool gives it up.
    Rejects,
}

impl Verdict {
    /// In a word or two.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Accepts => "accepts",
            Self::Differs => "reads differently",
            Self::Rejects => "rejects",
        }
    }
}

/// The verdict that the findings of one tool make.
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

/// Returns what these tools reject, drop or read differently, in file order, without findings that the text
/// allows. A fix suits all of them.
///
/// `description` is what odkit reads of the file.
pub fn check(
    document: &Document,
    description: &Description,
    tools: &[&'static Tool],
) -> Vec<Finding> {
    let mut found = Vec::new();
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
        // Members of CompactSubObj come from one section, and some tools look at a value twice.
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

/// Every tool, those that were tried first.
pub static TOOLS: &[&Tool] = &[
    &python_canopen::TOOL,
    &dcf_tools::TOOL,
    &npm_canopen::TOOL,
    &canopen_rs::TOOL,
    &canopennode_editor::TOOL,
    &codesys::TOOL,
    &twincat::TOOL,
];

/// The tool of this name, in any case.
pub fn tool(name: &str) -> Option<&'static Tool> {
    let mut tools = TOOLS.iter().copied();
    tools.find(|tool| tool.name.eq_ignore_ascii_case(name))
}

/// The rules of all tools.
pub fn rules() -> impl Iterator<Item = &'static Rule> {
    TOOLS.iter().flat_map(|tool| tool.rules.iter().copied())
}

/// The tool whose rule has this code.
pub fn tool_of(code: &str) -> Option<&'static Tool> {
    let mut tools = TOOLS.iter().copied();
    tools.find(|tool| tool.rules.iter().any(|rule| rule.code == code))
}

#[cfg(test)]
mod tests;
