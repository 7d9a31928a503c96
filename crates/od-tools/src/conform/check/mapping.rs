//! PDO mapping: the procedure of CiA 301, and refused mappings.

use od_model::{Address, Entry, values};
use od_wire::AbortCode::{
    DeviceState, Incompatible, Length, NoObject, NoSubIndex, NotMappable, PdoTooLong, SubZeroFirst,
    TooLong, UnsupportedAccess, ValueRange, ValueTooHigh,
};

use od_wire::nmt::Command;

use super::transmit::{Tpdo, contradiction, first, is_on, mapping, switch, timed};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::{abort_text, is_abort, request};

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

fn open(dut: &mut Dut<'_>) -> Checked<Open> {
    let pdo = variable(dut)?;
    opened(dut, pdo)
}

/// The entries of the mapping now.
pub(super) fn entries(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked<Vec<u32>> {
    let all = mapping(dut, pdo.map())?;
    Ok(all.iter().map(super::transmit::Mapped::raw).collect())
}

fn opened(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked<Open> {
    let entries = entries(dut, &pdo)?;
    reopen(dut, &pdo)?;
    Ok(Open { pdo, entries })
}

/// Makes a PDO with an open mapping not valid again, and its mapping empty.
pub(super) fn reopen(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    switch(dut, pdo, false)?;
    dut.write(Address::new(pdo.map(), 0), &[0])
}

/// Restores the mapping, and makes the PDO valid again.
fn close(dut: &mut Dut<'_>, open: &Open) -> Checked {
    let map = open.pdo.map();
    reopen(dut, &open.pdo)?;
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

pub(super) fn without_procedure(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut)?;
    refuses_without_procedure(dut, pdo, Entry::maps_to_tpdo)
}

/// Another entry is refused while sub-index 0 is not 0. The present entry changes nothing, so a node may accept it.
pub(super) fn refuses_without_procedure(
    dut: &mut Dut<'_>,
    pdo: Tpdo,
    fits: impl Fn(&Entry) -> bool,
) -> Checked {
    let pdo = changeable(dut, pdo)?;
    let entries = entries(dut, &pdo)?;
    let Some(first) = entries.first() else {
        return lacks("the PDO has no mapped object");
    };
    let mut others = dut.eds.dictionary().entries();
    let other = others.find(|entry| {
        let bits = raw(entry) & 0xFF;
        fits(entry) && raw(entry) != *first && (1..=first & 0xFF).contains(&bits)
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

pub(super) fn while_on(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut)?;
    refuses_while_on(dut, pdo)
}

/// Writing sub-index 0 of a valid PDO is refused, or 0 empties the PDO.
pub(super) fn refuses_while_on(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked {
    let pdo = changeable(dut, pdo)?;
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
    first(dut)?;
    each(dut, 0x1800, refuses_too_many)
}

/// The PDO refuses more mapped objects than its mapping has entries, and 65 to 253, which are reserved.
pub(super) fn refuses_too_many(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked {
    on(dut, pdo, |dut, map| {
        let codes = [
            PdoTooLong,
            ValueRange,
            ValueTooHigh,
            NotMappable,
            UnsupportedAccess,
            NoObject,
            NoSubIndex,
        ];
        let own = dut.eds.dictionary().entries();
        let own = own.filter(|entry| entry.address.index == map);
        let highest = own.map(|entry| entry.address.sub).max().unwrap_or(64);
        let mut counts = vec![highest.min(64) + 1, 65, 0x80, 0xFD];
        // FEh makes a multiplexed PDO, which needs a list of objects.
        if !(0x1FA0..=0x1FFF).any(|index| dut.eds.has(index)) {
            counts.push(0xFE);
        }
        for count in counts {
            dut.refuses_value(Address::new(map, 0), &[count], &codes)?;
        }
        Ok(())
    })
}

/// The longest object that a PDO may map according to the EDS and `may`.
fn longest(dut: &Dut<'_>, may: impl Fn(&Entry) -> bool) -> Option<Entry> {
    let entries = dut.eds.dictionary().entries();
    let bits = |entry: &Entry| {
        entry
            .data_type
            .bits()
            .filter(|bits| (8..=64).contains(bits))
    };
    let fits = |entry: &Entry| may(entry) && bits(entry).is_some();
    entries.filter(fits).max_by_key(bits)
}

/// A mapping entry for an object with its own length.
pub(super) fn raw(entry: &Entry) -> u32 {
    let Address { index, sub } = entry.address;
    let bits = entry.data_type.bits().unwrap_or(0);
    u32::from(index) << 16 | u32::from(sub) << 8 | u32::from(bits)
}

pub(super) fn too_long(dut: &mut Dut<'_>) -> Checked {
    first(dut)?;
    each(dut, 0x1800, |dut, pdo| {
        refuses_too_long(dut, pdo, Entry::maps_to_tpdo)
    })
}

/// The PDO refuses more than 64 bits.
pub(super) fn refuses_too_long(
    dut: &mut Dut<'_>,
    pdo: Tpdo,
    may: impl Fn(&Entry) -> bool,
) -> Checked {
    let pdo = changeable(dut, pdo)?;
    let Some(entry) = longest(dut, may) else {
        return lacks("no object can be mapped");
    };
    let bits = entry.data_type.bits().unwrap_or(8);
    let count = 64 / bits + 1;
    if !dut.eds.writes(pdo.map(), count) {
        return lacks("the mapping has no room for more than 64 bits of the first object");
    }
    on(dut, pdo, |dut, map| {
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
    first(dut)?;
    each(dut, 0x1800, refuses_missing)
}

/// The PDO refuses an object that the EDS does not have.
pub(super) fn refuses_missing(dut: &mut Dut<'_>, pdo: Tpdo) -> Checked {
    let Some(index) = dut.eds.absent(&[0x9FFF, 0x5FFF, 0x9FFE]) else {
        return lacks("the EDS has every object that could be missing");
    };
    refused_by(dut, pdo, u32::from(index) << 16 | 8)
}

pub(super) fn not_mappable(dut: &mut Dut<'_>) -> Checked {
    let entry = dut.eds.entry(0x1000, 0).filter(|entry| !entry.mappable);
    match entry {
        Some(entry) => {
            first(dut)?;
            each_refuses(dut, 0x1800, raw(&entry))
        }
        None => lacks("the EDS lets a TPDO carry 1000h"),
    }
}

pub(super) fn wrong_length(dut: &mut Dut<'_>) -> Checked {
    first(dut)?;
    each(dut, 0x1800, |dut, pdo| {
        refuses_wrong_length(dut, pdo, Entry::maps_to_tpdo)
    })
}

/// The PDO refuses more bits than an object has.
pub(super) fn refuses_wrong_length(
    dut: &mut Dut<'_>,
    pdo: Tpdo,
    may: impl Fn(&Entry) -> bool,
) -> Checked {
    let mut entries = dut.eds.dictionary().entries();
    let fits = |entry: &Entry| may(entry) && matches!(entry.data_type.bits(), Some(8 | 16 | 32));
    match entries.find(fits) {
        // Twice its length: the low byte of the entry.
        Some(entry) => refused_by(dut, pdo, raw(&entry) + (raw(&entry) & 0xFF)),
        None => lacks("no object of 8, 16 or 32 bits can be mapped"),
    }
}

/// Every valid PDO from the communication parameter `base` on refuses this mapping entry.
pub(super) fn each_refuses(dut: &mut Dut<'_>, base: u16, entry: u32) -> Checked {
    each(dut, base, |dut, pdo| refused_by(dut, pdo, entry))
}

/// Tests every valid PDO from the communication parameter `base` on. The case applies if it applies to one of them.
pub(super) fn each(
    dut: &mut Dut<'_>,
    base: u16,
    test: impl Fn(&mut Dut<'_>, Tpdo) -> Checked,
) -> Checked {
    let mut any = false;
    for number in dut.eds.pdos(base) {
        let com = base + number;
        let cob_id = dut.number(com, 1)? as u32;
        let all = mapping(dut, com + 0x200)?;
        if !is_on(cob_id) || contradiction(dut.eds, &all, base == 0x1800).is_some() {
            continue;
        }
        match test(dut, Tpdo { com, cob_id }) {
            Err(End::NotApplicable(_)) => {}
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    at_least_one(any, "the mapping cannot be written")
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
        let codes = [
            NotMappable,
            NoObject,
            NoSubIndex,
            PdoTooLong,
            Length,
            TooLong,
        ];
        let first = Address::new(map, 1);
        match dut.download(first, &entry.to_le_bytes())? {
            Ok(()) => return dut.refuses_value(Address::new(map, 0), &[1], &codes),
            Err(_) => dut.refuses_value(first, &entry.to_le_bytes(), &codes)?,
        }
        // A node that refuses it there refuses it in every other place.
        let shown = format!("as {map:04X}h:01 refuses it");
        for sub in (2..=64).take_while(|sub| dut.eds.writes(map, *sub)) {
            dut.cannot_change(Address::new(map, sub), &entry.to_le_bytes(), &shown)?;
        }
        Ok(())
    })
}

/// The objects of another mapping are in the TPDO.
pub(super) fn new_mapping(dut: &mut Dut<'_>) -> Checked {
    let Some(entry) = longest(dut, Entry::maps_to_tpdo) else {
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
        Some(entry) => {
            first(dut)?;
            each_refuses(dut, 0x1800, raw(&entry))
        }
        None => lacks("every object that an RPDO may carry a TPDO may carry, too"),
    }
}

/// A TPDO refuses the dummy entry 0005h.
pub(super) fn dummy(dut: &mut Dut<'_>) -> Checked {
    refused_entry(dut, DUMMY)
}

/// A mapping entry for a dummy of 8 bits.
pub(super) const DUMMY: u32 = 0x0005_0008;

/// The mappings of the other TPDOs: number of objects and first entry.
fn others(dut: &mut Dut<'_>, map: u16) -> Checked<Vec<(Address, Vec<u8>)>> {
    let mut all = Vec::new();
    for pdo in dut.eds.pdos(0x1800) {
        for sub in [0, 1] {
            let address = Address::new(0x1A00 + pdo, sub);
            if address.index != map
                && dut.eds.entry(address.index, sub).is_some()
                && let Ok(bytes) = dut.upload(address)?
            {
                all.push((address, bytes));
            }
        }
    }
    Ok(all)
}

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
        let neighbours = others(dut, map)?;
        if dut
            .download(Address::new(map, 1), &entry.to_le_bytes())?
            .is_err()
        {
            return lacks(format!(
                "the node does not accept a mapping of only {address}"
            ));
        }
        dut.write(Address::new(map, 0), &[1])?;
        for ((other, was), (_, is)) in neighbours.iter().zip(others(dut, map)?) {
            ensure(
                *was == is,
                format!("{other} = {} still", values::hex(was)),
                format!("{} was read after a write of {map:04X}h", values::hex(&is)),
            )?;
        }
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
            format!("a TPDO of {len} bytes with only {address}"),
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

/// An object and its value.
type Constant = (Entry, Vec<u8>);

/// Objects of 8, 16 or 32 bits that a TPDO may map, with their values; those whose value changes are left out.
fn constant(dut: &mut Dut<'_>) -> Checked<Vec<Constant>> {
    const MOST: usize = 40;
    let fits = |entry: &Entry| {
        entry.maps_to_tpdo()
            && entry.access.readable()
            && matches!(entry.data_type.bits(), Some(8 | 16 | 32))
    };
    let entries: Vec<Entry> = dut.eds.dictionary().entries().filter(fits).collect();
    let mut all = Vec::new();
    for entry in entries.into_iter().take(MOST) {
        if let Ok(before) = dut.upload(entry.address)?
            && dut.upload(entry.address)?.as_ref() == Ok(&before)
        {
            all.push((entry, before));
        }
    }
    Ok(all)
}

/// Two objects follow each other in a TPDO in the order of its mapping.
pub(super) fn order(dut: &mut Dut<'_>) -> Checked {
    let pdo = timed(dut, 50)?;
    if !dut.eds.writes(pdo.map(), 2) {
        return lacks("the mapping has no room for two objects");
    }
    let all = constant(dut)?;
    let bits = |entry: &Entry| raw(entry) & 0xFF;
    // The other order has other bytes.
    let differs = |one: &Constant, other: &Constant| {
        one.0.address != other.0.address
            && bits(&one.0) + bits(&other.0) <= 64
            && [&one.1[..], &other.1].concat() != [&other.1[..], &one.1].concat()
    };
    let mut pairs = all
        .iter()
        .flat_map(|one| all.iter().map(move |other| (one, other)));
    let Some((one, other)) = pairs.find(|(one, other)| differs(one, other)) else {
        return lacks("no two objects with different values can be mapped");
    };
    let (id, com, cob_id) = (pdo.id(), pdo.address(1), pdo.cob_id);
    let places = format!("{} and {}", one.0.address, other.0.address);
    on(dut, pdo, |dut, map| {
        for (sub, (entry, _)) in (1..).zip([one, other]) {
            if dut
                .download(Address::new(map, sub), &raw(entry).to_le_bytes())?
                .is_err()
            {
                return lacks(format!("the node does not map {places} together"));
            }
        }
        dut.write(Address::new(map, 0), &[2])?;
        dut.write(com, &cob_id.to_le_bytes())?;
        dut.nmt(Command::Start)?;
        let is_it = |frame: &od_wire::Frame| frame.id() == id && !frame.is_remote();
        // The start of the node may cause the first TPDO.
        dut.next(500_000, is_it)?;
        let heard = dut.next(500_000, is_it)?;
        let mut wanted = Vec::new();
        for (entry, _) in [one, other] {
            wanted.extend(dut.upload(entry.address)?.unwrap_or_default());
        }
        dut.nmt(Command::EnterPreOperational)?;
        let Some(heard) = heard else {
            return fail("a TPDO every 50 ms with the new mapping", "none came");
        };
        ensure(
            heard.frame.data() == wanted,
            format!(
                "{} in the TPDO, the values of {places}",
                values::hex(&wanted)
            ),
            format!("{} came", heard.frame),
        )
    })
}

/// Greatest number of objects that a case maps one after the other.
const MANY: usize = 256;

/// The PDO accepts each object that it may map according to the EDS, as its only one.
pub(super) fn takes_each(dut: &mut Dut<'_>, pdo: Tpdo, may: impl Fn(&Entry) -> bool) -> Checked {
    let fits =
        |entry: &Entry| may(entry) && matches!(entry.data_type.bits(), Some(8 | 16 | 32 | 64));
    let entries: Vec<Entry> = dut
        .eds
        .dictionary()
        .entries()
        .filter(fits)
        .take(MANY)
        .collect();
    on(dut, pdo, |dut, map| {
        let count = Address::new(map, 0);
        for entry in &entries {
            let place = Address::new(map, 1);
            let mut done = dut.download(place, &raw(entry).to_le_bytes())?;
            if done.is_ok() {
                done = dut.download(count, &[1])?;
                dut.write(count, &[0])?;
            }
            if let Err(code) = done {
                let expected = format!(
                    "{:08X}h in {place}, as the EDS lets a PDO carry {}",
                    raw(entry),
                    entry.address
                );
                dut.fault(fail(expected, format!("{} came", abort_text(code))))?;
            }
        }
        Ok(())
    })
}

/// A TPDO takes each object that the EDS lets it carry.
pub(super) fn each_mapped(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut)?;
    takes_each(dut, pdo, Entry::maps_to_tpdo)
}

/// Mappings for a PDO, with as many objects as there is room for; the first one may have an object twice.
pub(super) fn fillings(dut: &Dut<'_>, map: u16) -> [Vec<u32>; 2] {
    let transmits = map >= 0x1A00;
    let entries = dut.eds.dictionary().entries();
    let own = entries.filter(|entry| entry.address.index == map && entry.access.writable());
    let room = own
        .map(|entry| entry.address.sub)
        .max()
        .unwrap_or(0)
        .min(64);
    let may = |entry: &Entry| {
        let is_its = if transmits {
            entry.maps_to_tpdo()
        } else {
            entry.maps_to_rpdo()
        };
        is_its && matches!(entry.data_type.bits(), Some(8 | 16 | 32))
    };
    let mut all: Vec<u32> = dut
        .eds
        .dictionary()
        .entries()
        .filter(may)
        .map(|entry| raw(&entry))
        .collect();
    all.sort_by_key(|raw| raw & 0xFF);
    let fit = |times: usize| {
        let mut bits = 0;
        let mut fitting = Vec::new();
        for raw in all.iter().cycle().take(times * all.len()) {
            if fitting.len() < usize::from(room) && bits + (raw & 0xFF) <= 64 {
                bits += raw & 0xFF;
                fitting.push(*raw);
            }
        }
        fitting
    };
    [fit(64), fit(1)]
}
