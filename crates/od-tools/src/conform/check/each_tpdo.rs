//! Each TPDO of the node: finds it, gives it a mapping if it has none, and tests its communication parameters.

use od_model::{Address, Entry};
use od_wire::CobId;
use od_wire::nmt::Command;

use super::transmit::{
    Tpdo, contradiction, event_driven, gaps, is_on, learn_sync, mapping, next, none, starts_silent,
    switch, sync,
};
use crate::conform::dut::{Dut, QUIET};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::abort_text;

/// Every valid TPDO is sent with its CAN-ID and the length of its mapping.
pub(super) fn each(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, is_sent)
}

/// Tests each valid TPDO with its number of bytes; one without a mapping gets one for the test. The case applies if it
/// applies to one of them. Each TPDO has its values again before the test of the next one.
pub(super) fn on_each(
    dut: &mut Dut<'_>,
    test: impl Fn(&mut Dut<'_>, &Tpdo, usize) -> Checked,
) -> Checked {
    let (mut any, mut why) = (false, String::from("no TPDO is on"));
    for number in dut.eds.pdos(0x1800) {
        let com = 0x1800 + number;
        let cob_id = dut.number(com, 1)? as u32;
        if !is_on(cob_id) {
            continue;
        }
        let pdo = Tpdo { com, cob_id };
        let all = mapping(dut, pdo.map())?;
        if let Some(contradiction) = contradiction(dut.eds, &all, true) {
            why = format!("no TPDO works, by its EDS: {contradiction}");
            continue;
        }
        let kept = dut.undo.len();
        let done = if all.is_empty() {
            let entries: Vec<_> = dut.eds.dictionary().entries().collect();
            let fits = |entry: &&Entry| {
                entry.maps_to_tpdo() && matches!(entry.data_type.bits(), Some(8 | 16 | 32))
            };
            let Some(entry) = entries.iter().find(fits) else {
                continue;
            };
            let (raw, bits) = (
                super::mapping::raw(entry),
                entry.data_type.bits().unwrap_or(8),
            );
            let mapped = |dut: &mut Dut<'_>, map| {
                if dut
                    .download(Address::new(map, 1), &raw.to_le_bytes())?
                    .is_err()
                {
                    return Ok(());
                }
                dut.write(Address::new(map, 0), &[1])?;
                dut.write(Address::new(com, 1), &cob_id.to_le_bytes())?;
                let done = test(dut, &pdo, usize::from(bits).div_ceil(8));
                if !matches!(done, Err(End::Lost(_))) {
                    dut.nmt(Command::EnterPreOperational)?;
                }
                done
            };
            super::mapping::on(dut, pdo, mapped)
        } else {
            let bits: usize = all.iter().map(|mapped| mapped.bits).sum();
            test(dut, &pdo, bits.div_ceil(8))
        };
        if matches!(done, Err(End::Lost(_))) {
            return done;
        }
        dut.nmt(Command::EnterPreOperational)?;
        dut.put_back_since(kept)?;
        match done {
            Err(End::NotApplicable(reason)) => why = reason,
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    at_least_one(any, &why)
}

/// Bit 31 of its COB-ID makes the TPDO not valid.
fn is_silent_while_off(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    if !dut.eds.writes(pdo.com, 1) {
        return Ok(());
    }
    switch(dut, pdo, false)?;
    dut.nmt(Command::Start)?;
    let expected = format!(
        "no TPDO{} while bit 31 of its COB-ID is set",
        pdo.com - 0x17FF
    );
    let done = sync(dut).and_then(|()| none(dut, pdo, QUIET, &expected));
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
    done
}

/// Waits for the TPDO, by SYNC or event timer, and checks its length.
fn is_sent(dut: &mut Dut<'_>, pdo: &Tpdo, len: usize) -> Checked {
    dut.keep(pdo.address(2))?;
    let is_synchronous = dut.download(pdo.address(2), &[1])?.is_ok();
    if !is_synchronous {
        if !dut.eds.writes(pdo.com, 5) {
            return lacks("the TPDO is neither synchronous nor has it an event timer");
        }
        dut.set(pdo.address(5), &[50, 0])?;
    }
    dut.nmt(Command::Start)?;
    dut.wait(20_000)?;
    if is_synchronous {
        sync(dut)?;
    }
    let heard = next(dut, pdo, 500_000)?;
    dut.nmt(Command::EnterPreOperational)?;
    let name = format!("TPDO{}, {:04X}h,", pdo.com - 0x17FF, pdo.com);
    let Some(heard) = heard else {
        let by = if is_synchronous {
            "a SYNC"
        } else {
            "its event timer"
        };
        return fail(format!("{name} with {by}"), "none came");
    };
    ensure(
        usize::from(heard.frame.dlc()) == len,
        format!("{len} bytes in {name} as mapped"),
        format!("{} came", heard.frame),
    )?;
    if is_synchronous {
        for kind in [2, 3, 4, 5, 6, 7, 8, 9, 10, 100] {
            is_sent_with(dut, pdo, kind)?;
        }
        forbids_rtr(dut, pdo)?;
    }
    is_silent_while_off(dut, pdo)?;
    changes_in_operational(dut, pdo)?;
    keeps_times(dut, pdo)
}

/// Transmission type, event timer and bit 31 take effect in Operational, too, if the node takes them there.
fn changes_in_operational(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let name = format!("TPDO{}", pdo.com - 0x17FF);
    dut.keep(pdo.address(2))?;
    let has_timer = dut.eds.writes(pdo.com, 5);
    if has_timer {
        dut.set(pdo.address(5), &[0, 0])?;
    }
    let _ = dut.download(pdo.address(2), &[254])?;
    dut.nmt(Command::Start)?;
    if dut.download(pdo.address(2), &[1])?.is_ok() {
        comes_with_sync(dut, pdo, true, "after its transmission type became 1")?;
        let is_off = |cob_id: u32| (cob_id | 1 << 31).to_le_bytes();
        if dut.eds.writes(pdo.com, 1) && dut.download(pdo.address(1), &is_off(pdo.cob_id))?.is_ok()
        {
            let done = comes_with_sync(dut, pdo, false, "after bit 31 of its COB-ID became 1");
            dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
            done?;
            comes_with_sync(dut, pdo, true, "after bit 31 of its COB-ID became 0")?;
        }
        if dut.download(pdo.address(2), &[254])?.is_ok() {
            comes_with_sync(dut, pdo, false, "after its transmission type became 254")?;
        }
    }
    if has_timer && dut.download(pdo.address(5), &[50, 0])?.is_ok() {
        for _ in 0..3 {
            if next(dut, pdo, 100_000)?.is_none() {
                return fail(
                    format!(
                        "{name} every 50 ms, by an event timer that was written in Operational"
                    ),
                    "none came within 100 ms",
                );
            }
        }
    }
    dut.nmt(Command::EnterPreOperational)
}

/// Two SYNC messages in Operational are followed by this TPDO, or are not.
fn comes_with_sync(dut: &mut Dut<'_>, pdo: &Tpdo, wanted: bool, when: &str) -> Checked {
    // A change may send the TPDO once.
    dut.wait(QUIET)?;
    let mut count = 0;
    for _ in 0..2 {
        dut.drain()?;
        sync(dut)?;
        count += u8::from(next(dut, pdo, QUIET)?.is_some());
    }
    ensure(
        count == if wanted { 2 } else { 0 },
        format!(
            "TPDO{} {} SYNC in Operational, {when}",
            pdo.com - 0x17FF,
            if wanted { "with each" } else { "with no" }
        ),
        format!("it came with {count} of 2"),
    )
}

/// With a transmission type from 2 on, this TPDO comes twice in twice as many SYNC messages.
fn is_sent_with(dut: &mut Dut<'_>, pdo: &Tpdo, kind: u8) -> Checked {
    if dut.download(pdo.address(2), &[kind])?.is_err() {
        return Ok(());
    }
    starts_silent(dut, pdo)?;
    let from = dut.frames.len();
    for _ in 0..2 * u16::from(kind) {
        sync(dut)?;
        dut.wait(5_000)?;
    }
    dut.wait(20_000)?;
    let sent = dut.frames.get(from..).unwrap_or_default().iter();
    let sent = sent.filter(|one| !one.ours && pdo.carries(&one.frame));
    let count = sent.count();
    dut.nmt(Command::EnterPreOperational)?;
    ensure(
        count == 2,
        format!(
            "TPDO{} with 2 of {} SYNC messages, by transmission type {kind}",
            pdo.com - 0x17FF,
            2 * u16::from(kind)
        ),
        format!("{count} came"),
    )
}

/// With bit 30 of its COB-ID this synchronous TPDO does not answer a remote frame.
fn forbids_rtr(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let before = pdo.cob_id;
    if !CobId::new(before).allows_rtr() || !dut.eds.writes(pdo.com, 1) {
        return Ok(());
    }
    let other = before | 1 << 30;
    let mut is_taken = true;
    for value in [before | 1 << 31, other | 1 << 31, other] {
        let done = dut.download(pdo.address(1), &value.to_le_bytes())?;
        if let Err(code) = done
            && is_taken
            && value & 1 << 30 != 0
        {
            let expected = format!(
                "{} to take bit 30, since the TPDO allows remote frames",
                pdo.address(1)
            );
            dut.fault(fail(expected, abort_text(code)))?;
        }
        is_taken = is_taken && done.is_ok();
        if is_taken {
            let done = dut.is_as_written(pdo.address(1), &value.to_le_bytes());
            dut.fault(done)?;
        }
    }
    let done = if is_taken {
        dut.nmt(Command::Start)?;
        dut.ask_for(pdo.id(), 8)?;
        let number = pdo.com - 0x17FF;
        let expected = format!("no TPDO{number} after a remote frame with bit 30 of its COB-ID");
        none(dut, pdo, QUIET, &expected)
    } else {
        Ok(())
    };
    dut.nmt(Command::EnterPreOperational)?;
    for value in [before | 1 << 31, before] {
        dut.write(pdo.address(1), &value.to_le_bytes())?;
    }
    done
}

/// The event timer and the inhibit time of this TPDO take effect.
fn keeps_times(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let number = pdo.com - 0x17FF;
    let writes = |dut: &Dut<'_>, sub| dut.eds.writes(pdo.com, sub);
    if !writes(dut, 5) || event_driven(dut, pdo).is_err() {
        return Ok(());
    }
    dut.set(pdo.address(5), &[50, 0])?;
    let done = gaps(
        dut,
        pdo,
        2,
        // A changed value is an event, so that it may be sent earlier.
        |gap, slack| gap <= 55_000 + slack,
        &format!("every 50 ms at least by the event timer of TPDO{number}"),
    );
    dut.nmt(Command::EnterPreOperational)?;
    done?;
    if !writes(dut, 3) || !writes(dut, 1) {
        return Ok(());
    }
    let switch = |dut: &mut Dut<'_>, inhibit: &[u8]| {
        dut.write(pdo.address(1), &(pdo.cob_id | 1 << 31).to_le_bytes())?;
        dut.write(pdo.address(3), inhibit)?;
        dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())
    };
    let before = dut.read(pdo.address(3))?;
    switch(dut, &1000u16.to_le_bytes())?;
    let done = gaps(
        dut,
        pdo,
        2,
        // The event timer waits for the end of the inhibit time, or begins again then.
        |gap, slack| gap + slack + 5_000 >= 100_000 && gap <= 155_000 + slack,
        &format!(
            "every 100 to 150 ms by the inhibit time of TPDO{number} and an event timer of 50 ms"
        ),
    );
    dut.nmt(Command::EnterPreOperational)?;
    let synchronous = without_inhibit(dut, pdo);
    switch(dut, &before)?;
    done?;
    synchronous?;
    if before.iter().any(|byte| *byte != 0) {
        return Ok(());
    }
    let done = gaps(
        dut,
        pdo,
        2,
        |gap, slack| gap <= 55_000 + slack,
        &format!("every 50 ms at least, as the inhibit time of TPDO{number} is 0 again"),
    );
    dut.nmt(Command::EnterPreOperational)?;
    done
}

/// The inhibit time is that of the types 254 and 255: with type 1 the TPDO comes with each SYNC.
fn without_inhibit(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    if dut.download(pdo.address(2), &[1])?.is_err() {
        return Ok(());
    }
    dut.nmt(Command::Start)?;
    dut.wait(QUIET)?;
    let mut count = 0;
    for _ in 0..5 {
        dut.drain()?;
        sync(dut)?;
        count += u8::from(next(dut, pdo, 20_000)?.is_some());
    }
    dut.nmt(Command::EnterPreOperational)?;
    event_driven(dut, pdo)?;
    ensure(
        count == 5,
        format!(
            "TPDO{} with each of 5 SYNC messages in 100 ms, as type 1 has no inhibit time",
            pdo.com - 0x17FF
        ),
        format!("{count} came"),
    )
}
