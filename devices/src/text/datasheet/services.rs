//! Facts about the services, from the profile.

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
        8 => "requests need eight bytes".to_owned(),
        least => format!("requests need {least} to 8 bytes"),
    };
    facts.push(fact("SDO server", format!("{transfers}; {lengths}")));
    let wrong = match sdo.length.too_long {
        None => "of too many bytes the low ones are used".to_owned(),
        Some(code) => format!("a wrong length gives {:08X}h", code.code()),
    };
    let below = sdo.below_limit.code();
    let refusals =
        format!("{wrong}; a value above the limit gives 06090031h, below it {below:08X}h");
    facts.push(fact("Abort codes", refusals));
}

fn pdo(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let pdo = &kind.profile.pdo;
    let types = types(pdo.tpdo_types);
    facts.push(fact("TPDOs", format!("2; transmission types {types}")));
    let count = kind.dictionary.entry(0x1A00, 0);
    let mapping = if count.is_some_and(|entry| entry.access.writable()) {
        "dynamic, up to eight objects"
    } else {
        "fixed"
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
    let range = |(low, high): &(u8, u8)| {
        if low == high {
            low.to_string()
        } else {
            format!("{low}–{high}")
        }
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(", ")
}

fn nmt(kind: &DeviceKind, facts: &mut Vec<Vec<String>>) {
    let nmt = &kind.profile.nmt;
    let millis = |micros: u32| match micros {
        0 => "immediately".to_owned(),
        micros => format!("boot-up after {} ms", micros / 1000),
    };
    facts.push(fact(
        "Power-on and NMT reset node",
        millis(nmt.reset_node_us),
    ));
    let lost = match nmt.reset_communication {
        CommunicationReset::Communication => {
            "discards unsaved values of 1000h–1FFFh, node ID and bit rate"
        }
        CommunicationReset::Everything => "discards all unsaved values",
    };
    let duration = millis(nmt.reset_communication_us);
    facts.push(fact(
        "NMT reset communication",
        format!("{duration}; {lost}"),
    ));
    if let Some((index, _)) = nmt.self_start {
        facts.push(fact("Self-start", format!("set by {index:04X}h")));
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
        (_, 0) => "immediately".to_owned(),
        (SaveAnswer::AtOnce, ms) => format!("confirmed immediately, saved within {ms} ms"),
        (SaveAnswer::AfterStoring, ms) => format!("confirmed when saved, after {ms} ms"),
    };
    let cut = match store.cut {
        CutSave::LastSet => "an interrupted save leaves the last saved values",
        CutSave::Factory => "an interrupted save leaves the factory values",
    };
    facts.push(fact("Save (1010h)", format!("{answer}; {cut}")));
    let restore = match store.restore {
        Restore::AtOnce => "takes effect immediately",
        Restore::AfterReset => "takes effect after a reset",
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
        "switch state (global, selective), inquire LSS address, configure node ID and bit timing, \
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
        "; in Stopped only"
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
    let Some(encoder) = kind.encoder() else {
        return;
    };
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
            "rotary for the node ID, 1–99; 0: the objects set it. DIP for the bit rate, in \
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
        ("life guarding or heartbeat error", Some(errors.lost)),
        ("bus warning", errors.bus_warning),
        ("error passive", errors.bus_passive),
        ("recovered from bus-off", errors.bus_recovered),
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

/// Meaning of the bits of the manufacturer-specific options.
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
    add(profile.pdo.sync_only, "synchronous PDOs only");
    add(profile.nmt.self_start, "self-start");
    add(profile.nmt.reset_node_light, "reset node keeps the values");
    add(profile.errors.off.restart, "restarts after bus-off");
    if let Some(options) = kind.encoder().and_then(|encoder| encoder.options.as_ref()) {
        let at = |mask| Some((options.index, mask));
        add(at(options.keep_offset), "a new resolution keeps the offset");
        add(at(options.delay_timer), "1800h:05 is 6200h plus a delay");
        add(
            at(options.ignore_code_sequence),
            "speed and acceleration without a sign",
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
