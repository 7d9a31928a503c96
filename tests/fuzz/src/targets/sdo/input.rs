//! The frames to send, and the objects that change without a download.

use super::super::bench::{self, STEP};
use crate::random::Random;

/// Maximum number of steps of a device.
const STEPS: usize = 2000;

/// A device and its events.
pub(super) fn make(random: &mut Random) -> Vec<u8> {
    // Mostly one device of each manual, sometimes the others or files.
    let device = match random.below(8) {
        0 | 1 => bench::number_of("gxmm"),
        2 | 3 => bench::number_of("eam_mt"),
        4 | 5 => bench::number_of("en580c"),
        6 => bench::first_file() + random.below(2),
        _ => random.below(bench::kinds()),
    };
    let mut input = vec![0; STEP];
    input[0] = device as u8;
    for _ in 0..STEPS {
        let bytes = random.next().to_le_bytes();
        let more = random.next().to_le_bytes();
        let mut step = [
            bytes[0], bytes[1], bytes[2], bytes[3], bytes[4], more[0], more[1], more[2], more[3],
            more[4],
        ];
        // Inputs of the application belong to another target; here they would only prevent the comparison.
        if step[0] % 40 >= 35 {
            step[0] = 31;
        }
        input.extend(step);
    }
    input
}

/// Objects whose value need not be the last written one.
pub(super) const LIVE: &[u16] = &[
    0x1001, 0x1003, 0x1010, 0x1011, 0x2116, 0x2117, 0x2120, 0x2122, 0x2201, 0x2A00, 0x2A01, 0x6004,
    0x600C, 0x6030, 0x6040, 0x6503, 0x6504, 0x6505, 0x6506, 0x6508,
];

/// Objects that change each other.
pub(super) const COUPLED: &[&[u16]] = &[
    // Scaling, ranges, gear, preset and offset.
    &[
        0x2001, 0x2110, 0x6000, 0x6001, 0x6002, 0x6003, 0x6005, 0x600D, 0x6010, 0x6501, 0x6502,
        0x6509, 0x650A, 0x650C,
    ],
    // The event timer and its mirror, with the 2 ms of 2110h bit 8.
    &[0x1800, 0x2110, 0x6200],
    // Node ID and bit rate, on which other objects may depend.
    &[0x2100, 0x2101],
    // A mapping and its length.
    &[0x1A00],
    &[0x1A01],
];
