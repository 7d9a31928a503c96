//! PDO mapping: the procedure of CiA 301, and refused mappings.

use od_model::{Address, Entry, values};
use od_wire::AbortCode::{
    DeviceState, Incompatible, NoObject, NoSubIndex, NotMappable, PdoTooLong, SubZeroFirst,
    UnsupportedAccess, ValueRange, ValueTooHigh,
};

use od_wire::nmt::Command;

use super::transmit::{Tpdo, first, mapping, timed};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::sdo::{is_abort, request};

/// Makes the first TPDO not valid and its mapping empty; [`close`] restores both.
struct Open {
    pdo: Tpdo,
    entries: Vec<u32>,
}

fn variable(dut: &mut Dut<'_>) -> Checked<Tpdo> {
    let pdo = first(dut)?;
    changeable(dut, pdo)
}

/// The PDO, if its mapping and COB-ID can be written.
fn changeable(dut: &Dut<'_>, pdo: Tpdo) -> Checked<Tpdo> {
    if !dut.eds.writes(pdo.map(), 0) || !dut.eds.writes(pdo.map(), 1) {
        return lacks("the mapping cannot be written");
    }
    Ok(pdo)
}

fn switch(dut: &mut Dut<'_>, pdo: &Tpdo, on: bool) -> Checked {
    let bit = if on { 0 } else { 1 << 31 };
    dut.write(pdo.address(1), &(pdo.cob_id | bit).to_le_bytes())
}

fn open(dut: &mut Dut<'_>) -> Checked<Open> {
    let pdo = variable(dut)?;
    opened(dut, pdo)
}

