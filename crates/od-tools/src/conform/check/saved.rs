//! PDOs and times of error control that were saved are in use after a reset.

use od_model::{Address, values};
use od_wire::nmt::Command;
use od_wire::{Frame, Instant};

use super::content::carries_values;
use super::each_rpdo::{Changed, outputs, takes, valid, with_another};
use super::guarding::{guarded, without_heartbeat};
use super::heartbeat::{emcy, reports_silence, sends_emcy, watched};
use super::mapping::on;
use super::store::command;
use super::transmit::{Tpdo, is_on, timed_on};
use crate::conform::dut::{Dut, is_data};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};

/// CAN-ID and mapping of each TPDO are saved, and used after the reset.
pub(super) fn tpdos(dut: &mut Dut<'_>) -> Checked {
    let (mut any, mut why) = (false, String::from("no TPDO is on"));
    for number in dut.eds.pdos(0x1800) {
        let com = 0x1800 + number;
        let cob_id = dut.number(com, 1)? as u32;
        if !is_on(cob_id) {
            continue;
        }
        match saves_mapping(dut, Tpdo { com, cob_id }) {
            Err(End::NotApplicable(reason)) => why = reason,
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    at_least_one(any, &why)
}

fn saves_mapping(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked {
    let (com, map) = (pdo.address(1), pdo.map());
    if !are_saved(dut, &pdo) {
        return lacks("1010h:01 does not save a mapping that can be written, by the EDS");
    }
    let old = super::mapping::entries(dut, &pdo)?;
    let mut others = dut.eds.dictionary().entries();
    let other = others.find(|entry| {
        let raw = super::mapping::raw(entry);
        entry.maps_to_tpdo() && matches!(raw & 0xFF, 8 | 16 | 32) && old.first() != Some(&raw)
    });
    let Some(other) = other.map(|entry| super::mapping::raw(&entry)) else {
        return lacks("no other object can be mapped");
    };
    let moved = Tpdo {
        com: pdo.com,
        cob_id: (pdo.cob_id & !0x3FFF_FFFF) | 0x4F4,
    };
    if !configured(dut, &pdo, &[other], moved.cob_id)? {
        configured(dut, &pdo, &old, pdo.cob_id)?;
        return lacks("the node does not take another mapping and CAN-ID");
    }
    let kept = dut.undo.len();
    let test = |dut: &mut Dut<'_>, reset| {
        configured(dut, &pdo, &old, pdo.cob_id)?;
        dut.reset(reset)?;
        let wanted = [
            (com, moved.cob_id.to_le_bytes().to_vec()),
            (Address::new(map, 0), vec![1]),
            (Address::new(map, 1), other.to_le_bytes().to_vec()),
        ];
        for (address, wanted) in wanted {
            let after = dut.read(address)?;
            let name = values::label(dut.eds.dictionary(), address);
            let kept = ensure(
                after == wanted,
                format!(
                    "{} in {name} after the reset, as saved",
                    values::hex(&wanted)
                ),
                format!("{} was read", values::hex(&after)),
            );
            dut.fault(kept)?;
        }
        match timed_on(dut, &moved, 50).and_then(|()| carries_values(dut, &moved)) {
            Err(End::NotApplicable(_)) => {}
            done => done?,
        }
        dut.nmt(Command::EnterPreOperational)?;
        dut.put_back_since(kept)
    };
    let done = command(dut, 0x1010, 1, b"save")
        .and_then(|()| test(dut, Command::ResetNode))
        .and_then(|()| test(dut, Command::ResetCommunication));
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.nmt(Command::EnterPreOperational)?;
    dut.put_back_since(kept)?;
    configured(dut, &pdo, &old, pdo.cob_id)?;
    command(dut, 0x1010, 1, b"save")?;
    done
}

/// Writes mapping and COB-ID of a TPDO. Returns whether the node accepts all of it.
fn configured(dut: &mut Dut<'_>, pdo: &Tpdo, entries: &[u32], cob_id: u32) -> Checked<bool> {
    let map = pdo.map();
    let now = dut.number(pdo.com, 1)? as u32;
    let mut writes = vec![
        (pdo.address(1), (now | 1 << 31).to_le_bytes().to_vec()),
        (Address::new(map, 0), vec![0]),
    ];
    for (sub, entry) in (1..).zip(entries) {
        writes.push((Address::new(map, sub), entry.to_le_bytes().to_vec()));
    }
    writes.push((Address::new(map, 0), vec![entries.len() as u8]));
    for cob_id in [cob_id | 1 << 31, cob_id] {
        writes.push((pdo.address(1), cob_id.to_le_bytes().to_vec()));
    }
    for (address, bytes) in writes {
        if dut.download(address, &bytes)?.is_err() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Returns whether COB-ID and mapping can be written, and 1010h:01 saves them, by the EDS.
fn are_saved(dut: &Dut<'_>, pdo: &Tpdo) -> bool {
    let all = [
        pdo.address(1),
        Address::new(pdo.map(), 0),
        Address::new(pdo.map(), 1),
    ];
    all.into_iter().all(|address| {
        let entry = dut.eds.entry(address.index, address.sub);
        entry.is_some_and(|entry| entry.access.writable() && entry.group.covered_by(1))
    })
}

/// A mapping of each RPDO that was saved is in use after a reset, before any other command.
pub(super) fn rpdos(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1010, 1)? & 1 == 0 {
        return lacks("the node does not save on command");
    }
    let all = outputs(dut)?;
    let mut any = false;
    for (turn, pdo) in valid(dut)?.into_iter().enumerate() {
        if all.is_empty() || !are_saved(dut, &pdo) {
            continue;
        }
        // Another object for each RPDO.
        let entries = with_another(dut, pdo.map(), &all, &all[turn % all.len()]);
        let kept = dut.undo.len();
        let done = on(dut, pdo, |dut, map| {
            takes(dut, &pdo, map, &entries)?;
            command(dut, 0x1010, 1, b"save")?;
            dut.reset(Command::ResetNode)?;
            let changed = Changed::of(dut, &entries)?;
            changed.send(dut, &pdo)?;
            let why = format!(
                ", as RPDO{} has it after a save and a reset",
                pdo.com - 0x13FF
            );
            let done = changed.holds(dut, true, &why);
            dut.nmt(Command::EnterPreOperational)?;
            done
        });
        match done {
            Err(End::NotApplicable(_)) => continue,
            done => dut.fault(done)?,
        }
        any = true;
        dut.put_back_since(kept)?;
    }
    if any {
        command(dut, 0x1010, 1, b"save")?;
    }
    at_least_one(
        any,
        "no RPDO is on with a mapping that can be written and is saved, by the EDS",
    )
}

/// Saves these values, and runs a test after each reset, of values that only the memory has; then the earlier values are
/// saved again.
fn after_save(
    dut: &mut Dut<'_>,
    values: &[(Address, &[u8])],
    test: impl Fn(&mut Dut<'_>) -> Checked,
) -> Checked {
    let mut before = Vec::new();
    for (address, _) in values {
        let entry = dut.eds.entry(address.index, address.sub);
        if !entry.is_some_and(|entry| entry.access.writable() && entry.group.covered_by(1)) {
            return lacks(format!("1010h:01 does not save {address}, by the EDS"));
        }
        before.push((*address, dut.read(*address)?));
    }
    let write = |dut: &mut Dut<'_>| {
        let each = |(address, bytes): &(Address, Vec<u8>)| dut.write(*address, bytes);
        before.iter().try_for_each(each)
    };
    for (address, bytes) in values {
        dut.write(*address, bytes)?;
    }
    let done = command(dut, 0x1010, 1, b"save").and_then(|()| {
        for reset in [Command::ResetNode, Command::ResetCommunication] {
            write(dut)?;
            dut.reset(reset)?;
            test(dut)?;
        }
        Ok(())
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    write(dut)?;
    command(dut, 0x1010, 1, b"save")?;
    done
}

/// A heartbeat time.
pub(super) fn heartbeat(dut: &mut Dut<'_>) -> Checked {
    after_save(dut, &[(Address::new(0x1017, 0), &[100, 0])], |dut| {
        let id = dut.id(0x700);
        let is_beat = |frame: &Frame| is_data(frame, id) && frame.data() != [0];
        if dut.next(1_000_000, is_beat)?.is_none() {
            return fail(
                "a heartbeat within 1 s of the boot-up, as 1017h = 100 was saved",
                "none came",
            );
        }
        dut.wait(300_000)?;
        let beats = dut.frames.iter().rev();
        let beats = beats.filter(|one| !one.ours && is_data(&one.frame, id));
        // Up to the boot-up message, which counts as the first one (CiA 301, 7.2.8.3.3).
        let mut last: Option<Instant> = None;
        let mut gaps = Vec::new();
        for one in beats {
            gaps.extend(last.replace(one.at).map(|next| next.micros_since(one.at)));
            if one.frame.data() == [0] {
                break;
            }
        }
        let slack = dut.rig.slack();
        let is_early = |gap: &u64| gap + slack < 50_000;
        if let Some(gap) = gaps.pop_if(|gap| is_early(gap)) {
            let millis = gap / 1000;
            dut.notes.push(format!(
                "a heartbeat came {millis} ms after the boot-up message, which counts as the first one (CiA 301, 7.2.8.3.3)"
            ));
        }
        match gaps.into_iter().find(is_early) {
            Some(gap) => fail(
                "heartbeats every 100 ms, as 1017h = 100 was saved",
                format!("one came after {} ms", gap / 1000),
            ),
            None => Ok(()),
        }
    })
}

/// A node to monitor, which then misses its heartbeat.
pub(super) fn consumer(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    let node = watched(dut);
    let entry = [200, 0, node, 0];
    after_save(dut, &[(Address::new(0x1016, 1), &entry)], |dut| {
        reports_silence(dut, node, 200)
    })
}

/// A guard time and a life time factor.
pub(super) fn guarding(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    without_heartbeat(dut)?;
    let times: [(Address, &[u8]); 2] = [
        (Address::new(0x100C, 0), &[100, 0]),
        (Address::new(0x100D, 0), &[2]),
    ];
    after_save(dut, &times, |dut| {
        without_heartbeat(dut)?;
        guarded(dut)?;
        match emcy(dut, 0x8130, 600_000)? {
            Some(_) => guarded(dut).map(drop),
            None => fail(
                "EMCY 8130h within 600 ms of the last request, as 100Ch = 100 and 100Dh = 2 were saved",
                "none came",
            ),
        }
    })
}
