//! Each RPDO of the node: gives it a mapping, and tests what it writes, when, and what it does not.

use od_model::{Address, Entry, values};
use od_wire::Frame;
use od_wire::nmt::Command;

use super::heartbeat::{emcy, emcy_since, sends_emcy};
use super::mapping::{on, raw};
use super::transmit::{Tpdo, contradiction, is_on, learn_sync, mapping, switch, sync};
use crate::conform::dut::{Dut, FREE};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks, skip};
use crate::conform::sdo::abort_text;

/// Reason to skip a case without the permission.
pub(super) const NEEDS_MOTION: &str =
    "the case needs --allow-motion, since each RPDO moves an axis or sets outputs";

/// Returns whether the EDS allows the mapping of an RPDO; the case pdo-mapped-objects tests this.
pub(super) fn has_sound_mapping(dut: &mut Dut<'_>, com: u16) -> Checked<bool> {
    let all = mapping(dut, com + 0x200)?;
    Ok(contradiction(dut.eds, &all, false).is_none())
}

/// Objects of 8, 16 or 32 bits that an RPDO may map and that can be read, in order; without the permission, only those
/// that move nothing.
pub(super) fn outputs(dut: &Dut<'_>) -> Checked<Vec<Entry>> {
    let fits = |entry: &Entry| {
        entry.maps_to_rpdo()
            && entry.access.readable()
            && matches!(entry.data_type.bits(), Some(8 | 16 | 32))
    };
    let mut all: Vec<Entry> = dut.eds.dictionary().entries().filter(fits).collect();
    let is_any = !all.is_empty();
    all.retain(|entry| dut.may_move || !dut.eds.moves(entry.address));
    if is_any && all.is_empty() {
        return skip(NEEDS_MOTION);
    }
    Ok(all)
}

/// A frame that changes the first byte of each object of a mapping.
pub(super) struct Changed {
    bytes: Vec<u8>,
    /// Each object, its value before, and that of the frame.
    values: Vec<(Address, Vec<u8>, Vec<u8>)>,
}

impl Changed {
    /// Reads the objects of these mapping entries; a dummy takes its bits as 0.
    pub(super) fn of(dut: &mut Dut<'_>, entries: &[u32]) -> Checked<Self> {
        let (mut bytes, mut values) = (Vec::new(), Vec::new());
        for entry in entries {
            let address = Address::new((entry >> 16) as u16, (entry >> 8) as u8);
            if address.index < 0x20 {
                bytes.resize(bytes.len() + (entry & 0xFF) as usize / 8, 0);
                continue;
            }
            let before = dut.keep(address)?;
            let mut wanted = before.clone();
            if let Some(first) = wanted.first_mut() {
                *first ^= 1;
            }
            bytes.extend_from_slice(&wanted);
            values.push((address, before, wanted));
        }
        Ok(Self { bytes, values })
    }

    /// Sends the frame in Operational.
    pub(super) fn send(&self, dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
        dut.nmt(Command::Start)?;
        if let Some(frame) = Frame::new(pdo.id(), &self.bytes) {
            dut.send(frame)?;
        }
        dut.wait(20_000)
    }

    /// Writes the values before, so that the same frame changes them again.
    fn reset(&self, dut: &mut Dut<'_>) -> Checked {
        for (address, before, _) in &self.values {
            dut.write(*address, before)?;
        }
        Ok(())
    }

    /// Fails unless each object has its value before, or that of the frame.
    pub(super) fn holds(&self, dut: &mut Dut<'_>, is_new: bool, why: &str) -> Checked {
        for (address, before, wanted) in &self.values {
            let wanted = if is_new { wanted } else { before };
            let is = dut.read(*address)?;
            ensure(
                is == *wanted,
                format!("{} in {address}{why}", values::hex(wanted)),
                format!("{} was read", values::hex(&is)),
            )?;
        }
        Ok(())
    }
}

