//! TPDOs: when they are sent, and their communication parameters.

use std::ops::RangeInclusive;

use od_model::{Address, values};
use od_wire::AbortCode::{ValueRange, ValueTooHigh};
use od_wire::nmt::Command;
use od_wire::{CanId, CobId};

use super::each_tpdo::on_each;
use super::transmit::{
    Tpdo, first, gaps, learn_sync, mapping, next, none, starts_silent, sync, timed, timed_on,
    timer_gaps, typed, typed_on,
};
use crate::conform::dut::{Dut, FREE, QUIET, is_data};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};

pub(super) fn objects(dut: &mut Dut<'_>) -> Checked {
    for base in [0x1400, 0x1800] {
        for pdo in dut.eds.pdos(base) {
            for (index, sub) in [(base + pdo, 1), (base + pdo, 2), (base + 0x200 + pdo, 0)] {
                let done = dut.read(Address::new(index, sub)).map(drop);
                dut.fault(done)?;
            }
        }
    }
    Ok(())
}

/// The objects of the default mappings exist, have that length, and fit into a frame.
pub(super) fn mapped_objects(dut: &mut Dut<'_>) -> Checked {
    for base in [0x1600, 0x1A00] {
        for pdo in dut.eds.pdos(base - 0x200) {
            let map = base + pdo;
            let all = mapping(dut, map)?;
            for mapped in &all {
                let Address { index, sub } = mapped.address;
                if base == 0x1600 && index < 0x20 {
                    continue;
                }
                let name = format!("{} of {map:04X}h", mapped.address);
                let Some(entry) = dut.eds.entry(index, sub) else {
                    return fail(format!("{name} in the EDS"), "it does not have it");
                };
                let bits = entry.data_type.bits().map_or(mapped.bits, usize::from);
                ensure(
                    bits == mapped.bits || bits.div_ceil(8) * 8 == mapped.bits,
                    format!("{bits} bits of {name}"),
                    format!("{} are mapped", mapped.bits),
                )?;
            }
            let bits: usize = all.iter().map(|mapped| mapped.bits).sum();
            ensure(
                bits <= 64,
                format!("64 bits in {map:04X}h at most"),
                format!("{bits} are mapped"),
            )?;
        }
    }
    Ok(())
}

/// Event timers of one byte and of two, with both event-driven transmission types.
pub(super) fn event_timer(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 100)?;
        for kind in [254, 255] {
            // A node may have one of the two types.
            if dut.download(pdo.address(2), &[kind])?.is_err() {
                continue;
            }
            for (millis, count) in [(100u16, 5), (300, 2)] {
                dut.write(pdo.address(5), &millis.to_le_bytes())?;
                let wanted = u64::from(millis) * 1000;
                let shown = format!(
                    "every {millis} ms, with transmission type {kind} of TPDO{}",
                    pdo.com - 0x17FF
                );
                timer_gaps(dut, pdo, count, wanted, &shown)?;
                dut.nmt(Command::EnterPreOperational)?;
            }
        }
        Ok(())
    })
}

/// Each TPDO comes once with every n-th SYNC, and not without SYNC.
pub(super) fn sync_each(dut: &mut Dut<'_>, kind: u8, count: u16) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| with_sync(dut, pdo, kind, count))
}

fn with_sync(dut: &mut Dut<'_>, pdo: &Tpdo, kind: u8, count: u16) -> Checked {
    typed_on(dut, pdo, kind)?;
    starts_silent(dut, pdo)?;
    none(dut, pdo, 200_000, "no TPDO without SYNC")?;
    // With a counter, SYNC messages of the test do not have the right length.
    let counts = dut.eds.has(0x1019) && dut.number(0x1019, 0)? != 0;
    let from = dut.frames.len();
    // A TPDO that comes rarely does not need as much time after each SYNC.
    let pause = if kind > 10 { 5_000 } else { 30_000 };
    let mut came = Vec::new();
    for turn in 0..count {
        sync(dut)?;
        let mut number = 0;
        while next(dut, pdo, pause)?.is_some() {
            number += 1;
            if number > 3 {
                break;
            }
        }
        if number > 0 {
            came.push((turn, number));
        }
    }
    if !counts {
        no_emcy_since(dut, from)?;
    }
    let kind = u16::from(kind);
    let wanted = count / kind;
    let is_even = came.windows(2).all(|pair| pair[1].0 - pair[0].0 == kind);
    ensure(
        came.len() == usize::from(wanted) && is_even && came.iter().all(|(_, number)| *number == 1),
        format!("TPDO{} once with every {kind}. SYNC", pdo.com - 0x17FF),
        format!("of {count} SYNCs these had some: {came:?}"),
    )
}

