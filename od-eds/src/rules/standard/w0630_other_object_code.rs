use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::standards::cia301::of;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "W0630",
    severity: Error,
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
        && !standard.is_like(*object.code)
        && !own_rule
    {
        let finding = RULE.on(object, object.code.span);
        let finding = finding
            .fact("object", Fact::Index(object.index))
            .fact("name", standard.name);
        let finding = finding
            .fact("right", standard.code())
            .fact("given", *object.code);
        findings.push(finding.fact("standard", standard.source()));
    }
}
