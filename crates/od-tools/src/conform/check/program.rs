//! Objects of a program download, without a download: that would replace the program of the node.

use crate::conform::dut::Dut;
use crate::conform::end::{Checked, ensure, lacks};

/// Program data, control, software identification and flash status (CiA 302-3).
const ALL: [u16; 4] = [0x1F50, 0x1F51, 0x1F56, 0x1F57];

/// The objects have an entry for each program. No program is being written, and each one is stopped or started.
pub(super) fn status(dut: &mut Dut<'_>) -> Checked {
    let there: Vec<u16> = ALL
        .into_iter()
        .filter(|index| dut.eds.has(*index))
        .collect();
    let [first, others @ ..] = &there[..] else {
        return lacks("the EDS has none of 1F50h, 1F51h, 1F56h and 1F57h");
    };
    let count = dut.number(*first, 0)?;
    for index in others {
        let is = dut.number(*index, 0)?;
        let done = ensure(
            is == count,
            format!("{count} programs in {index:04X}h, as in {first:04X}h"),
            format!("{is} was read"),
        );
        dut.fault(done)?;
    }
    for sub in 1..=count.min(254) as u8 {
        if there.contains(&0x1F51) {
            let control = dut.number(0x1F51, sub)?;
            let done = ensure(
                matches!(control, 0 | 1 | 0x80..),
                format!("0 (stopped) or 1 (started) in 1F51h:{sub:02X}"),
                format!("{control} was read"),
            );
            dut.fault(done)?;
        }
        if there.contains(&0x1F57) {
            let status = dut.number(0x1F57, sub)?;
            let done = ensure(
                status & 0xFF01 == 0,
                format!(
                    "0 in bit 0 and in the reserved bits 8 to 15 of 1F57h:{sub:02X}, as no program is being written"
                ),
                format!("{status:X}h was read"),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}
