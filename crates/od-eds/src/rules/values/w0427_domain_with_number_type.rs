use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::span::{Span, Spanned};
use crate::subject::{Object, Subject as _};
use od_model::{DataType, Kind, ObjectCode};

pub(crate) static W0427: Rule = Rule {
    title: "DOMAIN has the type of a number",
    why: "One tool transfers the content as a DOMAIN of any length, another as a number. odkit uses the DataType.",
    source: "CiA 301, object codes; CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} is DOMAIN, but {DataType} is {given}",
    help: "write `{ObjectType=0x7}` (VAR){fix}, or `{DataType=0x000F}` (DOMAIN)",
    check: Check::Object(check),
    ..Rule::of("W0427")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if *object.code == ObjectCode::Domain {
        let types = object.entries().filter_map(|entry| entry.data_type);
        let found = types.filter_map(|given| w0427_number_in_domain(object.code.span, given));
        findings.extend(found.map(|finding| finding.about(object.address())));
    }
}

/// The finding about the data type of an object or a sub-index that is a DOMAIN, if it is that of a number; `code` is
/// the place of its ObjectType.
pub(crate) fn w0427_number_in_domain(code: Span, given: Spanned<DataType>) -> Option<Finding> {
    if matches!(given.kind(), Kind::Text | Kind::Bytes | Kind::Record) {
        return None;
    }
    let finding = W0427.at(given.span).fact("given", *given);
    let finding = finding.related(code, "declared as DOMAIN here");
    Some(finding.fix(Fix::unsafe_fix().replace(code, "0x7")))
}
