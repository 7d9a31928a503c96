use alloc::vec::Vec;

use crate::fact::{Fact, Key};
use crate::finding::{Check, Finding, Rule};
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0306: Rule = Rule {
    title: "ARRAY or RECORD has no sub-objects",
    why: "A master finds nothing to read or write. odkit leaves the object out of the dictionary.",
    source: "CiA 306-1, object sections",
    says: "the {code} has no sub-objects",
    help: "add {missing} and its other sub-objects, or remove the object",
    check: Check::Object(check),
    ..Rule::of("W0306")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let has_some = object.code.has_members() && *object.code != ObjectCode::DefStruct;
    // The reader has reported a CompactSubObj that it could not read.
    let unread = object
        .extra
        .iter()
        .any(|(key, _)| Key::CompactSubObj.is(key));
    if has_some && object.object.entries.is_empty() && !unread {
        let missing = Fact::Section(object.index, Some(1));
        let finding = W0306.on(object, object.span).fact("code", *object.code);
        findings.push(finding.fact("missing", missing));
    }
}
