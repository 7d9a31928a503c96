use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0354: Rule = Rule {
    title: "object with an object code that has no value",
    why: "A tool reads the object as the definition of a data type, and offers no value. odkit reads its value as that of a VAR or RECORD.",
    source: "CiA 301, object codes and object dictionary structure",
    says: "{object} is {code}, but the indices of data types are 0001h to 025Fh",
    help: "write `{ObjectType}=0x7` (VAR), 0x8 (ARRAY) or 0x9 (RECORD){fix}",
    also: &[NULL],
    fixability: Fixability::Unsafe,
    check: Check::Object(check),
    ..Rule::of("W0354")
};

/// Sentence for the object code 0.
const NULL: Form = Form {
    says: "{object} is {code}, an object without a value, but it has a data type",
    ..Form::OWN
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let is_type = matches!(*object.code, ObjectCode::DefType | ObjectCode::DefStruct);
    if is_type && object.index >= 0x1000 {
        let finding = W0354.on(object, object.code.span);
        let finding = finding.fact("object", Fact::Index(object.index));
        findings.push(with_code(finding, object));
    }
    let is_typed = object.entries().any(|entry| entry.data_type.is_some());
    if *object.code == ObjectCode::Null && is_typed {
        let finding = W0354.on(object, object.code.span).form(&NULL);
        let finding = finding.fact("object", Fact::Index(object.index));
        findings.push(with_code(finding, object));
    }
}

/// The finding with the object code, and the fix that writes the code that fits the sub-objects.
fn with_code(finding: Finding, object: &Object<'_>) -> Finding {
    let is_list = object.entries().any(|entry| entry.address.sub > 0);
    let right = if is_list { "0x9" } else { "0x7" };
    let fix = Fix::unsafe_fix().replace(object.code.span, right);
    finding.fact("code", *object.code).fix(fix)
}
