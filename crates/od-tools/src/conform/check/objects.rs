//! Every object of the EDS: access, type, limits, defaults.

use od_model::{Access, Address, Entry, Group, Kind, values};
use od_wire::AbortCode::{NoObject, NoSubIndex, ReadOnly, UnsupportedAccess, WriteOnly};
use od_wire::CobId;
use od_wire::nmt::Command;

use super::transfer::{out_of_range, outside};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::{abort_text, number, request};

/// Returns whether an abort means that an object has no data now, not that it does not exist.
fn is_empty(code: u32) -> bool {
    (code >> 24) == 8
}

/// Entries in a range of indices.
fn entries(dut: &Dut<'_>, from: u16, to: u16) -> Vec<Entry> {
    let all = dut.eds.dictionary().entries();
    all.filter(|entry| (from..=to).contains(&entry.address.index))
        .collect()
}

/// Every readable object exists, with the size of its type.
pub(super) fn read_all(dut: &mut Dut<'_>, from: u16, to: u16) -> Checked {
    let all = entries(dut, from, to);
    for entry in all.iter().filter(|entry| entry.access.readable()) {
        let done = read_one(dut, entry);
        dut.fault(done)?;
    }
    if all.is_empty() {
        lacks("the EDS has no such object")
    } else {
        Ok(())
    }
}

fn read_one(dut: &mut Dut<'_>, entry: &Entry) -> Checked {
    let name = values::label(dut.eds.dictionary(), entry.address);
    match dut.upload(entry.address)? {
        Ok(bytes) => {
            if let Some(size) = entry.data_type.size() {
                ensure(
                    bytes.len() == size,
                    format!("{size} bytes of {name}, {}", entry.data_type.name()),
                    format!("{} came: {}", bytes.len(), values::hex(&bytes)),
                )?;
            }
            if entry.data_type.kind() == Kind::Boolean && bytes.first() > Some(&1) {
                return fail(format!("0 or 1 in {name}"), values::hex(&bytes));
            }
            Ok(())
        }
        Err(code) if is_empty(code) => Ok(()),
        Err(code) => fail(format!("a value of {name}"), abort_text(code)),
    }
}

