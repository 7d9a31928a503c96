//! A slave with every service of CiA 301 except LSS, with a dictionary of 170 values and no
//! application.
#![no_std]
#![no_main]

use odkit::storage::Memory;
use odkit::{Frame, NoApplication, Node, NodeId};
use odkit_firmware::board::{Eeprom, Once};
use odkit_firmware::master::{self, Step, frame, sdo};

odkit::object_dictionary! {
    /// The slave.
    mod slave {
        eds = "../../eds/ds301.eds";
        without lss;
        errors = 8;
    }
}

static NODE: Once<slave::Node<NoApplication, Memory<Eeprom<2048>>>> = Once::new(Node::new(
    slave::Device,
    NodeId::ONE,
    NoApplication,
    // SAFETY: the only one.
    Memory::new(unsafe { Eeprom::new() }),
));

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x00, 0x64, 0, 0, 0, 0, 0]);
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 27] = [
    // 1008h by segments, and by block.
    sdo([0x40, 0x08, 0x10, 0, 0, 0, 0, 0]),
    sdo([0x60, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0x70, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0x60, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0xA4, 0x08, 0x10, 0, 127, 0, 0, 0]),
    sdo([0xA3, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0xA2, 3, 127, 0, 0, 0, 0, 0]),
    sdo([0xA1, 0, 0, 0, 0, 0, 0, 0]),
    // 2000h likewise.
    sdo([0x21, 0x00, 0x20, 0, 9, 0, 0, 0]),
    sdo([0x00, b'n', b'i', b'n', b'e', b' ', b'b', b'y']),
    sdo([0x1B, b't', b'e', 0, 0, 0, 0, 0]),
    sdo([0xC2, 0x00, 0x20, 0, 4, 0, 0, 0]),
    sdo([0x81, b'f', b'o', b'u', b'r', 0, 0, 0]),
    sdo([0xCD, 0, 0, 0, 0, 0, 0, 0]),
    // Guarding, RPDO 1 and one that is too short, a remote frame.
    sdo([0x2B, 0x0C, 0x10, 0, 100, 0, 0, 0]),
    sdo([0x23, 0x16, 0x10, 1, 100, 0, 5, 0]),
    frame(0x705, [5]),
    Step::Wait(1000),
    frame(0x201, [1, 2, 3, 4, 5, 6, 7, 8]),
    frame(0x201, [1]),
    // Mapping, save, restore.
    sdo([0x2F, 0x01, 0x1A, 0, 0, 0, 0, 0]),
    sdo([0x23, 0x01, 0x1A, 1, 0x20, 0, 0, 0x64]),
    sdo([0x2F, 0x01, 0x1A, 0, 1, 0, 0, 0]),
    sdo([0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']),
    sdo([0x23, 0x11, 0x10, 1, b'l', b'o', b'a', b'd']),
    Step::Change,
    frame(0, [0x81, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
