//! EMCY: message, register, history.

use od_model::{Address, values};
use od_wire::AbortCode::{NoData, NoSubIndex, ValueRange, ValueTooHigh};
use od_wire::nmt::Command;
use od_wire::{CobId, Frame};

use super::heartbeat::{beat, emcy, register_before, watch};
use crate::conform::dut::{Dut, FREE, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::sdo::{abort_text, is_abort, request};

const HISTORY: Address = Address::new(0x1003, 0);

pub(super) fn cob_id(dut: &mut Dut<'_>) -> Checked {
    let raw = dut.number(0x1014, 0)? as u32;
    let wanted = u32::from(dut.id(0x80));
    ensure(
        raw & 0x7FFF_FFFF == wanted,
        format!("1014h = {wanted:X}h, as predefined"),
        format!("{raw:X}h was read"),
    )
}

pub(super) fn register(dut: &mut Dut<'_>) -> Checked {
    let bytes = dut.read(Address::new(0x1001, 0))?;
    let shown = values::hex(&bytes);
    ensure(
        bytes.len() == 1 && (bytes[0] == 0 || bytes[0] & 1 == 1) && bytes[0] & 0x40 == 0,
        "one byte in 1001h, with bit 0 if there is any error, and without bit 6, which is reserved",
        format!("{shown} was read"),
    )
}

/// The history has as many entries as sub-index 0 says.
pub(super) fn history(dut: &mut Dut<'_>) -> Checked {
    let count = dut.number(0x1003, 0)?;
    for sub in 1..=count.min(254) as u8 {
        dut.read(Address::new(0x1003, sub))?;
    }
    if count < 254 {
        let beyond = Address::new(0x1003, count as u8 + 1);
        match dut.upload(beyond)? {
            // The value is 0 if there is no such error.
            Ok(bytes) => ensure(
                bytes.iter().all(|byte| *byte == 0),
                format!("no error in {beyond}"),
                values::hex(&bytes),
            )?,
            Err(code) => is_abort(
                &request(0x80, beyond, code.to_le_bytes()),
                &[NoData, NoSubIndex],
            )?,
        }
    }
    Ok(())
}

pub(super) fn history_clear(dut: &mut Dut<'_>) -> Checked {
    // With an entry, if the node can be made to report an error.
    let has_entry = match provoked(dut) {
        Ok((node, _)) => {
            beat(dut, node)?;
            dut.nmt(Command::EnterPreOperational)?;
            true
        }
        Err(End::Fail { .. } | End::NotApplicable(_)) => false,
        Err(other) => return Err(other),
    };
    dut.write(HISTORY, &[0])?;
    let count = dut.number(0x1003, 0)?;
    ensure(
        count == 0,
        "no entry after 0 was written to 1003h:00",
        format!("1003h:00 is {count}"),
    )?;
    let first = Address::new(0x1003, 1);
    match dut.upload(first)? {
        Ok(bytes) if has_entry => ensure(
            bytes.iter().all(|byte| *byte == 0),
            "no error in 1003h:01 after 0 was written to 1003h:00",
            format!("{} was read", values::hex(&bytes)),
        )?,
        _ => {}
    }
    if !has_entry {
        return Ok(());
    }
    // The next error is the first entry again.
    provoked(dut)?;
    let newest = dut.number(0x1003, 1)?;
    ensure(
        newest & 0xFFFF == 0x8130,
        "8130h in 1003h:01, the first error after 0 was written to 1003h:00",
        format!("{newest:08X}h was read"),
    )
}

/// 1015h is the shortest time between two EMCY messages.
pub(super) fn inhibit(dut: &mut Dut<'_>) -> Checked {
    const TENTHS: u16 = 5000;
    let address = Address::new(0x1015, 0);
    dut.set(address, &TENTHS.to_le_bytes())?;
    let is = dut.number(0x1015, 0)?;
    let wanted = u64::from(TENTHS);
    ensure(
        is == wanted,
        format!("{wanted} in 1015h"),
        format!("{is} was read"),
    )?;
    if !dut.eds.writes(0x1016, 1) || !dut.eds.has(0x1014) {
        return Ok(());
    }
    let (node, _) = provoked(dut)?;
    let from = dut.now();
    let id = dut.id(0x80);
    for _ in 0..30 {
        beat(dut, node)?;
        if dut.next(50_000, |frame| is_data(frame, id))?.is_some() {
            let took = dut.now().micros_since(from);
            return ensure(
                took + dut.rig.slack() + 5_000 >= 100 * wanted,
                "500 ms between two EMCY messages, as 1015h is 5000",
                format!("the second came after {} ms", took / 1000),
            );
        }
    }
    fail(
        "the EMCY message of the end of the error after the inhibit time",
        "none came within 1.5 s",
    )
}

/// EMCY messages have the CAN-ID of 1014h.
pub(super) fn cob_id_used(dut: &mut Dut<'_>) -> Checked {
    const OTHER: u32 = FREE as u32 + 3;
    let address = Address::new(0x1014, 0);
    let raw = dut.number(0x1014, 0)? as u32;
    dut.keep(address)?;
    let off = raw | 1 << 31;
    for value in [off, OTHER | 1 << 31, OTHER] {
        if let Err(code) = dut.download(address, &value.to_le_bytes())? {
            return lacks(format!(
                "1014h does not take another CAN-ID: {}",
                abort_text(code)
            ));
        }
    }
    provoke(dut)?;
    let ids = [CobId::new(OTHER).can_id(), CobId::new(raw).can_id()];
    let heard = dut.next(1_000_000, |frame| {
        ids.contains(&frame.id()) && !frame.is_remote()
    })?;
    // The PDO is not valid, so that the old COB-ID can be restored.
    for value in [OTHER | 1 << 31, off] {
        dut.write(address, &value.to_le_bytes())?;
    }
    match heard {
        Some(heard) => ensure(
            heard.frame.id() == ids[0],
            "the EMCY with the CAN-ID 6A3h of 1014h",
            format!("{} came", heard.frame),
        ),
        None => fail("the EMCY with the CAN-ID 6A3h of 1014h", "none came"),
    }
}

/// Causes an error: a monitored node stops its heartbeat.
fn provoke(dut: &mut Dut<'_>) -> Checked<u8> {
    let node = watch(dut, 100)?;
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    Ok(node)
}

fn provoked(dut: &mut Dut<'_>) -> Checked<(u8, Frame)> {
    let node = provoke(dut)?;
    match emcy(dut, 0x8130, 1_000_000)? {
        Some(frame) => Ok((node, frame)),
        None => fail("EMCY 8130h within 1 s of the last heartbeat", "none came"),
    }
}

pub(super) fn message(dut: &mut Dut<'_>) -> Checked {
    let (_, frame) = provoked(dut)?;
    let got = format!("{frame} came");
    ensure(frame.dlc() == 8, "an EMCY message of 8 bytes", got.clone())?;
    let register = frame.bytes()[2];
    ensure(
        register & 0x11 == 0x11,
        "bits 0 and 4 in byte 2, the error register",
        got,
    )?;
    let is = dut.number(0x1001, 0)?;
    ensure(
        is == u64::from(register),
        format!("1001h = {register:02X}h, as in the message"),
        format!("{is:02X}h was read"),
    )
}

pub(super) fn logged(dut: &mut Dut<'_>) -> Checked {
    provoked(dut)?;
    let count = dut.number(0x1003, 0)?;
    ensure(count > 0, "an entry in 1003h", "it has none")?;
    let newest = dut.number(0x1003, 1)?;
    ensure(
        newest & 0xFFFF == 0x8130,
        "8130h in 1003h:01, the newest error",
        format!("{newest:08X}h was read"),
    )
}

/// The end of the error sends EMCY 0000h, or an EMCY message without the bits of the error.
pub(super) fn reset(dut: &mut Dut<'_>) -> Checked {
    let (node, _) = provoked(dut)?;
    dut.drain()?;
    for _ in 0..5 {
        beat(dut, node)?;
        let id = dut.id(0x80);
        if let Some(heard) = dut.next(80_000, |frame| is_data(frame, id))? {
            let frame = heard.frame;
            return ensure(
                frame.data().starts_with(&[0, 0]) && frame.dlc() == 8,
                "EMCY 0000h of 8 bytes when the heartbeat comes again",
                format!("{frame} came"),
            );
        }
    }
    fail("EMCY 0000h when the heartbeat comes again", "none came")
}

/// After the error neither the message nor 1001h has a bit of it.
pub(super) fn register_clears(dut: &mut Dut<'_>) -> Checked {
    // The second error is like the first one.
    for _ in 0..2 {
        clears_once(dut)?;
    }
    Ok(())
}

fn clears_once(dut: &mut Dut<'_>) -> Checked {
    let before = register_before(dut)?;
    let (node, _) = provoked(dut)?;
    let id = dut.id(0x80);
    let mut message = None;
    for _ in 0..5 {
        beat(dut, node)?;
        let heard = dut.next(80_000, |frame| is_data(frame, id))?;
        message = heard.map(|heard| heard.frame);
        if message.is_some() {
            break;
        }
    }
    let after = dut.number(0x1001, 0)?;
    ensure(
        after == before,
        format!("1001h = {before:02X}h after the error, as before it"),
        format!("{after:02X}h was read"),
    )?;
    let Some(message) = message else {
        return Ok(());
    };
    ensure(
        u64::from(message.bytes()[2]) == after,
        format!("{after:02X}h in byte 2, the error register"),
        format!("{message} came"),
    )
}

/// A reset ends an error of the communication: 1001h has no bit of it, and it is reported when it occurs again.
pub(super) fn over_reset(dut: &mut Dut<'_>) -> Checked {
    for command in [Command::ResetNode, Command::ResetCommunication] {
        let before = register_before(dut)?;
        provoked(dut)?;
        dut.reset(command)?;
        let after = dut.number(0x1001, 0)?;
        let done = ensure(
            after == before,
            format!("1001h = {before:02X}h after the NMT reset, as before the error"),
            format!("{after:02X}h was read"),
        );
        dut.fault(done)?;
    }
    provoked(dut).map(drop)
}

/// An error sends one message, and its end another one.
pub(super) fn once(dut: &mut Dut<'_>) -> Checked {
    let (node, _) = provoked(dut)?;
    if let Some(frame) = emcy(dut, 0x8130, 1_000_000)? {
        return fail(
            "one EMCY 8130h for one error",
            format!("{frame} came again"),
        );
    }
    let mut ends = 0;
    for _ in 0..10 {
        beat(dut, node)?;
        ends += u8::from(emcy(dut, 0, 50_000)?.is_some());
    }
    ensure(
        ends <= 1,
        "one EMCY 0000h for the end of the error",
        format!("{ends} came"),
    )
}

/// The same error is reported again when it occurs again.
pub(super) fn again(dut: &mut Dut<'_>) -> Checked {
    let (node, _) = provoked(dut)?;
    for _ in 0..5 {
        beat(dut, node)?;
        dut.wait(50_000)?;
    }
    dut.drain()?;
    match emcy(dut, 0x8130, 1_000_000)? {
        Some(_) => Ok(()),
        None => fail(
            "EMCY 8130h again within 1 s of the last heartbeat",
            "it came for the first error only",
        ),
    }
}

/// Most errors that [`history_full`] causes.
const ERRORS: u64 = 17;

/// An error once more than 1003h has entries: 1003h:00 counts each one up to that number.
pub(super) fn history_full(dut: &mut Dut<'_>) -> Checked {
    let entries = dut.eds.dictionary().entries();
    let own = entries.filter(|one| one.address.index == HISTORY.index);
    let room: u64 = own.map(|one| one.address.sub).max().unwrap_or(0).into();
    dut.write(HISTORY, &[0])?;
    let (node, _) = provoked(dut)?;
    for errors in 1..=(room + 1).min(ERRORS) {
        let count = dut.number(HISTORY.index, 0)?;
        let mut counted = 0;
        for sub in 1..=count.min(254) as u8 {
            let error = dut.number(HISTORY.index, sub)? & 0xFFFF;
            counted += u64::from(error == 0x8130);
        }
        // A node may also have an entry for the end of an error.
        let is_full = count == room && counted <= errors;
        ensure(
            is_full || counted == errors && count < room,
            format!(
                "{} entries of 8130h in 1003h, {room} entries at most, after {errors} errors",
                errors.min(room)
            ),
            format!("{counted} of {count} entries were 8130h"),
        )?;
        for _ in 0..5 {
            beat(dut, node)?;
            dut.wait(50_000)?;
        }
        dut.drain()?;
        if emcy(dut, 0x8130, 1_000_000)?.is_none() {
            return fail(
                "EMCY 8130h for each missing heartbeat",
                format!("none came after {errors}"),
            );
        }
    }
    Ok(())
}

pub(super) fn off(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x1014, 0);
    let raw = dut.number(0x1014, 0)? as u32;
    dut.keep(address)?;
    if let Err(code) = dut.download(address, &(raw | 1 << 31).to_le_bytes())? {
        return lacks(format!(
            "1014h cannot be switched off: {}",
            abort_text(code)
        ));
    }
    let node = provoke(dut)?;
    let id = CobId::new(raw).can_id();
    if let Some(heard) = dut.next(500_000, |frame| frame.id() == id)? {
        return fail(
            "no EMCY while bit 31 of 1014h is set",
            format!("{} came", heard.frame),
        );
    }
    // The heartbeat ends the error, and is missing again when the node may report it.
    beat(dut, node)?;
    dut.write(address, &raw.to_le_bytes())?;
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    match emcy(dut, 0x8130, 1_000_000)? {
        Some(_) => Ok(()),
        None => fail("EMCY 8130h again without bit 31 of 1014h", "none came"),
    }
}

