//! Objects of the manufacturer that the manuals of the built-in encoders describe. A case looks at the numbers of the
//! product first, since other devices have other objects there.

use od_model::{Address, values};
use od_wire::nmt::Command;

use super::each_tpdo::on_each;
use super::transmit::{learn_sync, next, sync, timed_on, typed_on};
use crate::conform::dut::{Dut, QUIET};
use crate::conform::end::{Checked, at_least_one, ensure, fail, lacks};

/// Vendor and products of a manual.
pub(super) type Makers = (u64, &'static [u64]);

/// GX families: manual 000.
const GX: Makers = (0xEC, &[0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F]);
/// EAM: manual 001.
pub(super) const EAM: Makers = (0x5F, &[0x70, 0x71]);
/// The built-in module of inputs and outputs.
pub(super) const IO: Makers = (0x5F, &[0x401]);
/// EN580C: manual 003.
pub(super) const EN: Makers = (0x5F, &[0x76]);

pub(super) fn is_of(dut: &mut Dut<'_>, makers: &[Makers]) -> Checked {
    let (vendor, product) = (dut.number(0x1018, 1)?, dut.number(0x1018, 2)?);
    let is_one = |(own, products): &Makers| *own == vendor && products.contains(&product);
    if makers.iter().any(is_one) {
        Ok(())
    } else {
        lacks("the object is that of another product")
    }
}

/// A repeat counter limits how often a TPDO is sent while its value stays the same.
pub(super) fn repeats(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[GX])?;
    on_each(dut, |dut, pdo, _| {
        let counter = Address::new(pdo.com + 0x1000, 0);
        dut.keep(counter)?;
        timed_on(dut, pdo, 50)?;
        for (count, least, most) in [(3u8, 1, 4), (1, 0, 2), (0, 5, 100)] {
            dut.write(counter, &[count])?;
            dut.nmt(Command::Start)?;
            let until = dut.now().plus_millis(600);
            let (mut last, mut same, mut other) = (None, 0, 0);
            while let Some(heard) = dut.receive(until)? {
                if pdo.carries(&heard.frame) {
                    let data = heard.frame.data().to_vec();
                    match last.replace(data.clone()) {
                        Some(before) if before == data => same += 1,
                        before => other += u32::from(before.is_some()),
                    }
                }
            }
            dut.nmt(Command::EnterPreOperational)?;
            if other > same {
                return lacks("the shaft turns");
            }
            let done = ensure(
                (least..=most).contains(&same),
                format!(
                    "TPDO{} with the same value {least} to {most} times in 600 ms, as {counter} is {count}",
                    pdo.com - 0x17FF
                ),
                format!("it came {same} times"),
            );
            dut.fault(done)?;
        }
        Ok(())
    })
}

/// With bits 6 and 7 of 2110h, and not with one of them, the node sends synchronous TPDOs only.
pub(super) fn sync_only(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[GX])?;
    learn_sync(dut)?;
    let options = Address::new(0x2110, 0);
    let own = dut.keep(options)?;
    on_each(dut, |dut, pdo, _| {
        let number = pdo.com - 0x17FF;
        timed_on(dut, pdo, 50)?;
        for (bits, wanted) in [(0, true), (0x40, true), (0x80, true), (0xC0, false)] {
            let mut bytes = own.clone();
            if let Some(first) = bytes.first_mut() {
                *first = *first & 0x3F | bits;
            }
            dut.write(options, &bytes)?;
            dut.nmt(Command::Start)?;
            dut.drain()?;
            let came = next(dut, pdo, 300_000)?.is_some();
            dut.nmt(Command::EnterPreOperational)?;
            let which = if wanted { "the" } else { "no" };
            let done = ensure(
                came == wanted,
                format!(
                    "{which} TPDO{number} by its event timer, with {bits:02X}h in bits 6 and 7 of 2110h"
                ),
                if came { "it came" } else { "none came" },
            );
            dut.fault(done)?;
        }
        typed_on(dut, pdo, 1)?;
        dut.nmt(Command::Start)?;
        dut.drain()?;
        sync(dut)?;
        let came = next(dut, pdo, QUIET)?.is_some();
        dut.nmt(Command::EnterPreOperational)?;
        dut.write(options, &own)?;
        ensure(
            came,
            format!("TPDO{number} with SYNC, with C0h in bits 6 and 7 of 2110h"),
            "none came",
        )
    })
}

