use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::subject::Object;

pub(crate) static W0918: Rule = Rule {
    title: "drive chooses a mode that it does not display",
    why: "A master writes the mode to 6060h and waits until 6061h shows it. Without one of the two it waits forever.",
    source: "CiA 402, objects 6060h and 6061h",
    says: "{object} ({own}) needs object {other} ({name}), which is missing",
    help: "add {missing}, or remove {object}",
    check: Check::Object(check),
    ..Rule::of("W0918")
};

const CHOICE: &str = "modes of operation";
const DISPLAY: &str = "modes of operation display";

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    // The axes of a device are 800h apart.
    let (other, own, name) = match object.index {
        0x6000..=0x9FFF if object.index & 0x7FF == 0x060 => (object.index + 1, CHOICE, DISPLAY),
        0x6000..=0x9FFF if object.index & 0x7FF == 0x061 => (object.index - 1, DISPLAY, CHOICE),
        _ => return,
    };
    let exists = object.description.objects.contains_key(&other);
    if !exists && device(object.description, 402).is_some() {
        let finding = W0918
            .on(object, object.span)
            .fact("object", Fact::Index(object.index));
        let finding = finding.fact("own", own).fact("name", name);
        let finding = finding.fact("other", Fact::Index(other));
        findings.push(finding.fact("missing", Fact::Section(other, None)));
    }
}
