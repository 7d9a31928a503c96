//! What a service needs is there: objects that belong together, error control, LSS, SYNC.
//!
//! Guarantees that a master which finds one half of a service finds the other half. Assumes that
//! types and values were checked. Source: CiA 301, chapter of each service; CiA 305, LSS address.

use alloc::format;
use alloc::vec::Vec;

use super::place;
use crate::description::Description;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;
use crate::span::Span;
use od_model::Address;

/// An object, the one it is nothing without, and what it is about.
const PAIRS: [(u16, u16, &str); 9] = [
    (0x1006, 0x1005, "a SYNC period needs SYNC"),
    (0x1007, 0x1005, "a SYNC window needs SYNC"),
    (0x1019, 0x1005, "a SYNC counter needs SYNC"),
    (0x100C, 0x100D, "node guarding needs both"),
    (0x100D, 0x100C, "node guarding needs both"),
    (0x1010, 0x1011, "what can be saved can be restored"),
    (0x1011, 0x1010, "what can be restored can be saved"),
    (0x1015, 0x1014, "an inhibit time of EMCY needs EMCY"),
    (0x1024, 0x1023, "an OS command mode needs OS commands"),
];

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, other, why) in PAIRS {
        if let Some(object) = description.objects.get(&index)
            && !description.objects.contains_key(&other)
        {
            findings.push(
                rules::W0642
                    .told(
                        object.span,
                        format!("there is {index:04X}h, but no {other:04X}h: {why}"),
                    )
                    .about(Address::new(index, 0))
                    .with_help(format!(
                        "write a section [{other:04X}], or remove [{index:04X}]"
                    )),
            );
        }
    }
    let has = |index| description.objects.contains_key(&index);
    if has(0x1000) && !has(0x1017) && !has(0x100C) {
        findings.push(
            rules::W0635
                .told(
                    Span::default(),
                    "there is neither 1017h (heartbeat) nor 100Ch (node guarding)",
                )
                .with_help("write a section [1017]; every device has one of the two"),
        );
    }
    error_history(description, findings);
    lss(description, findings);
    commissioning(description, findings);
}

fn error_history(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x1003, 0);
    let Some(entry) = description.entry(address) else {
        return;
    };
    if let Some(value) = &entry.default
        && value.value.integer(0).is_some_and(|number| number != 0)
    {
        findings.push(
            rules::W0639
                .told(
                    place(&[value.span, entry.span]),
                    "a new device has errors in its history already",
                )
                .about(address)
                .with_help(
                    "write `DefaultValue=0`: sub-index 0 of 1003h counts the errors there are",
                )
                .fix(Fix::unsafe_fix().replace(value.span, "0")),
        );
    }
}

fn lss(description: &Description, findings: &mut Vec<Finding>) {
    let info = description.section("DeviceInfo");
    let Some(given) = info.and_then(|info| info.get("LSS_Supported")) else {
        return;
    };
    let Some(identity) = description.objects.get(&0x1018) else {
        return;
    };
    let missing: Vec<u8> = (1..=4)
        .filter(|sub| !identity.entries.contains_key(sub))
        .collect();
    if number(given) == Some(1) && !missing.is_empty() {
        let list: Vec<_> = missing
            .iter()
            .map(|sub| format!("1018h:{sub:02X}"))
            .collect();
        findings.push(
            rules::W0634
                .told(
                    given.span,
                    format!(
                        "an LSS address needs {}, which the device lacks",
                        list.join(", ")
                    ),
                )
                .about(Address::new(0x1018, 0))
                .with_label(identity.span, "1018h is here")
                .with_help("write the missing sections, or `LSS_Supported=0`"),
        );
    }
}

fn commissioning(description: &Description, findings: &mut Vec<Finding>) {
    let section = description.section("DeviceComissioning");
    let Some(section) = section.or_else(|| description.section("DeviceCommissioning")) else {
        return;
    };
    for (key, valid, help) in [
        (
            "NodeID",
            &(1..=127).chain([255]).collect::<Vec<i128>>()[..],
            "write a number from 1 to 127, or 255 for a device that LSS gives one",
        ),
        (
            "Baudrate",
            &[10, 20, 50, 100, 125, 250, 500, 800, 1000],
            "write 10, 20, 50, 125, 250, 500, 800 or 1000 (kbit/s)",
        ),
    ] {
        let Some(given) = section.get(key).filter(|given| !given.is_empty()) else {
            continue;
        };
        // What is no number at all was named by the reader.
        let high = if key == "NodeID" { 0xFF } else { 0xFFFF };
        if number(given).is_some_and(|n| (0..=high).contains(&n) && !valid.contains(&n)) {
            findings.push(
                rules::W0638
                    .told(given.span, format!("{key} is `{}`", given.value))
                    .with_help(help),
            );
        }
    }
}
