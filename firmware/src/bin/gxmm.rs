//! The complete GXMM: a multiturn encoder with a sampled sensor.
#![no_std]
#![no_main]

use od_devices::bus_cover::{ENCODER, PROFILE, gxmm};
use odkit::encoder::{Angle, Encoder, EncoderProfile, Family, Sampled};
use odkit::storage::Memory;
use odkit::{Device, Dictionary, Duration, Frame, Node, NodeId, Profile, Services};
use odkit_firmware::board::{Eeprom, Once};
use odkit_firmware::master::{self, Step, frame, sdo};

/// No object contains a speed, so no sample is stored.
type Shaft = Encoder<Sampled<Angle, 0>, Covers>;

/// The encoders with a bus cover.
struct Covers;

impl Family for Covers {
    const PROFILE: Option<&'static EncoderProfile> = Some(&ENCODER);
}

/// GXMM without the services that its profile switches off.
struct Gxmm;

impl Services for Gxmm {
    const DICTIONARY: Option<Dictionary<'static>> = Some(gxmm::DICTIONARY);
    const SEGMENTED: bool = false;
    const BLOCK: bool = false;
    const RPDOS: bool = false;
    const CHANGES: bool = false;
    const SYNC_LENGTH: bool = false;
    /// Five of the encoder, five of the services (81xxh, 82xxh).
    const ERRORS: usize = 10;
}

impl Device for Gxmm {
    type Values = Values;
    type Rooms = Rooms;

    fn dictionary(&self) -> Dictionary<'_> {
        gxmm::DICTIONARY
    }

    fn profile(&self) -> &Profile {
        &PROFILE
    }
}

odkit::rooms!(Gxmm);

static NODE: Once<Node<Gxmm, Shaft, Memory<Eeprom<2048>>>> = Once::new(Node::new(
    Gxmm,
    NodeId::ONE,
    Encoder::of_family(Sampled::new(
        Angle::from_fractions(1 << 30),
        Duration::from_millis(1),
    )),
    // SAFETY: the only one.
    Memory::new(unsafe { Eeprom::new() }),
));

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 16] = [
    sdo([0x40, 0x18, 0x10, 1, 0, 0, 0, 0]),
    // Scaling, a preset, node guarding.
    sdo([0x2B, 0x00, 0x60, 0, 4, 0, 0, 0]),
    sdo([0x23, 0x01, 0x60, 0, 0, 4, 0, 0]),
    sdo([0x23, 0x02, 0x60, 0, 0, 0, 1, 0]),
    sdo([0x23, 0x03, 0x60, 0, 0x10, 0, 0, 0]),
    sdo([0x40, 0x04, 0x60, 0, 0, 0, 0, 0]),
    frame(0x80, []),
    Step::Change,
    Step::Wait(1000),
    sdo([0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']),
    sdo([0x23, 0x11, 0x10, 1, b'l', b'o', b'a', b'd']),
    // LSS in Stopped: the master inquires the vendor-ID.
    frame(0, [2, 0]),
    frame(0x7E5, [4, 1, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [0x5A, 0, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [4, 0, 0, 0, 0, 0, 0, 0]),
    frame(0, [0x81, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
