//! RPDOs: values that a master sends.

use od_model::{Address, Entry, values};
use od_wire::nmt::Command;
use od_wire::{CanId, CobId, Frame};

use super::each_rpdo::{NEEDS_MOTION, has_sound_mapping, outputs, takes, with_another};
use super::heartbeat::{beat, emcy, emcy_since, sends_emcy, watch};
use super::mapping::{self, DUMMY, each_refuses, on, raw};
use super::tpdo::refuses_types;
use super::transmit::{Mapped, Tpdo, contradiction, is_on, learn_sync, mapping, sync};
use crate::conform::dut::{Dut, FREE};
use crate::conform::end::{Checked, ensure, fail, lacks, skip};

/// A valid RPDO, and the first value that it writes.
struct Rpdo {
    com: u16,
    cob_id: u32,
    all: Vec<Mapped>,
}

/// The first valid RPDO with this transmission type.
fn first(dut: &mut Dut<'_>, kind: u8) -> Checked<Rpdo> {
    let mut is_held = false;
    for pdo in dut.eds.pdos(0x1400) {
        let com = 0x1400 + pdo;
        let cob_id = dut.number(com, 1)? as u32;
        let all = mapping(dut, com + 0x200)?;
        let Some(one) = all.first().filter(|one| one.address.index >= 0x20) else {
            continue;
        };
        let entry = dut.eds.entry(one.address.index, one.address.sub);
        let fits = entry.is_some_and(|entry| entry.access.readable());
        let is_whole = all.iter().all(|one| one.bits % 8 == 0);
        let works = is_on(cob_id) && contradiction(dut.eds, &all, false).is_none();
        if !works || !fits || !is_whole {
            continue;
        }
        if !dut.may_move && all.iter().any(|one| dut.eds.moves(one.address)) {
            is_held = true;
            continue;
        }
        dut.keep(one.address)?;
        let address = Address::new(com, 2);
        dut.keep(address)?;
        if dut.download(address, &[kind])?.is_err() {
            return lacks(format!("the RPDO does not take transmission type {kind}"));
        }
        return Ok(Rpdo { com, cob_id, all });
    }
    if is_held {
        return skip(NEEDS_MOTION);
    }
    lacks("no RPDO is on and writes a value that can be read")
}

impl Rpdo {
    fn value(&self) -> Address {
        self.all[0].address
    }

    /// The bytes with another first value; also returns this value.
    fn other(&self, dut: &mut Dut<'_>) -> Checked<(Vec<u8>, Vec<u8>)> {
        let mut bytes = Vec::new();
        for mapped in &self.all {
            let mut value = dut.upload(mapped.address)?.unwrap_or_default();
            value.resize(mapped.bits / 8, 0);
            bytes.extend(value);
        }
        bytes.truncate(8);
        if let Some(first) = bytes.first_mut() {
            *first ^= 1;
        }
        let value = bytes[..self.all[0].bits / 8].to_vec();
        Ok((bytes, value))
    }

    fn send(&self, dut: &mut Dut<'_>, bytes: &[u8]) -> Checked {
        match Frame::new(CobId::new(self.cob_id).can_id(), bytes) {
            Some(frame) => dut.send(frame)?,
            None => return Ok(()),
        }
        dut.wait(20_000)
    }

    fn holds(&self, dut: &mut Dut<'_>, wanted: &[u8], why: &str) -> Checked {
        let is = dut.read(self.value())?;
        ensure(
            is == wanted,
            format!("{} in {}{why}", values::hex(wanted), self.value()),
            format!("{} was read", values::hex(&is)),
        )
    }
}

pub(super) fn write(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    dut.nmt(Command::Start)?;
    let (mut bytes, value) = pdo.other(dut)?;
    // The last of several objects has another value, too, if it moves nothing and its limits allow it.
    let last = pdo.all.last().filter(|_| pdo.all.len() > 1);
    let mut wanted = None;
    if let Some(Mapped { address, bits }) = last
        && let Some(entry) = dut.eds.entry(address.index, address.sub)
        && entry.access.readable()
        && dut.eds.writable().contains(&entry)
    {
        let mut other = dut.keep(*address)?;
        if other.len() == bits / 8
            && bytes.len() >= other.len()
            && let Some(first) = other.first_mut()
        {
            *first ^= 1;
            if dut.eds.excludes(*address, &other, dut.node).is_none() {
                let from = bytes.len() - other.len();
                bytes[from..].copy_from_slice(&other);
                wanted = Some((*address, other));
            }
        }
    }
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &value, ", as the RPDO has it")?;
    let Some((address, other)) = wanted else {
        return Ok(());
    };
    let is = dut.read(address)?;
    ensure(
        is == other,
        format!("{} in {address}, as the RPDO has it", values::hex(&other)),
        format!("{} was read", values::hex(&is)),
    )
}

