use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use od_model::Address;

pub(crate) static W0960: Rule = Rule {
    title: "cam objects are incomplete",
    why: "A master that configures a cam gets an abort. A cam channel has state, enable, polarity, two limits and a hysteresis.",
    source: "CiA 406, objects 6300h to 6330h",
    says: "{first} defines cams, but {object} (CAM {what}) is missing",
    help: "add {missing}",
    check: Check::Device(check),
    ..Rule::of("W0960")
};

/// Objects of a cam channel.
const OBJECTS: [(u16, &str); 6] = [
    (0x6300, "state"),
    (0x6301, "enable"),
    (0x6302, "polarity"),
    (0x6310, "low limit"),
    (0x6320, "high limit"),
    (0x6330, "hysteresis"),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let cams = description.objects.range(0x6300..=0x63FF).next();
    let Some((first, cams)) = cams.filter(|_| device(description, 406).is_some()) else {
        return;
    };
    for (index, what) in OBJECTS {
        if !description.objects.contains_key(&index) {
            let finding = W0960
                .at(cams.span)
                .about(Address::new(index, 0))
                .fact("what", what);
            let finding = finding.fact("first", Fact::Index(*first));
            let finding = finding.fact("object", Fact::Index(index));
            findings.push(finding.fact("missing", Fact::Section(index, None)));
        }
    }
}