/// A start in Operational is not a transition: the count of SYNC messages goes on.
pub(super) fn started_again(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| {
        typed_on(dut, pdo, 3)?;
        starts_silent(dut, pdo)?;
        // Devices differ in which SYNC they count first.
        let mut is_sent = false;
        for _ in 0..3 {
            sync(dut)?;
            is_sent |= next(dut, pdo, 30_000)?.is_some();
            if is_sent {
                break;
            }
        }
        if !is_sent {
            return lacks("the TPDO does not come with three SYNC messages");
        }
        let mut came = Vec::new();
        for turn in 1..=3 {
            sync(dut)?;
            if next(dut, pdo, 30_000)?.is_some() {
                came.push(turn);
            }
            if turn == 1 {
                starts_silent(dut, pdo)?;
            }
        }
        ensure(
            came == [3],
            format!(
                "TPDO{} with the third SYNC after the one before, by transmission type 3, also if NMT start comes again after the first",
                pdo.com - 0x17FF
            ),
            format!("it came with {came:?}"),
        )
    })
}

/// SYNC messages of the right length cause no EMCY message; `from` is the number of a frame.
pub(super) fn no_emcy_since(dut: &Dut<'_>, from: usize) -> Checked {
    let id = dut.id(0x80);
    let mut sent = dut.frames.get(from..).unwrap_or_default().iter();
    match sent.find(|one| !one.ours && is_data(&one.frame, id)) {
        Some(emcy) => fail(
            "no EMCY message with SYNC messages of the right length",
            format!("{} came", emcy.frame),
        ),
        None => Ok(()),
    }
}

pub(super) fn acyclic(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| {
        typed_on(dut, pdo, 0)?;
        starts_silent(dut, pdo)?;
        none(dut, pdo, 300_000, "no TPDO without SYNC")?;
        // After SYNC, a TPDO of type 0 is sent only if an event came before; a value that stays the same is no event.
        let (mut last, mut same) = (None, 0);
        for _ in 0..SYNCS {
            sync(dut)?;
            if let Some(heard) = next(dut, pdo, 30_000)? {
                let data = heard.frame.data().to_vec();
                same += u8::from(last.replace(data.clone()) == Some(data));
            }
        }
        ensure(
            same < SYNCS - 1,
            format!("TPDO{} with SYNC only after an event", pdo.com - 0x17FF),
            format!("it came with each of {SYNCS} SYNC messages, with the same bytes"),
        )
    })
}

/// Number of SYNC messages for a TPDO that needs an event.
const SYNCS: u8 = 6;

/// With transmission type 252 the node samples with SYNC, and sends only after a remote frame.
pub(super) fn rtr_synchronous(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, len| {
        typed_on(dut, pdo, 252)?;
        if !CobId::new(pdo.cob_id).allows_rtr() {
            return lacks("the COB-ID forbids remote frames (bit 30)");
        }
        starts_silent(dut, pdo)?;
        for _ in 0..2 {
            for _ in 0..3 {
                sync(dut)?;
                none(
                    dut,
                    pdo,
                    50_000,
                    "no TPDO with SYNC, without a remote frame",
                )?;
            }
            dut.ask_for(pdo.id(), len as u8)?;
            // Devices differ in whether they send at once or with the next SYNC.
            if next(dut, pdo, QUIET)?.is_none() {
                sync(dut)?;
                if next(dut, pdo, QUIET)?.is_none() {
                    return fail(
                        format!(
                            "TPDO{} after its remote frame, with the next SYNC at the latest",
                            pdo.com - 0x17FF
                        ),
                        "none came",
                    );
                }
            }
        }
        Ok(())
    })
}

