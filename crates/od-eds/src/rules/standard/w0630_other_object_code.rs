use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity};
use crate::standards::cia301::{is_standard_array, of};
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0630: Rule = Rule {
    code: "W0630",
    severity: Severity::Error,
    buildable: true,
    title: "standard object has another object code",
    why: "A master that knows the object from the standard reads sub-indices that do not exist, or misses some that exist.",
    source: "CiA 301, chapter 7.5; CiA 302",
    says: "{object} ({name}) is {given}, but {standard} specifies {right}",
    help: "write `{ObjectType={right}}`",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let own_rule = matches!(object.index, 0x1000 | 0x1001 | 0x1018);
    if let Some(standard) = of(object.index)
        && !own_rule
        && (!standard.is_like(*object.code) || is_record(object))
    {
        // A RECORD whose sub-objects have one type has the same values on the bus.
        let severity = if standard.is_like(*object.code) {
            Severity::Warning
        } else {
            Severity::Error
        };
        let finding = W0630.on(object, object.code.span).severity_of(severity);
        let finding = finding
            .fact("object", Fact::Index(object.index))
            .fact("name", standard.name);
        let finding = finding
            .fact("right", standard.code())
            .fact("given", *object.code);
        findings.push(finding.fact("standard", standard.source()));
    }
}

/// Returns whether the standard specifies the object as a list of equal values, and it is a RECORD.
/// A tool that reads an ARRAY by the description of sub-index 1 knows only the sub-objects in the
/// file.
fn is_record(object: &Object<'_>) -> bool {
    is_standard_array(object.index) && *object.code == ObjectCode::Record
}
