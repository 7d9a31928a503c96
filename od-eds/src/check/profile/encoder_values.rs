//! CiA 406: resolution, range, preset, status and timers do not contradict each other.
//!
//! Guarantees that an encoder as it is shipped shows what its own parameters say. Assumes that
//! the objects are of the profile's types; what has no default is not looked at.
//! Source: CiA 406, objects 6000h to 6509h.

use alloc::format;
use alloc::vec::Vec;

use super::DeviceType;
use super::encoder::revolutions;
use crate::check::start_number;
use crate::description::Description;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::span::Spanned;
use od_model::Address;

pub(super) fn check(description: &Description, device: DeviceType, findings: &mut Vec<Finding>) {
    let value = |index, sub| start_number(description, Address::new(index, sub));
    let units = value(0x6001, 0);
    let range = value(0x6002, 0);
    let physical = value(0x6501, 0);
    let turns = value(0x6502, 0);
    if let (Some(units), Some(range)) = (units, range) {
        product(units, range, turns, findings);
    }
    if let (Some(units), Some(physical)) = (units, physical)
        && physical.value > 0
        && units.value > physical.value
    {
        findings.push(
            rules::W0956
                .told(
                    units.span,
                    format!(
                        "{} units a revolution are more than the {} that there are",
                        units.value, physical.value
                    ),
                )
                .about(Address::new(0x6001, 0))
                .with_label(physical.span, "6501h says the resolution here")
                .with_help(format!("write at most {}", physical.value)),
        );
    }
    if let (Some(preset), Some(range)) = (value(0x6003, 0), range)
        && range.value > 0
        && preset.value >= range.value
    {
        findings.push(
            rules::W0955
                .told(
                    preset.span,
                    format!(
                        "preset {} is no position: the range is 0 to {}",
                        preset.value,
                        range.value - 1
                    ),
                )
                .about(Address::new(0x6003, 0))
                .with_label(range.span, "6002h says the range here")
                .with_help("write a position within the range, for example `DefaultValue=0`"),
        );
    }
    // Some count steps in 6502h, as 6002h does: then so many of them are one revolution.
    let turns = turns.map(|turns| match (range, physical) {
        (Some(range), Some(physical))
            if range.value == turns.value && (2..=turns.value).contains(&physical.value) =>
        {
            Spanned::new(turns.value / physical.value, turns.span)
        }
        _ => turns,
    });
    kind(device, turns, findings);
    status(value(0x6000, 0), value(0x6500, 0), findings);
    signals(0x6503, value(0x6503, 0), value(0x6504, 0), findings);
    signals(0x6505, value(0x6505, 0), value(0x6506, 0), findings);
    timers(value(0x6200, 0), value(0x1800, 5), findings);
}

/// A range that is neither whole revolutions nor whole divisions of all of them makes the
/// position jump where the encoder starts again.
fn product(
    units: Spanned<u64>,
    range: Spanned<u64>,
    turns: Option<Spanned<u64>>,
    findings: &mut Vec<Finding>,
) {
    let all = u128::from(units.value) * u128::from(turns.map_or(1, |turns| turns.value.max(1)));
    let own = u128::from(range.value);
    if units.value == 0 || range.value == 0 || all == own {
        return;
    }
    // A smaller range is sound where it fits into the whole one without a rest.
    if own < all && all.is_multiple_of(own) {
        return;
    }
    let turns = turns.map_or(1, |turns| turns.value.max(1));
    findings.push(
        rules::W0952
            .told(
                range.span,
                format!(
                    "6002h is {own}, but {} units times {turns} revolutions are {all}",
                    units.value
                ),
            )
            .about(Address::new(0x6002, 0))
            .with_label(units.span, "6001h says the units of one revolution here")
            .with_help(format!(
                "write `DefaultValue={all}`, or a range that divides it"
            ))
            .fix(match u32::try_from(all) {
                Ok(all) => Fix::unsafe_fix().replace(range.span, format!("{all}")),
                Err(_) => Fix::unsafe_fix(),
            }),
    );
}

fn kind(device: DeviceType, turns: Option<Spanned<u64>>, findings: &mut Vec<Finding>) {
    let (Some(turns), Some(many)) = (turns, revolutions(device)) else {
        return;
    };
    let (wrong, says) = match many {
        true => (turns.value <= 1, "a multiturn encoder"),
        false => (turns.value > 1, "a singleturn encoder"),
    };
    if wrong {
        findings.push(
            rules::W0957
                .told(
                    turns.span,
                    format!(
                        "1000h says {says}, but 6502h says {} revolutions",
                        turns.value
                    ),
                )
                .about(Address::new(0x6502, 0))
                .with_help(
                    "mend 6502h, or the upper half of 1000h: 1 is singleturn, 2 is multiturn",
                ),
        );
    }
}

/// 6500h shows what 6000h was set to: code sequence, commissioning diagnosis, scaling.
fn status(
    parameters: Option<Spanned<u64>>,
    status: Option<Spanned<u64>>,
    findings: &mut Vec<Finding>,
) {
    let (Some(parameters), Some(status)) = (parameters, status) else {
        return;
    };
    if (parameters.value ^ status.value) & 0b111 != 0 {
        findings.push(
            rules::W0954
                .told(
                    status.span,
                    format!(
                        "6500h is 0x{:X}, but 6000h is 0x{:X}",
                        status.value, parameters.value
                    ),
                )
                .about(Address::new(0x6500, 0))
                .with_label(parameters.span, "6000h is set here")
                .with_help("give bits 0 to 2 of both the same values")
                .fix(Fix::unsafe_fix().replace(
                    status.span,
                    format!("0x{:X}", status.value & !0b111 | parameters.value & 0b111),
                )),
        );
    }
}

/// An encoder tells no alarm and no warning that it says it has not.
fn signals(
    index: u16,
    active: Option<Spanned<u64>>,
    supported: Option<Spanned<u64>>,
    findings: &mut Vec<Finding>,
) {
    let (Some(active), Some(supported)) = (active, supported) else {
        return;
    };
    let more = active.value & !supported.value;
    if more != 0 {
        findings.push(
            rules::W0959
                .told(
                    active.span,
                    format!(
                        "{index:04X}h has bits (0x{more:X}) that {:04X}h does not support",
                        index + 1
                    ),
                )
                .about(Address::new(index, 0))
                .with_label(supported.span, "what is supported stands here")
                .with_help("write `DefaultValue=0`: a new device has nothing to tell"),
        );
    }
}

/// 6200h and the event timer of the first TPDO are one timer.
fn timers(cycle: Option<Spanned<u64>>, event: Option<Spanned<u64>>, findings: &mut Vec<Finding>) {
    let (Some(cycle), Some(event)) = (cycle, event) else {
        return;
    };
    if cycle.value != event.value {
        findings.push(
            rules::W0958
                .told(
                    cycle.span,
                    format!(
                        "6200h is {} ms, but 1800h:05 is {} ms",
                        cycle.value, event.value
                    ),
                )
                .about(Address::new(0x6200, 0))
                .with_label(event.span, "1800h:05 is set here")
                .with_help("give both the same value")
                .fix(Fix::unsafe_fix().replace(cycle.span, format!("{}", event.value))),
        );
    }
}
