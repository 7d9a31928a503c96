use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity};
use crate::fix::Fix;
use crate::rules::profile::shared::device_type;
use crate::standards::checked;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0922: Rule = Rule {
    title: "1000h does not declare the profile of the objects",
    why: "A master that reads from 1000h what the device is does not use it as such a device.",
    source: "CiA 301, object 1000h; CiA 401, CiA 402, CiA 404 and CiA 406, object overview",
    says: "1000h declares device profile {declared}, but {objects} are objects of CiA {profile}",
    help: "write {profile} (0x{profile:X}) to bits 0 to 15 of 1000h{fix}",
    also: &[NONE],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0922")
};

/// Sentence for a device without a profile.
const NONE: Form = Form {
    says: "1000h declares no device profile, but {objects} are objects of CiA {profile}",
    ..Form::OWN
};

/// Objects that no other of these profiles has together, with code and types as they are here.
const SIGNS: [(u16, [u16; 3]); 6] = [
    (402, [0x6040, 0x6041, 0x6060]),
    (402, [0x6040, 0x6041, 0x6502]),
    (406, [0x6004, 0x6500, 0x6501]),
    (401, [0x6000, 0x6200, 0x6401]),
    (401, [0x6000, 0x6200, 0x6206]),
    (404, [0x6110, 0x6130, 0x6131]),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let number = start_number(description, Address::new(0x1000, 0));
    let Some((device, number)) = device_type(description).zip(number) else {
        return;
    };
    // Of other profiles odkit does not know the objects, and several logical devices have several profiles.
    if device.is_several() || !matches!(device.profile, 0 | 401 | 402 | 404 | 406) {
        return;
    }
    let is_own = |profile: u16, index: u16| {
        let own = description.objects.get(&index);
        own.zip(checked(profile, index))
            .is_some_and(|(own, right)| {
                let sub = u8::from(right.code.has_members());
                let given = own.entries.get(&sub).and_then(|entry| entry.data_type);
                own.code.has_members() == right.code.has_members()
                    && given.is_some_and(|given| right.types(sub).any(|known| known == *given))
            })
    };
    let sign = SIGNS.iter().find(|(profile, objects)| {
        *profile != device.profile && objects.iter().all(|index| is_own(*profile, *index))
    });
    if let Some((profile, objects)) = sign {
        let objects = objects.iter().map(|index| Fact::Index(*index)).collect();
        let finding = W0922.at(number.span).about(Address::new(0x1000, 0));
        let finding = finding.fact("objects", Fact::List(objects));
        let finding = finding.fact("profile", u32::from(*profile));
        let right = number.value & 0xFFFF_0000 | u64::from(*profile);
        let fix = Fix::unsafe_fix().replace(number.span, format!("0x{right:08X}"));
        let finding = finding.fix(fix);
        findings.push(match device.profile {
            // A master can still use the objects that it knows.
            0 => finding.form(&NONE).severity_of(Severity::Info),
            declared => finding.fact("declared", u32::from(declared)),
        });
    }
}