/// Maps only these entries to the RPDO, and sends other values, which the objects must have then.
pub(super) fn takes(dut: &mut Dut<'_>, pdo: &Tpdo, map: u16, entries: &[u32]) -> Checked {
    for (sub, entry) in (1..).zip(entries) {
        if let Err(code) = dut.download(Address::new(map, sub), &entry.to_le_bytes())? {
            return fail(
                format!("{entry:08X}h in {map:04X}h:{sub:02X}"),
                abort_text(code),
            );
        }
    }
    dut.write(Address::new(map, 0), &[entries.len() as u8])?;
    dut.keep(pdo.address(2))?;
    let _ = dut.download(pdo.address(2), &[255])?;
    dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
    let changed = Changed::of(dut, entries)?;
    changed.send(dut, pdo)?;
    let why = format!(", as RPDO{} has it", pdo.com - 0x13FF);
    let done = changed.holds(dut, true, &why);
    dut.nmt(Command::EnterPreOperational)?;
    done
}

/// A frame that is too short writes nothing and causes EMCY 8210h, each time; one that is too long writes its first
/// bytes.
fn lengths(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32]) -> Checked {
    let number = pdo.com - 0x13FF;
    let has_emcy = sends_emcy(dut).is_ok();
    for _ in 0..2 {
        let mut changed = Changed::of(dut, entries)?;
        let last = changed.bytes.pop();
        dut.nmt(Command::Start)?;
        dut.drain()?;
        if let Some(frame) = Frame::new(pdo.id(), &changed.bytes) {
            dut.send(frame)?;
        }
        if has_emcy {
            let expected = format!("EMCY 8210h for RPDO{number}, which was too short");
            let Some(frame) = emcy(dut, 0x8210, 200_000)? else {
                return fail(expected, "none came");
            };
            is_whole(&frame, &expected)?;
        }
        let why = format!(", as RPDO{number} was too short");
        changed.holds(dut, false, &why)?;
        // The next valid frame ends the error.
        changed.bytes.extend(last);
        changed.send(dut, pdo)?;
        let why = format!(", as RPDO{number} was long enough again");
        changed.holds(dut, true, &why)?;
        changed.reset(dut)?;
    }
    let mut changed = Changed::of(dut, entries)?;
    let len = changed.bytes.len();
    for longer in [len + 1, 8] {
        if longer > 8 || longer <= len {
            continue;
        }
        changed.bytes.resize(longer, 0);
        changed.send(dut, pdo)?;
        let why = format!(", from the first bytes of RPDO{number} with {longer} bytes");
        changed.holds(dut, true, &why)?;
        changed.reset(dut)?;
    }
    dut.nmt(Command::EnterPreOperational)
}

/// An EMCY message of an error has 8 bytes, and bit 0 of the error register.
fn is_whole(frame: &Frame, expected: &str) -> Checked {
    ensure(
        frame.dlc() == 8 && frame.bytes()[2] & 1 == 1,
        format!("{expected}, of 8 bytes, with bit 0 of the error register"),
        format!("{frame} came"),
    )
}

/// Transmission types with which an RPDO waits for the next SYNC, whatever their number is.
const SYNCHRONOUS: [u8; 4] = [0, 1, 2, 240];

/// A synchronous RPDO of these objects waits for SYNC, also the second time, and an event-driven one does not.
fn waits(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32]) -> Checked {
    let changed = Changed::of(dut, entries)?;
    let number = pdo.com - 0x13FF;
    for kind in SYNCHRONOUS {
        if dut.download(pdo.address(2), &[kind])?.is_err() {
            continue;
        }
        for _ in 0..2 {
            changed.send(dut, pdo)?;
            let why = format!(", as RPDO{number} waits for SYNC, by transmission type {kind}");
            changed.holds(dut, false, &why)?;
            sync(dut)?;
            dut.wait(20_000)?;
            let why = format!(" after SYNC, by transmission type {kind} of RPDO{number}");
            changed.holds(dut, true, &why)?;
            changed.reset(dut)?;
            // The frame was used, and does not come back.
            sync(dut)?;
            dut.wait(20_000)?;
            let why = format!(", as RPDO{number} did not come again before SYNC");
            changed.holds(dut, false, &why)?;
        }
    }
    for kind in [254, 255] {
        if dut.download(pdo.address(2), &[kind])?.is_err() {
            continue;
        }
        changed.send(dut, pdo)?;
        let why = format!(", as RPDO{number} has it, by transmission type {kind}");
        changed.holds(dut, true, &why)?;
        changed.reset(dut)?;
    }
    dut.nmt(Command::EnterPreOperational)
}