/// A read-only object aborts a write of its own value.
pub(super) fn read_only(dut: &mut Dut<'_>) -> Checked {
    for entry in entries(dut, 0x1000, 0x9FFF) {
        let is_fixed = matches!(entry.access, Access::Ro | Access::Const);
        let Some(size) = entry.data_type.size().filter(|size| is_fixed && *size <= 4) else {
            continue;
        };
        let mut data = [0; 4];
        if let Ok(bytes) = dut.upload(entry.address)? {
            let len = bytes.len().min(4);
            data[..len].copy_from_slice(&bytes[..len]);
        }
        let command = 0x23 | (4 - size as u8) << 2;
        let done = dut.refuses(
            request(command, entry.address, data),
            &[UnsupportedAccess, ReadOnly],
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn write_only(dut: &mut Dut<'_>) -> Checked {
    let mut any = false;
    for entry in entries(dut, 0x1000, 0x9FFF) {
        if entry.access == Access::Wo {
            any = true;
            let read = request(0x40, entry.address, [0; 4]);
            let done = dut.refuses(read, &[UnsupportedAccess, WriteOnly]);
            dut.fault(done)?;
        }
    }
    at_least_one(any, "no object is write only")
}

/// A writable object accepts its own value.
pub(super) fn own_value(dut: &mut Dut<'_>) -> Checked {
    for entry in dut.eds.writable() {
        let done = takes_own_value(dut, &entry);
        dut.fault(done)?;
    }
    Ok(())
}

fn takes_own_value(dut: &mut Dut<'_>, entry: &Entry) -> Checked {
    let bytes = match dut.upload(entry.address)? {
        Ok(bytes) if !bytes.is_empty() => bytes,
        _ => return Ok(()),
    };
    if let Err(code) = dut.download(entry.address, &bytes)?
        && !is_empty(code)
    {
        let name = values::label(dut.eds.dictionary(), entry.address);
        if let Some(why) = dut.eds.excludes(entry.address, &bytes, dut.node) {
            return fail(
                format!("a value that the EDS allows; {why}"),
                "the node has it",
            );
        }
        return fail(
            format!("{name} to take its own value {}", values::hex(&bytes)),
            abort_text(code),
        );
    }
    let after = dut.upload(entry.address)?;
    // Values that the device computes or counts may change.
    if entry.group != Group::None && after.as_ref().is_ok_and(|after| *after != bytes) {
        let name = values::label(dut.eds.dictionary(), entry.address);
        let got = after.unwrap_or_default();
        return fail(
            format!("{name} = {} again", values::hex(&bytes)),
            format!("{} was read", values::hex(&got)),
        );
    }
    Ok(())
}

pub(super) fn limits(dut: &mut Dut<'_>) -> Checked {
    let mut any = false;
    // Also a command of the application, which a value beyond its limits does not give; not one that moves a machine.
    let mut all = dut.eds.writable();
    let is_command = |entry: &Entry| {
        entry.address.index >= 0x2000
            && entry.access.writable()
            && entry.access.readable()
            && !dut.eds.moves(entry.address)
            && !all.contains(entry)
    };
    let commands: Vec<Entry> = dut.eds.dictionary().entries().filter(is_command).collect();
    all.extend(commands);
    for entry in all {
        for high in [true, false] {
            if let Some(bytes) = outside(&entry, high, dut.node.raw()) {
                any = true;
                let done = out_of_range(dut, &entry, &bytes, high);
                dut.fault(done)?;
            }
        }
    }
    at_least_one(any, "no object that can be written has limits")
}

/// A value at its limit is accepted.
pub(super) fn limits_reached(dut: &mut Dut<'_>) -> Checked {
    let node = dut.node.raw();
    let quiet = dut.eds.writable();
    let quiet = quiet.iter().filter(|entry| entry.address.index == 0x1017);
    for entry in quiet {
        let (low, high) = (entry.low.integer(node), entry.high.integer(node));
        for limit in [low, high].into_iter().flatten() {
            let size = entry.data_type.size().unwrap_or(2);
            dut.set(entry.address, &limit.to_le_bytes()[..size])?;
        }
    }
    Ok(())
}

/// Sub-index 0 of an ARRAY or RECORD is the highest sub-index, which exists; the next does not.
pub(super) fn sub_indices(dut: &mut Dut<'_>) -> Checked {
    let dictionary = dut.eds.dictionary();
    for object in dictionary.objects() {
        if !(0x1000..0xA000).contains(&object.index) {
            continue;
        }
        if !object.code.has_members() {
            let beyond = Address::new(object.index, 1);
            let done = dut.refuses(request(0x40, beyond, [0; 4]), &[NoSubIndex]);
            dut.fault(done)?;
            continue;
        }
        let members: Vec<Entry> = dictionary.members(&object).collect();
        let Some(first) = members.first().filter(|first| first.address.sub == 0) else {
            continue;
        };
        let Ok(count) = dut.upload(first.address)? else {
            continue;
        };
        let last = members.iter().rev().find(|entry| entry.address.sub < 0xFF);
        let highest = last.map_or(0, |entry| entry.address.sub);
        // In the history and the mappings sub-index 0 is the number of used entries. In all other
        // objects a sub-index 0 that no master can write is the highest sub-index, whether it is
        // `const` or `ro` in the EDS.
        let counts = matches!(object.index, 0x1003 | 0x1600..=0x17FF | 0x1A00..=0x1BFF);
        let is_fixed = match first.access {
            Access::Const => true,
            Access::Ro => !counts,
            _ => false,
        };
        if is_fixed {
            let done = ensure(
                count.first() == Some(&highest),
                format!(
                    "{highest} in {}, the highest sub-index of the EDS",
                    first.address
                ),
                format!("{} was read", values::hex(&count)),
            );
            dut.fault(done)?;
        }
        if highest < 0xFE {
            let beyond = Address::new(object.index, highest + 1);
            let done = dut.refuses(request(0x40, beyond, [0; 4]), &[NoSubIndex]);
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// Sub-index 255 does not exist, or describes the structure of the object.
pub(super) fn sub_index_255(dut: &mut Dut<'_>) -> Checked {
    for object in dut.eds.dictionary().objects() {
        if !(0x1000..0xA000).contains(&object.index) {
            continue;
        }
        let address = Address::new(object.index, 0xFF);
        let done = match dut.upload(address)? {
            Err(code) => ensure(
                code == NoSubIndex.code() || is_empty(code),
                format!("abort 06090011h for {address}, or its structure"),
                abort_text(code),
            ),
            Ok(bytes) => ensure(
                bytes.len() == 4 && bytes[0] == object.code.code(),
                format!("the structure in {address}, or abort 06090011h"),
                values::hex(&bytes),
            ),
        };
        dut.fault(done)?;
    }
    Ok(())
}

/// Sub-indices between those of the EDS do not exist.
pub(super) fn gaps(dut: &mut Dut<'_>) -> Checked {
    let dictionary = dut.eds.dictionary();
    let mut any = false;
    for object in dictionary.objects() {
        // An object of 254 sub-objects has its gaps by a count that the EDS need not repeat.
        if !object.code.has_members() || !(0x1000..0xA000).contains(&object.index) {
            continue;
        }
        let subs: Vec<u8> = dictionary
            .members(&object)
            .map(|entry| entry.address.sub)
            .collect();
        for pair in subs.windows(2) {
            let between = pair[0].saturating_add(1)..pair[1];
            for sub in between.filter(|_| pair[1] < 0xFF).take(4) {
                any = true;
                let address = Address::new(object.index, sub);
                let done = dut.refuses(request(0x40, address, [0; 4]), &[NoSubIndex]);
                dut.fault(done)?;
            }
        }
    }
    at_least_one(any, "no object of the EDS leaves a sub-index out")
}

/// Objects of CiA 301 that the EDS lacks do not exist.
pub(super) fn unlisted(dut: &mut Dut<'_>) -> Checked {
    for index in 0x1000..=0x102B {
        if !dut.eds.has(index)
            && let Ok(bytes) = dut.upload(Address::new(index, 0))?
        {
            dut.fault(fail(
                format!("no {index:04X}h, as the EDS has none"),
                format!("{} was read", values::hex(&bytes)),
            ))?;
        }
    }
    Ok(())
}

/// A constant has the value in the EDS.
pub(super) fn constants(dut: &mut Dut<'_>) -> Checked {
    defaults(dut, |entry| {
        entry.access == Access::Const && entry.address != Address::new(0x1018, 4)
    })
}

/// After a restore and a reset every value that a master can write is the default.
pub(super) fn after_restore(dut: &mut Dut<'_>) -> Checked {
    let before = super::store::backup(dut)?;
    let done = restored(dut);
    let back = super::store::bring_back(dut, &before);
    done.and(back)
}

fn restored(dut: &mut Dut<'_>) -> Checked {
    super::store::command(dut, 0x1011, 1, b"load")?;
    dut.reset(Command::ResetNode)?;
    defaults(dut, |entry| {
        entry.access.writable() && entry.access.readable() && entry.group != Group::None
    })
}

/// Compares values with the defaults of the EDS.
fn defaults(dut: &mut Dut<'_>, which: impl Fn(&Entry) -> bool) -> Checked {
    let node = dut.node;
    let all = entries(dut, 0x1000, 0x9FFF);
    for entry in all.into_iter().filter(which) {
        let Some(wanted) = dut.eds.default(&entry, node) else {
            continue;
        };
        match dut.upload(entry.address) {
            Ok(Ok(bytes)) => {
                let name = values::label(dut.eds.dictionary(), entry.address);
                // A node whose node ID was set keeps it.
                let is_own_id = bytes == [node.raw()] && name.to_ascii_lowercase().contains("node");
                let done = ensure(
                    bytes == wanted || is_own_id,
                    format!("{name} = {}, the default", values::hex(&wanted)),
                    format!("{} was read", values::hex(&bytes)),
                );
                dut.fault(done)?;
            }
            Ok(Err(code)) if is_empty(code) || code == NoObject.code() => {}
            Ok(Err(code)) => {
                let expected = format!("a value of {}", entry.address);
                dut.fault(fail(expected, abort_text(code)))?;
            }
            Err(End::Lost(fault)) => return Err(End::Lost(fault)),
            Err(other) => return Err(other),
        }
    }
    Ok(())
}

/// Communication objects that a case writes, with another value, to see whether other objects
/// change.
const WRITTEN: [(u16, u8); 11] = [
    (0x1017, 0),
    (0x100C, 0),
    (0x100D, 0),
    (0x1015, 0),
    (0x1016, 1),
    (0x1029, 1),
    (0x1800, 5),
    (0x1800, 2),
    (0x1800, 1),
    (0x1400, 2),
    (0x1400, 1),
];

/// A write changes only its own object.
pub(super) fn neighbours(dut: &mut Dut<'_>) -> Checked {
    let mut any = false;
    // Two values of the application that move nothing, beside those of communication.
    let own = dut.eds.writable().into_iter();
    let own = own.filter(|entry| {
        (0x2000..0xA000).contains(&entry.address.index) && entry.group != Group::None
    });
    let own: Vec<_> = own
        .map(|entry| (entry.address.index, entry.address.sub))
        .take(2)
        .collect();
    for (index, sub) in WRITTEN.into_iter().chain(own) {
        let address = Address::new(index, sub);
        if !dut.eds.writes(index, sub) {
            continue;
        }
        let Some((other, before)) = different(dut, address)? else {
            continue;
        };
        // Two readings: a value that differs between them changes without a write.
        let (first, second) = (snapshot(dut, index)?, snapshot(dut, index)?);
        dut.undo.push((address, before));
        if dut.download(address, &other)?.is_err() {
            continue;
        }
        any = true;
        let after = snapshot(dut, index)?;
        for (was, (again, is)) in first.iter().zip(second.iter().zip(&after)) {
            let moves = was.1 != again.1 || was.0 == address;
            if !moves && again.1 != is.1 {
                let eds = dut.eds;
                let name = |address| values::label(eds.dictionary(), address);
                let (expected, got) = (
                    format!("{} = {} still", name(was.0), values::hex(&was.1)),
                    format!(
                        "{} was read after a write of {}",
                        values::hex(&is.1),
                        name(address)
                    ),
                );
                dut.fault(fail(expected, got))?;
            }
        }
        // Compare before the next object, so that a fault belongs to one write.
        if let Some((address, before)) = dut.undo.pop() {
            dut.write(address, &before)?;
        }
    }
    at_least_one(any, "no parameter of communication can be changed")
}

/// Another value of an object, and its present one.
fn different(dut: &mut Dut<'_>, address: Address) -> Checked<Option<(Vec<u8>, Vec<u8>)>> {
    let Ok(before) = dut.upload(address)? else {
        return Ok(None);
    };
    let mut other = before.clone();
    // A restricted COB-ID could not be written back; another case finds it.
    if matches!(address.index, 0x1400..=0x15FF | 0x1800..=0x19FF) && address.sub == 1 {
        let cob_id = CobId::new(number(&before) as u32);
        if cob_id.is_restricted() || !cob_id.is_consistent() {
            return Ok(None);
        }
    }
    match (address.index, address.sub, &mut other[..]) {
        (0x1016, _, [time, ..]) => *time ^= 0x40,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 2, [kind]) => *kind = if *kind == 1 { 255 } else { 1 },
        // Bit 31: the PDO is not valid.
        (0x1400..=0x15FF | 0x1800..=0x19FF, 1, [.., flags]) if *flags & 0x80 == 0 => *flags |= 0x80,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 1, _) => return Ok(None),
        (0x1029, _, [class]) => *class = if *class == 1 { 0 } else { 1 },
        (0x2000.., _, [first, ..]) => *first ^= 1,
        (_, _, [first, ..]) => *first ^= 0x40,
        _ => return Ok(None),
    }
    let is_allowed = dut.eds.excludes(address, &other, dut.node).is_none();
    Ok(is_allowed.then_some((other, before)))
}

/// The readable values around an object: those of communication without counters and reports, or those of the application
/// that are saved. One may be another name of the other: 6200h of an encoder is the event timer of a TPDO (CiA 406).
fn snapshot(dut: &mut Dut<'_>, index: u16) -> Checked<Vec<(Address, Vec<u8>)>> {
    let (from, to) = if index < 0x2000 {
        (0x1005, 0x1FFF)
    } else {
        (0x2000, 0x9FFF)
    };
    let mut all = Vec::new();
    for entry in entries(dut, from, to) {
        let is_small = entry.data_type.size().is_some_and(|size| size <= 4);
        let is_kept = index < 0x2000 || entry.access.writable() && entry.group != Group::None;
        let is_program = (0x1F50..=0x1F5F).contains(&entry.address.index);
        if entry.access.readable() && is_small && is_kept && !is_program {
            let value = dut.upload(entry.address)?;
            all.push((entry.address, value.unwrap_or_default()));
        }
    }
    Ok(all)
}