/// With transmission type 253 only a remote frame sends the TPDO, and the event timer does not.
pub(super) fn rtr_only(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, len| {
        typed_on(dut, pdo, 253)?;
        if !CobId::new(pdo.cob_id).allows_rtr() {
            return lacks("the COB-ID forbids remote frames (bit 30)");
        }
        if dut.eds.writes(pdo.com, 5) {
            dut.set(pdo.address(5), &50u16.to_le_bytes())?;
        }
        let number = pdo.com - 0x17FF;
        dut.nmt(Command::Start)?;
        for _ in 0..2 {
            let expected = format!("no TPDO{number} without a remote frame");
            none(dut, pdo, 300_000, &expected)?;
            sync(dut)?;
            none(dut, pdo, 50_000, &expected)?;
            dut.ask_for(pdo.id(), len as u8)?;
            if next(dut, pdo, QUIET)?.is_none() {
                return fail(
                    format!("TPDO{number} within 100 ms of its remote frame"),
                    "none came",
                );
            }
        }
        Ok(())
    })
}

/// Each valid TPDO that allows remote frames; one without a mapping gets one.
pub(super) fn rtr(dut: &mut Dut<'_>) -> Checked {
    first(dut)?;
    on_each(dut, |dut, pdo, len| {
        if !CobId::new(pdo.cob_id).allows_rtr() {
            return lacks("the COB-ID forbids remote frames (bit 30)");
        }
        dut.nmt(Command::Start)?;
        dut.drain()?;
        dut.ask_for(pdo.id(), len as u8)?;
        let heard = next(dut, pdo, QUIET)?;
        dut.nmt(Command::EnterPreOperational)?;
        match heard {
            Some(_) => Ok(()),
            None => fail(
                format!("the TPDO {} within 100 ms of its remote frame", pdo.id()),
                "none came",
            ),
        }
    })
}

/// With bit 30 of its COB-ID a TPDO does not respond to a remote frame.
pub(super) fn rtr_forbidden(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let mut pdo = typed(dut, 1)?;
    let before = pdo.cob_id;
    if CobId::new(before).allows_rtr() {
        if !dut.eds.writes(pdo.com, 1) {
            return lacks("the COB-ID allows remote frames (bit 30) and cannot be written");
        }
        dut.keep(pdo.address(1))?;
        pdo.cob_id = before | 1 << 30;
        for value in [before | 1 << 31, pdo.cob_id | 1 << 31, pdo.cob_id] {
            if dut.download(pdo.address(1), &value.to_le_bytes())?.is_err() {
                // The PDO is not valid, so that the COB-ID can be restored.
                let _ = dut.download(pdo.address(1), &(before | 1 << 31).to_le_bytes())?;
                return lacks("the node does not forbid remote frames (bit 30)");
            }
        }
    }
    dut.nmt(Command::Start)?;
    dut.wait(QUIET)?;
    dut.ask_for(pdo.id(), 8)?;
    let done = none(
        dut,
        &pdo,
        QUIET,
        "no response to a remote frame with bit 30 of the COB-ID",
    );
    dut.nmt(Command::EnterPreOperational)?;
    if pdo.cob_id != before {
        dut.write(pdo.address(1), &(before | 1 << 31).to_le_bytes())?;
    }
    done
}

/// The node does not respond to a remote frame for the TPDO of another node.
pub(super) fn rtr_other_node(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = typed(dut, 1)?;
    let own = dut.node.raw();
    let other = if own == 127 { 126 } else { own + 1 };
    dut.nmt(Command::Start)?;
    dut.wait(QUIET)?;
    dut.ask_for(CanId::standard(0x180 + u16::from(other)), 8)?;
    none(
        dut,
        &pdo,
        QUIET,
        "no response to a remote frame for another node",
    )
}

