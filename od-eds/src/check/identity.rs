//! [DeviceInfo] names the device that 1018h is.
//!
//! Guarantees that a master which picks a file by vendor, product and revision
//! finds this one for this device. Assumes nothing; a 0 and an absent value say
//! nothing. Source: CiA 306-1, DeviceInfo.

use alloc::format;
use alloc::vec::Vec;

use super::start_number;
use crate::description::Description;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;
use od_model::Address;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    for (key, sub) in [
        ("VendorNumber", 1),
        ("ProductNumber", 2),
        ("RevisionNumber", 3),
    ] {
        let address = Address::new(0x1018, sub);
        let Some(given) = info.get(key) else { continue };
        let (Some(number), Some(object)) = (number(given), start_number(description, address))
        else {
            continue;
        };
        if number == 0 || object.value == 0 || number == i128::from(object.value) {
            continue;
        }
        let value = object.value;
        findings.push(
            rules::W0607
                .told(
                    given.span,
                    format!("{key} is 0x{number:X}, but {address} is 0x{value:X}"),
                )
                .about(address)
                .with_label(object.span, "the object's value is here")
                .with_help(format!("write `{key}=0x{value:X}`, or mend the object"))
                .fix(Fix::unsafe_fix().replace(given.span, format!("0x{value:X}"))),
        );
    }
}
