use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::standard::shared::{code, data_type, value};
use crate::subject::Object;
use od_model::{DataType, ObjectCode};

pub(crate) static E0605: Rule = Rule {
    code: "E0605",
    severity: Error,
    title: "object 1001h differs from CiA 301",
    why: "A master that reads 1001h as an UNSIGNED8 VAR gets another length, or an abort.",
    source: "CiA 301, object 1001h",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA 301 specifies {right}",
    help: "write `{key={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if object.index == 0x1001 {
        findings.extend(code(&E0605, object, &[ObjectCode::Var]));
        findings
            .extend(value(object).and_then(|entry| data_type(&E0605, &entry, DataType::Unsigned8)));
    }
}