/// The event timer goes on while a master writes other objects.
pub(super) fn undisturbed(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 100)?;
        dut.nmt(Command::Start)?;
        next(dut, pdo, 500_000)?;
        let from = dut.frames.len();
        writes_others(dut, pdo.com, 600_000)?;
        let sent = dut.frames.get(from..).unwrap_or_default().iter();
        let count = sent
            .filter(|one| !one.ours && pdo.carries(&one.frame))
            .count();
        ensure(
            count >= 4,
            format!(
                "TPDO{} every 100 ms while a master writes the values of other objects again",
                pdo.com - 0x17FF
            ),
            format!("{count} came in 600 ms"),
        )
    })
}

/// Writes the own values of objects of communication for this time, but none of the parameter `except`.
pub(super) fn writes_others(dut: &mut Dut<'_>, except: u16, micros: u64) -> Checked {
    let is_one = |address: &Address| match address.index {
        0x1017 => true,
        index @ 0x1800..=0x19FF => index != except && address.sub == 5,
        _ => false,
    };
    let entries = dut.eds.writable();
    let own: Vec<Address> = entries.iter().map(|entry| entry.address).collect();
    let mut values = Vec::new();
    for address in own.into_iter().filter(is_one).take(4) {
        values.push((address, dut.read(address)?));
    }
    if values.is_empty() {
        return lacks("the EDS has no other object to write");
    }
    let end = dut.now().plus_micros(micros);
    while dut.now() < end {
        for (address, bytes) in &values {
            let _ = dut.download(*address, bytes)?;
        }
        dut.wait(20_000)?;
    }
    Ok(())
}

/// With event timer 0 the node sends a TPDO only because of events.
pub(super) fn event_timer_off(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        dut.nmt(Command::Start)?;
        if next(dut, pdo, 500_000)?.is_none() {
            return fail("a TPDO every 50 ms", "none came");
        }
        dut.write(pdo.address(5), &[0, 0])?;
        dut.drain()?;
        // A changed value is an event.
        let mut last = None;
        let until = dut.now().plus_micros(500_000);
        while let Some(heard) = dut.receive(until)? {
            if !pdo.carries(&heard.frame) {
                continue;
            }
            let data = heard.frame.data().to_vec();
            if last.replace(data.clone()) == Some(data) {
                return fail(
                    "no TPDO by an event timer of 0",
                    format!("{} came again", heard.frame),
                );
            }
        }
        Ok(())
    })
}

pub(super) fn not_in_pre_operational(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        dut.drain()?;
        quiet(dut, pdo, "Pre-operational")
    })
}

pub(super) fn not_in_stopped(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        for (command, state) in [
            (Command::EnterPreOperational, "Pre-operational"),
            (Command::Stop, "Stopped"),
        ] {
            dut.nmt(Command::Start)?;
            dut.wait(QUIET)?;
            dut.nmt(command)?;
            dut.drain()?;
            quiet(dut, pdo, state)?;
            dut.nmt(Command::Start)?;
            if next(dut, pdo, 500_000)?.is_none() {
                return fail(
                    format!("TPDO{} again after {state}", pdo.com - 0x17FF),
                    "none came",
                );
            }
        }
        Ok(())
    })
}

pub(super) fn sync_not_in_stopped(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, _| {
        typed_on(dut, pdo, 1)?;
        for (command, state) in [
            (Command::EnterPreOperational, "Pre-operational"),
            (Command::Stop, "Stopped"),
        ] {
            dut.nmt(command)?;
            dut.drain()?;
            quiet(dut, pdo, state)?;
        }
        starts_silent(dut, pdo)?;
        sync(dut)?;
        match next(dut, pdo, QUIET)? {
            Some(_) => Ok(()),
            None => fail(
                format!(
                    "TPDO{} with SYNC again after another start",
                    pdo.com - 0x17FF
                ),
                "none came",
            ),
        }
    })
}