/// RPDOs refuse the reserved transmission types.
pub(super) fn reserved_types(dut: &mut Dut<'_>) -> Checked {
    refuses_types(dut, 0x1400, 241..=253)
}

pub(super) fn not_in_pre_operational(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let before = dut.read(pdo.value())?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, ", as the RPDO came in Pre-operational")?;
    dut.nmt(Command::Stop)?;
    pdo.send(dut, &bytes)?;
    dut.nmt(Command::Start)?;
    pdo.holds(dut, &before, ", as the RPDO came in Stopped")?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &value, ", as the RPDO came after another start")
}

pub(super) fn short(dut: &mut Dut<'_>) -> Checked {
    let (pdo, before) = send_short(dut)?;
    let came = emcy(dut, 0x8210, 200_000)?.is_some();
    if !came && dut.eds.has(0x1014) {
        return fail("EMCY 8210h for an RPDO that is too short", "none came");
    }
    pdo.holds(dut, &before, ", as the RPDO was too short")?;
    if came && dut.eds.entry(0x1003, 1).is_some() {
        let newest = dut.number(0x1003, 1)?;
        let done = ensure(
            newest & 0xFFFF == 0x8210,
            "8210h in 1003h:01, the newest error",
            format!("{newest:08X}h was read"),
        );
        dut.fault(done)?;
    }
    // The next valid frame ends the error, and is used.
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    dut.wait(20_000)?;
    pdo.holds(dut, &value, ", as the RPDO was long enough again")
}

/// Two different errors: an RPDO that is too short, then a missing heartbeat. The newest is the first of the history.
pub(super) fn history_order(dut: &mut Dut<'_>) -> Checked {
    let entry = |sub| Address::new(0x1003, sub);
    if !dut.eds.has(0x1003) || dut.eds.entry(0x1003, 2).is_none() {
        return lacks("1003h has one entry");
    }
    // Without another error the node reports a missing heartbeat.
    let node = watch(dut, 100)?;
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    if emcy(dut, 0x8130, 1_000_000)?.is_none() {
        return lacks("a missing heartbeat causes no EMCY 8130h");
    }
    // The heartbeat ends the error, and nothing is monitored until the other error.
    beat(dut, node)?;
    dut.write(Address::new(0x1016, 1), &[0; 4])?;
    dut.wait(50_000)?;
    let count = dut.number(0x1003, 0)?;
    send_short(dut)?;
    if emcy(dut, 0x8210, 200_000)?.is_none() {
        return lacks("an RPDO that is too short causes no EMCY 8210h");
    }
    let node = watch(dut, 100)?;
    beat(dut, node)?;
    if emcy(dut, 0x8130, 1_000_000)?.is_none() {
        return fail(
            "EMCY 8130h for a missing heartbeat while the error 8210h is present",
            "none came",
        );
    }
    let now = dut.number(0x1003, 0)?;
    let entries = dut.eds.dictionary().entries();
    let own = entries.filter(|one| one.address.index == 0x1003);
    let room = own.map(|one| one.address.sub).max().unwrap_or(0).into();
    ensure(
        now == (count + 2).min(room),
        format!("two more entries than {count} in 1003h:00, {room} at most"),
        format!("{now} was read"),
    )?;
    for (sub, code) in [(1, 0x8130), (2, 0x8210)] {
        let is = dut.number(0x1003, sub)?;
        ensure(
            is & 0xFFFF == code,
            format!("{code:04X}h in {}, as 8210h came before 8130h", entry(sub)),
            format!("{is:08X}h was read"),
        )?;
    }
    Ok(())
}

/// A missing heartbeat, then an RPDO that is too short. With 1 in 1029h:01 the first error leaves the node in
/// Operational, without which it does not receive the RPDO.
pub(super) fn second_error(dut: &mut Dut<'_>) -> Checked {
    let behaviour = Address::new(0x1029, 1);
    let before = dut.number(0x1001, 0)?;
    dut.keep(behaviour)?;
    if dut.download(behaviour, &[1])?.is_err() {
        return lacks("an error of communication leaves Operational");
    }
    let node = watch(dut, 100)?;
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    if emcy(dut, 0x8130, 1_000_000)?.is_none() {
        return lacks("a missing heartbeat causes no EMCY 8130h");
    }
    let (pdo, _) = send_short(dut)?;
    if emcy(dut, 0x8210, 200_000)?.is_none() {
        return fail(
            "EMCY 8210h for an RPDO that is too short while the error 8130h is present",
            "none came",
        );
    }
    // One error ends: 1001h has the other one, and so has a message about the end (CiA 301, 7.2.7.1).
    let (good, _) = pdo.other(dut)?;
    let from = dut.frames.len();
    pdo.send(dut, &good)?;
    let rest = dut.number(0x1001, 0)?;
    let done = ensure(
        rest & 0x10 != 0,
        "1 in bit 4 of 1001h, as the heartbeat is still missing after the other error ended",
        format!("{rest:02X}h was read"),
    );
    dut.fault(done)?;
    if let Some(frame) = emcy_since(dut, from, 0, 50_000)? {
        let done = ensure(
            u64::from(frame.bytes()[2]) == rest,
            format!("{rest:02X}h in byte 2 of the EMCY message about the end of one of two errors"),
            format!("{frame} came"),
        );
        dut.fault(done)?;
    }
    // Both errors end.
    beat(dut, node)?;
    dut.write(Address::new(0x1016, 1), &[0; 4])?;
    dut.wait(50_000)?;
    let after = dut.number(0x1001, 0)?;
    ensure(
        after & !before & 0x10 == 0,
        "0 in bit 4 of 1001h after both errors",
        format!("{after:02X}h was read"),
    )
}

