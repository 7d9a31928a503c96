//! Node guarding and life guarding.

use od_model::{Address, values};
use od_wire::Frame;
use od_wire::nmt::Command;

use super::heartbeat::{PRODUCER, emcy, emcy_since, register_before, sends_emcy};
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, ensure, fail};

/// Guards the node once; silence is a failure.
pub(super) fn guarded(dut: &mut Dut<'_>) -> Checked<u8> {
    match dut.guarded()? {
        Some(state) => Ok(state),
        None => fail("a response to node guarding within 100 ms", "none came"),
    }
}

/// Heartbeat and guarding exclude each other; the heartbeat has priority.
pub(super) fn without_heartbeat(dut: &mut Dut<'_>) -> Checked {
    if dut.eds.writes(0x1017, 0) {
        dut.set(PRODUCER, &[0, 0])
    } else {
        Ok(())
    }
}

pub(super) fn toggle(dut: &mut Dut<'_>) -> Checked {
    without_heartbeat(dut)?;
    let mut last = guarded(dut)?;
    for command in [Command::EnterPreOperational, Command::Start, Command::Stop] {
        dut.nmt(command)?;
        for _ in 0..4 {
            let state = guarded(dut)?;
            ensure(
                (state ^ last) & 0x80 != 0,
                "another toggle bit (bit 7) in each response, in each NMT state",
                format!("{last:02X}h and {state:02X}h came"),
            )?;
            last = state;
        }
    }
    Ok(())
}

pub(super) fn after_reset(dut: &mut Dut<'_>) -> Checked {
    without_heartbeat(dut)?;
    // The next toggle bit would be 1, so this detects a node that continues the old sequence.
    for _ in 0..2 {
        if guarded(dut)? & 0x80 == 0 {
            break;
        }
    }
    dut.reset(Command::ResetCommunication)?;
    without_heartbeat(dut)?;
    for wanted in [0, 0x80] {
        let state = guarded(dut)?;
        ensure(
            matches!(state & 0x7F, 4 | 5 | 0x7F),
            "state 04h, 05h or 7Fh in the response after the boot-up message",
            format!("{state:02X}h came"),
        )?;
        ensure(
            state & 0x80 == wanted,
            format!("toggle bit {}", wanted >> 7),
            format!("{state:02X}h came"),
        )?;
    }
    Ok(())
}

/// The node does not respond to a guarding request for another node, and does not count it.
pub(super) fn other_node(dut: &mut Dut<'_>) -> Checked {
    without_heartbeat(dut)?;
    let before = guarded(dut)?;
    let own = dut.node.raw();
    let other = if own == 127 { 126 } else { own + 1 };
    dut.drain()?;
    dut.ask_for(od_wire::CanId::standard(0x700 + u16::from(other)), 1)?;
    let ids = [dut.id(0x700), dut.id(0x80)];
    let is_own = |frame: &Frame| ids.iter().any(|id| is_data(frame, *id));
    if let Some(heard) = dut.next(QUIET, is_own)? {
        return fail(
            "no response to a guarding request to another node",
            format!("{} came", heard.frame),
        );
    }
    let after = guarded(dut)?;
    ensure(
        (before ^ after) & 0x80 != 0,
        "a toggle bit that a request to another node does not change",
        format!("{before:02X}h and {after:02X}h came"),
    )
}

pub(super) fn states(dut: &mut Dut<'_>) -> Checked {
    without_heartbeat(dut)?;
    for (command, wanted) in [
        (Command::Start, 5),
        (Command::Stop, 4),
        (Command::EnterPreOperational, 0x7F),
    ] {
        dut.nmt(command)?;
        // With each toggle bit.
        for _ in 0..2 {
            let state = guarded(dut)? & 0x7F;
            ensure(
                state == wanted,
                format!("state {wanted:02X}h"),
                format!("{state:02X}h came"),
            )?;
        }
    }
    Ok(())
}

pub(super) fn objects(dut: &mut Dut<'_>) -> Checked {
    for index in [0x100C, 0x100D] {
        let address = Address::new(index, 0);
        let before = dut.keep(address)?;
        if dut.eds.writes(index, 0) {
            let mut other = before.clone();
            other[0] ^= 5;
            dut.write(address, &other)?;
            let after = dut.read(address)?;
            let got = format!("{} was read", values::hex(&after));
            ensure(
                after == other,
                format!("{} in {address}", values::hex(&other)),
                got,
            )?;
        }
    }
    Ok(())
}

/// The life time is the product of 100Ch and 100Dh.
pub(super) fn life(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    for (millis, factor) in [(100, 2), (100, 4), (300, 1)] {
        life_time(dut, millis, factor)?;
    }
    // Long times: a guard time of more than 12 bits, and products of 16 and of more bits.
    for (millis, factor) in [(4100u16, 1), (256, 255), (0x8000, 2), (0xFFFF, 255)] {
        dut.set(Address::new(0x100C, 0), &millis.to_le_bytes())?;
        dut.set(Address::new(0x100D, 0), &[factor])?;
        dut.nmt(Command::Start)?;
        let from = dut.frames.len();
        guarded(dut)?;
        if let Some(frame) = emcy_since(dut, from, 0x8130, 400_000)? {
            return fail(
                format!(
                    "no EMCY 8130h in the first 400 ms with {millis} in 100Ch and {factor} in 100Dh"
                ),
                format!("{frame} came"),
            );
        }
        dut.nmt(Command::EnterPreOperational)?;
    }
    Ok(())
}