/// The entries of the mapping now.
fn entries(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked<Vec<u32>> {
    let all = mapping(dut, pdo.map())?;
    let raw = |mapped: &super::transmit::Mapped| {
        let Address { index, sub } = mapped.address;
        u32::from(index) << 16 | u32::from(sub) << 8 | mapped.bits as u32
    };
    Ok(all.iter().map(raw).collect())
}

fn opened(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked<Open> {
    let entries = entries(dut, &pdo)?;
    switch(dut, &pdo, false)?;
    dut.write(Address::new(pdo.map(), 0), &[0])?;
    Ok(Open { pdo, entries })
}

/// Restores the mapping, and makes the PDO valid again.
fn close(dut: &mut Dut<'_>, open: &Open) -> Checked {
    let map = open.pdo.map();
    switch(dut, &open.pdo, false)?;
    dut.write(Address::new(map, 0), &[0])?;
    for (sub, entry) in (1..).zip(&open.entries) {
        dut.write(Address::new(map, sub), &entry.to_le_bytes())?;
    }
    dut.write(Address::new(map, 0), &[open.entries.len() as u8])?;
    switch(dut, &open.pdo, true)?;
    dut.notes.push(format!("put back the mapping {map:04X}h"));
    Ok(())
}

/// Runs a test with an open mapping, and closes it again.
fn with(dut: &mut Dut<'_>, test: impl FnOnce(&mut Dut<'_>, u16) -> Checked) -> Checked {
    let pdo = variable(dut)?;
    on(dut, pdo, test)
}

/// Runs a test with the open mapping of this PDO, and closes it again.
pub(super) fn on(
    dut: &mut Dut<'_>,
    pdo: Tpdo,
    test: impl FnOnce(&mut Dut<'_>, u16) -> Checked,
) -> Checked {
    let pdo = changeable(dut, pdo)?;
    let open = opened(dut, pdo)?;
    let done = test(dut, open.pdo.map());
    if let Err(End::Lost(_)) = done {
        return done;
    }
    let closed = close(dut, &open);
    done.and(closed)
}

pub(super) fn procedure(dut: &mut Dut<'_>) -> Checked {
    let open = open(dut)?;
    close(dut, &open)?;
    let all = mapping(dut, open.pdo.map())?;
    ensure(
        all.len() == open.entries.len(),
        format!("{} mapped objects", open.entries.len()),
        format!("{} are mapped", all.len()),
    )
}

/// Another entry is refused while sub-index 0 is not 0. The present entry changes nothing, so a node may accept it.
pub(super) fn without_procedure(dut: &mut Dut<'_>) -> Checked {
    let pdo = variable(dut)?;
    let entries = entries(dut, &pdo)?;
    let Some(first) = entries.first() else {
        return lacks("the TPDO has no mapped object");
    };
    let mut others = dut.eds.dictionary().entries();
    let other = others.find(|entry| {
        let bits = raw(entry) & 0xFF;
        entry.maps_to_tpdo() && raw(entry) != *first && (1..=first & 0xFF).contains(&bits)
    });
    let Some(other) = other else {
        return lacks("no other object of this length can be mapped");
    };
    let codes = [
        UnsupportedAccess,
        NotMappable,
        SubZeroFirst,
        DeviceState,
        Incompatible,
    ];
    switch(dut, &pdo, false)?;
    let entry = raw(&other).to_le_bytes();
    let done = dut.refuses_value(Address::new(pdo.map(), 1), &entry, &codes);
    if let Err(End::Lost(_)) = done {
        return done;
    }
    close(dut, &Open { pdo, entries })?;
    done
}

/// Writing sub-index 0 of a valid PDO is refused, or 0 empties the PDO.
pub(super) fn while_on(dut: &mut Dut<'_>) -> Checked {
    let pdo = variable(dut)?;
    let zero = Address::new(pdo.map(), 0);
    let count = dut.read(zero)?;
    let codes = [UnsupportedAccess, NotMappable, DeviceState, Incompatible];
    match dut.download(zero, &[0])? {
        Err(code) => is_abort(&request(0x80, zero, code.to_le_bytes()), &codes),
        Ok(()) => {
            dut.undo.push((zero, count));
            let is = dut.number(pdo.map(), 0)?;
            ensure(
                is == 0,
                "an abort, or 0 mapped objects",
                format!("{is} are mapped"),
            )
        }
    }
}

pub(super) fn too_many(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, map| {
        let codes = [
            PdoTooLong,
            ValueRange,
            ValueTooHigh,
            NotMappable,
            UnsupportedAccess,
            NoObject,
            NoSubIndex,
        ];
        dut.refuses_value(Address::new(map, 0), &[65], &codes)
    })
}

/// The longest object that a TPDO may map according to the EDS.
fn mappable(dut: &Dut<'_>) -> Option<Entry> {
    let entries = dut.eds.dictionary().entries();
    let bits = |entry: &Entry| {
        entry
            .data_type
            .bits()
            .filter(|bits| (8..=64).contains(bits))
    };
    let fits = |entry: &Entry| entry.maps_to_tpdo() && bits(entry).is_some();
    entries.filter(fits).max_by_key(bits)
}

/// A mapping entry for an object with its own length.
pub(super) fn raw(entry: &Entry) -> u32 {
    let Address { index, sub } = entry.address;
    let bits = entry.data_type.bits().unwrap_or(0);
    u32::from(index) << 16 | u32::from(sub) << 8 | u32::from(bits)
}

pub(super) fn too_long(dut: &mut Dut<'_>) -> Checked {
    let Some(entry) = mappable(dut) else {
        return lacks("no object can be mapped");
    };
    let bits = entry.data_type.bits().unwrap_or(8);
    let count = 64 / bits + 1;
    let pdo = variable(dut)?;
    if !dut.eds.writes(pdo.map(), count) {
        return lacks("the mapping has no room for more than 64 bits of the first object");
    }
    with(dut, |dut, map| {
        for sub in 1..=count {
            let address = Address::new(map, sub);
            // Some servers refuse the entry itself.
            match dut.download(address, &raw(&entry).to_le_bytes())? {
                Ok(()) => {}
                Err(code) if sub > 1 && code == PdoTooLong.code() => return Ok(()),
                Err(_) => return lacks("the node does not map one object twice"),
            }
        }
        dut.refuses_value(Address::new(map, 0), &[count], &[PdoTooLong])
    })
}

pub(super) fn missing_object(dut: &mut Dut<'_>) -> Checked {
    let Some(index) = dut.eds.absent(&[0x9FFF, 0x5FFF, 0x9FFE]) else {
        return lacks("the EDS has every object that could be missing");
    };
    refused_entry(dut, u32::from(index) << 16 | 8)
}

pub(super) fn not_mappable(dut: &mut Dut<'_>) -> Checked {
    let entry = dut.eds.entry(0x1000, 0).filter(|entry| !entry.mappable);
    match entry {
        Some(entry) => refused_entry(dut, raw(&entry)),
        None => lacks("the EDS lets a TPDO carry 1000h"),
    }
}

/// The node refuses a mapping entry that no TPDO may have, at once or with the number of entries.
fn refused_entry(dut: &mut Dut<'_>, entry: u32) -> Checked {
    let pdo = variable(dut)?;
    refused_by(dut, pdo, entry)
}

/// The node refuses a mapping entry that this PDO may not have, at once or with the number of
/// entries.
pub(super) fn refused_by(dut: &mut Dut<'_>, pdo: Tpdo, entry: u32) -> Checked {
    on(dut, pdo, |dut, map| {
        let codes = [NotMappable, NoObject, NoSubIndex];
        let first = Address::new(map, 1);
        match dut.download(first, &entry.to_le_bytes())? {
            Ok(()) => dut.refuses_value(Address::new(map, 0), &[1], &codes),
            Err(_) => dut.refuses_value(first, &entry.to_le_bytes(), &codes),
        }
    })
}

/// The objects of another mapping are in the TPDO.
pub(super) fn new_mapping(dut: &mut Dut<'_>) -> Checked {
    let Some(entry) = mappable(dut) else {
        return lacks("no object can be mapped");
    };
    with(dut, |dut, map| {
        dut.write(Address::new(map, 1), &raw(&entry).to_le_bytes())?;
        dut.write(Address::new(map, 0), &[1])?;
        let is = dut.number(map, 1)?;
        ensure(
            is == u64::from(raw(&entry)),
            format!("{:08X}h in {map:04X}h:01", raw(&entry)),
            format!("{is:08X}h was read"),
        )
    })
}

/// A TPDO refuses an object that only RPDOs may map.
pub(super) fn direction(dut: &mut Dut<'_>) -> Checked {
    let mut entries = dut.eds.dictionary().entries();
    let is_output = |entry: &Entry| {
        entry.maps_to_rpdo() && !entry.maps_to_tpdo() && entry.data_type.bits().is_some()
    };
    match entries.find(is_output) {
        Some(entry) => refused_entry(dut, raw(&entry)),
        None => lacks("every object that an RPDO may carry a TPDO may carry, too"),
    }
}

/// A TPDO refuses the dummy entry 0005h.
pub(super) fn dummy(dut: &mut Dut<'_>) -> Checked {
    refused_entry(dut, DUMMY)
}

/// A mapping entry for a dummy of 8 bits.
pub(super) const DUMMY: u32 = 0x0005_0008;

/// A TPDO contains the objects of a new mapping.
pub(super) fn sent(dut: &mut Dut<'_>) -> Checked {
    let pdo = timed(dut, 50)?;
    let now = mapping(dut, pdo.map())?;
    let bits: usize = now.iter().map(|mapped| mapped.bits).sum();
    let entries: Vec<Entry> = dut.eds.dictionary().entries().collect();
    let other = entries.iter().find(|entry| {
        let own = entry.data_type.bits().map_or(0, usize::from);
        entry.maps_to_tpdo() && own.is_multiple_of(8) && own > 0 && own <= 64 && own != bits
    });
    let Some(other) = other else {
        return lacks("no object of another length can be mapped");
    };
    let (entry, address) = (raw(other), other.address);
    let len = usize::from(other.data_type.bits().unwrap_or(0)).div_ceil(8);
    let id = pdo.id();
    let cob_id = pdo.cob_id;
    let com = pdo.address(1);
    on(dut, pdo, |dut, map| {
        if dut
            .download(Address::new(map, 1), &entry.to_le_bytes())?
            .is_err()
        {
            return lacks(format!("the node does not map {address} alone"));
        }
        dut.write(Address::new(map, 0), &[1])?;
        dut.write(com, &cob_id.to_le_bytes())?;
        dut.nmt(Command::Start)?;
        let before = dut.upload(address)?;
        // The start of the node may cause the first TPDO.
        dut.next(500_000, |frame| frame.id() == id && !frame.is_remote())?;
        let heard = dut.next(500_000, |frame| frame.id() == id && !frame.is_remote())?;
        let after = dut.upload(address)?;
        dut.nmt(Command::EnterPreOperational)?;
        let Some(heard) = heard else {
            return fail("a TPDO every 50 ms with the new mapping", "none came");
        };
        let got = format!("{} came", heard.frame);
        ensure(
            usize::from(heard.frame.dlc()) == len,
            format!("a TPDO of {len} bytes, {address} alone"),
            got.clone(),
        )?;
        match (before, after) {
            (Ok(before), Ok(after)) if before == after => ensure(
                heard.frame.data() == before,
                format!("{} of {address} in the TPDO", values::hex(&before)),
                got,
            ),
            _ => Ok(()),
        }
    })
}