/// Sends an RPDO, which ends an earlier error, and then one without its last byte; returns it and its value before.
fn send_short(dut: &mut Dut<'_>) -> Checked<(Rpdo, Vec<u8>)> {
    sends_emcy(dut)?;
    let pdo = first(dut, 255)?;
    dut.nmt(Command::Start)?;
    let (good, _) = pdo.other(dut)?;
    pdo.send(dut, &good)?;
    let before = dut.read(pdo.value())?;
    let (bytes, _) = pdo.other(dut)?;
    dut.drain()?;
    let short = &bytes[..bytes.len().saturating_sub(1)];
    if let Some(frame) = Frame::new(CobId::new(pdo.cob_id).can_id(), short) {
        dut.send(frame)?;
    }
    Ok((pdo, before))
}

/// An RPDO of more bytes than its mapping: the first bytes are the values.
pub(super) fn long(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    dut.nmt(Command::Start)?;
    let (mut bytes, value) = pdo.other(dut)?;
    if bytes.len() >= 8 {
        return lacks("the first RPDO has eight bytes");
    }
    bytes.push(0);
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &value, ", from the first bytes of a longer RPDO")
}

pub(super) fn synchronous(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = first(dut, 1)?;
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, " until SYNC")?;
    sync(dut)?;
    dut.wait(20_000)?;
    pdo.holds(dut, &value, " after SYNC")
}

pub(super) fn off(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let address = Address::new(pdo.com, 1);
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    dut.set(address, &(pdo.cob_id | 1 << 31).to_le_bytes())?;
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, ", as the RPDO is off")?;
    dut.write(address, &pdo.cob_id.to_le_bytes())?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &value, ", as the RPDO is on again")
}

/// An RPDO has the CAN-ID of its COB-ID, and no longer the one from before.
pub(super) fn cob_id(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let address = Address::new(pdo.com, 1);
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    let own = pdo.cob_id;
    let moved = (own & !0x3FFF_FFFF) | u32::from(FREE + 4);
    dut.set(address, &(own | 1 << 31).to_le_bytes())?;
    for value in [moved | 1 << 31, moved] {
        if dut.download(address, &value.to_le_bytes())?.is_err() {
            return lacks("the node does not take another COB-ID");
        }
    }
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(
        dut,
        &before,
        ", as the RPDO came with its CAN-ID from before",
    )?;
    let moved_pdo = Rpdo {
        cob_id: moved,
        ..pdo
    };
    moved_pdo.send(dut, &bytes)?;
    let done = moved_pdo.holds(dut, &value, ", as the RPDO came with its new CAN-ID 6A4h");
    // The RPDO is not valid, so that the old COB-ID can be restored.
    dut.nmt(Command::EnterPreOperational)?;
    for value in [moved | 1 << 31, own | 1 << 31] {
        dut.write(address, &value.to_le_bytes())?;
    }
    done
}

/// A frame of 29 bits whose number is the CAN-ID of an RPDO writes nothing.
pub(super) fn extended_frame(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let Some(id) = CobId::new(pdo.cob_id).can_id().as_standard() else {
        return lacks("the RPDO has a CAN-ID of 29 bits");
    };
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, _) = pdo.other(dut)?;
    if let Some(frame) = Frame::new(CanId::extended(id.into()), &bytes) {
        dut.send(frame)?;
    }
    dut.wait(20_000)?;
    pdo.holds(dut, &before, ", as a frame with a CAN-ID of 29 bits came")
}

/// An RPDO takes each object that the EDS lets it carry.
pub(super) fn each_mapped(dut: &mut Dut<'_>) -> Checked {
    let pdo = any_on(dut)?;
    mapping::takes_each(dut, pdo, Entry::maps_to_rpdo)
}

