//! The I/O module of CiA 401, with every service of its dictionary.
#![no_std]
#![no_main]

use od_devices::io::{Io, io};
use odkit::storage::Memory;
use odkit::{Frame, NodeId};
use odkit_firmware::board::{Eeprom, Once};
use odkit_firmware::master::{self, Step, frame, sdo};

static NODE: Once<io::Node<Io, Memory<Eeprom<2048>>>> = Once::new(io::Node::new(
    io::Device,
    NodeId::ONE,
    Io::new(),
    // SAFETY: the only one.
    Memory::new(unsafe { Eeprom::new() }),
));

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x00, 0x60, 1, 0, 0, 0, 0]);
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 8] = [
    // Polarity: inputs change. Outputs, and their error values in Stopped.
    sdo([0x2F, 0x02, 0x60, 1, 0xFF, 0, 0, 0]),
    sdo([0x2F, 0x23, 0x64, 0, 1, 0, 0, 0]),
    frame(0x201, [0xA5, 0x5A]),
    frame(0x301, [0, 1, 0, 2]),
    Step::Change,
    frame(0, [2, 0]),
    frame(0, [1, 0]),
    frame(0, [0x81, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
