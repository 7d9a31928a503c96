use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::standards::cia301::of;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0642: Rule = Rule {
    title: "object needs another object that is missing",
    why: "A master that finds one half of a service expects the other half, and cannot use the service.",
    source: "CiA 301, objects 1005h to 1029h; CiA 302-2 and 302-3",
    says: "{object} needs object {other} ({name}), which is missing",
    help: "add {missing}, or remove {object}",
    also: &[MASTER],
    check: Check::Object(check),
    ..Rule::of("W0642")
};

/// Sentence for an NMT master without slaves.
const MASTER: Form = Form {
    says: "{object} makes the device an NMT master, but object {other} ({name}) is missing",
    help: "add {missing}, or clear bit 0 of {object}",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let report = |other: u16, at, form| {
        if object.description.objects.contains_key(&other) {
            return None;
        }
        let name = of(other).map_or("", |standard| standard.name);
        let finding = W0642.on(object, at).form(form);
        let finding = finding.fact("object", Fact::Index(object.index));
        let finding = finding.fact("other", Fact::Index(other)).fact("name", name);
        Some(finding.fact("missing", Fact::Section(other, None)))
    };
    let other = of(object.index).map_or(0, |standard| standard.needs);
    if other != 0 {
        findings.extend(report(other, object.span, &Form::OWN));
    }
    let startup = (object.index == 0x1F80)
        .then(|| start_number(object.description, Address::new(0x1F80, 0)))
        .flatten();
    if let Some(startup) = startup.filter(|startup| startup.value & 1 != 0) {
        // A master can know its slaves in another way.
        let found = report(0x1F81, startup.span, &MASTER);
        findings.extend(found.map(|found| found.severity_of(Severity::Info)));
    }
}