/// An RPDO writes nothing in Pre-operational, in Stopped and while it is not valid, and again afterwards.
fn ignores(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32]) -> Checked {
    let changed = Changed::of(dut, entries)?;
    let number = pdo.com - 0x13FF;
    let frame = Frame::new(pdo.id(), &changed.bytes);
    for (command, state) in [
        (Command::EnterPreOperational, "Pre-operational"),
        (Command::Stop, "Stopped"),
    ] {
        dut.nmt(command)?;
        if let Some(frame) = frame {
            dut.send(frame)?;
        }
        dut.wait(20_000)?;
        dut.nmt(Command::Start)?;
        changed.holds(dut, false, &format!(", as RPDO{number} came in {state}"))?;
    }
    switch(dut, pdo, false)?;
    changed.send(dut, pdo)?;
    changed.holds(dut, false, &format!(", as RPDO{number} is off"))?;
    switch(dut, pdo, true)?;
    changed.send(dut, pdo)?;
    changed.holds(dut, true, &format!(", as RPDO{number} is on again"))?;
    changed.reset(dut)?;
    dut.nmt(Command::EnterPreOperational)
}

/// With bit 29 of its COB-ID an RPDO takes frames of 29 bits, or the node refuses bit 29.
fn takes_extended(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32]) -> Checked {
    let number = pdo.com - 0x13FF;
    let long = Tpdo {
        com: pdo.com,
        cob_id: 1 << 29 | 0x04F1_F1F1,
    };
    let changed = Changed::of(dut, entries)?;
    let off = 1 << 31;
    for value in [long.cob_id | off, long.cob_id] {
        if dut.download(pdo.address(1), &value.to_le_bytes())?.is_err() {
            return dut.write(pdo.address(1), &(pdo.cob_id | off).to_le_bytes());
        }
    }
    changed.send(dut, &long)?;
    let why = format!(", as RPDO{number} came with its CAN-ID of 29 bits");
    let done = changed.holds(dut, true, &why);
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    changed.reset(dut)?;
    dut.nmt(Command::EnterPreOperational)?;
    for value in [long.cob_id | off, pdo.cob_id | off] {
        dut.write(pdo.address(1), &value.to_le_bytes())?;
    }
    done
}

/// An RPDO with another CAN-ID takes frames with it, and not with the one from before.
fn moves(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32]) -> Checked {
    let number = pdo.com - 0x13FF;
    let moved = Tpdo {
        com: pdo.com,
        cob_id: (pdo.cob_id & !0x3FFF_FFFF) | u32::from(FREE + 4),
    };
    let changed = Changed::of(dut, entries)?;
    let off = 1 << 31;
    for value in [pdo.cob_id | off, moved.cob_id | off, moved.cob_id] {
        if dut.download(pdo.address(1), &value.to_le_bytes())?.is_err() {
            // The node does not take another COB-ID.
            return dut.write(pdo.address(1), &(pdo.cob_id | off).to_le_bytes());
        }
    }
    changed.send(dut, pdo)?;
    let why = format!(", as RPDO{number} came with its CAN-ID from before");
    let mut done = changed.holds(dut, false, &why);
    if done.is_ok() {
        changed.send(dut, &moved)?;
        let why = format!(", as RPDO{number} came with its new CAN-ID 6A4h");
        done = changed.holds(dut, true, &why);
    }
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    dut.nmt(Command::EnterPreOperational)?;
    for value in [moved.cob_id | off, pdo.cob_id | off] {
        dut.write(pdo.address(1), &value.to_le_bytes())?;
    }
    done
}

