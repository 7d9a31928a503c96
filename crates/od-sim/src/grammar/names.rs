//! Names of faults and NMT commands, for lines of every kind.

use od_wire::nmt::Command;

use super::problem::Problem;
use super::tokens::Tokens;
use crate::device::faults;

/// Reads the name of a fault.
pub(super) fn fault_name(tokens: &mut Tokens<'_>) -> Result<&'static str, Problem> {
    tokens.one_of("fault", &faults::NAMES.map(|name| (name, name)))
}

/// Reads an NMT command and its node: 0 for `all`, `None` if it is missing.
pub(crate) fn nmt_command(tokens: &mut Tokens<'_>) -> Result<(Command, Option<u8>), Problem> {
    let command = tokens.one_of(
        "NMT command",
        &[
            ("start", Command::Start),
            ("stop", Command::Stop),
            ("preop", Command::EnterPreOperational),
            ("reset", Command::ResetNode),
            ("reset-comm", Command::ResetCommunication),
        ],
    )?;
    let node = if tokens.is_empty() {
        None
    } else if tokens.take("all") {
        Some(0)
    } else {
        Some(tokens.number(0, 127)? as u8)
    };
    Ok((command, node))
}
