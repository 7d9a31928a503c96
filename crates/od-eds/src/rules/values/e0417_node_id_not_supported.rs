use alloc::vec::Vec;

use crate::description::Value;
use crate::fact::{Fact, Key};
use crate::finding::{Check, Finding, Rule};
use crate::rules::values::shared::{DECLARED, data_type, values};
use crate::span::{Span, Spanned};
use crate::subject::Entry;
use od_model::DataType;

pub(crate) static E0417: Rule = Rule {
    title: "$NODEID in a type that does not support it",
    why: "Only UNSIGNED8, UNSIGNED16, UNSIGNED24 and UNSIGNED32 can depend on the node ID.",
    source: "CiA 306-1, $NODEID",
    says: "{key} `{given}` uses $NODEID, which {type} does not support",
    help: "write a number, or `{DataType={right}}` ({right})",
    check: Check::Entry(check),
    ..Rule::of("E0417")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Some(data_type) = data_type(entry).filter(|given| !given.holds_node_id()) else {
        return;
    };
    for (key, value) in values(entry) {
        if matches!(value.value, Value::NodeId(_)) {
            let span = value.span.or(entry.span);
            let finding = finding(key, value.value.clone(), span, data_type);
            findings.push(finding.about(entry.address));
        }
    }
}

/// The finding about a formula of a type that cannot have one.
pub(crate) fn finding(
    key: Key,
    given: impl Into<Fact>,
    span: Span,
    data_type: Spanned<DataType>,
) -> Finding {
    let finding = E0417.at(span).key(key).fact("given", given);
    finding
        .fact("type", *data_type)
        .fact("right", DataType::Unsigned32)
        .related(data_type.span, DECLARED)
}