fn life_time(dut: &mut Dut<'_>, millis: u16, factor: u8) -> Checked {
    dut.set(Address::new(0x100C, 0), &millis.to_le_bytes())?;
    dut.set(Address::new(0x100D, 0), &[factor])?;
    dut.nmt(Command::Start)?;
    let life = u64::from(millis) * u64::from(factor) * 1000;
    let from = dut.frames.len();
    for _ in 0..3 {
        guarded(dut)?;
        if emcy_since(dut, from, 0x8130, life * 6 / 10)?.is_some() {
            return fail("no EMCY 8130h while the node is guarded", "it came");
        }
    }
    guarded(dut)?;
    let begin = dut.now();
    // A node may count guard times.
    let within = life + u64::from(millis) * 1000 + 80_000;
    let shown = format!("EMCY 8130h {} to {} ms", life / 1000, within / 1000);
    let shown =
        format!("{shown} after the last request, with {millis} in 100Ch and {factor} in 100Dh");
    match emcy(dut, 0x8130, within)? {
        Some(_) => {
            let took = dut.now().micros_since(begin) + dut.rig.slack() + 20_000;
            let got = format!("it came after {} ms", dut.now().micros_since(begin) / 1000);
            ensure(took >= life, shown, got)?;
        }
        None => return fail(shown, "none came"),
    }
    // The next request ends the error.
    guarded(dut)?;
    dut.nmt(Command::EnterPreOperational)
}

/// After reset communication life guarding waits for the first request again.
pub(super) fn life_reset(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    dut.set(Address::new(0x100C, 0), &[100, 0])?;
    dut.set(Address::new(0x100D, 0), &[2])?;
    dut.nmt(Command::Start)?;
    guarded(dut)?;
    dut.reset(Command::ResetCommunication)?;
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    match emcy_since(dut, from, 0x8130, 700_000)? {
        Some(frame) => fail(
            "no EMCY 8130h after reset communication, as no request came since",
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

/// After guarding requests resume, 1001h has the value from before the error.
pub(super) fn life_ends(dut: &mut Dut<'_>) -> Checked {
    let before = register_before(dut)?;
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    dut.set(Address::new(0x100C, 0), &[100, 0])?;
    dut.set(Address::new(0x100D, 0), &[2])?;
    dut.nmt(Command::Start)?;
    // The toggle bit is 0 in the last response before the error, so it must be 1 in the first one after it.
    if guarded(dut)? & 0x80 != 0 {
        guarded(dut)?;
    }
    if emcy(dut, 0x8130, 600_000)?.is_none() {
        return fail("EMCY 8130h within 600 ms of the last request", "none came");
    }
    for wanted in [0x80, 0, 0x80] {
        let state = guarded(dut)?;
        let done = ensure(
            state & 0x80 == wanted,
            format!(
                "toggle bit {} in the response after the error, since only a reset makes it 0",
                wanted >> 7
            ),
            format!("{state:02X}h came"),
        );
        dut.fault(done)?;
        dut.wait(50_000)?;
    }
    let after = dut.number(0x1001, 0)?;
    ensure(
        after == before,
        format!("1001h = {before:02X}h when requests come again, as before the error"),
        format!("{after:02X}h was read"),
    )
}

/// Life guarding begins with the first request.
pub(super) fn life_waits(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    dut.set(Address::new(0x100C, 0), &[100, 0])?;
    dut.set(Address::new(0x100D, 0), &[2])?;
    // Guarding requests of earlier cases do not count after a reset; their life time may be over by
    // now.
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    match emcy_since(dut, from, 0x8130, 600_000)? {
        Some(frame) => fail(
            "no EMCY 8130h before the first request",
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

/// Without a guard time or a life time factor there is no life guarding.
pub(super) fn life_off(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    for (time, factor) in [(100, 0), (0, 2)] {
        dut.set(Address::new(0x100C, 0), &[time, 0])?;
        dut.set(Address::new(0x100D, 0), &[factor])?;
        let from = dut.frames.len();
        dut.nmt(Command::Start)?;
        guarded(dut)?;
        if let Some(frame) = emcy_since(dut, from, 0x8130, 600_000)? {
            return fail(
                format!("no EMCY 8130h with {time} in 100Ch and {factor} in 100Dh"),
                format!("{frame} came"),
            );
        }
    }
    Ok(())
}

/// With a heartbeat the node does not respond to guarding.
pub(super) fn heartbeat_excludes(dut: &mut Dut<'_>) -> Checked {
    dut.set(PRODUCER, &[0xE8, 3])?;
    dut.drain()?;
    let id = dut.id(0x700);
    dut.ask_for(od_wire::CanId::standard(id), 1)?;
    match dut.next_of(id, QUIET)? {
        Some(heard) => fail(
            "no response to guarding while 1017h is not 0",
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}
