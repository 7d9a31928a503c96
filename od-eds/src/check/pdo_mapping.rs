//! What a PDO maps exists, is mappable in its direction, and fits.
//!
//! Guarantees that every PDO can be made as its defaults say. Assumes that
//! sub-index 0 counts the mapped objects: entries above it are not looked at, nor
//! is anything where it is 0, or 254 or 255 (multiplexed PDOs).
//! Source: CiA 301, PDO mapping parameter; CiA 306-1, AccessType and DummyUsage.

use alloc::format;
use alloc::vec::Vec;

use super::{named, place, start_number};
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;
use crate::span::{Span, Spanned};
use od_model::{Address, DataType};

/// What one mapping entry says, and where.
struct Mapped {
    /// The mapping entry.
    entry: Address,
    /// What it maps.
    target: Address,
    bits: Spanned<u8>,
    rpdo: bool,
}

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in description.objects.range(0x1600..=0x1BFF) {
        let rpdo = match index {
            0x1600..=0x17FF => true,
            0x1A00..=0x1BFF => false,
            _ => continue,
        };
        if object.code.has_members() {
            mapping(description, *index, rpdo, object, findings);
        }
    }
}

fn mapping(
    description: &Description,
    index: u16,
    rpdo: bool,
    object: &ObjectDescription,
    findings: &mut Vec<Finding>,
) {
    // Without a count, nothing is known to be mapped.
    let count = start_number(description, Address::new(index, 0)).map_or(0, |count| count.value);
    let count = match u8::try_from(count) {
        Ok(count @ ..=64) => count,
        Ok(254 | 255) => return,
        _ => {
            let address = Address::new(index, 0);
            let span = start_number(description, address).map(|count| count.span);
            findings.push(
                rules::W0524
                    .told(
                        span.unwrap_or(object.span),
                        format!("{count} objects cannot be mapped into 64 bits"),
                    )
                    .about(address)
                    .with_help("write a number up to 64, or 254 or 255 for a multiplexed PDO"),
            );
            return;
        }
    };
    let info = description.section("DeviceInfo");
    let granularity = info
        .and_then(|info| number(info.get("Granularity")?))
        .and_then(|coarse| u32::try_from(coarse).ok())
        .filter(|coarse| (2..=64).contains(coarse));
    let mut bits = 0u32;
    let mut seen: Vec<(u32, Span)> = Vec::new();
    for (sub, entry) in object.entries.range(1..=count.max(1)) {
        if *sub > count {
            break;
        }
        let address = Address::new(index, *sub);
        if let Some(given) = entry.data_type.filter(|t| **t != DataType::Unsigned32) {
            findings.push(
                rules::E0510
                    .told(
                        place(&[given.span, entry.span]),
                        format!("a mapping entry must be UNSIGNED32, but is {}", *given),
                    )
                    .about(address)
                    .with_help("write `DataType=0x0007`")
                    .fix(Fix::unsafe_fix().replace(given.span, "0x0007")),
            );
            continue;
        }
        let Some(value) = start_number(description, address) else {
            continue;
        };
        let Ok(number) = u32::try_from(value.value) else {
            continue;
        };
        if number == 0 {
            // Nothing, not even a length: there is nothing else to judge.
            findings.push(
                rules::W0525
                    .told(
                        place(&[value.span, entry.span]),
                        format!("{count} objects are mapped, but this entry maps nothing"),
                    )
                    .about(address)
                    .with_help("write what is mapped, or a lower number into sub-index 0"),
            );
            continue;
        }
        match seen
            .iter()
            .find(|(other, _)| *other == number && number >> 21 != 0)
        {
            Some((_, first)) => findings.push(
                rules::I0528
                    .told(
                        place(&[value.span, entry.span]),
                        "this PDO carries the same object twice",
                    )
                    .about(address)
                    .with_label(*first, "it is mapped here, too")
                    .with_help("map it once, if twice is not meant"),
            ),
            None => seen.push((number, value.span)),
        }
        let [len, sub, low, high] = number.to_le_bytes();
        let span = place(&[value.span, entry.span]);
        let mapped = Mapped {
            entry: address,
            target: Address::new(u16::from_le_bytes([low, high]), sub),
            bits: Spanned::new(len, span),
            rpdo,
        };
        let told = |findings: &[Finding]| findings.iter().any(|d| d.rule.code == rules::W0526.code);
        if let Some(coarse) = granularity.filter(|coarse| !u32::from(len).is_multiple_of(*coarse))
            && !told(findings)
        {
            findings.push(
                rules::W0526
                    .told(
                        span,
                        format!("{len} bits are mapped, but Granularity is {coarse}"),
                    )
                    .about(address)
                    .with_help("map a multiple of the granularity, or mend it in [DeviceInfo]"),
            );
        }
        if let Some(finding) = target(description, &mapped) {
            findings.push(finding.about(address));
        }
        let before = bits;
        bits += u32::from(len);
        if before <= 64 && bits > 64 {
            findings.push(
                rules::E0505
                    .told(span, format!("with this object the PDO has {bits} bits"))
                    .about(address)
                    .with_help("a PDO has at most 64 bits; map less"),
            );
        }
    }
}