/// Fails if the TPDO is sent because of timer, SYNC or remote frame.
fn quiet(dut: &mut Dut<'_>, pdo: &Tpdo, state: &str) -> Checked {
    let expected = format!("no TPDO in {state}");
    none(dut, pdo, 200_000, &expected)?;
    sync(dut)?;
    none(dut, pdo, 50_000, &expected)?;
    if CobId::new(pdo.cob_id).allows_rtr() {
        dut.ask_for(pdo.id(), 8)?;
        none(dut, pdo, 50_000, &expected)?;
    }
    Ok(())
}

pub(super) fn length(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, wanted| {
        timed_on(dut, pdo, 50)?;
        dut.nmt(Command::Start)?;
        let Some(heard) = next(dut, pdo, 500_000)? else {
            return fail("a TPDO every 50 ms", "none came");
        };
        ensure(
            usize::from(heard.frame.dlc()) == wanted,
            format!("a TPDO of {wanted} bytes, as mapped"),
            format!("{} came", heard.frame),
        )
    })
}

/// Bit 31 of the COB-ID makes the TPDO not valid.
pub(super) fn off(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = timed(dut, 50)?;
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    dut.set(pdo.address(1), &(pdo.cob_id | 1 << 31).to_le_bytes())?;
    dut.nmt(Command::Start)?;
    none(
        dut,
        &pdo,
        300_000,
        "no TPDO while bit 31 of its COB-ID is set",
    )?;
    quiet(dut, &pdo, "Operational with bit 31 of its COB-ID")?;
    dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
    match next(dut, &pdo, 500_000)? {
        Some(_) => Ok(()),
        None => fail("the TPDO again without bit 31", "none came"),
    }
}

/// Each TPDO is sent with the CAN-ID of its COB-ID.
pub(super) fn cob_id(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        moves(dut, pdo)
    })
}

fn moves(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    let number = pdo.com - 0x17FF;
    let id = FREE + 1;
    let other = (pdo.cob_id & !0x3FFF_FFFF) | u32::from(id);
    for value in [pdo.cob_id | 1 << 31, other | 1 << 31, other] {
        if dut.download(pdo.address(1), &value.to_le_bytes())?.is_err() {
            for value in [pdo.cob_id | 1 << 31, pdo.cob_id] {
                dut.write(pdo.address(1), &value.to_le_bytes())?;
            }
            return lacks("the node does not take another COB-ID");
        }
    }
    dut.nmt(Command::Start)?;
    let moved = Tpdo {
        com: pdo.com,
        cob_id: other,
    };
    let done = match next(dut, &moved, 500_000)? {
        Some(_) => none(
            dut,
            pdo,
            QUIET,
            &format!("no TPDO{number} with the old CAN-ID"),
        ),
        None => fail(
            format!("TPDO{number} with the new CAN-ID {id:03X}h"),
            "none came",
        ),
    };
    dut.nmt(Command::EnterPreOperational)?;
    for value in [other | 1 << 31, pdo.cob_id | 1 << 31, pdo.cob_id] {
        dut.write(pdo.address(1), &value.to_le_bytes())?;
    }
    done
}

pub(super) fn reserved_types(dut: &mut Dut<'_>) -> Checked {
    first(dut)?;
    refuses_types(dut, 0x1800, 241..=251)
}

/// Every PDO from the communication parameter `base` on refuses these transmission types.
pub(super) fn refuses_types(dut: &mut Dut<'_>, base: u16, kinds: RangeInclusive<u8>) -> Checked {
    let mut any = false;
    for number in dut.eds.pdos(base) {
        let com = base + number;
        if !dut.eds.writes(com, 2) {
            continue;
        }
        any = true;
        let address = Address::new(com, 2);
        dut.keep(address)?;
        for kind in kinds.clone() {
            let done = dut.refuses_value(address, &[kind], &[ValueRange, ValueTooHigh]);
            dut.fault(done)?;
        }
    }
    at_least_one(any, "the transmission type cannot be written")
}

