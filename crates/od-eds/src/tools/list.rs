//! The tools that odkit knows, and the rules of each.

use crate::finding::Rule;
use crate::tools::tool::Tool;
use crate::tools::{
    canopen_rs, canopennode_editor, codesys, dcf_tools, npm_canopen, python_canopen, twincat,
};

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