fn target(description: &Description, mapped: &Mapped) -> Option<Finding> {
    let Mapped { target, bits, .. } = mapped;
    let span = bits.span;
    if (1..=0x1F).contains(&target.index) {
        return dummy(description, mapped);
    }
    let Some(object) = description.objects.get(&target.index) else {
        return Some(
            rules::E0501
                .told(span, format!("{:04X}h does not exist", target.index))
                .with_help("map an object that exists, or add it"),
        );
    };
    let Some(entry) = object.entries.get(&target.sub) else {
        return Some(
            rules::E0512
                .told(span, format!("{target} does not exist"))
                .with_label(object.span, format!("{:04X}h is here", target.index))
                .with_help("map a sub-index that exists, or add it"),
        );
    };
    let name = &entry.name.value;
    let shown = named(description, *target);
    if !*entry.mappable {
        return Some(
            rules::E0502
                .told(span, format!("{shown} \"{name}\" is not mappable"))
                .with_label(
                    place(&[entry.mappable.span, entry.span]),
                    "the object is here",
                )
                .with_help(format!(
                    "write `PDOMapping=1` for {shown}, or map another object"
                ))
                .fix(Fix::unsafe_fix().replace(entry.mappable.span, "1")),
        );
    }
    let direction = match mapped.rpdo {
        true => entry.access.maps_to_rpdo(),
        false => entry.access.maps_to_tpdo(),
    };
    if !direction {
        let (pdo, allowed) = match mapped.rpdo {
            true => ("an RPDO", "an RPDO maps wo, rw and rww"),
            false => ("a TPDO", "a TPDO maps ro, rw, rwr and const"),
        };
        return Some(
            rules::E0503
                .told(
                    span,
                    format!("{shown} \"{name}\" is {} and not for {pdo}", *entry.access),
                )
                .with_label(
                    place(&[entry.access.span, entry.span]),
                    "its AccessType is here",
                )
                .with_help(allowed),
        );
    }
    let data_type = entry.data_type?;
    match data_type.bits() {
        Some(right) if right != **bits => Some(
            wrong_length(mapped, &shown, right)
                .with_label(data_type.span, format!("{} is declared here", *data_type)),
        ),
        _ => None,
    }
}

fn wrong_length(mapped: &Mapped, shown: &str, right: u8) -> Finding {
    let Mapped { target, bits, .. } = mapped;
    let rule = match (right, **bits) {
        (1, 8) => &rules::W0513,
        _ => &rules::E0504,
    };
    let mended = format!("0x{:04X}{:02X}{right:02X}", target.index, target.sub);
    rule.told(
        bits.span,
        format!(
            "{shown} has {right} bit{}, but is mapped with {}",
            if right == 1 { "" } else { "s" },
            bits.value
        ),
    )
    .with_help(format!("write `{mended}`"))
    .fix(Fix::unsafe_fix().replace(bits.span, mended))
}

/// A data type as a placeholder for bits that the device ignores.
fn dummy(description: &Description, mapped: &Mapped) -> Option<Finding> {
    let Mapped { target, bits, .. } = mapped;
    let index = target.index;
    if !mapped.rpdo {
        return Some(
            rules::E0507
                .told(
                    bits.span,
                    format!("{index:04X}h is a dummy, and this is a TPDO"),
                )
                .with_help("map an object that can be sent"),
        );
    }
    if let Some(right) = DataType::from_code(index).and_then(DataType::bits)
        && right != **bits
    {
        let shown = format!("{index:04X}h");
        return Some(wrong_length(mapped, &shown, right));
    }
    let key = format!("Dummy{index:04X}");
    let usage = description.section("DummyUsage");
    let given = usage.and_then(|section| section.get(&key));
    if given.and_then(|value| number(value)) == Some(1) {
        return None;
    }
    let fix = match (given, usage) {
        (Some(value), _) => Fix::unsafe_fix().replace(value.span, "1"),
        (None, Some(usage)) => Fix::unsafe_fix().below(usage.name.span, format!("{key}=1")),
        (None, None) => Fix::unsafe_fix(),
    };
    Some(
        rules::W0506
            .told(
                bits.span,
                format!("[DummyUsage] does not allow the dummy {index:04X}h"),
            )
            .about(mapped.entry)
            .with_help(format!("write `{key}=1` in [DummyUsage]"))
            .fix(fix),
    )
}
