use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::rules::standard::shared::{code, data_type};
use crate::subject::Object;
use od_model::{DataType, ObjectCode};

pub(crate) static E0606: Rule = Rule {
    title: "object 1018h differs from CiA 301",
    why: "A master that reads the identity gets another length, or an abort. 1018h is a RECORD of UNSIGNED32; sub-index 1, the vendor-ID, is mandatory.",
    source: "CiA 301, object 1018h",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA 301 specifies {right}",
    help: "write `{key={right}}`{fix}",
    also: &[NO_VENDOR],
    check: Check::Object(check),
    ..Rule::of("E0606")
};

/// Sentence for an identity without a vendor-ID.
const NO_VENDOR: Form = Form {
    says: "1018h lacks sub-index 1 (vendor-ID)",
    help: "add {missing}",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if object.index != 0x1018 {
        return;
    }
    findings.extend(code(
        &E0606,
        object,
        &[ObjectCode::Record, ObjectCode::Array],
    ));
    if !object.code.has_members() {
        return;
    }
    if !object.object.entries.contains_key(&1) {
        let missing = Fact::Section(0x1018, Some(1));
        findings.push(
            E0606
                .on(object, object.span)
                .form(&NO_VENDOR)
                .fact("missing", missing),
        );
    }
    let known = object
        .entries()
        .filter(|entry| (1..=4).contains(&entry.address.sub));
    findings.extend(known.filter_map(|entry| data_type(&E0606, &entry, DataType::Unsigned32)));
}
