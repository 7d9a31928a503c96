use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::device;
use crate::subject::{Object, start_value};
use od_model::Address;

pub(crate) static W0911: Rule = Rule {
    code: "W0911",
    severity: Warning,
    title: "lower limit of a drive is above the upper one",
    why: "The drive rejects every position.",
    source: "CiA 402, objects 607Bh and 607Dh",
    says: "sub-index 2 of {object} is {high}, but sub-index 1 is {low}",
    help: "write the lower limit to sub-index 1 and the upper limit to sub-index 2",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !matches!(object.index, 0x607B | 0x607D) || device(object.description, 402).is_none() {
        return;
    }
    let at = |sub| object.object.entries.get(&sub).and_then(start_value);
    if let Some((low, high)) = at(1).zip(at(2))
        && let Some((least, most)) = low.integer(0).zip(high.integer(0))
        && least > most
    {
        let finding = W0911
            .on(object, high.span)
            .about(Address::new(object.index, 2));
        let finding = finding.fact("object", Fact::Index(object.index));
        let finding = finding.fact("low", least).fact("high", most);
        findings.push(finding.related(low.span, "lower limit set here"));
    }
}
