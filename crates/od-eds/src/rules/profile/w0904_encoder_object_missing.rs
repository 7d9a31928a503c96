use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::profile::shared::{Encoder, POSITIONS, need};

pub(crate) static W0904: Rule = Rule {
    code: "W0904",
    severity: Error,
    buildable: true,
    title: "encoder lacks a mandatory object",
    why: "A master that reads position, resolution or status from the objects of CiA 406 gets an abort.",
    source: "CiA 406, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    check: Check::Device(check),
    ..Rule::NEW
};

/// Objects of every encoder, with their names. Of several, one is enough.
const OBJECTS: [(&[u16], &str); 10] = [
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

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let mut object =
        |any_of: &[u16], what| findings.extend(need(&W0904, description, any_of, what));
    for (any_of, what) in OBJECTS {
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