/// The first valid RPDO, with any mapping.
fn any_on(dut: &mut Dut<'_>) -> Checked<Tpdo> {
    for number in dut.eds.pdos(0x1400) {
        let com = 0x1400 + number;
        let cob_id = dut.number(com, 1)? as u32;
        if is_on(cob_id) && has_sound_mapping(dut, com)? {
            return Ok(Tpdo { com, cob_id });
        }
    }
    lacks("no RPDO is on with a mapping that the EDS allows")
}

/// The mapping of an RPDO can be written by the procedure of CiA 301.
pub(super) fn mapping_procedure(dut: &mut Dut<'_>) -> Checked {
    let pdo = any_on(dut)?;
    let before = mapping(dut, pdo.map())?.len();
    let map = pdo.map();
    on(dut, pdo, |_, _| Ok(()))?;
    let after = mapping(dut, map)?.len();
    ensure(
        after == before,
        format!("{before} mapped objects in {map:04X}h"),
        format!("{after} are mapped"),
    )
}

/// An RPDO refuses an object that only TPDOs may map.
pub(super) fn direction(dut: &mut Dut<'_>) -> Checked {
    let mut entries = dut.eds.dictionary().entries();
    let is_input = |entry: &Entry| {
        entry.maps_to_tpdo() && !entry.maps_to_rpdo() && entry.data_type.bits().is_some()
    };
    let Some(entry) = entries.find(is_input) else {
        return lacks("every object that a TPDO may carry an RPDO may carry, too");
    };
    any_on(dut)?;
    each_refuses(dut, 0x1400, raw(&entry))
}

/// An RPDO refuses an object that cannot be mapped.
pub(super) fn not_mappable(dut: &mut Dut<'_>) -> Checked {
    let Some(entry) = dut.eds.entry(0x1000, 0).filter(|entry| !entry.mappable) else {
        return lacks("the EDS lets an RPDO carry 1000h");
    };
    any_on(dut)?;
    each_refuses(dut, 0x1400, raw(&entry))
}

pub(super) fn mapping_missing_object(dut: &mut Dut<'_>) -> Checked {
    any_on(dut)?;
    mapping::each(dut, 0x1400, mapping::refuses_missing)
}

pub(super) fn mapping_without_procedure(dut: &mut Dut<'_>) -> Checked {
    let pdo = any_on(dut)?;
    mapping::refuses_without_procedure(dut, pdo, Entry::maps_to_rpdo)
}

pub(super) fn mapping_while_on(dut: &mut Dut<'_>) -> Checked {
    let pdo = any_on(dut)?;
    mapping::refuses_while_on(dut, pdo)
}

pub(super) fn mapping_too_many(dut: &mut Dut<'_>) -> Checked {
    any_on(dut)?;
    mapping::each(dut, 0x1400, mapping::refuses_too_many)
}

pub(super) fn mapping_too_long(dut: &mut Dut<'_>) -> Checked {
    any_on(dut)?;
    mapping::each(dut, 0x1400, |dut, pdo| {
        mapping::refuses_too_long(dut, pdo, Entry::maps_to_rpdo)
    })
}

pub(super) fn mapping_wrong_length(dut: &mut Dut<'_>) -> Checked {
    any_on(dut)?;
    mapping::each(dut, 0x1400, |dut, pdo| {
        mapping::refuses_wrong_length(dut, pdo, Entry::maps_to_rpdo)
    })
}

/// An RPDO writes the objects of a new mapping.
pub(super) fn mapping_used(dut: &mut Dut<'_>) -> Checked {
    let pdo = any_on(dut)?;
    let now = mapping(dut, pdo.map())?;
    let first = now.first().map(|mapped| mapped.address);
    let all = outputs(dut)?;
    let Some(other) = all.iter().find(|entry| Some(entry.address) != first) else {
        return lacks("no other object can be mapped");
    };
    let entries = with_another(dut, pdo.map(), &all, other);
    on(dut, pdo, |dut, map| takes(dut, &pdo, map, &entries))
}

/// A dummy entry skips bits of the frame and writes nothing.
pub(super) fn dummy(dut: &mut Dut<'_>) -> Checked {
    let section = dut.eds.description.section("DummyUsage");
    let used = section.and_then(|section| section.get("Dummy0005"));
    if used.is_none_or(|used| used.value.trim() != "1") {
        return lacks("the EDS does not have Dummy0005=1 in [DummyUsage]");
    }
    let pdo = any_on(dut)?;
    let Some(entry) = outputs(dut)?.first().map(raw) else {
        return lacks("no object can be mapped");
    };
    on(dut, pdo, |dut, map| takes(dut, &pdo, map, &[DUMMY, entry]))
}
