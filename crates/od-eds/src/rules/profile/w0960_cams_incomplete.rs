use alloc::vec::Vec;

use crate::description::{Description, ObjectDescription};
use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule};
use crate::rules::profile::shared::device;
use od_model::Address;

pub(crate) static W0960: Rule = Rule {
    title: "objects of cams or of the work area are incomplete",
    why: "A master that configures a cam or a work area gets an abort. A cam channel has state, enable, polarity, two limits and a hysteresis; a work area has its state and two limits.",
    source: "CiA 406, objects 6300h to 6330h and 6400h to 6402h",
    says: "{first} defines cams, but {object} (CAM {what}) is missing",
    help: "add {missing}",
    also: &[AREA],
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

/// Sentence for a work area.
const AREA: Form = Form {
    says: "{first} belongs to a work area, but {object} (work area {what}) is missing",
    ..Form::OWN
};

/// Objects of a work area.
const AREAS: [(u16, &str); 3] = [
    (0x6400, "state"),
    (0x6401, "low limit"),
    (0x6402, "high limit"),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    if device(description, 406).is_some() {
        let cams = description.objects.range(0x6300..=0x63FF).next();
        complete(description, cams, &OBJECTS, &Form::OWN, findings);
        let areas = description.objects.range(0x6400..=0x6402).next();
        complete(description, areas, &AREAS, &AREA, findings);
    }
}

/// Reports each object that is missing, if there is a first one.
fn complete(
    description: &Description,
    first: Option<(&u16, &ObjectDescription)>,
    objects: &[(u16, &'static str)],
    form: &'static Form,
    findings: &mut Vec<Finding>,
) {
    let Some((first, own)) = first else {
        return;
    };
    for (index, what) in objects {
        if !description.objects.contains_key(index) {
            let finding = W0960.at(own.span).about(Address::new(*index, 0)).form(form);
            let finding = finding.fact("what", *what);
            let finding = finding.fact("first", Fact::Index(*first));
            let finding = finding.fact("object", Fact::Index(*index));
            findings.push(finding.fact("missing", Fact::Section(*index, None)));
        }
    }
}
