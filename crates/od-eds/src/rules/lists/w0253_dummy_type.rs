use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use od_model::DataType;

pub(crate) static W0253: Rule = Rule {
    title: "[DummyUsage] names a type that cannot be a dummy entry",
    why: "A tool may offer a dummy entry that has no length. Only data types with a fixed length can be mapped.",
    source: "CiA 306-1, DummyUsage; CiA 301, dummy mapping",
    says: "`{name}` does not name a data type with a fixed length",
    help: "remove the line{fix}; the dummy entries are `Dummy0001` to `Dummy0007`",
    also: &[DIGITS],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0253")
};

/// Sentence for a data type that does not have four digits.
const DIGITS: Form = Form {
    says: "`{name}` does not have the four digits of a data type",
    help: "write `Dummy{code:04X}`{fix}, or remove the line",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let usage = description.section("DummyUsage");
    for (key, _) in usage.into_iter().flat_map(|usage| &usage.pairs) {
        let digits = key.get("Dummy".len()..).unwrap_or_default();
        let Ok(code) = u16::from_str_radix(digits, 16) else {
            continue;
        };
        if digits.len() != 4 {
            let finding = W0253.at(key.span).form(&DIGITS);
            let fix = Fix::unsafe_fix().replace(key.span, format!("Dummy{code:04X}"));
            let finding = finding.fact("name", key.as_str()).fact("code", code);
            findings.push(finding.fix(fix));
        } else if DataType::from_code(code).and_then(DataType::bits).is_none() {
            let finding = W0253.at(key.span).fact("name", key.as_str());
            findings.push(finding.fix(Fix::unsafe_fix().remove_line(key.span)));
        }
    }
}
