//! A drive of CiA 402 with two axes, both in motion.
#![no_std]
#![no_main]

use od_devices::drive::{Drive, drive};
use odkit::storage::Memory;
use odkit::{Frame, NodeId};
use odkit_firmware::board::{Eeprom, Once};
use odkit_firmware::master::{self, Step, frame, sdo};

static NODE: Once<drive::Node<Drive, Memory<Eeprom<4096>>>> = Once::new(drive::Node::new(
    drive::Device,
    NodeId::ONE,
    Drive::new(),
    // SAFETY: the only one.
    Memory::new(unsafe { Eeprom::new() }),
));

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x64, 0x60, 0, 0, 0, 0, 0]);
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 15] = [
    // A set-point for axis 1, homing for axis 2.
    sdo([0x2F, 0x60, 0x60, 0, 1, 0, 0, 0]),
    sdo([0x23, 0x7A, 0x60, 0, 0x10, 0x27, 0, 0]),
    sdo([0x2B, 0x40, 0x60, 0, 0x06, 0, 0, 0]),
    sdo([0x2B, 0x40, 0x60, 0, 0x0F, 0, 0, 0]),
    sdo([0x2B, 0x40, 0x60, 0, 0x1F, 0, 0, 0]),
    sdo([0x2F, 0x60, 0x68, 0, 6, 0, 0, 0]),
    sdo([0x2F, 0x98, 0x68, 0, 17, 0, 0, 0]),
    sdo([0x2B, 0x40, 0x68, 0, 0x06, 0, 0, 0]),
    sdo([0x2B, 0x40, 0x68, 0, 0x1F, 0, 0, 0]),
    Step::Wait(300),
    // Cyclic positions.
    sdo([0x2F, 0x60, 0x60, 0, 8, 0, 0, 0]),
    frame(0x301, [0x0F, 0, 0x20, 0x27, 0, 0]),
    frame(0x80, []),
    Step::Wait(10),
    frame(0, [0x81, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
