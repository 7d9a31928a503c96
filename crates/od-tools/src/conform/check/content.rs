//! The content of TPDOs: the values that SDO reads.

use od_model::Address;
use od_wire::nmt::Command;
use od_wire::{CobId, Frame};

use super::each_tpdo::on_each;
use super::transmit::{
    Mapped, Tpdo, contradiction, is_on, learn_sync, mapping, next, sync, timed_on,
};
use crate::conform::dut::{Dut, QUIET};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail};
use crate::conform::sdo::{abort_text, number};

/// A value that does not change is the same by SDO and in the TPDO.
pub(super) fn content(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        carries_values(dut, pdo)?;
        change(dut, pdo)?;
        carries_values(dut, pdo)
    })
}

/// A TPDO that is sent by its event timer has the values that SDO reads.
pub(super) fn carries_values(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let all = mapping(dut, pdo.map())?;
    dut.nmt(Command::Start)?;
    // The start of the node may cause the first TPDO.
    next(dut, pdo, 500_000)?;
    let before = read(dut, &all)?;
    let Some(heard) = next(dut, pdo, 500_000)? else {
        return fail("a TPDO every 50 ms", "none came");
    };
    let after = read(dut, &all)?;
    has_values(&heard.frame, &all, &before, &after)
}

/// The frame has the values of its objects that did not change, before and after it.
fn has_values(
    frame: &Frame,
    all: &[Mapped],
    before: &[Option<u64>],
    after: &[Option<u64>],
) -> Checked {
    let bits: usize = all.iter().map(|mapped| mapped.bits).sum();
    ensure(
        usize::from(frame.dlc()) == bits.div_ceil(8),
        format!("{} bytes, as mapped", bits.div_ceil(8)),
        format!("{} came", frame),
    )?;
    let sent = fields(frame, all);
    for ((mapped, is), (before, after)) in all.iter().zip(sent).zip(before.iter().zip(after)) {
        let mask = mask_of(mapped);
        if let (Some(before), Some(after)) = (before, after)
            && before == after
        {
            ensure(
                is == before & mask,
                format!("{before:X}h of {} in the TPDO", mapped.address),
                format!("{is:X}h in {frame}"),
            )?;
        }
    }
    Ok(())
}

/// Gives other values to the mapped objects that a master can write, and returns them.
fn change(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked<Vec<Address>> {
    let entries = dut.eds.writable();
    let mut changed = Vec::new();
    for one in mapping(dut, pdo.map())? {
        if !entries.iter().any(|entry| entry.address == one.address) {
            continue;
        }
        dut.keep(one.address)?;
        let mut other = dut.read(one.address)?;
        // A value that has not been there before.
        if let Some(first) = other.first_mut() {
            *first = first.wrapping_add(1);
        }
        if dut.download(one.address, &other)?.is_ok() {
            changed.push(one.address);
        }
    }
    Ok(changed)
}

/// With type 252 a value that changes after SYNC is not in the TPDO before the next one.
fn keeps_sample(dut: &mut Dut<'_>, pdo: &Tpdo, len: usize, before: &[Option<u64>]) -> Checked {
    let all = mapping(dut, pdo.map())?;
    let changed = change(dut, pdo)?;
    dut.wait(20_000)?;
    dut.ask_for(pdo.id(), len as u8)?;
    let Some(heard) = next(dut, pdo, QUIET)? else {
        return Ok(());
    };
    let is_changed = |mapped: &Mapped| changed.contains(&mapped.address);
    let values = all.iter().zip(before);
    let sample: Vec<Option<u64>> = values
        .map(|(mapped, value)| value.filter(|_| is_changed(mapped)))
        .collect();
    has_values(&heard.frame, &all, &sample, &sample)
}

/// A value that goes on changing, such as the position of a turning shaft, changes in the TPDO, too.
pub(super) fn moving(dut: &mut Dut<'_>) -> Checked {
    const ROUNDS: usize = 6;
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, len| {
        let all = mapping(dut, pdo.map())?;
        let mut any = false;
        // By event timer, SYNC and remote frame.
        for kind in [255, 1, 253] {
            let is_remote = kind == 253;
            if is_remote && !CobId::new(pdo.cob_id).allows_rtr() {
                continue;
            }
            if kind != 255 {
                dut.keep(pdo.address(2))?;
                if dut.download(pdo.address(2), &[kind])?.is_err() {
                    continue;
                }
            } else if let Err(other) = timed_on(dut, pdo, 50) {
                match other {
                    End::NotApplicable(_) => continue,
                    other => return Err(other),
                }
            }
            dut.nmt(Command::Start)?;
            let (mut read_values, mut sent) = (Vec::new(), Vec::new());
            for _ in 0..ROUNDS {
                dut.wait(20_000)?;
                read_values.push(read(dut, &all)?);
                if kind == 1 {
                    sync(dut)?;
                } else if is_remote {
                    dut.ask_for(pdo.id(), len as u8)?;
                }
                if let Some(heard) = next(dut, pdo, 200_000)? {
                    sent.push(fields(&heard.frame, &all));
                }
            }
            dut.nmt(Command::EnterPreOperational)?;
            for (at, mapped) in all.iter().enumerate() {
                let moves = read_values
                    .windows(2)
                    .all(|pair| pair[0][at] != pair[1][at]);
                any |= moves;
                let is_same = sent.iter().all(|values| values[at] == sent[0][at]);
                if moves && is_same && sent.len() == ROUNDS {
                    let expected = format!(
                        "another value of {} in each TPDO{}, as SDO reads",
                        mapped.address,
                        pdo.com - 0x17FF
                    );
                    let got = format!("it had {:X}h each time", sent[0][at]);
                    dut.fault(fail(expected, got))?;
                }
            }
        }
        at_least_one(any, "no value of a TPDO goes on changing")
    })
}

