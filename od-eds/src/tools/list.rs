//! The tools, and their rules.

use crate::finding::Rule;
use crate::tools::python_canopen;
use crate::tools::tool::Tool;

/// Every tool, those that were tried first.
pub static TOOLS: &[&Tool] = &[&python_canopen::TOOL];

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
