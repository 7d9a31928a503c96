use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;

pub(crate) static W0219: Rule = Rule {
    title: "[Tools] does not match its sections",
    why: "A tool cannot start the program that belongs to the device.",
    source: "CiA 306-1, Tools",
    says: "Items is {given}, but section [Tool{tool}] is missing",
    help: "add a section [Tool{tool}], or lower Items{fix}",
    fixability: Fixability::Unsafe,
    also: &[LACKS],
    check: Check::Device(check),
    ..Rule::of("W0219")
};

/// Sentence for a tool without a name or a command.
const LACKS: Form = Form {
    says: "[Tool{tool}] lacks `{field}`",
    help: "add `{field}=` and its value",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let items = description
        .section("Tools")
        .and_then(|tools| tools.get("Items"));
    let Some(items) = items else {
        return;
    };
    for tool in 1..=number(items).unwrap_or(0).clamp(0, 255) {
        let Some(section) = description.section(&format!("Tool{tool}")) else {
            let finding = W0219.given(items).fact("tool", tool);
            let mut behind = (tool + 1..=255).map(|later| format!("Tool{later}"));
            let is_last = !behind.any(|later| description.section(&later).is_some());
            let fix = Fix::unsafe_fix();
            findings.push(if is_last {
                finding.fix(fix.replace(items.span, (tool - 1).to_string()))
            } else {
                finding
            });
            continue;
        };
        for field in ["Name", "Command"] {
            if section.get(field).is_none() {
                let finding = W0219.at(section.name.span).form(&LACKS);
                findings.push(finding.fact("tool", tool).fact("field", field));
            }
        }
    }
}
