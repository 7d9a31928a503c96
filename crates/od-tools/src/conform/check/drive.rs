//! CiA 402: drives. No case enables the operation of a drive, so its shaft does not move.

use od_model::Address;
use od_wire::AbortCode::{DeviceState, General, ValueRange, ValueTooHigh, ValueTooLow};

use super::states::MODES;
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, ensure, lacks};

const CONTROLWORD: Address = Address::new(0x6040, 0);
const MODE: Address = Address::new(0x6060, 0);

/// Time in which a drive changes to another state or mode, in microseconds.
const CHANGE: u64 = 1_000_000;

/// Mask and bits of the statusword in a state.
const DISABLED: (u64, u64) = (0x4F, 0x40);
const READY: (u64, u64) = (0x6F, 0x21);

pub(super) fn objects(dut: &mut Dut<'_>) -> Checked {
    for index in [0x6041, 0x6502] {
        dut.read(Address::new(index, 0))?;
    }
    ensure(
        dut.eds.writes(0x6040, 0),
        "6040h, the controlword",
        "the EDS has no 6040h that a master can write",
    )
}

/// Waits until the statusword shows this state.
fn becomes(dut: &mut Dut<'_>, name: &str, (mask, bits): (u64, u64)) -> Checked {
    let end = dut.now().plus_micros(CHANGE);
    loop {
        let is = dut.number(0x6041, 0)?;
        if is & mask == bits || dut.now() >= end {
            return ensure(
                is & mask == bits,
                format!("6041h of {name} within 1 s"),
                format!("{is:04X}h was read"),
            );
        }
        dut.wait(10_000)?;
    }
}

fn command(dut: &mut Dut<'_>, word: u16) -> Checked {
    dut.write(CONTROLWORD, &word.to_le_bytes())
}

/// Changes to Switch on disabled. A drive with a fault skips the case, since it would fail for
/// another reason.
fn disabled(dut: &mut Dut<'_>) -> Checked {
    command(dut, 0)?;
    if dut.number(0x6041, 0)? & 0x4F == 0x08 {
        return lacks("the drive has a fault");
    }
    becomes(dut, "Switch on disabled", DISABLED)
}

pub(super) fn initial(dut: &mut Dut<'_>) -> Checked {
    dut.reset(od_wire::nmt::Command::ResetNode)?;
    if dut.number(0x6041, 0)? & 0x4F == 0x08 {
        return lacks("the drive has a fault");
    }
    becomes(dut, "Switch on disabled", DISABLED)
}

/// Transitions 2 and 7.
pub(super) fn shutdown(dut: &mut Dut<'_>) -> Checked {
    disabled(dut)?;
    command(dut, 6)?;
    let done = becomes(dut, "Ready to switch on", READY);
    command(dut, 0)?;
    done?;
    becomes(dut, "Switch on disabled", DISABLED)
}

/// Transition 3 needs Ready to switch on.
pub(super) fn order(dut: &mut Dut<'_>) -> Checked {
    disabled(dut)?;
    command(dut, 7)?;
    dut.wait(50_000)?;
    let is = dut.number(0x6041, 0)?;
    command(dut, 0)?;
    ensure(
        is & DISABLED.0 == DISABLED.1,
        "Switch on disabled after command 7, which Ready to switch on accepts only",
        format!("{is:04X}h was read from 6041h"),
    )
}

/// A mode that is missing in 6502h.
pub(super) fn other_mode(dut: &mut Dut<'_>) -> Checked {
    disabled(dut)?;
    let supported = dut.number(0x6502, 0)?;
    let mut modes = MODES.iter();
    let Some((mode, _)) = modes.find(|(_, bit)| supported >> bit & 1 == 0) else {
        return lacks("6502h has every mode");
    };
    dut.keep(MODE)?;
    let codes = [ValueRange, ValueTooHigh, ValueTooLow, DeviceState, General];
    match dut.download(MODE, &mode.to_le_bytes())? {
        Err(_) => dut.refuses_value(MODE, &mode.to_le_bytes(), &codes),
        Ok(()) => {
            let shown = dut.number(0x6060, 0)? as u8 as i8;
            let done = ensure(
                shown == *mode,
                format!("an abort for mode {mode}, which 6502h lacks, or {mode} in 6060h"),
                format!("the value was accepted, and {shown} was read"),
            );
            dut.fault(done)?;
            dut.wait(100_000)?;
            let is = dut.number(0x6061, 0)? as u8 as i8;
            ensure(
                is != *mode,
                format!("mode {mode}, which 6502h lacks, not to become the present one"),
                format!("{is} was read from 6061h"),
            )
        }
    }
}
