//! CiA 401: I/O modules. No case changes an output.

use od_model::Address;

use crate::conform::dut::Dut;
use crate::conform::end::{Checked, ensure};

/// Bits of 1000h, their meaning, and the first and the last object of each part.
const PARTS: [(u32, &str, &[u16]); 4] = [
    (16, "digital inputs", &[0x6000, 0x6020, 0x6100, 0x6120]),
    (17, "digital outputs", &[0x6200, 0x6220, 0x6300, 0x6320]),
    (
        18,
        "analogue inputs",
        &[0x6400, 0x6401, 0x6402, 0x6403, 0x6404],
    ),
    (
        19,
        "analogue outputs",
        &[0x6410, 0x6411, 0x6412, 0x6413, 0x6414],
    ),
];

/// The device type matches the dictionary.
pub(super) fn device_type(dut: &mut Dut<'_>) -> Checked {
    let device_type = dut.number(0x1000, 0)?;
    for (bit, name, objects) in PARTS {
        let says = device_type >> bit & 1 == 1;
        let has = objects.iter().any(|index| dut.eds.has(*index));
        let done = ensure(
            says == has,
            format!("bit {bit} of 1000h = {}, as for {name}", u8::from(has)),
            format!("{device_type:08X}h was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// 6002h inverts 6000h, in each group of inputs.
pub(super) fn polarity(dut: &mut Dut<'_>) -> Checked {
    for sub in 1..=dut.number(0x6002, 0)?.min(0xFE) as u8 {
        let done = inverts(dut, sub);
        dut.fault(done)?;
    }
    Ok(())
}

fn inverts(dut: &mut Dut<'_>, sub: u8) -> Checked {
    let polarity = Address::new(0x6002, sub);
    let old = dut.keep(polarity)?;
    let before = dut.number(0x6000, sub)?;
    let inverted: Vec<u8> = old.iter().map(|byte| !byte).collect();
    dut.write(polarity, &inverted)?;
    // Wait until the module has read its inputs again.
    dut.wait(100_000)?;
    let is = dut.number(0x6000, sub)?;
    ensure(
        is == !before & 0xFF,
        format!(
            "6000h:{sub:02X} = {:02X}h, inverted by 6002h:{sub:02X}",
            !before & 0xFF
        ),
        format!("{is:02X}h was read, as if an input changed or 6002h had no effect"),
    )
}
