//! Objects that the profile of a device requires, and that the device does not have.

use alloc::vec::Vec;

use od_model::Address;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity, Severity::Error};
use crate::rules::profile::shared::{Encoder, IO_BLOCKS, POSITIONS, device};
use crate::subject::start_number;

pub(crate) static W0901: Rule = Rule {
    title: "I/O module lacks the objects of its channels",
    why: "A master that reads from 1000h which channels exist finds no object for them.",
    source: "CiA 401, object 1000h",
    says: "1000h declares {what}, but object {objects} is missing",
    help: "add {missing}, or clear bit {bit} of 1000h",
    check: Check::Device(check_io),
    ..Rule::of("W0901")
};

fn check_io(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device(description, 401) else {
        return;
    };
    let blocks = IO_BLOCKS
        .iter()
        .filter(|(bit, _, _)| device.has(*bit) == Some(true));
    findings.extend(blocks.filter_map(|(bit, any_of, what)| {
        let finding = need(&W0901, description, any_of, what)?;
        Some(finding.fact("bit", bit + 16))
    }));
}

pub(crate) static W0902: Rule = Rule {
    title: "drive lacks its supported modes",
    why: "A master that chooses a mode by CiA 402 gets an abort.",
    source: "CiA 402, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    also: &[NO_MODE],
    check: Check::Device(check_modes),
    ..Rule::of("W0902")
};

/// Sentence for a drive that supports no mode.
const NO_MODE: Form = Form {
    says: "{objects} ({what}) is 0, so the drive supports no mode",
    help: "set the bit of each mode that the drive supports",
};

fn check_modes(description: &Description, findings: &mut Vec<Finding>) {
    if device(description, 402).is_some() {
        findings.extend(need(
            &W0902,
            description,
            &[0x6502],
            "supported drive modes",
        ));
        let modes = start_number(description, Address::new(0x6502, 0));
        if let Some(modes) = modes.filter(|modes| modes.value == 0) {
            let finding = W0902.at(modes.span).about(Address::new(0x6502, 0));
            let finding = finding.form(&NO_MODE).fact("what", "supported drive modes");
            let finding = finding.fact("objects", Fact::Index(0x6502));
            // The drive may fill it when it starts.
            findings.push(finding.severity_of(Severity::Info));
        }
    }
}

pub(crate) static E0908: Rule = Rule {
    buildable: true,
    title: "drive lacks its control or status",
    why: "A master that controls drives by CiA 402 gets an abort.",
    source: "CiA 402, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    also: &[AXIS],
    check: Check::Device(check_control),
    ..Rule::of("E0908")
};

/// Sentence for a further axis that has one of the two.
const AXIS: Form = Form {
    says: "axis {axis} has {other}, but mandatory object {object} ({what}) is missing",
    help: "add {missing}, or remove the axis",
};

/// Objects that control a drive, with their names. A device of several axes has them 800h apart.
const CONTROL: [(u16, &str); 2] = [(0x6040, "controlword"), (0x6041, "statusword")];

fn check_control(description: &Description, findings: &mut Vec<Finding>) {
    if device(description, 402).is_some() {
        let objects = CONTROL.iter();
        findings
            .extend(objects.filter_map(|(index, what)| need(&E0908, description, &[*index], what)));
        (1..8).for_each(|axis| findings.extend(half_axis(description, axis)));
    }
}

/// Reports a further axis, counted from 1, that has its control or its status only.
fn half_axis(description: &Description, axis: u16) -> Option<Finding> {
    let [control, status] = CONTROL.map(|(index, what)| {
        let index = index + 0x800 * axis;
        (index, description.objects.get(&index), what)
    });
    let (other, own, index, what) = match (control, status) {
        ((other, Some(own), _), (index, None, what)) => (other, own, index, what),
        ((index, None, what), (other, Some(own), _)) => (other, own, index, what),
        _ => return None,
    };
    let finding = E0908.at(own.span).about(Address::new(other, 0)).form(&AXIS);
    let finding = finding.fact("axis", axis + 1).fact("what", what);
    let finding = finding.fact("other", Fact::Index(other));
    let finding = finding.fact("object", Fact::Index(index));
    Some(finding.fact("missing", Fact::Section(index, None)))
}

pub(crate) static W0903: Rule = Rule {
    title: "measuring device lacks the objects of its blocks",
    why: "A master that reads from 1000h which function blocks exist finds no process values for them.",
    source: "CiA 404, object 1000h",
    says: "1000h declares {what}, but object {objects} is missing",
    help: "add {missing}, or clear bit {bit} of 1000h",
    check: Check::Device(check_blocks),
    ..Rule::of("W0903")
};

/// A bit of 1000h, the process values of the block that it announces, and the name of the block.
const BLOCKS: [(u32, &[u16], &str); 2] = [
    (1, &[0x6130, 0x7130, 0x8130, 0x9130], "analogue inputs"),
    (3, &[0x6300, 0x7300, 0x8300, 0x9300], "analogue outputs"),
];

fn check_blocks(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device(description, 404) else {
        return;
    };
    let blocks = BLOCKS
        .iter()
        .filter(|(bit, _, _)| device.has(*bit) == Some(true));
    findings.extend(blocks.filter_map(|(bit, any_of, what)| {
        let finding = need(&W0903, description, any_of, what)?;
        Some(finding.fact("bit", bit + 16))
    }));
}

pub(crate) static W0904: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "encoder lacks a mandatory object",
    why: "A master that reads position, resolution or status from the objects of CiA 406 gets an abort.",
    source: "CiA 406, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    check: Check::Device(check_encoder),
    ..Rule::of("W0904")
};

/// Objects that every encoder has, with their names. If an entry has several, one of them is
/// enough.
const ENCODER: [(&[u16], &str); 10] = [
    (&[0x6000], "operating parameters"),
    (&POSITIONS, "position value"),
    (&[0x6500], "operating status"),
    (&[0x6501], "singleturn resolution"),
    (&[0x6503], "alarms"),
    (&[0x6504], "supported alarms"),
    (&[0x6505], "warnings"),
    (&[0x6506], "supported warnings"),
    (&[0x6507], "profile and software version"),
    (&[0x6509], "offset value"),
];

fn check_encoder(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let mut object =
        |any_of: &[u16], what| findings.extend(need(&W0904, description, any_of, what));
    for (any_of, what) in ENCODER {
        object(any_of, what);
        if any_of == [0x6501] && encoder.is_multiturn() == Some(true) {
            object(&[0x6502], "number of distinguishable revolutions");
        }
    }
    // Encoders of class 2 have both objects of scaling.
    let scaling = [
        (0x6001, "measuring units per revolution"),
        (0x6002, "total measuring range"),
    ];
    if scaling
        .iter()
        .any(|(index, _)| description.objects.contains_key(index))
    {
        for (index, what) in scaling {
            object(&[index], what);
        }
    }
}

/// The finding about a mandatory object that is missing; one of these is enough.
fn need(
    rule: &'static Rule,
    description: &Description,
    any_of: &[u16],
    what: &'static str,
) -> Option<Finding> {
    let exists = |index: &u16| description.objects.contains_key(index);
    let first = any_of.first().filter(|_| !any_of.iter().any(exists))?;
    let device_type = start_number(description, Address::new(0x1000, 0));
    let objects = any_of.iter().map(|index| Fact::Index(*index)).collect();
    let finding = rule.at(device_type.map(|number| number.span).unwrap_or_default());
    let finding = finding.about(Address::new(*first, 0)).fact("what", what);
    let finding = finding.fact("objects", Fact::OneOf(objects));
    Some(finding.fact("missing", Fact::Section(*first, None)))
}
