use alloc::format;

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "E0428",
    severity: Error,
    title: "$NODEID is misspelled",
    why: "No tool knows the name, and the value has no number. odkit leaves the value out of the dictionary.",
    source: "CiA 306-1, $NODEID",
    fixability: Fixability::Unsafe,
    says: "{key} `{given}` has another name than `$NODEID`",
    help: "write `$NODEID+0x{offset:X}`{fix}",
    ..Rule::NEW
};

/// The finding about a formula with this offset, whose name of the node ID is not the one of CiA 306.
pub(crate) fn finding(key: Key, given: &Text<'_>, offset: u32) -> Finding {
    let right = format!("$NODEID+0x{offset:X}");
    let finding = RULE.given(given).key(key).fact("offset", offset);
    finding.fix(Fix::unsafe_fix().replace(given.span, right))
}
