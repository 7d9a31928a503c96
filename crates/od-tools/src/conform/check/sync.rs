//! SYNC, TIME: consumer and producer.

use od_model::Address;
use od_wire::nmt::Command;
use od_wire::{CanId, CobId, Frame};

use super::each_tpdo::on_each;
use super::transmit::{Tpdo, learn_sync, sync, typed, typed_on};
use crate::conform::dut::{Dut, FREE, QUIET};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::number;
use crate::link::Heard;

const COB_ID: Address = Address::new(0x1005, 0);

pub(super) fn cob_id(dut: &mut Dut<'_>) -> Checked {
    let raw = dut.number(0x1005, 0)?;
    ensure(
        raw & 0x3FFF_F800 == 0 || raw & 0x2000_0000 != 0,
        "a CAN-ID of 11 bits, or bit 29, in 1005h",
        format!("{raw:08X}h was read"),
    )
}

/// Synchronous TPDOs follow another CAN-ID in 1005h.
pub(super) fn other_cob_id(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = typed(dut, 1)?;
    let old = dut.sync_id;
    let other = (old & !0x7FF) | u32::from(FREE + 2);
    dut.keep(COB_ID)?;
    if dut.download(COB_ID, &other.to_le_bytes())?.is_err() {
        return lacks("the node does not accept another CAN-ID");
    }
    let id = CobId::new(pdo.cob_id).can_id();
    dut.nmt(Command::Start)?;
    dut.drain()?;
    sync(dut)?;
    if let Some(heard) = dut.next(QUIET, |frame| frame.id() == id)? {
        return fail("no TPDO with the old SYNC", format!("{} came", heard.frame));
    }
    dut.sync_id = other;
    sync(dut)?;
    let came = dut.next(QUIET, |frame| frame.id() == id)?;
    dut.sync_id = old;
    ensure(came.is_some(), "a TPDO with the new SYNC 6A2h", "none came")
}

