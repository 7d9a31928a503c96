//! What the services do, by the profile.

use std::format;
use std::prelude::v1::*;

use odkit::{CommunicationReset, CutSave, Restore, SaveAnswer, SavedCobIds};

use od_eds::convert::markdown::fact;
use odkit::DeviceKind;
use odkit::encoder::Role;

pub(super) fn facts(kind: &DeviceKind) -> Vec<Vec<String>> {
    let mut facts = Vec::new();
    sdo(kind, &mut facts);
    pdo(kind, &mut facts);
    nmt(kind, &mut facts);
    store(kind, &mut facts);
    lss(kind, &mut facts);
    bit_rates(kind, &mut facts);
    errors(kind, &mut facts);
    options(kind, &mut facts);
    facts
}

fn sdo(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let sdo = &kind.profile.sdo;
    let transfers = match (sdo.segmented_upload, sdo.segmented_download, sdo.block) {
        (false, _, _) => "expedited",
        (true, false, _) => "expedited; segmented upload",
        (true, true, false) => "expedited, segmented",
        (true, true, true) => "expedited, segmented, block",
    };
    let lengths = match sdo.min_dlc {
        8 => "requests have eight bytes".to_owned(),
        least => format!("requests have {least} to 8 bytes"),
    };
    facts.push(fact("SDO server", format!("{transfers}; {lengths}")));
    let wrong = match sdo.length.too_long {
        None => "too much data counts with its low bytes".to_owned(),
        Some(code) => format!("wrong lengths are {:08X}h", code.code()),
    };
    let below = sdo.below_limit.code();
    let refusals = format!("{wrong}; above a limit is 06090031h, below it {below:08X}h");
    facts.push(fact("Refusals", refusals));
}

fn pdo(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let pdo = &kind.profile.pdo;
    let types = types(pdo.tpdo_types);
    facts.push(fact("TPDOs", format!("2; transmission types {types}")));
    let count = kind.dictionary.entry(0x1A00, 0);
    let mapping = match count.is_some_and(|entry| entry.access.writable()) {
        true => "dynamic, up to eight objects",
        false => "fixed",
    };
    facts.push(fact("PDO mapping", mapping));
    if let Some(index) = pdo.repeat_counter {
        facts.push(fact(
            "Repeat counters",
            format!("{index:04X}h and {:04X}h", index + 1),
        ));
    }
}

