use alloc::format;
use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule, Severity};
use crate::fix::Fix;
use crate::standards::cia301::{Members, Standard, of};
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0630: Rule = Rule {
    severity: Severity::Error,
    buildable: true,
    title: "standard object has another object code",
    why: "A master that knows the object from the standard reads sub-indices that do not exist, or misses some that exist.",
    source: "CiA 301, chapter 7.5; CiA 302",
    says: "{object} ({name}) is {given}, but {standard} specifies {right}",
    help: "write `{ObjectType={right}}`{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Object(check),
    ..Rule::of("W0630")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let own_rule = matches!(object.index, 0x1000 | 0x1001 | 0x1018);
    if let Some(standard) = of(object.index)
        && (!own_rule && !standard.is_like(*object.code) || is_other_list(object, standard))
    {
        // Both have the same values on the bus.
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
        let finding = finding.fact("standard", standard.source());
        // Another code than that of a list needs other sections.
        findings.push(if standard.is_like(*object.code) {
            let right = format!("0x{:X}", standard.code().code());
            finding.fix(Fix::unsafe_fix().replace(object.code.span, right))
        } else {
            finding
        });
    }
}

/// Returns whether the object is a RECORD that the standard specifies as an ARRAY, or an ARRAY that it specifies as a
/// RECORD. A mapping and 1026h are lists of equal values, so both codes fit. A tool that uses the description of
/// sub-index 1 for a whole ARRAY reads wrong sub-objects.
fn is_other_list(object: &Object<'_>, standard: &Standard) -> bool {
    let own = *object.code;
    let is_list = object.index == 0x1026 || matches!(standard.members, Members::Record([]));
    own != standard.code()
        && !is_list
        && matches!(own, ObjectCode::Array | ObjectCode::Record)
        && standard.is_like(own)
}
