//! Store and restore: 1010h and 1011h.

use od_model::{Address, Entry, Group, Literal, values};
use od_wire::AbortCode::{Length, LocalControl, NotStored, TooShort};
use od_wire::nmt::Command;

use super::transfer::another_saved;
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::eds::is_number;
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::sdo::{abort_text, number};

/// Time after the response to a save, since a node may still be writing, in microseconds.
const MEMORY: u64 = 600_000;

/// The values that a save includes.
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
    let id = dut.id(0x580);
    let expected = format!("one response to the signature in {index:04X}h:{sub:02X}");
    dut.silent(id, MEMORY, &expected)
}

pub(super) fn wrong_signature(dut: &mut Dut<'_>, index: u16) -> Checked {
    // A node that takes one of the others for a restore would lose its values.
    let wrong: &[&[u8]] = match index {
        0x1010 => &[b"evas", b"SAVE", b"load", &b"save"[..3], b"sa"],
        _ => &[b"evas", b"loa", b"lo"],
    };
    refuses_signatures(dut, index, wrong)
}

fn refuses_signatures(dut: &mut Dut<'_>, index: u16, wrong: &[&[u8]]) -> Checked {
    let count = dut.number(index, 0)?.min(127) as u8;
    for sub in 1..=count {
        if dut.eds.entry(index, sub).is_none() {
            continue;
        }
        for signature in wrong {
            let address = Address::new(index, sub);
            let codes = [NotStored, LocalControl, Length, TooShort];
            let codes = if signature.len() < 4 {
                &codes[..]
            } else {
                &codes[..2]
            };
            let done = dut.refuses_value(address, signature, codes);
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// Signatures that are nearly right restore nothing.
pub(super) fn wrong_signatures(dut: &mut Dut<'_>) -> Checked {
    let before = backup(dut)?;
    refuses_signatures(dut, 0x1011, &[b"save", b"LOAD", b"daol"])?;
    if dut.faults.is_empty() {
        return Ok(());
    }
    dut.reset(Command::ResetNode)?;
    bring_back(dut, &before)
}

/// 1010h declares whether it saves on command or automatically.
pub(super) fn save_can(dut: &mut Dut<'_>) -> Checked {
    let can = dut.number(0x1010, 1)?;
    if can == 0 {
        return lacks("1010h:01 is 0: the node saves neither on command nor automatically");
    }
    says(dut, 0x1010, 3, "0, 1, 2 or 3", "bits 2 to 31 are reserved")
}

pub(super) fn load_can(dut: &mut Dut<'_>) -> Checked {
    let can = dut.number(0x1011, 1)?;
    if can == 0 {
        return lacks("1011h:01 is 0: the node does not restore");
    }
    says(dut, 0x1011, 1, "0 or 1", "bits 1 to 31 are reserved")
}

/// Each sub-index has only these bits.
fn says(dut: &mut Dut<'_>, index: u16, bits: u64, expected: &str, why: &str) -> Checked {
    let count = dut.number(index, 0)?.min(127) as u8;
    for sub in 1..=count {
        let address = Address::new(index, sub);
        let Ok(bytes) = dut.upload(address)? else {
            continue;
        };
        let can = number(&bytes);
        let done = ensure(
            can & !bits == 0,
            format!("{expected} in {address}: {why}"),
            format!("{can:X}h was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn save(dut: &mut Dut<'_>) -> Checked {
    saved(dut, 1)
}

pub(super) fn save_communication(dut: &mut Dut<'_>) -> Checked {
    match dut.eds.entry(0x1010, 2) {
        Some(_) => saved(dut, 2)?,
        None => return lacks("1010h has no sub-index 2"),
    }
    saves_no_communication(dut)
}

/// A group of values that a sub-index of 1010h and 1011h of its own saves and restores.
#[derive(Clone, Copy)]
pub(super) enum Apart {
    Application = 3,
    Manufacturer = 4,
}

fn has_limits(entry: &Entry) -> bool {
    entry.low != Literal::None && entry.high != Literal::None
}

/// A value that only sub-index 1 and that of its group save: before and now.
fn another_apart(dut: &mut Dut<'_>, group: Apart) -> Checked<Option<Change>> {
    for entry in dut.eds.writable() {
        let is_own = entry.address.index >= 0x2000
            && entry.group.covered_by(group as u8)
            && !dut.eds.moves(entry.address);
        if !is_own {
            continue;
        }
        let changed = match group {
            Apart::Application if has_limits(&entry) => super::nmt::another_of(dut, &entry)?,
            // Nobody else knows what an object of a manufacturer does, so its value changes by 1 only.
            _ if is_number(&entry) => {
                let before = dut.read(entry.address)?;
                let mut other = before.clone();
                other.iter_mut().take(1).for_each(|byte| *byte ^= 1);
                let is_allowed = dut.eds.excludes(entry.address, &other, dut.node).is_none();
                is_allowed.then_some((other, before))
            }
            _ => None,
        };
        if let Some((other, before)) = changed
            && dut.download(entry.address, &other)?.is_ok()
        {
            return Ok(Some((entry.address, before, other)));
        }
    }
    Ok(None)
}

/// The sub-index of this group saves its values, and that of communication does not.
pub(super) fn save_apart(dut: &mut Dut<'_>, group: Apart) -> Checked {
    let own = group as u8;
    if dut.eds.entry(0x1010, 2).is_none() || !saves_on_command(dut, own)? {
        return lacks(format!("1010h:{own:02X} does not save on command"));
    }
    let Some((address, before, other)) = another_apart(dut, group)? else {
        return lacks(format!("no value of 1010h:{own:02X} can be changed"));
    };
    let done = (|| {
        command(dut, 0x1010, 2, b"save")?;
        dut.write(address, &before)?;
        dut.reset(Command::ResetNode)?;
        is_there(dut, address, &before, "1010h:02 does not save it")?;
        dut.write(address, &other)?;
        command(dut, 0x1010, own, b"save")?;
        dut.write(address, &before)?;
        dut.reset(Command::ResetNode)?;
        let why = format!("1010h:{own:02X} saves it");
        is_there(dut, address, &other, &why)
    })();
    saved_again(dut, done, address, &before)
}

/// The sub-index of this group restores its values, and that of communication does not.
pub(super) fn load_apart(dut: &mut Dut<'_>, group: Apart) -> Checked {
    let own = group as u8;
    if !saves_on_command(dut, 1)? || dut.number(0x1011, own)? & 1 == 0 {
        return lacks(format!("1011h:{own:02X} does not restore"));
    }
    let all = backup(dut)?;
    let Some((address, before, other)) = another_apart(dut, group)? else {
        return lacks(format!("no value of 1011h:{own:02X} can be changed"));
    };
    let default = dut.eds.entry(address.index, address.sub);
    let default = default.and_then(|entry| dut.eds.default(&entry, dut.node));
    let done = (|| {
        command(dut, 0x1010, 1, b"save")?;
        command(dut, 0x1011, 2, b"load")?;
        dut.reset(Command::ResetNode)?;
        is_there(dut, address, &other, "1011h:02 does not restore it")?;
        command(dut, 0x1011, own, b"load")?;
        dut.reset(Command::ResetNode)?;
        let why = format!("1011h:{own:02X} restores it");
        match &default {
            Some(default) => is_there(dut, address, default, &why),
            None => Ok(()),
        }
    })();
    let done = saved_again(dut, done, address, &before);
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    done.and(bring_back(dut, &all))
}

/// Fails unless a value is the wanted one after the reset.
fn is_there(dut: &mut Dut<'_>, address: Address, wanted: &[u8], why: &str) -> Checked {
    let after = dut.read(address)?;
    ensure(
        after == wanted,
        format!(
            "{} in {address} after the reset: {why}",
            values::hex(wanted)
        ),
        format!("{} was read", values::hex(&after)),
    )
}

/// Writes the earlier value and saves it, whatever the result of the case is.
fn saved_again(dut: &mut Dut<'_>, done: Checked, address: Address, before: &[u8]) -> Checked {
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    dut.write(address, before)?;
    command(dut, 0x1010, 1, b"save")?;
    dut.notes
        .push(format!("saved {address} = {} again", values::hex(before)));
    done
}

/// Returns whether this sub-index of 1010h says that the node saves on command (bit 0).
fn saves_on_command(dut: &mut Dut<'_>, sub: u8) -> Checked<bool> {
    Ok(dut.number(0x1010, sub)? & 1 != 0)
}

/// 1010h:03 saves the parameters of the application only, if the node saves them on command.
fn saves_no_communication(dut: &mut Dut<'_>) -> Checked {
    let other = another_saved(dut, Some(2))?;
    let Some((address, bytes)) = other.filter(|_| dut.eds.entry(0x1010, 3).is_some()) else {
        return Ok(());
    };
    if !saves_on_command(dut, 3)? {
        return Ok(());
    }
    let before = dut.read(address)?;
    dut.write(address, &bytes)?;
    command(dut, 0x1010, 3, b"save")?;
    dut.reset(Command::ResetNode)?;
    let after = dut.read(address)?;
    if after != before {
        dut.write(address, &before)?;
        command(dut, 0x1010, 2, b"save")?;
    }
    ensure(
        after == before,
        format!(
            "{} in {address} after the reset: 1010h:03 does not save it",
            values::hex(&before)
        ),
        format!("{} was read", values::hex(&after)),
    )
}

/// Resets the node, which then reports no error of its stored data (CiA 301, table 26: 55xxh and 63xxh).
fn reset_without_error(dut: &mut Dut<'_>) -> Checked {
    let had_error = dut.upload(Address::new(0x1001, 0))? != Ok(vec![0]);
    let from = dut.frames.len();
    dut.reset(Command::ResetNode)?;
    dut.settle(QUIET)?;
    let id = dut.id(0x80);
    let frames = dut.frames.get(from..).unwrap_or_default().iter();
    let mut own = frames.filter(|traced| is_data(&traced.frame, id));
    let error = own.find(|traced| matches!(traced.frame.bytes()[1], 0x55 | 0x63));
    match error.map(|traced| traced.frame) {
        Some(frame) if !had_error => fail(
            "no EMCY 55xxh or 63xxh after the reset, as the stored data are right",
            format!("{frame} came"),
        ),
        _ => Ok(()),
    }
}

/// A value that this sub-index saves is active after a reset.
fn saved(dut: &mut Dut<'_>, sub: u8) -> Checked {
    if !saves_on_command(dut, sub)? {
        return lacks("the node does not save on command");
    }
    let Some((address, bytes)) = another_saved(dut, Some(sub))? else {
        return lacks("no parameter of communication can be written");
    };
    let before = dut.read(address)?;
    let parts = [0x1010, 0x1011].map(|index| Address::new(index, sub));
    let can = parts
        .map(|part| dut.upload(part))
        .into_iter()
        .collect::<Checked<Vec<_>>>()?;
    dut.write(address, &bytes)?;
    let done = command(dut, 0x1010, sub, b"save").and_then(|()| {
        for (part, can) in parts.into_iter().zip(can) {
            let is = dut.upload(part)?;
            ensure(
                is == can,
                format!("the same value in {part} after a save as before"),
                format!(
                    "{} was read",
                    is.map_or_else(abort_text, |is| values::hex(&is))
                ),
            )?;
        }
        // A node that keeps its values at a reset must have saved this one, too: write the earlier value before the reset.
        dut.write(address, &before)?;
        let done = reset_without_error(dut);
        dut.fault(done)?;
        for command in [None, Some(Command::ResetCommunication)] {
            if let Some(command) = command {
                dut.write(address, &before)?;
                dut.reset(command)?;
            }
            let after = dut.read(address)?;
            ensure(
                after == bytes,
                format!(
                    "{} in {address} after the reset, as saved",
                    values::hex(&bytes)
                ),
                format!("{} was read", values::hex(&after)),
            )?;
        }
        Ok(())
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

/// After a restore and a reset a changed value is the default.
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
            let done = reset_without_error(dut);
            dut.fault(done)?;
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

/// Communication parameters that can be changed, saved and reset without harm.
fn several(dut: &Dut<'_>) -> Vec<Entry> {
    // A case may change the inhibit time of EMCY messages, which acts at once and is restored.
    let inhibit = dut.eds.entry(0x1015, 0);
    let inhibit = inhibit.filter(|entry| entry.access.writable());
    let all = dut.eds.writable().into_iter().chain(inhibit);
    let is_quiet = |entry: &Entry| {
        let Address { index, sub } = entry.address;
        let is_kind = match index {
            0x100C | 0x100D | 0x1015 | 0x1016 | 0x1017 => true,
            0x1029 => sub == 1,
            0x1400..=0x15FF => sub == 2,
            0x1800..=0x19FF => matches!(sub, 2 | 5),
            _ => false,
        };
        is_kind && (sub > 0 || index != 0x1016) && entry.group.covered_by(1)
    };
    let mut all: Vec<Entry> = all.filter(is_quiet).collect();
    all.sort_by_key(|entry| entry.address);
    all.dedup_by_key(|entry| entry.address);
    all
}

/// A changed communication parameter: address, value before and now.
type Change = (Address, Vec<u8>, Vec<u8>);

/// Changes several communication parameters.
fn change_several(dut: &mut Dut<'_>) -> Checked<Vec<Change>> {
    let mut changed = Vec::new();
    for entry in several(dut) {
        let address = entry.address;
        let before = dut.read(address)?;
        let mut other = before.clone();
        let number = address.sub;
        match (address.index, &mut other[..]) {
            // Each entry monitors a separate node, which never sends.
            (0x1016, [low, high, node, _]) => {
                (*low, *high, *node) = (0x10, 0x27, 100u8.saturating_add(number).min(127));
            }
            (0x1400..=0x19FF, [kind]) if number == 2 => *kind = if *kind == 1 { 255 } else { 1 },
            (0x1029, [class]) => *class = if *class == 1 { 0 } else { 1 },
            (_, [first, ..]) => *first ^= 0x30,
            _ => continue,
        }
        if dut.eds.excludes(address, &other, dut.node).is_none()
            && dut.download(address, &other)?.is_ok()
        {
            changed.push((address, before, other));
        }
    }
    if changed.len() < 2 {
        for (address, before, _) in changed {
            dut.write(address, &before)?;
        }
        return lacks("fewer than two parameters of communication can be changed");
    }
    Ok(changed)
}

/// Fails unless each value is the changed one.
fn all_are_there(dut: &mut Dut<'_>, changed: &[Change], when: &str) -> Checked {
    for (address, _, other) in changed {
        let after = dut.read(*address)?;
        let name = values::label(dut.eds.dictionary(), *address);
        let kept = ensure(
            after == *other,
            format!("{} in {name} {when}", values::hex(other)),
            format!("{} was read", values::hex(&after)),
        );
        dut.fault(kept)?;
    }
    Ok(())
}

/// Changes values, saves, resets and compares; then saves the earlier values again.
pub(super) fn save_all(dut: &mut Dut<'_>) -> Checked {
    let changed = change_several(dut)?;
    let done = command(dut, 0x1010, 1, b"save").and_then(|()| {
        all_are_there(dut, &changed, "after the save, which changes no value")?;
        // A node that keeps its values at a reset must have saved these, too: write the earlier values before the
        // reset.
        for (address, before, _) in &changed {
            dut.write(*address, before)?;
        }
        dut.reset(Command::ResetNode)?;
        all_are_there(dut, &changed, "after the reset, as saved")
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    for (address, before, _) in &changed {
        dut.write(*address, before)?;
    }
    command(dut, 0x1010, 1, b"save")?;
    dut.notes
        .push(format!("saved {} values again", changed.len()));
    done
}

/// A restore brings back every default, of several changed values.
pub(super) fn load_all(dut: &mut Dut<'_>) -> Checked {
    let before = backup(dut)?;
    let changed = change_several(dut)?;
    let done = command(dut, 0x1010, 1, b"save").and_then(|()| {
        command(dut, 0x1011, 1, b"load")?;
        dut.reset(Command::ResetNode)?;
        for (address, ..) in &changed {
            let entry = dut.eds.entry(address.index, address.sub);
            let Some(default) = entry.and_then(|entry| dut.eds.default(&entry, dut.node)) else {
                continue;
            };
            let after = dut.read(*address)?;
            let name = values::label(dut.eds.dictionary(), *address);
            let done = ensure(
                after == default,
                format!(
                    "{} in {name} after the reset, the default",
                    values::hex(&default)
                ),
                format!("{} was read", values::hex(&after)),
            );
            dut.fault(done)?;
        }
        Ok(())
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    done.and(bring_back(dut, &before))
}

/// The second of two saves is valid.
pub(super) fn save_twice(dut: &mut Dut<'_>) -> Checked {
    let Some((address, bytes)) = another_saved(dut, Some(1))? else {
        return lacks("no parameter of communication can be written");
    };
    let before = dut.read(address)?;
    let mut second = bytes.clone();
    second[0] ^= 0x10;
    let done = (|| {
        for value in [&bytes, &second] {
            dut.write(address, value)?;
            command(dut, 0x1010, 1, b"save")?;
        }
        dut.write(address, &before)?;
        dut.reset(Command::ResetNode)?;
        let after = dut.read(address)?;
        ensure(
            after == second,
            format!("{} in {address}, as saved last", values::hex(&second)),
            format!("{} was read", values::hex(&after)),
        )
    })();
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.write(address, &before)?;
    command(dut, 0x1010, 1, b"save")?;
    done
}

/// A restore takes effect with the next reset, not before.
pub(super) fn load_after_reset(dut: &mut Dut<'_>) -> Checked {
    let before = backup(dut)?;
    let Some((address, bytes)) = another_saved(dut, Some(1))? else {
        return lacks("no parameter of communication can be written");
    };
    dut.write(address, &bytes)?;
    let done = (|| {
        command(dut, 0x1011, 1, b"load")?;
        let after = dut.read(address)?;
        ensure(
            after == bytes,
            format!("{} in {address} until the reset", values::hex(&bytes)),
            format!("{} was read", values::hex(&after)),
        )
    })();
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.reset(Command::ResetNode)?;
    done.and(bring_back(dut, &before))
}

/// The period and the counter of SYNC are saved.
pub(super) fn sync_saved(dut: &mut Dut<'_>) -> Checked {
    let (period, counter) = (Address::new(0x1006, 0), Address::new(0x1019, 0));
    let covered = |address: Address| {
        let entry = dut.eds.entry(address.index, address.sub);
        entry.is_some_and(|entry| entry.group.covered_by(1))
    };
    if !covered(period) || !covered(counter) {
        return lacks("1010h:01 does not save 1006h and 1019h, by the EDS");
    }
    let before = [dut.read(period)?, dut.read(counter)?];
    // 1019h is written while 1006h is 0.
    let write = |dut: &mut Dut<'_>, [one, other]: [&[u8]; 2]| {
        dut.write(period, &[0; 4])?;
        dut.write(counter, other)?;
        dut.write(period, one)?;
        command(dut, 0x1010, 1, b"save")
    };
    let wanted: [&[u8]; 2] = [&[0x10, 0x27, 0, 0], &[7]];
    let done = write(dut, wanted).and_then(|()| {
        dut.reset(Command::ResetNode)?;
        for (address, wanted) in [period, counter].into_iter().zip(wanted) {
            let after = dut.read(address)?;
            let kept = ensure(
                after == wanted,
                format!(
                    "{} in {address} after the reset, as saved",
                    values::hex(wanted)
                ),
                format!("{} was read", values::hex(&after)),
            );
            dut.fault(kept)?;
        }
        Ok(())
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    write(dut, [&before[0], &before[1]])?;
    done
}

/// Date and time of the configuration (1020h) are saved.
pub(super) fn configuration_date(dut: &mut Dut<'_>) -> Checked {
    let all = [1, 2].map(|sub| Address::new(0x1020, sub));
    let mut before = Vec::new();
    for (address, value) in all.into_iter().zip([12_345u32, 678]) {
        before.push((address, dut.read(address)?));
        dut.write(address, &value.to_le_bytes())?;
    }
    let done = command(dut, 0x1010, 1, b"save").and_then(|()| {
        dut.reset(Command::ResetNode)?;
        for (address, value) in all.into_iter().zip([12_345u32, 678]) {
            let after = dut.read(address)?;
            let kept = ensure(
                after == value.to_le_bytes(),
                format!("{value} in {address} after the reset, as saved"),
                format!("{} was read", values::hex(&after)),
            );
            dut.fault(kept)?;
        }
        Ok(())
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    for (address, bytes) in &before {
        dut.write(*address, bytes)?;
    }
    command(dut, 0x1010, 1, b"save")?;
    done
}

/// The parameters of SDO servers and clients from these indices on.
fn channels(dut: &mut Dut<'_>, from: u16, to: u16) -> Checked<Vec<(Address, Vec<u8>)>> {
    let mut all = Vec::new();
    let entries: Vec<Entry> = dut.eds.dictionary().entries().collect();
    for entry in entries {
        if (from..=to).contains(&entry.address.index) && entry.access.readable() {
            all.push((
                entry.address,
                dut.upload(entry.address)?.unwrap_or_default(),
            ));
        }
    }
    if all.is_empty() {
        return lacks("the EDS has no further SDO channel");
    }
    Ok(all)
}

/// Fails for each value that has changed.
fn are_kept(dut: &mut Dut<'_>, before: &[(Address, Vec<u8>)]) -> Checked {
    for (address, was) in before {
        let is = dut.upload(*address)?.unwrap_or_default();
        let kept = ensure(
            is == *was,
            format!("{} in {address} after the reset", values::hex(was)),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(kept)?;
    }
    Ok(())
}

/// Reset communication does not change the SDO servers.
pub(super) fn servers_reset(dut: &mut Dut<'_>) -> Checked {
    let before = channels(dut, 0x1201, 0x127F)?;
    dut.reset(Command::ResetCommunication)?;
    are_kept(dut, &before)
}

/// A save and reset communication do not change SDO clients.
pub(super) fn clients_saved(dut: &mut Dut<'_>) -> Checked {
    let before = channels(dut, 0x1280, 0x12FF)?;
    command(dut, 0x1010, 1, b"save")?;
    dut.reset(Command::ResetCommunication)?;
    are_kept(dut, &before)
}