/// The inhibit time of a valid TPDO cannot be changed.
pub(super) fn inhibit_fixed(dut: &mut Dut<'_>) -> Checked {
    fixed(dut, 3, "the inhibit time cannot be written")
}

/// The SYNC start value of a valid TPDO cannot be changed.
pub(super) fn start_value_fixed(dut: &mut Dut<'_>) -> Checked {
    fixed(dut, 6, "the SYNC start value cannot be written")
}

/// Fails if a sub-index of the communication parameter of a valid TPDO changes.
fn fixed(dut: &mut Dut<'_>, sub: u8, without: &str) -> Checked {
    on_each(dut, |dut, pdo, _| {
        if !dut.eds.writes(pdo.com, sub) || !dut.eds.writes(pdo.com, 1) {
            return lacks(without);
        }
        let address = pdo.address(sub);
        let before = dut.read(address)?;
        let mut other = before.clone();
        if let Some(first) = other.first_mut() {
            *first ^= 1;
        }
        let done = dut.cannot_change(address, &other, "as the TPDO is valid");
        if matches!(done, Err(End::Fail { .. })) {
            dut.write(pdo.address(1), &(pdo.cob_id | 1 << 31).to_le_bytes())?;
            dut.write(address, &before)?;
            dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
        }
        done
    })
}

/// After reset communication the event timer is what sub-index 5 says then.
pub(super) fn over_reset(dut: &mut Dut<'_>) -> Checked {
    let pdo = timed(dut, 50)?;
    dut.nmt(Command::Start)?;
    if next(dut, &pdo, 500_000)?.is_none() {
        return fail("a TPDO every 50 ms", "none came");
    }
    dut.reset(Command::ResetCommunication)?;
    let millis = dut.number(pdo.com, 5)?;
    if millis == 50 {
        return lacks("the event timer is 50 ms after the reset");
    }
    dut.nmt(Command::Start)?;
    let mut last = None;
    let until = dut.now().plus_micros(500_000);
    let mut same = 0;
    while let Some(heard) = dut.receive(until)? {
        if pdo.carries(&heard.frame) {
            let data = heard.frame.data().to_vec();
            same += u32::from(last.replace(data.clone()) == Some(data));
        }
    }
    // A changed value is an event; a timer that is slower than 50 ms sends at most every 51 ms.
    let most = 500u64.checked_div(millis).unwrap_or(0) + 2;
    ensure(
        u64::from(same) <= most,
        format!("no TPDO by the event timer from before the reset, as it is {millis} ms now"),
        format!("{same} came within 500 ms"),
    )
}

/// An inhibit time that is longer than the event timer, and one that is shorter.
pub(super) fn inhibit(dut: &mut Dut<'_>) -> Checked {
    let pdo = timed(dut, 20)?;
    if !dut.eds.writes(pdo.com, 3) || !dut.eds.writes(pdo.com, 1) {
        return lacks("the inhibit time cannot be written");
    }
    let off = (pdo.cob_id | 1 << 31).to_le_bytes();
    dut.set(pdo.address(1), &off)?;
    let before = dut.read(pdo.address(3))?;
    dut.write(pdo.address(3), &1000u16.to_le_bytes())?;
    dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
    let mut done = gaps(
        dut,
        &pdo,
        4,
        |gap, slack| gap + slack + 5_000 >= 100_000,
        "every 100 ms at most",
    );
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(pdo.address(1), &off)?;
    if done.is_ok() {
        dut.write(pdo.address(3), &200u16.to_le_bytes())?;
        dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
        dut.write(pdo.address(5), &150u16.to_le_bytes())?;
        let shown = "every 150 ms, the event timer, with an inhibit time of 20 ms";
        done = timer_gaps(dut, &pdo, 4, 150_000, shown);
        dut.nmt(Command::EnterPreOperational)?;
        dut.write(pdo.address(1), &off)?;
    }
    dut.write(pdo.address(3), &before)?;
    dut.notes.push(format!(
        "put back {} = {}",
        pdo.address(3),
        values::hex(&before)
    ));
    done
}
