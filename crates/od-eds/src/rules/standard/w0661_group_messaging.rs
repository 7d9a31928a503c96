use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0661: Rule = Rule {
    title: "multiplexed PDO of a device without multiplexed PDOs",
    why: "A configuration tool that trusts GroupMessaging does not offer multiplexed PDOs, or reads the PDO as an ordinary one.",
    source: "CiA 306-1, DeviceInfo; CiA 301, MPDO protocol",
    fixability: Fixability::Unsafe,
    says: "GroupMessaging is 0, but {object} is the mapping of a multiplexed PDO",
    help: "write `GroupMessaging=1`{fix}, or write the number of mapped objects",
    check: Check::Device(check),
    ..Rule::of("W0661")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let info = description.section("DeviceInfo");
    let Some(given) = info.and_then(|info| info.get("GroupMessaging")) else {
        return;
    };
    let mut objects = description.objects.keys();
    let found = objects.find_map(|index| {
        let count = Address::new(*index, 0);
        let is_mapping = matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
        let number = start_number(description, count).filter(|_| is_mapping)?;
        matches!(number.value, 254 | 255).then_some((*index, number.span))
    });
    if let Some((index, span)) = found
        && number(given) == Some(0)
    {
        let fix = Fix::unsafe_fix().replace(given.span, "1");
        let finding = W0661.at(given.span).index(index).fix(fix);
        findings.push(finding.related(span, "multiplexed by this number"));
    }
}