pub(super) fn not_in_stopped(dut: &mut Dut<'_>) -> Checked {
    provoke(dut)?;
    dut.nmt(Command::Stop)?;
    match emcy(dut, 0x8130, 500_000 + QUIET)? {
        Some(frame) => fail("no EMCY in Stopped", format!("{frame} came")),
        None => Ok(()),
    }
}

/// 1029h:01 gives the reaction of the NMT state to a communication error.
pub(super) fn behaviour(dut: &mut Dut<'_>, value: u8, state: u8) -> Checked {
    let address = Address::new(0x1029, 1);
    let before = dut.keep(address)?;
    dut.follow_state()?;
    for is_operational in [false, true] {
        let first = if is_operational {
            u8::from(value != 1)
        } else {
            value
        };
        if dut.download(address, &[first])?.is_err() && is_operational {
            break;
        }
        let node = watch(dut, 100)?;
        dut.nmt(Command::Start)?;
        // A node need not take the value in Operational.
        if is_operational && dut.download(address, &[value])?.is_err() {
            break;
        }
        beat(dut, node)?;
        // The heartbeat of the test itself does not belong to the monitored node.
        dut.wait(400_000)?;
        // The end of the error does not change the state again.
        let done = dut.is_in(state).and_then(|()| {
            beat(dut, node)?;
            dut.is_in(state)
        });
        if matches!(done, Err(End::Lost(_))) {
            return done;
        }
        // The heartbeat that ends the error can be missing again before the values are restored, which a node in
        // Stopped does not allow.
        dut.nmt(Command::EnterPreOperational)?;
        dut.write(address, &before)?;
        beat(dut, node)?;
        done?;
    }
    Ok(())
}

