//! Store and restore: 1010h and 1011h.

use od_model::{Address, Group, values};
use od_wire::AbortCode::{LocalControl, NotStored};
use od_wire::nmt::Command;

use super::transfer::another_saved;
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, ensure, lacks};

/// A node may confirm a save and need time to carry it out.
const MEMORY: u64 = 600_000;

/// The values that a save keeps.
pub(super) fn backup(dut: &mut Dut<'_>) -> Checked<Vec<(Address, Vec<u8>)>> {
    let mut all = Vec::new();
    for entry in dut.eds.writable() {
        if entry.group != Group::None
            && let Ok(bytes) = dut.upload(entry.address)?
            && !bytes.is_empty()
        {
            all.push((entry.address, bytes));
        }
    }
    Ok(all)
}

/// Writes the values that differ, and saves them.
pub(super) fn bring_back(dut: &mut Dut<'_>, before: &[(Address, Vec<u8>)]) -> Checked {
    let mut back = Vec::new();
    for (address, bytes) in before {
        if dut.upload(*address)?.is_ok_and(|now| now != *bytes) {
            match dut.download(*address, bytes)? {
                Ok(()) => back.push(address.to_string()),
                Err(code) => dut
                    .notes
                    .push(format!("could not put back {address}: {code:08X}h")),
            }
        }
    }
    if !back.is_empty() {
        dut.notes.push(format!("put back {}", back.join(", ")));
    }
    command(dut, 0x1010, 1, b"save")
}

/// Writes a signature, and gives the node time for its memory.
pub(super) fn command(dut: &mut Dut<'_>, index: u16, sub: u8, signature: &[u8]) -> Checked {
    dut.write(Address::new(index, sub), signature)?;
    dut.wait(MEMORY)
}

fn wrong_signature(dut: &mut Dut<'_>, index: u16) -> Checked {
    let count = dut.number(index, 0)?.min(127) as u8;
    for sub in 1..=count {
        let address = Address::new(index, sub);
        if dut.eds.entry(index, sub).is_some() {
            dut.refuses_value(address, b"evas", &[NotStored, LocalControl])?;
        }
    }
    Ok(())
}

pub(super) fn save_signature(dut: &mut Dut<'_>) -> Checked {
    wrong_signature(dut, 0x1010)
}

pub(super) fn load_signature(dut: &mut Dut<'_>) -> Checked {
    wrong_signature(dut, 0x1011)
}

/// 1010h declares that it saves on command, or automatically.
pub(super) fn save_can(dut: &mut Dut<'_>) -> Checked {
    let can = dut.number(0x1010, 1)?;
    if can == 0 {
        return lacks("1010h:01 is 0: the node saves neither on command nor automatically");
    }
    ensure(
        can & !3 == 0,
        "0, 1, 2 or 3 in 1010h:01: bits 2 to 31 are reserved",
        format!("{can:X}h was read"),
    )
}

pub(super) fn load_can(dut: &mut Dut<'_>) -> Checked {
    let can = dut.number(0x1011, 1)?;
    if can == 0 {
        return lacks("1011h:01 is 0: the node does not restore");
    }
    ensure(
        can == 1,
        "0 or 1 in 1011h:01: bits 1 to 31 are reserved",
        format!("{can:X}h was read"),
    )
}

pub(super) fn save(dut: &mut Dut<'_>) -> Checked {
    saved(dut, 1)
}

pub(super) fn save_communication(dut: &mut Dut<'_>) -> Checked {
    match dut.eds.entry(0x1010, 2) {
        Some(_) => saved(dut, 2),
        None => lacks("1010h has no sub-index 2"),
    }
}

/// A value that is saved by this sub-index is there after a reset.
fn saved(dut: &mut Dut<'_>, sub: u8) -> Checked {
    let Some((address, bytes)) = another_saved(dut, Some(sub))? else {
        return lacks("no parameter of communication can be written");
    };
    let before = dut.read(address)?;
    dut.write(address, &bytes)?;
    let done = command(dut, 0x1010, sub, b"save").and_then(|()| {
        dut.reset(Command::ResetNode)?;
        let after = dut.read(address)?;
        ensure(
            after == bytes,
            format!(
                "{} in {address} after the reset, as saved",
                values::hex(&bytes)
            ),
            format!("{} was read", values::hex(&after)),
        )
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.write(address, &before)?;
    command(dut, 0x1010, sub, b"save")?;
    dut.notes
        .push(format!("saved {address} = {} again", values::hex(&before)));
    done
}

pub(super) fn load(dut: &mut Dut<'_>) -> Checked {
    loaded(dut, 1)
}

pub(super) fn load_communication(dut: &mut Dut<'_>) -> Checked {
    match dut.eds.entry(0x1011, 2) {
        Some(_) => loaded(dut, 2),
        None => lacks("1011h has no sub-index 2"),
    }
}

/// After a restore and a reset a changed value is the default again.
fn loaded(dut: &mut Dut<'_>, sub: u8) -> Checked {
    let before = backup(dut)?;
    let Some((address, bytes)) = another_saved(dut, Some(sub))? else {
        return lacks("no parameter of communication can be written");
    };
    let default = dut.eds.entry(address.index, address.sub);
    let Some(default) = default.and_then(|entry| dut.eds.default(&entry, dut.node)) else {
        return lacks("the EDS has no default to compare with");
    };
    dut.write(address, &bytes)?;
    command(dut, 0x1010, sub, b"save")?;
    let done = dut
        .write(Address::new(0x1011, sub), b"load")
        .and_then(|()| {
            dut.reset(Command::ResetNode)?;
            let after = dut.read(address)?;
            ensure(
                after == default,
                format!(
                    "{} in {address} after the reset, the default",
                    values::hex(&default)
                ),
                format!("{} was read", values::hex(&after)),
            )
        });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    done.and(bring_back(dut, &before))
}
