use alloc::format;
use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::structure::shared::{counts, highest};
use crate::subject::Object;
use od_model::DataType;

pub(crate) static W0307: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "ARRAY or RECORD has no sub-index 0",
    why: "A master reads sub-index 0 to learn how many sub-objects exist.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 is missing",
    help: "add {missing} with `{DataType={right}}` and the highest sub-index as {DefaultValue}{fix}",
    check: Check::Object(check),
    ..Rule::of("W0307")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !counts(object) || object.object.entries.contains_key(&0) {
        return;
    }
    let missing = Fact::Section(object.index, Some(0));
    let finding = W0307.on(object, object.span).fact("missing", missing);
    findings.push(finding.fact("right", DataType::Unsigned8).fix(fix(object)));
}

/// Adds a sub-index 0 before the first sub-object.
fn fix(object: &Object<'_>) -> Fix {
    let Some(first) = object.entries().next() else {
        return Fix::unsafe_fix();
    };
    let (index, highest) = (object.index, highest(object));
    Fix::unsafe_fix().above(
        first.span,
        format!(
            "[{index:04X}sub0]\nParameterName=Highest sub-index supported\nObjectType=0x7\n\
             DataType=0x0005\nAccessType=ro\nDefaultValue={highest}\nPDOMapping=0\n"
        ),
    )
}
