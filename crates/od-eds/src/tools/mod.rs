//! Tools that read device files: the content that each rejects, drops or reads differently from the standard.
//!
//! A tool reads text, not odkit's description of it. Each therefore has a reader of its own here, which reads the
//! lines as the tool does; its result is compared with the description.
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
mod check;
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

use crate::finding::Rule;

pub use check::{Verdict, check, is_compared, reading, verdict};
pub use tool::{Read, ReadEntry, Reading, Tool};

/// All tools; those that were run come first.
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
