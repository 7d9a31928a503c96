//! CiA 402: every command of the controlword in every state, and every mode, of each axis.

use super::axis::{
    Axis, CHANGE, DISABLED, ENABLE, ENABLED, PROFILE_VELOCITY, READY, SWITCHED_ON, Shown, each,
};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, ensure, lacks};

/// A state: the commands that lead to it, and the state after each command.
type Row = (
    Shown<'static>,
    &'static [u16],
    &'static [(u16, Shown<'static>)],
);

/// Shutdown 6, switch on 7, enable operation 15, quick stop 2, disable voltage 0, fault reset 80h, which is disable voltage
/// without a fault. In Ready to switch on a drive may take 15 for both switch on and enable operation.
const ROWS: [Row; 4] = [
    (
        DISABLED,
        &[],
        &[
            (7, DISABLED),
            (ENABLE, DISABLED),
            (2, DISABLED),
            (0x80, DISABLED),
            (0, DISABLED),
            (6, READY),
        ],
    ),
    (
        READY,
        &[6],
        &[
            (6, READY),
            (7, SWITCHED_ON),
            (2, DISABLED),
            (0, DISABLED),
            (0x80, DISABLED),
        ],
    ),
    (
        SWITCHED_ON,
        &[6, 7],
        &[
            (7, SWITCHED_ON),
            (6, READY),
            (ENABLE, ENABLED),
            (2, DISABLED),
            (0, DISABLED),
            (0x80, DISABLED),
        ],
    ),
    (
        ENABLED,
        &[6, 7, ENABLE],
        &[
            (ENABLE, ENABLED),
            (7, SWITCHED_ON),
            (6, READY),
            (0, DISABLED),
            (0x80, DISABLED),
        ],
    ),
];

/// Time in which a drive that ignores a command could change its state, in microseconds.
const STAYS: u64 = 50_000;

pub(super) fn machine(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        for (from, path, commands) in ROWS {
            for (word, to) in commands {
                axis.command(dut, 0)?;
                axis.shows(dut, CHANGE, DISABLED)?;
                for step in path {
                    axis.command(dut, *step)?;
                    dut.wait(10_000)?;
                }
                axis.shows(dut, CHANGE, from)?;
                axis.command(dut, *word)?;
                if from == *to {
                    dut.wait(STAYS)?;
                }
                let name = format!("{} after {word:02X}h in {}", to.0, from.0);
                let done = axis.shows(dut, CHANGE, (&name, to.1, to.2));
                dut.fault(done)?;
            }
        }
        Ok(())
    })
}

/// Modes with their bits in 6502h.
pub(super) const MODES: [(i8, u32); 9] = [
    (1, 0),
    (3, 2),
    (6, 5),
    (8, 7),
    (9, 8),
    (7, 6),
    (2, 1),
    (4, 3),
    (10, 9),
];

/// 6061h shows each mode of 6502h after it was written.
pub(super) fn modes(dut: &mut Dut<'_>) -> Checked {
    let axes = (0..8).map(|number| Axis(number * 0x800));
    let axes: Vec<Axis> = axes
        .filter(|axis| dut.eds.writes(0x6060 + axis.0, 0) && axis.has(dut, 0x6502))
        .collect();
    for axis in axes {
        axis.command(dut, 0)?;
        if axis.value(dut, 0x6041)? & 0x4F == 0x08 {
            return lacks("the drive has a fault");
        }
        axis.shows(dut, CHANGE, DISABLED)?;
        let supported = axis.value(dut, 0x6502)?;
        for (mode, _) in MODES
            .into_iter()
            .filter(|(_, bit)| supported >> bit & 1 == 1)
        {
            axis.set(dut, 0x6060, mode.into())?;
            let end = dut.now().plus_micros(CHANGE);
            let mut is = axis.value(dut, 0x6061)?;
            while is != i64::from(mode) && dut.now() < end {
                dut.wait(10_000)?;
                is = axis.value(dut, 0x6061)?;
            }
            let done = ensure(
                is == i64::from(mode),
                format!(
                    "{mode} in {} within 1 s, as was written to {}",
                    axis.at(0x6061),
                    axis.at(0x6060)
                ),
                format!("{is} was read"),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}