/// The bits of a mapped value.
fn mask_of(mapped: &Mapped) -> u64 {
    u64::MAX >> (64 - mapped.bits.clamp(1, 64))
}

/// The values in a frame, in the order of the mapping.
fn fields(frame: &Frame, all: &[Mapped]) -> Vec<u64> {
    let carried = number(frame.data());
    let mut shift = 0;
    let field = |mapped: &Mapped| {
        let value = carried.checked_shr(shift).unwrap_or(0) & mask_of(mapped);
        shift += mapped.bits as u32;
        value
    };
    all.iter().map(field).collect()
}

/// By SYNC and by remote frame, too, a TPDO has the values of its objects: with type 252 those at the last SYNC.
pub(super) fn sampled(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    on_each(dut, |dut, pdo, len| {
        dut.keep(pdo.address(2))?;
        let all = mapping(dut, pdo.map())?;
        let mut any = false;
        for kind in [1u8, 252, 253] {
            let by_remote = kind != 1;
            if by_remote && !CobId::new(pdo.cob_id).allows_rtr()
                || dut.download(pdo.address(2), &[kind])?.is_err()
            {
                continue;
            }
            any = true;
            dut.nmt(Command::Start)?;
            for _ in 0..2 {
                change(dut, pdo)?;
                dut.wait(20_000)?;
                let before = read(dut, &all)?;
                if kind != 253 {
                    sync(dut)?;
                }
                if by_remote {
                    dut.ask_for(pdo.id(), len as u8)?;
                }
                // Without one, another case fails.
                if let Some(heard) = next(dut, pdo, QUIET)? {
                    let after = read(dut, &all)?;
                    let done = has_values(&heard.frame, &all, &before, &after);
                    dut.fault(done)?;
                    if kind == 252 {
                        let done = keeps_sample(dut, pdo, len, &before);
                        dut.fault(done)?;
                    }
                }
            }
            dut.nmt(Command::EnterPreOperational)?;
        }
        at_least_one(
            any,
            "the TPDO has none of the transmission types 1, 252 and 253",
        )
    })
}

/// The first TPDOs after a reset have the values that SDO reads, too.
pub(super) fn after_reset(dut: &mut Dut<'_>) -> Checked {
    for command in [Command::ResetNode, Command::ResetCommunication] {
        dut.reset(command)?;
        learn_sync(dut)?;
        on_each(dut, |dut, pdo, _| {
            timed_on(dut, pdo, 50)?;
            let done = carries_values(dut, pdo);
            dut.fault(done)?;
            dut.nmt(Command::EnterPreOperational)?;
            // A node need not have both kinds.
            if dut.download(pdo.address(2), &[1])?.is_err() {
                return Ok(());
            }
            dut.nmt(Command::Start)?;
            sync(dut)?;
            match next(dut, pdo, QUIET)? {
                Some(_) => Ok(()),
                None => fail(
                    format!("TPDO{} with the first SYNC after a reset", pdo.com - 0x17FF),
                    "none came",
                ),
            }
        })?;
    }
    Ok(())
}

