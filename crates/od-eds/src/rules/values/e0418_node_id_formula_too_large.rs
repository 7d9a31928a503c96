use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Rule};
use crate::rules::values::shared::{DECLARED, data_type, values};
use crate::subject::Entry;

pub(crate) static E0418: Rule = Rule {
    title: "$NODEID formula is too large for its DataType",
    why: "The highest node ID is 127, and the sum with it must be valid too.",
    source: "CiA 306-1, $NODEID",
    says: "{key} `{given}` is {sum} for node ID 127, which is not a valid {type}",
    help: "write at most `$NODEID+0x{most:X}`",
    check: Check::Entry(check),
    ..Rule::of("E0418")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Some(data_type) = data_type(entry).filter(|given| given.holds_node_id()) else {
        return;
    };
    for (key, value) in values(entry) {
        if let Value::NodeId(offset) = value.value
            && !value.fits(*data_type)
        {
            let high = data_type.integer_range().map_or(0, |(_, high)| high);
            let finding = E0418.on(entry, value.span).key(key);
            let finding = finding
                .fact("given", value.value.clone())
                .fact("sum", i128::from(offset) + 127)
                .fact("type", *data_type)
                .fact("most", high - 127);
            findings.push(finding.related(data_type.span, DECLARED));
        }
    }
}
