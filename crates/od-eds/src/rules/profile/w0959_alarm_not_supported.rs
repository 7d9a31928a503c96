use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0959: Rule = Rule {
    title: "active alarm or warning is not supported",
    why: "A master shows an alarm or a warning that the device cannot report. 6503h and 6505h use only the bits of 6504h and 6506h.",
    source: "CiA 406, objects 6503h to 6506h",
    says: "{object} sets bits 0x{more:X}, which {supported} does not support",
    help: "write `{DefaultValue=0}`{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0959")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    for index in [0x6503, 0x6505] {
        let (active, supported) = (encoder.value(index), encoder.value(index + 1));
        let (Some(active), Some(supported)) = (active, supported) else {
            continue;
        };
        let more = active.value & !supported.value;
        if more != 0 {
            let finding = W0959.at(active.span).about(Address::new(index, 0));
            let finding = finding
                .fact("object", Fact::Index(index))
                .fact("more", more);
            let finding = finding.fact("supported", Fact::Index(index + 1));
            let finding = finding.related(supported.span, "supported bits are set here");
            findings.push(finding.fix(Fix::unsafe_fix().replace(active.span, "0")));
        }
    }
}