/// A remote frame with the CAN-ID of SYNC is not a SYNC message.
pub(super) fn remote(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = typed(dut, 1)?;
    dut.nmt(Command::Start)?;
    dut.drain()?;
    dut.ask_for(CobId::new(dut.sync_id).can_id(), 0)?;
    let id = pdo.id();
    match dut.next(QUIET, |frame| frame.id() == id)? {
        Some(heard) => fail(
            "no TPDO after a remote frame with the CAN-ID of SYNC",
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}

/// A frame of 29 bits whose number is the CAN-ID of SYNC is not a SYNC message.
pub(super) fn extended_frame(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = typed(dut, 1)?;
    let Some(id) = CobId::new(dut.sync_id).can_id().as_standard() else {
        return lacks("SYNC has a CAN-ID of 29 bits");
    };
    dut.nmt(Command::Start)?;
    dut.drain()?;
    if let Some(frame) = Frame::new(CanId::extended(id.into()), &[]) {
        dut.send(frame)?;
    }
    let id = pdo.id();
    match dut.next(QUIET, |frame| frame.id() == id)? {
        Some(heard) => fail(
            "no TPDO after a frame with a CAN-ID of 29 bits",
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}

/// A new period takes effect while the node produces SYNC: a shorter one, and one of more than two bytes.
pub(super) fn other_period(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    let is_sync = |frame: &Frame| frame.id() == id;
    if dut.next(200_000, is_sync)?.is_none() {
        return fail("a SYNC message every 50 ms", "none came for 200 ms");
    }
    for (period, count) in [(20_000u32, 6), (100_000, 4)] {
        let millis = period / 1000;
        dut.write(Address::new(0x1006, 0), &period.to_le_bytes())?;
        // The period from before may end first.
        dut.wait(60_000)?;
        let mut last = None;
        let mut gaps = Vec::new();
        for _ in 0..count {
            let Some(heard) = dut.next(200_000, is_sync)? else {
                return fail(
                    format!("a SYNC message every {millis} ms"),
                    "none came for 200 ms",
                );
            };
            if let Some(before) = last.replace(heard.at) {
                gaps.push(heard.at.micros_since(before));
            }
        }
        gaps.sort_unstable();
        let middle = gaps[gaps.len() / 2];
        let done = ensure(
            middle.abs_diff(period.into()) <= u64::from(period) / 10 + dut.rig.slack(),
            format!("a SYNC message every {millis} ms after a change of 1006h, 10 % off at most"),
            format!("they came every {middle} us"),
        );
        dut.fault(done)?;
    }
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())
}

/// While the node produces SYNC, the CAN-ID in 1005h cannot be changed.
pub(super) fn cob_id_fixed(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let on = raw | 1 << 30;
    let other = (on & !0x7FF) | u32::from(FREE + 2);
    let done = dut.cannot_change(
        COB_ID,
        &other.to_le_bytes(),
        "as the node produces SYNC with another CAN-ID",
    );
    dut.nmt(Command::EnterPreOperational)?;
    if matches!(done, Err(End::Fail { .. })) {
        let off = other & !(1 << 30);
        dut.write(COB_ID, &off.to_le_bytes())?;
    }
    dut.write(COB_ID, &raw.to_le_bytes())?;
    done
}

/// After reset communication the node produces SYNC only if 1005h says so.
pub(super) fn producer_reset(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    if dut.next(200_000, |frame| frame.id() == id)?.is_none() {
        return fail("a SYNC message every 50 ms", "none came for 200 ms");
    }
    dut.reset(Command::ResetCommunication)?;
    if dut.number(0x1005, 0)? as u32 & 1 << 30 != 0 {
        return lacks("the node produces SYNC after a reset");
    }
    dut.nmt(Command::Start)?;
    dut.drain()?;
    match dut.next(300_000, |frame| frame.id() == id)? {
        Some(heard) => fail(
            "no SYNC after the reset, as bit 30 of 1005h is 0",
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}

/// The counter of SYNC begins with 1 after Stopped.
pub(super) fn counter_restart(dut: &mut Dut<'_>) -> Checked {
    // 1019h can be written only while the period is 0.
    dut.set(Address::new(0x1006, 0), &[0; 4])?;
    dut.set(Address::new(0x1019, 0), &[240])?;
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    let mut last = 0;
    while last < 2 {
        match dut.next(200_000, |frame| frame.id() == id)? {
            Some(heard) if heard.frame.dlc() == 1 => last = heard.frame.bytes()[0],
            Some(heard) => return fail("SYNC with a counter", format!("{} came", heard.frame)),
            None => return fail("a SYNC message every 50 ms", "none came for 200 ms"),
        }
    }
    dut.nmt(Command::Stop)?;
    dut.wait(QUIET)?;
    dut.drain()?;
    dut.nmt(Command::Start)?;
    let first = dut
        .frames
        .iter()
        .rev()
        .take_while(|traced| !traced.ours)
        .filter(|traced| traced.frame.id() == id)
        .last()
        .map(|traced| traced.frame);
    let first = match first {
        Some(frame) => Some(frame),
        None => dut
            .next(200_000, |frame| frame.id() == id)?
            .map(|heard| heard.frame),
    };
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    dut.write(Address::new(0x1006, 0), &[0; 4])?;
    match first {
        Some(frame) => ensure(
            frame.data() == [1],
            "the SYNC counter 1 after Stopped",
            format!("{frame} came"),
        ),
        None => fail("a SYNC message every 50 ms after Stopped", "none came"),
    }
}

/// The period at which the cases let a node produce SYNC, in microseconds.
const PERIOD: u32 = 50_000;

/// Makes the node produce SYNC with this period; returns 1005h without bit 30.
fn produce(dut: &mut Dut<'_>, micros: u32) -> Checked<u32> {
    learn_sync(dut)?;
    let raw = dut.number(0x1005, 0)? as u32;
    dut.keep(COB_ID)?;
    dut.set(Address::new(0x1006, 0), &micros.to_le_bytes())?;
    if dut
        .download(COB_ID, &(raw | 1 << 30).to_le_bytes())?
        .is_err()
    {
        return lacks("the node does not produce SYNC");
    }
    dut.nmt(Command::Start)?;
    dut.drain()?;
    Ok(raw)
}

/// The node's SYNC messages, when it produces them every 50 ms.
fn produced(dut: &mut Dut<'_>, count: usize) -> Checked<Vec<Heard>> {
    produced_every(dut, PERIOD, count)
}

/// As [`produced`], with another period in microseconds.
fn produced_every(dut: &mut Dut<'_>, micros: u32, count: usize) -> Checked<Vec<Heard>> {
    let raw = produce(dut, micros)?;
    let id = CobId::new(raw).can_id();
    let mut all = Vec::new();
    for _ in 0..count {
        match dut.next(200_000, |frame| frame.id() == id)? {
            Some(heard) => all.push(heard),
            None => {
                let expected = format!("a SYNC message every {} ms", micros / 1000);
                return fail(expected, "none came for 200 ms");
            }
        }
    }
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    Ok(all)
}

pub(super) fn producer(dut: &mut Dut<'_>) -> Checked {
    let counts = dut.eds.has(0x1019) && dut.number(0x1019, 0)? != 0;
    let all = produced(dut, 6)?;
    for pair in all.windows(2) {
        let gap = pair[1].at.micros_since(pair[0].at);
        ensure(
            gap.abs_diff(50_000) <= 5_000 + dut.rig.slack(),
            "a SYNC message every 50 ms, 10 % off at most",
            format!("one came after {} us", gap),
        )?;
    }
    let (len, expected) = if counts {
        (1, "SYNC with a counter, as 1019h is not 0")
    } else {
        (0, "SYNC without data, as 1019h is 0")
    };
    let wrong = all.iter().find(|heard| heard.frame.dlc() != len);
    match wrong {
        Some(heard) => fail(expected, format!("{} came", heard.frame)),
        None => Ok(()),
    }
}

/// A producer sends SYNC with another CAN-ID of 1005h.
pub(super) fn producer_cob_id(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let raw = dut.number(0x1005, 0)? as u32;
    dut.keep(COB_ID)?;
    dut.set(Address::new(0x1006, 0), &50_000u32.to_le_bytes())?;
    let other = (raw & !(1 << 30 | 0x7FF)) | u32::from(FREE + 2);
    for value in [other, other | 1 << 30] {
        if dut.download(COB_ID, &value.to_le_bytes())?.is_err() {
            return lacks("the node does not produce SYNC with another CAN-ID");
        }
    }
    dut.nmt(Command::Start)?;
    let ids = [CobId::new(other).can_id(), CobId::new(raw).can_id()];
    let heard = dut.next(200_000, |frame| ids.contains(&frame.id()))?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &other.to_le_bytes())?;
    match heard {
        Some(heard) => ensure(
            heard.frame.id() == ids[0],
            "SYNC with the CAN-ID 6A2h of 1005h",
            format!("{} came", heard.frame),
        ),
        None => fail("a SYNC message every 50 ms", "none came for 200 ms"),
    }
}

/// The period goes on while a master writes other objects.
pub(super) fn producer_undisturbed(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    let from = dut.frames.len();
    let done = super::tpdo::writes_others(dut, 0, 600_000);
    let sent = dut.frames.get(from..).unwrap_or_default().iter();
    let count = sent.filter(|one| !one.ours && one.frame.id() == id).count();
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    done?;
    ensure(
        count >= 9,
        "a SYNC message every 50 ms while a master writes the values of other objects again",
        format!("{count} came in 600 ms"),
    )
}

/// No SYNC with the period 0, and none without bit 30.
pub(super) fn producer_off(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    if dut.next(200_000, |frame| frame.id() == id)?.is_none() {
        return fail("a SYNC message every 50 ms", "none came for 200 ms");
    }
    dut.write(Address::new(0x1006, 0), &[0; 4])?;
    dut.drain()?;
    let heard = dut.next(200_000, |frame| frame.id() == id)?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    if let Some(heard) = heard {
        return fail("no SYNC with 0 in 1006h", format!("{} came", heard.frame));
    }
    produced(dut, 1)?;
    match dut.next(200_000, |frame| frame.id() == id)? {
        Some(heard) => fail(
            "no SYNC without bit 30 of 1005h",
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}

/// A node that cannot produce SYNC refuses bit 30 of 1005h.
pub(super) fn no_producer(dut: &mut Dut<'_>) -> Checked {
    use od_wire::AbortCode::ValueRange;
    if dut.eds.has(0x1006) {
        return lacks("the EDS has 1006h, the period of a producer");
    }
    let raw = dut.number(0x1005, 0)? as u32;
    dut.keep(COB_ID)?;
    dut.refuses_value(COB_ID, &(raw | 1 << 30).to_le_bytes(), &[ValueRange])
}

/// A producer sends SYNC in Pre-operational, too.
pub(super) fn producer_pre_operational(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.drain()?;
    let id = CobId::new(raw).can_id();
    let from = dut.frames.len();
    let heard = dut.next(200_000, |frame| frame.id() == id)?;
    // Its own SYNC triggers no TPDO there.
    dut.wait(QUIET)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    let sent = dut.frames.get(from..).unwrap_or_default().iter();
    let sent: Vec<Frame> = sent.filter(|one| !one.ours).map(|one| one.frame).collect();
    for number in dut.eds.pdos(0x1800) {
        let cob_id = CobId::new(dut.number(0x1800 + number, 1)? as u32);
        let is_it = |frame: &&Frame| cob_id.is_valid() && frame.id() == cob_id.can_id();
        if let Some(frame) = sent.iter().find(is_it) {
            let got = format!("{frame} came");
            dut.fault(fail(
                "no TPDO in Pre-operational, with SYNC of the node",
                got,
            ))?;
        }
    }
    match heard {
        Some(_) => Ok(()),
        None => fail(
            "a SYNC message every 50 ms in Pre-operational",
            "none came for 200 ms",
        ),
    }
}

/// A stopped producer sends no SYNC.
pub(super) fn producer_stopped(dut: &mut Dut<'_>) -> Checked {
    let raw = produce(dut, PERIOD)?;
    let id = CobId::new(raw).can_id();
    if dut.next(200_000, |frame| frame.id() == id)?.is_none() {
        return fail("a SYNC message every 50 ms", "none came for 200 ms");
    }
    dut.nmt(Command::Stop)?;
    dut.drain()?;
    let heard = dut.next(200_000, |frame| frame.id() == id)?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(COB_ID, &raw.to_le_bytes())?;
    match heard {
        Some(heard) => fail("no SYNC in Stopped", format!("{} came", heard.frame)),
        None => Ok(()),
    }
}

/// 1019h cannot be changed while 1006h is not 0.
pub(super) fn counter_fixed(dut: &mut Dut<'_>) -> Checked {
    use od_wire::AbortCode::{DeviceState, Incompatible, LocalControl, NotStored};
    learn_sync(dut)?;
    let address = Address::new(0x1019, 0);
    let before = dut.keep(address)?;
    dut.set(Address::new(0x1006, 0), &100_000u32.to_le_bytes())?;
    let other = if before == [4] { 5 } else { 4 };
    let codes = [DeviceState, LocalControl, NotStored, Incompatible];
    dut.refuses_value(address, &[other], &codes)
}

/// A TPDO with a SYNC start value waits for the SYNC message with this counter, and with 0 for any.
pub(super) fn start_value(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    // 1019h can be written only while the period is 0.
    let counter = Address::new(0x1019, 0);
    dut.set(Address::new(0x1006, 0), &[0; 4])?;
    dut.set(counter, &[10])?;
    on_each(dut, |dut, pdo, _| {
        typed_on(dut, pdo, 1)?;
        if !dut.eds.writes(pdo.com, 6) || !dut.eds.writes(pdo.com, 1) {
            return lacks("the SYNC start value cannot be written");
        }
        begins_with(dut, pdo)
    })
}

fn begins_with(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    // The case restores the start value itself, while the PDO is not valid.
    let off = (pdo.cob_id | 1 << 31).to_le_bytes();
    dut.write(pdo.address(1), &off)?;
    let before = dut.read(pdo.address(6))?;
    let (id, tpdo) = (CobId::new(dut.sync_id).can_id(), pdo.id());
    // The counter decides, and not the number of SYNC messages since the start.
    for (start, counts, wanted) in [
        (3, [1, 2, 3, 4, 5], &[3, 4, 5][..]),
        (2, [9, 10, 1, 2, 3], &[2, 3]),
        (10, [8, 9, 10, 1, 2], &[10, 1, 2]),
        (0, [7, 8, 9, 10, 1], &[7, 8, 9, 10, 1]),
    ] {
        dut.write(pdo.address(6), &[start])?;
        dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
        dut.nmt(Command::Start)?;
        dut.wait(QUIET)?;
        let mut came = Vec::new();
        let from = dut.frames.len();
        for count in counts {
            if let Some(frame) = Frame::new(id, &[count]) {
                dut.send(frame)?;
            }
            if dut.next(30_000, |frame| frame.id() == tpdo)?.is_some() {
                came.push(count);
            }
        }
        dut.nmt(Command::EnterPreOperational)?;
        dut.write(pdo.address(1), &off)?;
        let done = super::tpdo::no_emcy_since(dut, from);
        dut.fault(done)?;
        let done = ensure(
            came == wanted,
            format!(
                "TPDOs with the SYNC counters {wanted:?} of {counts:?}, as the start value is {start}"
            ),
            format!("with the counters {came:?}"),
        );
        dut.fault(done)?;
    }
    dut.write(pdo.address(6), &before)?;
    dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())
}

/// With 1019h the counter of SYNC runs from 1 to its value; with 0 SYNC has no data again.
pub(super) fn counter(dut: &mut Dut<'_>) -> Checked {
    let (period, counter) = (Address::new(0x1006, 0), Address::new(0x1019, 0));
    dut.keep(counter)?;
    for (most, micros) in [
        (4u8, PERIOD),
        (2, PERIOD),
        (11, PERIOD),
        (240, 5_000),
        (0, PERIOD),
    ] {
        // 1019h can be written only while the period is 0.
        dut.set(period, &[0; 4])?;
        if dut.download(period, &micros.to_le_bytes())?.is_err() {
            continue;
        }
        dut.set(period, &[0; 4])?;
        dut.write(counter, &[most])?;
        let count = usize::from(most) + usize::from(most.min(12)) + 1;
        let all = produced_every(dut, micros, count)?;
        dut.write(period, &[0; 4])?;
        if most == 0 {
            let with_data = all.iter().find(|heard| heard.frame.dlc() != 0);
            let done = match with_data {
                Some(heard) => fail(
                    "SYNC without data with 0 in 1019h again",
                    format!("{} came", heard.frame),
                ),
                None => Ok(()),
            };
            dut.fault(done)?;
            continue;
        }
        let counts: Vec<u8> = all.iter().map(|heard| heard.frame.bytes()[0]).collect();
        let follows = |pair: &[u8]| pair[1] == if pair[0] == most { 1 } else { pair[0] + 1 };
        let is_right = all.iter().all(|heard| heard.frame.dlc() == 1)
            && counts.iter().all(|count| (1..=most).contains(count))
            && counts.windows(2).all(follows);
        let done = ensure(
            is_right,
            format!("SYNC with a counter from 1 to {most}, the value of 1019h"),
            format!("{counts:?}"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn counter_range(dut: &mut Dut<'_>) -> Checked {
    use od_wire::AbortCode::{ValueRange, ValueTooHigh, ValueTooLow};
    let address = Address::new(0x1019, 0);
    dut.keep(address)?;
    for value in [1].into_iter().chain(241..=255) {
        let codes = [ValueRange, ValueTooHigh, ValueTooLow];
        let done = dut.refuses_value(address, &[value], &codes);
        dut.fault(done)?;
    }
    // Each other value is right.
    dut.set(Address::new(0x1006, 0), &[0; 4])?;
    for value in [2, 3, 127, 128, 239, 240, 0] {
        dut.write(address, &[value])?;
        let is = dut.read(address)?;
        let done = ensure(
            is == [value],
            format!("{value} in {address}, as written"),
            format!("{is:02X?} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn time_cob_id(dut: &mut Dut<'_>) -> Checked {
    let raw = dut.number(0x1012, 0)?;
    ensure(
        raw & 0x1FFF_F800 == 0 || raw & 0x2000_0000 != 0,
        "a CAN-ID of 11 bits, or bit 29, in 1012h",
        format!("{raw:08X}h was read"),
    )
}

/// While the node consumes or produces TIME, the CAN-ID in 1012h cannot be changed.
pub(super) fn time_cob_id_fixed(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x1012, 0);
    let raw = number(&dut.keep(address)?) as u32;
    let off = raw & 0x3FFF_FFFF;
    let mut any = false;
    for flag in [1 << 31, 1 << 30] {
        if dut.download(address, &(off | flag).to_le_bytes())?.is_err() {
            continue;
        }
        any = true;
        let other = (off & !0x7FF) | u32::from(FREE + 2);
        let why = "as the node uses TIME with another CAN-ID";
        let done = dut.cannot_change(address, &(other | flag).to_le_bytes(), why);
        if matches!(done, Err(End::Fail { .. })) {
            dut.write(address, &other.to_le_bytes())?;
        }
        dut.fault(done)?;
        dut.write(address, &off.to_le_bytes())?;
    }
    at_least_one(any, "the node neither consumes nor produces TIME")
}

/// The node continues to work after valid and invalid TIME messages.
pub(super) fn time(dut: &mut Dut<'_>) -> Checked {
    let raw = dut.number(0x1012, 0)? as u16 & 0x7FF;
    for data in [&[0, 0, 0, 0, 0x20, 0x40][..], &[], &[1, 2, 3], &[0xFF; 8]] {
        dut.send_to(raw, data)?;
        dut.wait(20_000)?;
    }
    dut.still_serves()
}
