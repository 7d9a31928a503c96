//! PDOs that were saved are in use after a reset.

use od_model::{Address, values};
use od_wire::nmt::Command;

use super::content::carries_values;
use super::each_rpdo::{Changed, outputs, takes, valid, with_another};
use super::mapping::on;
use super::store::command;
use super::transmit::{Tpdo, is_on, timed_on};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, lacks};

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
    let done = command(dut, 0x1010, 1, b"save").and_then(|()| {
        configured(dut, &pdo, &old, pdo.cob_id)?;
        dut.reset(Command::ResetNode)?;
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
            Err(End::NotApplicable(_)) => Ok(()),
            done => done,
        }
    });
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