/// This object, and another one after it if the mapping has room for both.
pub(super) fn with_another(dut: &Dut<'_>, map: u16, all: &[Entry], first: &Entry) -> Vec<u32> {
    let other = all.iter().find(|entry| {
        let bits = (raw(first) & 0xFF) + (raw(entry) & 0xFF);
        entry.address != first.address && bits <= 64 && dut.eds.writes(map, 2)
    });
    [Some(first), other]
        .into_iter()
        .flatten()
        .map(raw)
        .collect()
}

/// The valid RPDOs whose mapping the EDS allows.
pub(super) fn valid(dut: &mut Dut<'_>) -> Checked<Vec<Tpdo>> {
    let mut found = Vec::new();
    for number in dut.eds.pdos(0x1400) {
        let com = 0x1400 + number;
        let cob_id = dut.number(com, 1)? as u32;
        if is_on(cob_id) && has_sound_mapping(dut, com)? {
            found.push(Tpdo { com, cob_id });
        }
    }
    Ok(found)
}

/// Every valid RPDO writes the objects of its mapping; one without a mapping gets one.
pub(super) fn each(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let all = outputs(dut)?;
    let mut any = false;
    for pdo in valid(dut)? {
        let now = mapping(dut, pdo.map())?;
        let own = now.first().map(|mapped| mapped.address);
        let own = all.iter().find(|entry| Some(entry.address) == own);
        let Some(entry) = own.or_else(|| all.first()) else {
            return lacks("no object can be mapped");
        };
        let entries = with_another(dut, pdo.map(), &all, entry);
        let done = on(dut, pdo, |dut, map| {
            takes(dut, &pdo, map, &entries)?;
            lengths(dut, &pdo, &entries)?;
            waits(dut, &pdo, &entries)?;
            ignores(dut, &pdo, &entries)?;
            moves(dut, &pdo, &entries)?;
            takes_extended(dut, &pdo, &entries)
        });
        match done {
            Err(End::NotApplicable(_)) => {}
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    at_least_one(any, "no RPDO is on whose mapping can be written")
}

/// Every valid RPDO writes each object of a mapping that is as long as possible.
pub(super) fn full(dut: &mut Dut<'_>) -> Checked {
    let all = outputs(dut)?;
    let mut any = false;
    for pdo in valid(dut)? {
        let [_, once] = super::mapping::fillings(dut, pdo.map());
        let is_output = |raw: &u32| {
            let address = Address::new((raw >> 16) as u16, (raw >> 8) as u8);
            all.iter().any(|entry| entry.address == address)
        };
        let entries: Vec<u32> = once.into_iter().filter(is_output).collect();
        if entries.len() < 2 {
            continue;
        }
        let done = on(dut, pdo, |dut, map| {
            // The whole mapping, then its first objects only.
            for count in (1..=entries.len()).rev() {
                super::mapping::reopen(dut, &pdo)?;
                takes(dut, &pdo, map, &entries[..count])?;
            }
            super::mapping::reopen(dut, &pdo)?;
            takes(dut, &pdo, map, &entries)?;
            lengths(dut, &pdo, &entries)
        });
        match done {
            Err(End::NotApplicable(_)) => {}
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    at_least_one(any, "no RPDO is on that can have two objects")
}

/// The first RPDOs after a reset write their objects, too.
pub(super) fn after_reset(dut: &mut Dut<'_>) -> Checked {
    let outputs = outputs(dut)?;
    let mut any = false;
    for command in [Command::ResetNode, Command::ResetCommunication] {
        dut.reset(command)?;
        for pdo in valid(dut)? {
            let all = mapping(dut, pdo.map())?;
            let is_output = |address| outputs.iter().any(|entry| entry.address == address);
            let is_seen = !all.is_empty() && all.iter().all(|one| is_output(one.address));
            if !is_seen {
                continue;
            }
            let kept = dut.undo.len();
            dut.keep(pdo.address(2))?;
            if dut.download(pdo.address(2), &[255])?.is_err() {
                continue;
            }
            any = true;
            let entries: Vec<u32> = all.iter().map(super::transmit::Mapped::raw).collect();
            let changed = Changed::of(dut, &entries)?;
            for _ in 0..2 {
                changed.send(dut, &pdo)?;
                let why = format!(", as RPDO{} has it after a reset", pdo.com - 0x13FF);
                let done = changed.holds(dut, true, &why);
                dut.fault(done)?;
                changed.reset(dut)?;
            }
            dut.nmt(Command::EnterPreOperational)?;
            dut.put_back_since(kept)?;
        }
    }
    at_least_one(any, "no RPDO is on and writes values that can be read")
}

/// An RPDO with an event timer (sub-index 5) that does not come again in time causes EMCY 8250h, and the next one ends this
/// error; no EMCY before the first one, and none while it comes in time.
pub(super) fn time_out(dut: &mut Dut<'_>) -> Checked {
    const MILLIS: u16 = 200;
    sends_emcy(dut)?;
    let mut any = false;
    for pdo in valid(dut)? {
        let all = mapping(dut, pdo.map())?;
        let is_held = !dut.may_move && all.iter().any(|one| dut.eds.moves(one.address));
        if is_held || all.is_empty() || !dut.eds.writes(pdo.com, 5) {
            continue;
        }
        any = true;
        let entries: Vec<u32> = all.iter().map(super::transmit::Mapped::raw).collect();
        dut.set(pdo.address(5), &MILLIS.to_le_bytes())?;
        let changed = Changed::of(dut, &entries)?;
        let done = is_in_time(dut, &pdo, &changed, MILLIS);
        dut.fault(done)?;
        dut.nmt(Command::EnterPreOperational)?;
        dut.write(pdo.address(5), &[0, 0])?;
    }
    at_least_one(
        any,
        "no RPDO that is on has an event timer that can be written",
    )
}

fn is_in_time(dut: &mut Dut<'_>, pdo: &Tpdo, changed: &Changed, millis: u16) -> Checked {
    let name = format!("RPDO{}", pdo.com - 0x13FF);
    let time = 1000 * u64::from(millis);
    let late = |dut: &mut Dut<'_>, micros| emcy(dut, 0x8250, micros);
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    if let Some(frame) = emcy_since(dut, from, 0x8250, 2 * time)? {
        let expected = format!("no EMCY 8250h before the first {name}");
        return fail(expected, format!("{frame} came"));
    }
    for _ in 0..2 {
        for _ in 0..6 {
            if let Some(frame) = Frame::new(pdo.id(), &changed.bytes) {
                dut.send(frame)?;
            }
            if let Some(frame) = late(dut, time / 2)? {
                let expected = format!("no EMCY 8250h while {name} comes in time");
                return fail(expected, format!("{frame} came"));
            }
        }
        let expected = format!("EMCY 8250h, as {name} did not come for {millis} ms");
        match late(dut, 2 * time)? {
            Some(frame) => is_whole(&frame, &expected)?,
            None => return fail(expected, "none came"),
        }
        if let Some(frame) = Frame::new(pdo.id(), &changed.bytes) {
            dut.send(frame)?;
        }
        if emcy(dut, 0, time / 2)?.is_none() {
            let expected = format!("EMCY 0000h, as {name} came again after EMCY 8250h");
            return fail(expected, "none came");
        }
    }
    // There is no PDO in Pre-operational, and the next start begins as the first one.
    for command in [Command::EnterPreOperational, Command::Start] {
        dut.nmt(command)?;
        if let Some(frame) = late(dut, 2 * time)? {
            let expected =
                format!("no EMCY 8250h in Pre-operational, and none before {name} after it");
            return fail(expected, format!("{frame} came"));
        }
    }
    // An RPDO that was late in Operational before ends its error, too.
    let before = dut.number(0x1001, 0)?;
    let send = |dut: &mut Dut<'_>| {
        let frame = Frame::new(pdo.id(), &changed.bytes);
        frame.map_or(Ok(()), |frame| dut.send(frame))
    };
    send(dut)?;
    dut.wait(2 * time)?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.nmt(Command::Start)?;
    send(dut)?;
    dut.wait(time / 4)?;
    let after = dut.number(0x1001, 0)?;
    ensure(
        after == before,
        format!("1001h = {before:02X}h, as {name} comes again after Pre-operational"),
        format!("{after:02X}h was read"),
    )
}
