use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::standards::cia301::of;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0642: Rule = Rule {
    title: "object needs another object that is missing",
    why: "A master that finds one half of a service expects the other half, and cannot use the service.",
    source: "CiA 301, objects 1000h to 1029h; CiA 302-2 and 302-3",
    says: "{object} needs object {other} ({name}), which is missing",
    help: "add {missing}, or remove {object}",
    also: &[MASTER, FLYING, DEVICES],
    check: Check::Object(check),
    ..Rule::of("W0642")
};

/// Sentence for an NMT master without slaves.
const MASTER: Form = Form {
    says: "{object} makes the device an NMT master, but object {other} ({name}) is missing",
    help: "add {missing}, or clear bit 0 of {object}",
};

/// Sentence for a flying master without its times.
const FLYING: Form = Form {
    says: "{object} makes the device a flying NMT master, but object {other} ({name}) is missing",
    help: "add {missing}, or clear bit 5 of {object}",
};

/// Sentence for a module of several logical devices.
const DEVICES: Form = Form {
    says: "{object} declares several logical devices, but object {other} ({name} of one of them) is missing",
    help: "add {missing} for each device, or write the properties of the only device to bits 16 to 31",
};

/// The device types of a module of several logical devices, 800h apart, and the value of bits 16 to 31 of 1000h that
/// announces them (CiA 301, object 1000h).
const DEVICE_TYPES: [u16; 4] = [0x67FF, 0x6FFF, 0x77FF, 0x7FFF];
const SEVERAL: u64 = 0xFFFF;

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let report = |other: u16, at, form| {
        if object.description.objects.contains_key(&other) {
            return None;
        }
        let name = of(other).map_or("device type", |standard| standard.name);
        let finding = W0642.on(object, at).form(form);
        let finding = finding.fact("object", Fact::Index(object.index));
        let finding = finding.fact("other", Fact::Index(other)).fact("name", name);
        Some(finding.fact("missing", Fact::Section(other, None)))
    };
    let other = of(object.index).map_or(0, |standard| standard.needs);
    if other != 0 {
        findings.extend(report(other, object.span, &Form::OWN));
    }
    let device_type = (object.index == 0x1000)
        .then(|| start_number(object.description, Address::new(0x1000, 0)))
        .flatten();
    let has = |index: &u16| object.description.objects.contains_key(index);
    if let Some(device_type) = device_type.filter(|own| own.value >> 16 == SEVERAL)
        && !DEVICE_TYPES.iter().any(has)
    {
        findings.extend(report(DEVICE_TYPES[0], device_type.span, &DEVICES));
    }
    let startup = (object.index == 0x1F80)
        .then(|| start_number(object.description, Address::new(0x1F80, 0)))
        .flatten();
    if let Some(startup) = startup.as_ref().filter(|startup| startup.value & 1 != 0) {
        // A master can know its slaves in another way.
        let found = report(0x1F81, startup.span, &MASTER);
        findings.extend(found.map(|found| found.severity_of(Severity::Info)));
    }
    if let Some(startup) = startup.filter(|startup| startup.value & 1 << 5 != 0) {
        findings.extend(report(0x1F90, startup.span, &FLYING));
    }
}