/// Ranges of transmission types.
pub(super) fn types(ranges: &[(u8, u8)]) -> String {
    let range = |(low, high): &(u8, u8)| match low == high {
        true => low.to_string(),
        false => format!("{low}–{high}"),
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(", ")
}

fn nmt(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let nmt = &kind.profile.nmt;
    let millis = |micros: u32| match micros {
        0 => "at once".to_owned(),
        micros => format!("boot-up after {} ms", micros / 1000),
    };
    facts.push(fact(
        "Power-on and NMT reset node",
        millis(nmt.reset_node_us),
    ));
    let lost = match nmt.reset_communication {
        CommunicationReset::Communication => "takes back 1000h–1FFFh, node ID and bit rate",
        CommunicationReset::Everything => "takes back all that was not saved",
    };
    let duration = millis(nmt.reset_communication_us);
    facts.push(fact(
        "NMT reset communication",
        format!("{duration}; {lost}"),
    ));
    if let Some((index, _)) = nmt.self_start {
        facts.push(fact("Starts by itself", format!("as {index:04X}h says")));
    }
    let control = match kind.profile.guarding_switch {
        Some((index, bits)) => format!(
            "heartbeat, or node guarding with bit {} of {index:04X}h",
            bits.trailing_zeros()
        ),
        None => "heartbeat (1017h), else node guarding".to_owned(),
    };
    let consumer = match kind.dictionary.entry(0x1016, 1) {
        Some(_) => "; heartbeat consumer (1016h)",
        None => "",
    };
    facts.push(fact("Error control", format!("{control}{consumer}")));
}

fn store(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let store = &kind.profile.store;
    let answer = match (store.answer, store.duration_us / 1000) {
        (_, 0) => "at once".to_owned(),
        (SaveAnswer::AtOnce, ms) => format!("answered at once, stored within {ms} ms"),
        (SaveAnswer::AfterStoring, ms) => format!("answered when stored, after {ms} ms"),
    };
    let cut = match store.cut {
        CutSave::LastSet => "a cut save leaves the last set",
        CutSave::Factory => "a cut save leaves the factory values",
    };
    facts.push(fact("Save (1010h)", format!("{answer}; {cut}")));
    let restore = match store.restore {
        Restore::AtOnce => "acts at once",
        Restore::AfterReset => "acts after a reset",
    };
    facts.push(fact("Restore (1011h)", restore));
    let cob_ids = match store.cob_ids {
        SavedCobIds::Absolute => "stay when the node ID changes",
        SavedCobIds::Difference => "move with the node ID",
    };
    facts.push(fact("Saved COB-IDs", cob_ids));
}

fn lss(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let Some(lss) = &kind.profile.lss else {
        return;
    };
    let mut services = String::from(
        "switch state (global, selective), inquire identity, configure node ID and bit timing, \
         activate, store",
    );
    for (has, service) in [
        (lss.inquire_node_id, "inquire node ID"),
        (lss.identify_remote, "identify remote slave"),
        (lss.non_configured, "identify non-configured slave"),
        (lss.fastscan, "fastscan"),
    ] {
        if has {
            services.push_str(", ");
            services.push_str(service);
        }
    }
    let when = if lss.stopped_only {
        "; in Stopped alone"
    } else {
        ""
    };
    facts.push(fact("LSS slave", format!("{services}{when}")));
}

fn bit_rates(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let list = |rates: &[u16]| {
        let known = rates.iter().enumerate().filter(|(_, rate)| **rate != 0);
        let pairs = known.map(|(code, rate)| format!("{code} = {rate}"));
        pairs.collect::<Vec<_>>().join(", ")
    };
    let encoder = kind.encoder;
    if let Some(address) = encoder.object(Role::BitRate) {
        let rates = list(encoder.bit_rates);
        facts.push(fact(
            "Bit rates",
            format!("{:04X}h, in kbit/s: {rates}", address.index),
        ));
    }
    if !encoder.switch_rates.is_empty() {
        let rates = list(encoder.switch_rates);
        let switches = format!(
            "rotary for the node ID, 1–99; with 0 the objects rule. DIP for the bit rate, in \
             kbit/s: {rates}"
        );
        facts.push(fact("Switches", switches));
    }
}

fn errors(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let errors = &kind.profile.errors;
    let has = |sub| kind.dictionary.entry(0x1029, sub).is_some();
    let rules = errors.behaviour.iter().filter(|(_, sub)| has(*sub));
    let rules: Vec<String> = rules
        .map(|(bits, sub)| format!("1029h:{sub:02X} on bits {bits:02X}h of 1001h"))
        .collect();
    if !rules.is_empty() {
        facts.push(fact("Error behaviour", rules.join(", ")));
    }
    let notices = [
        ("lost master", Some(errors.lost)),
        ("bus warning", errors.bus_warning),
        ("error passive", errors.bus_passive),
        ("back from bus-off", errors.bus_recovered),
        ("lost frames", errors.overrun),
    ];
    let known = notices.iter().filter_map(|(name, notice)| {
        let notice = (*notice)?;
        Some(format!("{:04X}h {name}", notice.code))
    });
    facts.push(fact(
        "EMCY of the bus",
        known.collect::<Vec<_>>().join(", "),
    ));
}

/// What bits of the manufacturer's options do.
fn options(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let profile = kind.profile;
    let mut bits: Vec<(u16, u32, &str)> = Vec::new();
    let mut add = |switch: Option<(u16, u32)>, what| {
        if let Some((index, mask)) = switch.filter(|(index, mask)| *mask != 0 && *index != 0x1F80) {
            bits.push((index, mask, what));
        }
    };
    add(
        profile.guarding_switch,
        "node guarding in place of heartbeat",
    );
    add(profile.pdo.sync_only, "synchronous PDOs alone");
    add(profile.nmt.self_start, "starts by itself");
    add(profile.nmt.reset_node_light, "reset node keeps the values");
    add(
        profile.errors.off.restart,
        "the bus begins anew after bus-off",
    );
    if let Some(options) = &kind.encoder.options {
        let at = |mask| Some((options.index, mask));
        add(at(options.keep_offset), "a new resolution keeps the offset");
        add(at(options.delay_timer), "1800h:05 is later than 6200h");
        add(
            at(options.ignore_sense),
            "speed and acceleration without the sense of rotation",
        );
    }
    bits.sort_by_key(|(index, mask, _)| (*index, mask.trailing_zeros()));
    for (index, mask, what) in bits {
        let numbers: Vec<String> = (0..32)
            .filter(|bit| mask >> bit & 1 == 1)
            .map(|bit| bit.to_string())
            .collect();
        facts.push(fact(
            &format!("{index:04X}h bit {}", numbers.join(", ")),
            what,
        ));
    }
}