/// The end of life guarding is an error of communication, too: each value of 1029h:01.
pub(super) fn behaviour_guarding(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x1029, 1);
    dut.keep(address)?;
    if dut.eds.writes(0x1017, 0) {
        dut.set(Address::new(0x1017, 0), &[0, 0])?;
    }
    dut.set(Address::new(0x100C, 0), &100u16.to_le_bytes())?;
    dut.set(Address::new(0x100D, 0), &[2])?;
    for (value, state) in [(1, 5), (0, 0x7F), (2, 4)] {
        if dut.download(address, &[value])?.is_err() {
            continue;
        }
        dut.nmt(Command::Start)?;
        if dut.guarded()?.is_none() {
            return lacks("the node does not respond to node guarding");
        }
        dut.wait(500_000)?;
        let is = dut.guarded()?.unwrap_or(0) & 0x7F;
        dut.nmt(Command::EnterPreOperational)?;
        let done = ensure(
            is == state,
            format!("NMT state {state:02X}h after life guarding ended, as 1029h:01 is {value}"),
            format!("{is:02X}h came"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn behaviour_range(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x1029, 1);
    let entry = dut.eds.entry(0x1029, 1);
    let before = dut.keep(address)?;
    // Without a limit in the EDS a device may accept values of its own.
    if entry.is_none_or(|entry| entry.high == od_model::Literal::None)
        && dut.download(address, &[0x55])?.is_ok()
    {
        dut.write(address, &before)?;
        return lacks("the node takes values of its own in 1029h:01");
    }
    dut.refuses_value(address, &[0x55], &[ValueRange, ValueTooHigh])
}
