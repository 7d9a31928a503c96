//! RPDOs: values that a master sends.

use od_model::{Address, values};
use od_wire::nmt::Command;
use od_wire::{CobId, Frame};

use super::heartbeat::{emcy, sends_emcy};
use super::transmit::{Mapped, contradiction, is_on, learn_sync, mapping, sync};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, ensure, fail, lacks};

/// An RPDO that is on, and the first value that it writes.
struct Rpdo {
    com: u16,
    cob_id: u32,
    all: Vec<Mapped>,
}

/// The first RPDO that is on, with this transmission type.
fn first(dut: &mut Dut<'_>, kind: u8) -> Checked<Rpdo> {
    for pdo in dut.eds.pdos(0x1400) {
        let com = 0x1400 + pdo;
        let cob_id = dut.number(com, 1)? as u32;
        let all = mapping(dut, com + 0x200)?;
        let Some(one) = all.first().filter(|one| one.address.index >= 0x20) else {
            continue;
        };
        let entry = dut.eds.entry(one.address.index, one.address.sub);
        let fits = entry.is_some_and(|entry| entry.access.readable());
        let is_whole = all.iter().all(|one| one.bits % 8 == 0);
        let works = is_on(cob_id) && contradiction(dut.eds, &all, false).is_none();
        if !works || !fits || !is_whole {
            continue;
        }
        dut.keep(one.address)?;
        let address = Address::new(com, 2);
        dut.keep(address)?;
        if dut.download(address, &[kind])?.is_err() {
            return lacks(format!("the RPDO does not take transmission type {kind}"));
        }
        return Ok(Rpdo { com, cob_id, all });
    }
    lacks("no RPDO is on and writes a value that can be read")
}

impl Rpdo {
    fn value(&self) -> Address {
        self.all[0].address
    }

    /// The bytes with another first value, and this value.
    fn other(&self, dut: &mut Dut<'_>) -> Checked<(Vec<u8>, Vec<u8>)> {
        let mut bytes = Vec::new();
        for mapped in &self.all {
            let mut value = dut.upload(mapped.address)?.unwrap_or_default();
            value.resize(mapped.bits / 8, 0);
            bytes.extend(value);
        }
        bytes.truncate(8);
        if let Some(first) = bytes.first_mut() {
            *first ^= 1;
        }
        let value = bytes[..self.all[0].bits / 8].to_vec();
        Ok((bytes, value))
    }

    fn send(&self, dut: &mut Dut<'_>, bytes: &[u8]) -> Checked {
        match Frame::new(CobId::new(self.cob_id).can_id(), bytes) {
            Some(frame) => dut.send(frame)?,
            None => return Ok(()),
        }
        dut.wait(20_000)
    }

    fn holds(&self, dut: &mut Dut<'_>, wanted: &[u8], why: &str) -> Checked {
        let is = dut.read(self.value())?;
        ensure(
            is == wanted,
            format!("{} in {}{why}", values::hex(wanted), self.value()),
            format!("{} was read", values::hex(&is)),
        )
    }
}

pub(super) fn write(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    dut.nmt(Command::Start)?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &value, ", as the RPDO has it")
}

pub(super) fn not_in_pre_operational(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let before = dut.read(pdo.value())?;
    let (bytes, _) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, ", as the RPDO came in Pre-operational")?;
    dut.nmt(Command::Stop)?;
    pdo.send(dut, &bytes)?;
    dut.nmt(Command::EnterPreOperational)?;
    pdo.holds(dut, &before, ", as the RPDO came in Stopped")
}

pub(super) fn short(dut: &mut Dut<'_>) -> Checked {
    sends_emcy(dut)?;
    let pdo = first(dut, 255)?;
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, _) = pdo.other(dut)?;
    dut.drain()?;
    let Some(frame) = Frame::new(CobId::new(pdo.cob_id).can_id(), &bytes[..bytes.len() - 1]) else {
        return Ok(());
    };
    dut.send(frame)?;
    if emcy(dut, 0x8210, 200_000)?.is_none() && dut.eds.has(0x1014) {
        return fail("EMCY 8210h for an RPDO that is too short", "none came");
    }
    pdo.holds(dut, &before, ", as the RPDO was too short")?;
    // The next good one ends the error.
    let good = pdo.other(dut)?;
    pdo.send(dut, &good.0)
}

pub(super) fn synchronous(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let pdo = first(dut, 1)?;
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, value) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, " until SYNC")?;
    sync(dut)?;
    dut.wait(20_000)?;
    pdo.holds(dut, &value, " after SYNC")
}

pub(super) fn off(dut: &mut Dut<'_>) -> Checked {
    let pdo = first(dut, 255)?;
    let address = Address::new(pdo.com, 1);
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    dut.set(address, &(pdo.cob_id | 1 << 31).to_le_bytes())?;
    dut.nmt(Command::Start)?;
    let before = dut.read(pdo.value())?;
    let (bytes, _) = pdo.other(dut)?;
    pdo.send(dut, &bytes)?;
    pdo.holds(dut, &before, ", as the RPDO is off")
}