/// Each TPDO carries the objects of a mapping that is as long as possible.
pub(super) fn full(dut: &mut Dut<'_>) -> Checked {
    inverts_inputs(dut)?;
    let mut any = false;
    // TPDOs that take an object twice, and those that do not.
    let (mut taken, mut refused) = (0, Vec::new());
    for number in dut.eds.pdos(0x1800) {
        let com = 0x1800 + number;
        let cob_id = dut.number(com, 1)? as u32;
        let pdo = Tpdo { com, cob_id };
        let all = mapping(dut, pdo.map())?;
        if !is_on(cob_id) || contradiction(dut.eds, &all, true).is_some() {
            continue;
        }
        let kept = dut.undo.len();
        let done = timed_on(dut, &pdo, 50).and_then(|()| {
            super::mapping::on(dut, pdo, |dut, map| {
                // The entries of its own mapping are still there.
                carries_each_length(dut, &pdo, all.len() as u8)?;
                match is_full(dut, &pdo, map)? {
                    None => taken += 1,
                    Some(why) => refused.push(why),
                }
                Ok(())
            })
        });
        if matches!(done, Err(End::Lost(_))) {
            return done;
        }
        dut.put_back_since(kept)?;
        match done {
            Err(End::NotApplicable(_)) => {}
            done => {
                dut.fault(done)?;
                any = true;
            }
        }
    }
    for (address, code) in refused.into_iter().filter(|_| taken > 0) {
        let expected = format!("{address} to take a mapping that another TPDO takes");
        dut.fault(fail(expected, abort_text(code)))?;
    }
    at_least_one(any, "no TPDO is on whose mapping can be written")
}

/// Inverts the digital inputs of a module, as an input that is 0 does not show whether a TPDO carries it.
fn inverts_inputs(dut: &mut Dut<'_>) -> Checked {
    if dut.eds.meets("cia401") != Some(true) {
        return Ok(());
    }
    let polarity = dut.eds.writable();
    let polarity = polarity
        .iter()
        .map(|entry| entry.address)
        .filter(|address| address.index == 0x6002);
    for address in polarity {
        let zeros = !dut.number(0x6000, address.sub)? as u8;
        let old = dut.keep(address)?.first().copied().unwrap_or(0);
        let _ = dut.download(address, &[old ^ zeros])?;
    }
    Ok(())
}

/// Maps as many objects as there is room for. A node need not take one object twice: returns where it refuses this.
fn is_full(dut: &mut Dut<'_>, pdo: &Tpdo, map: u16) -> Checked<Option<(Address, u32)>> {
    let count = Address::new(map, 0);
    let [twice, once] = super::mapping::fillings(dut, map);
    let mut refused = None;
    for entries in [twice, once] {
        let before = refused;
        refused = None;
        let mut writes: Vec<(Address, Vec<u8>)> = Vec::new();
        for (sub, entry) in (1..).zip(&entries) {
            writes.push((Address::new(map, sub), entry.to_le_bytes().to_vec()));
        }
        writes.push((count, vec![entries.len() as u8]));
        for (address, bytes) in writes {
            if let Err(code) = dut.download(address, &bytes)? {
                refused = Some((address, code));
                break;
            }
        }
        let Some((address, code)) = refused else {
            carries_each_length(dut, pdo, entries.len() as u8)?;
            return Ok(before);
        };
        if before.is_some() {
            return fail(
                format!("{address} to take a mapping that the EDS allows"),
                abort_text(code),
            );
        }
    }
    Ok(None)
}

/// The TPDO carries its whole open mapping, then its first objects only.
fn carries_each_length(dut: &mut Dut<'_>, pdo: &Tpdo, length: u8) -> Checked {
    for count in (1..=length).rev() {
        super::mapping::reopen(dut, pdo)?;
        dut.write(Address::new(pdo.map(), 0), &[count])?;
        dut.write(pdo.address(1), &pdo.cob_id.to_le_bytes())?;
        let done = carries_values(dut, pdo);
        if !matches!(done, Err(End::Lost(_))) {
            dut.nmt(Command::EnterPreOperational)?;
        }
        done?;
    }
    super::mapping::reopen(dut, pdo)
}

fn read(dut: &mut Dut<'_>, all: &[Mapped]) -> Checked<Vec<Option<u64>>> {
    let mut found = Vec::new();
    for mapped in all {
        let bytes = dut.upload(mapped.address)?;
        found.push(bytes.ok().map(|bytes| number(&bytes)));
    }
    Ok(found)
}
