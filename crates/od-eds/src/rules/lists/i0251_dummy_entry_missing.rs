use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;

pub(crate) static I0251: Rule = Rule {
    title: "[DummyUsage] lacks a dummy entry",
    why: "Some tools require an entry for each of the seven dummies, 0001h to 0007h. odkit assumes 0 for a missing one.",
    source: "CiA 306-1, DummyUsage",
    fixability: Fixability::Safe,
    says: "[DummyUsage] lacks {missing}",
    help: "write 0 for each{fix}, or 1 if RPDOs may map the dummy entry",
    check: Check::Device(check),
    ..Rule::of("I0251")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let usage = description.section("DummyUsage");
    let Some(usage) = usage.filter(|_| !description.objects.is_empty()) else {
        return;
    };
    let keys = (1..=7).map(|index| format!("Dummy{index:04X}"));
    let missing: Vec<String> = keys.filter(|key| usage.get(key).is_none()).collect();
    if !missing.is_empty() {
        let lines: Vec<String> = missing.iter().map(|key| format!("{key}=0")).collect();
        let fix = Fix::safe().below(usage.name.span, lines.join("\n"));
        let missing: Vec<Fact> = missing
            .into_iter()
            .map(|key| Fact::Text(format!("`{key}`")))
            .collect();
        findings.push(I0251.at(usage.name.span).fact("missing", missing).fix(fix));
    }
}
