use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::structure::shared::decimal;
use crate::standards::cia301::has_node_ids;
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0351: Rule = Rule {
    title: "ARRAY or PDO mapping has a gap",
    why: "A master that reads sub-indices 1, 2, 3 and so on gets an abort at the gap.",
    source: "CiA 301, object codes",
    says: "this {code} has sub-index {given} but no sub-index {missing}",
    help: "number the sub-objects without a gap, or write `{ObjectType=0x9}` (RECORD)",
    fixability: Fixability::Unsafe,
    also: &[DECIMAL, MAPPING],
    check: Check::Object(check),
    ..Rule::of("W0351")
};

/// The help for a sub-index that is probably written in decimal.
const DECIMAL: Form = Form {
    help: "write `{right}` if the sub-index is decimal{fix}; CiA 306 numbers sub-objects in hexadecimal",
    ..Form::OWN
};

/// The help for a PDO mapping, whose entries are counted from 1.
const MAPPING: Form = Form {
    help: "number the mapping entries without a gap",
    ..Form::OWN
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let entries = object.entries();
    let entries = entries.filter(|entry| (1..=254).contains(&entry.address.sub));
    let mut gaps = (1u8..=254).zip(entries);
    let gap = gaps.find(|(expected, entry)| entry.address.sub != *expected);
    let is_mapping = matches!(object.index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let is_list = *object.code == ObjectCode::Array && !has_node_ids(object.index) || is_mapping;
    if let Some((missing, entry)) = gap.filter(|_| is_list) {
        let finding = W0351.on(&entry, entry.span).fact("missing", missing);
        let finding = finding.fact("code", *object.code);
        let finding = if is_mapping {
            finding.form(&MAPPING)
        } else {
            finding
        };
        let finding = finding.fact("given", entry.address.sub);
        findings.push(match decimal(object.object) {
            Some((sub, meant)) if sub == entry.address.sub => {
                let right = format!("[{:04X}sub{meant:X}]", object.index);
                let fix = Fix::unsafe_fix().replace(entry.span, right.as_str());
                finding.form(&DECIMAL).fact("right", right).fix(fix)
            }
            _ => finding,
        });
    }
}
