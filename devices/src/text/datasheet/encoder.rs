//! Facts about the encoder, from its profile.

use std::format;
use std::prelude::v1::*;

use odkit::encoder::{
    Appears, Counter, EncoderProfile, GearKind, Quantity, RangeRule, Report, Role, Source, Total,
    Until,
};

use od_eds::convert::markdown::fact;
use odkit::{Address, DeviceKind};

/// The columns of [`faults`].
pub(super) fn fault_head(encoder: &EncoderProfile) -> Vec<&'static str> {
    let mut head = [
        "`fault`",
        "EMCY",
        "1001h",
        "6503h",
        "6505h",
        "detected",
        "active until",
    ]
    .to_vec();
    if encoder.object(Role::InjectedError).is_some() {
        head.push("injected by");
    }
    head
}

pub(super) fn facts(kind: &DeviceKind, profile: &EncoderProfile) -> Vec<Vec<String>> {
    let mut facts = Vec::new();
    let sensor = profile.sensor_of(kind.dictionary);
    let turns = match sensor.turns {
        1 => "singleturn".to_owned(),
        turns => format!("{turns} revolutions"),
    };
    facts.push(fact(
        "Sensor",
        format!("{} steps per revolution, {turns}", sensor.steps),
    ));
    if let Some(steps) = profile.unscaled_steps {
        facts.push(fact(
            "With scaling off",
            format!("{steps} steps per revolution"),
        ));
    }
    if kind.channels > 1 {
        facts.push(fact(
            "Channels",
            format!(
                "{} nodes with one shaft and one power supply",
                kind.channels
            ),
        ));
    }
    let range = match profile.range_rule {
        RangeRule::Sensor => "1 to the resolution of the sensor",
        RangeRule::PowerOfTwo => "6001h times a power of two; 0 means 2^32",
        RangeRule::Turns => "at most 6001h times the revolutions of the sensor",
    };
    facts.push(fact("Total range (6002h)", range));
    let total = match profile.total {
        Total::Steps => "steps in all",
        Total::Revolutions => "revolutions of the sensor",
        Total::Shown => "6002h / 6001h",
    };
    facts.push(fact("6502h", total));
    let counter = match profile.counter {
        _ if sensor.turns == 1 => "the angle is kept, revolutions are not counted".to_owned(),
        Counter::Sensor => "whole ranges of the sensor are not counted".to_owned(),
        Counter::Kept { turns } => {
            format!(
                "up to {} revolutions in either direction are counted",
                turns / 2
            )
        }
        Counter::Volatile => "revolutions are not counted".to_owned(),
    };
    facts.push(fact("Without power", counter));
    let offset = if profile.signed_offset {
        "signed"
    } else {
        "modulo the range"
    };
    facts.push(fact("Offset (6509h)", offset));
    if let Some(gear) = &profile.gear
        && kind.dictionary.entry(gear.index, 1).is_some()
    {
        let what = match gear.kind {
            GearKind::Position => "divides the position value; takes effect after save and restart",
            GearKind::Output => "6002h is one revolution of its output; takes effect immediately",
        };
        let text = format!("{:04X}h:01 = {} enables it; {what}", gear.index, gear.on);
        facts.push(fact("Electronic gear", text));
    }
    for (address, movement) in profile.movements() {
        let (name, unit) = match (movement.quantity, movement.sources) {
            (Quantity::Speed, [(_, Source::Revolutions), ..]) => ("Speed", "rpm"),
            (Quantity::Speed, _) => ("Speed", "steps/s"),
            (Quantity::Acceleration, _) => ("Acceleration", "steps/s²"),
        };
        let text = format!(
            "{address}, {unit}, mean of {} milliseconds",
            movement.interval
        );
        facts.push(fact(name, text));
    }
    let time = match profile.role(Address::new(0x6508, 0)) {
        Some(Role::TenthHoursSinceStart) => "0.1 h since the last start",
        Some(Role::TenthHours) => "0.1 h over the device's life",
        _ => "not counted",
    };
    facts.push(fact("6508h", time));
    facts
}

pub(super) fn faults(kind: &DeviceKind, encoder: &EncoderProfile) -> Vec<Vec<String>> {
    let supports = |index, bits: u16| {
        let entry = kind.dictionary.entry(index, 0);
        let supported = entry.and_then(|entry| entry.default.integer(1));
        supported.is_none_or(|supported| supported & i128::from(bits) == i128::from(bits))
    };
    let has = |report: &&Report| {
        !encoder.by_support || (supports(0x6504, report.alarm) && supports(0x6506, report.warning))
    };
    let reports = encoder.reports.iter().filter(has);
    let columns = fault_head(encoder).len();
    reports.map(|report| row(report, columns)).collect()
}

fn row(report: &Report, columns: usize) -> Vec<String> {
    let bits = |bits: u16| match bits {
        0 => String::new(),
        bits => format!("{bits:04X}h"),
    };
    let seen = match (report.appears, report.off_ms) {
        (Appears::Always, _) => "immediately".to_owned(),
        (Appears::Startup, 0) => "at the start".to_owned(),
        (Appears::Startup, ms) => format!("at a start after {} s without power", ms / 1000),
        (Appears::Runtime, _) => "at run time".to_owned(),
        (Appears::Injected, _) => "injected".to_owned(),
    };
    let until = match report.until {
        Until::Repaired => "fault cleared",
        Until::Reboot => "next start",
        Until::Ever => "never",
    };
    let code = report.injection.map(|code| format!("{code:08X}h"));
    let cells = [
        format!("`{}`", report.fault.name()),
        format!("{:04X}h", report.code),
        format!("{:02X}h", report.register),
        bits(report.alarm),
        bits(report.warning),
        seen,
        until.to_owned(),
        code.unwrap_or_default(),
    ];
    cells.into_iter().take(columns).collect()
}