/// Each customer data object keeps all its bits, and changes no other one.
pub(super) fn customer_data(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[GX, EAM, EN])?;
    let entries: Vec<_> = dut.eds.dictionary().entries().collect();
    let is_one = |address: Address| address.index == 0x2300 && address.sub > 0;
    let all: Vec<Address> = entries
        .iter()
        .filter(|entry| is_one(entry.address) && entry.access.writable())
        .map(|entry| entry.address)
        .collect();
    for round in [0x5A_u8, 0xA5] {
        let mut written = Vec::new();
        for address in &all {
            let len = dut.keep(*address)?.len();
            let value = vec![round ^ address.sub; len];
            dut.write(*address, &value)?;
            written.push((*address, value));
        }
        for (address, value) in written {
            let done = dut.is_as_written(address, &value);
            dut.fault(done)?;
        }
    }
    at_least_one(!all.is_empty(), "the EDS has no customer data")
}

/// The time stamp of the position, and the time since boot-up, go on.
pub(super) fn clocks(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[EAM, EN])?;
    let clocks = [Address::new(0x2120, 0), Address::new(0x2A00, 1)];
    let mut any = false;
    for clock in clocks {
        if dut.eds.entry(clock.index, clock.sub).is_none() {
            continue;
        }
        any = true;
        let first = dut.read(clock)?;
        let mut is_new = false;
        for _ in 0..5 {
            dut.wait(501_000)?;
            is_new |= dut.read(clock)? != first;
        }
        if !is_new {
            let got = format!("{} was read each time", values::hex(&first));
            dut.fault(fail(format!("another value of {clock} after 2.5 s"), got))?;
        }
    }
    at_least_one(any, "the EDS has neither 2120h nor 2A00h")
}

/// Operating times in seconds go on like a clock. The number of operating cycles counts each power-on, but no NMT reset, and
/// the time since boot-up begins again.
pub(super) fn records(dut: &mut Dut<'_>) -> Checked {
    const SINCE_BOOT_UP: Address = Address::new(0x2A00, 1);
    const CYCLES: Address = Address::new(0x2A01, 0);
    is_of(dut, &[GX, EN])?;
    let is_there = |dut: &Dut<'_>, at: Address| dut.eds.entry(at.index, at.sub).is_some();
    let mut times = vec![
        SINCE_BOOT_UP,
        Address::new(0x2A00, 2),
        Address::new(0x2201, 2),
    ];
    times.retain(|at| is_there(dut, *at));
    let mut before = Vec::new();
    for at in &times {
        before.push(dut.number(at.index, at.sub)?);
    }
    dut.wait(5_000_000)?;
    for (at, before) in times.iter().zip(before) {
        let is = dut.number(at.index, at.sub)?;
        let done = ensure(
            is.wrapping_sub(before).abs_diff(5) <= 1,
            format!("5 s more in {at} after 5 s, 1 s off at most"),
            format!("{is} was read after {before}"),
        );
        dut.fault(done)?;
    }
    if !is_there(dut, CYCLES) {
        return at_least_one(!times.is_empty(), "the EDS has none of these records");
    }
    let cycles = dut.number(CYCLES.index, 0)?;
    dut.reset(Command::ResetNode)?;
    let mut wanted = vec![(cycles, "NMT reset node")];
    if dut.rig.has_power() {
        wanted.push((cycles + 1, "the power was off"));
    }
    for (wanted, after) in wanted {
        if wanted != cycles {
            dut.power_cycle()?;
            let is = dut.number(SINCE_BOOT_UP.index, SINCE_BOOT_UP.sub)?;
            let done = ensure(
                is <= 3,
                format!("3 s at most in {SINCE_BOOT_UP} after {after}"),
                format!("{is} was read"),
            );
            dut.fault(done)?;
        }
        let is = dut.number(CYCLES.index, 0)?;
        let done = ensure(
            is == wanted,
            format!("{wanted} in {CYCLES} after {after}"),
            format!("{is} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// Numbers of a bit rate, or of the source of a speed or an acceleration, that the manual of a product does not have.
pub(super) fn choices(dut: &mut Dut<'_>) -> Checked {
    const RATE: Address = Address::new(0x2100, 0);
    const SPEED: Address = Address::new(0x6031, 1);
    const ACCELERATION: Address = Address::new(0x6041, 1);
    let lists: [(Makers, Address, &[u8]); 6] = [
        (GX, RATE, &[9, 0xFF]),
        (EAM, RATE, &[9, 0xFF]),
        (EN, RATE, &[0, 1, 9, 0xFF]),
        (EN, SPEED, &[0, 3]),
        (EN, ACCELERATION, &[0, 3]),
        (EAM, ACCELERATION, &[0, 3]),
    ];
    let mut any = false;
    for (maker, address, values) in lists {
        if is_of(dut, &[maker]).is_err() || !dut.eds.writes(address.index, address.sub) {
            continue;
        }
        any = true;
        dut.keep(address)?;
        for value in values {
            let done = dut.cannot_change(address, &[*value], "as the manual does not have it");
            dut.fault(done)?;
        }
    }
    at_least_one(any, "the object is that of another product")
}
