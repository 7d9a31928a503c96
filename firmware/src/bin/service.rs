//! A small node with the one service that the feature names, or with none, to measure the size of
//! each.
#![no_std]
#![no_main]

use odkit::storage::Memory;
use odkit::{
    CanId, Device, Dictionary, Frame, LssProfile, NoApplication, Node, NodeId, Profile, Services,
};
use odkit_firmware::board::{Eeprom, Once};
use odkit_firmware::master::{self, Step, frame, sdo};

odkit::object_dictionary! {
    /// The objects of every variant, and in some variants those of a service.
    mod slave {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1005 { name = "COB-ID SYNC message"; type = u32; access = rw; default = 0x80 }
        add 0x1008 { name = "Device name"; type = str; access = const; default = "thermometer" }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; access = rw; default = $NODEID + 0x80 }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 1000 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018sub2 { name = "Product code"; type = u32; default = 1 }
        add 0x1018sub3 { name = "Revision number"; type = u32; default = 1 }
        add 0x1018sub4 { name = "Serial number"; type = u32; default = 1 }
        add 0x1800 { code = record; name = "TPDO communication parameter 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1A00 { code = record; name = "TPDO mapping parameter 1" }
        add 0x1A00sub0 { name = "Mapped objects"; type = u8; access = const; default = 1 }
        add 0x1A00sub1 { name = "Application object 1"; type = u32; access = const; default = 0x2000_0020 }
        add 0x2000 { name = "Counter"; type = u32; access = rw; mappable = true; default = 4711 }
        add 0x2001 { name = "Note"; type = str; access = rw; capacity = 16 }

        variant rpdos {
            add 0x1400 { code = record; name = "RPDO communication parameter 1" }
            add 0x1400sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x200 }
            add 0x1400sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
            add 0x1600 { code = record; name = "RPDO mapping parameter 1" }
            add 0x1600sub0 { name = "Mapped objects"; type = u8; access = const; default = 1 }
            add 0x1600sub1 { name = "Application object 1"; type = u32; access = const; default = 0x2000_0020 }
        }
        variant deadlines {
            add 0x1400 { code = record; name = "RPDO communication parameter 1" }
            add 0x1400sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x200 }
            add 0x1400sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
            add 0x1400sub5 { name = "Event timer"; type = u16; access = rw; default = 100 }
            add 0x1600 { code = record; name = "RPDO mapping parameter 1" }
            add 0x1600sub0 { name = "Mapped objects"; type = u8; access = const; default = 1 }
            add 0x1600sub1 { name = "Application object 1"; type = u32; access = const; default = 0x2000_0020 }
        }
        variant guarding {
            modify 0x1017 { default = 0 }
            add 0x100C { name = "Guard time"; type = u16; access = rw; default = 100 }
            add 0x100D { name = "Life time factor"; type = u8; access = rw; default = 2 }
        }
        variant consumer {
            add 0x1016 { code = array; name = "Consumer heartbeat time" }
            add 0x1016sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x0005_0064 }
        }
        variant storage {
            add 0x1010 { code = array; name = "Store parameters" }
            add 0x1010sub1 { name = "All parameters"; type = u32; access = rw; default = 1 }
            add 0x1011 { code = array; name = "Restore default parameters" }
            add 0x1011sub1 { name = "All parameters"; type = u32; access = rw; default = 1 }
        }
        variant behaviour {
            add 0x1029 { code = array; name = "Error behaviour" }
            add 0x1029sub1 { name = "Communication error"; type = u8; access = rw; default = 0 }
        }
        variant servers {
            add 0x1201 { code = record; name = "SDO server parameter 2" }
            add 0x1201sub1 { name = "COB-ID client to server"; type = u32; access = rw; default = 0x6A1 }
            add 0x1201sub2 { name = "COB-ID server to client"; type = u32; access = rw; default = 0x6C1 }
        }
        variant sync_producer {
            add 0x1006 { name = "Communication cycle period"; type = u32; access = rw; default = 0 }
        }
        variant time {
            add 0x1012 { name = "COB-ID TIME"; type = u32; access = rw; default = 0x8000_0100 }
        }
    }
}

/// CiA 301 without deviations.
static PROFILE: Profile = Profile {
    lss: if cfg!(feature = "lss") {
        Some(LssProfile::CIA305)
    } else {
        None
    },
    ..Profile::CIA301
};

/// The tables with the objects of the service.
const DICTIONARY: Dictionary<'static> = if cfg!(feature = "rpdos") {
    slave::rpdos::DICTIONARY
} else if cfg!(feature = "deadlines") {
    slave::deadlines::DICTIONARY
} else if cfg!(feature = "guarding") {
    slave::guarding::DICTIONARY
} else if cfg!(feature = "consumer") {
    slave::consumer::DICTIONARY
} else if cfg!(feature = "storage") {
    slave::storage::DICTIONARY
} else if cfg!(feature = "behaviour") {
    slave::behaviour::DICTIONARY
} else if cfg!(feature = "servers") {
    slave::servers::DICTIONARY
} else if cfg!(feature = "sync-producer") {
    slave::sync_producer::DICTIONARY
} else if cfg!(feature = "time") {
    slave::time::DICTIONARY
} else {
    slave::DICTIONARY
};

/// The node, without all services except that one.
struct Measured;

impl Services for Measured {
    const DICTIONARY: Option<Dictionary<'static>> = Some(DICTIONARY);
    const LSS: bool = cfg!(feature = "lss");
    const SEGMENTED: bool = cfg!(feature = "segmented");
    const BLOCK: bool = cfg!(feature = "block");
    const RPDOS: bool = cfg!(feature = "rpdos") || cfg!(feature = "deadlines");
    const CHANGES: bool = cfg!(feature = "changes");
    const GUARDING: bool = cfg!(feature = "guarding");
    const CONSUMER: bool = cfg!(feature = "consumer");
    const STORAGE: bool = cfg!(feature = "storage");
    const BEHAVIOUR: bool = cfg!(feature = "behaviour");
    const EVENTS: bool = cfg!(feature = "events");
    const SYNC_LENGTH: bool = cfg!(feature = "sync-length");
    const ERRORS: usize = 4;
}

impl Device for Measured {
    type Values = Values;
    type Rooms = Rooms;

    fn dictionary(&self) -> Dictionary<'_> {
        DICTIONARY
    }

    fn profile(&self) -> &Profile {
        &PROFILE
    }
}

odkit::rooms!(Measured);

static NODE: Once<Node<Measured, NoApplication, Memory<Eeprom<1024>>>> = Once::new(Node::new(
    Measured,
    NodeId::ONE,
    NoApplication,
    // SAFETY: the only one.
    Memory::new(unsafe { Eeprom::new() }),
));

/// The master requests the state of the node.
const GUARD: Frame = match Frame::remote(CanId::standard(0x701), 1) {
    Some(guard) => guard,
    None => Frame::standard(0x701, &[]),
};

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x00, 0x20, 0, 0, 0, 0, 0]);
/// Uses every service, whether or not the node has it.
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 35] = [
    // 1008h by segments, and by block; 2001h likewise.
    sdo([0x40, 0x08, 0x10, 0, 0, 0, 0, 0]),
    sdo([0x60, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0x70, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0xA4, 0x08, 0x10, 0, 127, 0, 0, 0]),
    sdo([0xA3, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0xA2, 2, 127, 0, 0, 0, 0, 0]),
    sdo([0xA1, 0, 0, 0, 0, 0, 0, 0]),
    sdo([0x21, 0x01, 0x20, 0, 9, 0, 0, 0]),
    sdo([0x00, b'n', b'i', b'n', b'e', b' ', b'b', b'y']),
    sdo([0x1B, b't', b'e', 0, 0, 0, 0, 0]),
    sdo([0xC2, 0x01, 0x20, 0, 4, 0, 0, 0]),
    sdo([0x81, b'f', b'o', b'u', b'r', 0, 0, 0]),
    sdo([0xCD, 0, 0, 0, 0, 0, 0, 0]),
    // An RPDO, and one that is too short; a change.
    frame(0x201, [1, 2, 3, 4, 5, 6, 7, 8]),
    frame(0x201, [1]),
    sdo([0x23, 0x00, 0x20, 0, 1, 0, 0, 0]),
    Step::Change,
    // The master guards the node and then stops; node 5 sends heartbeats and then stops.
    Step::Frame(GUARD),
    Step::Wait(1000),
    frame(0x705, [5]),
    Step::Wait(1000),
    // A second client, SYNC, TIME.
    frame(0x6A1, [0x40, 0x00, 0x20, 0, 0, 0, 0, 0]),
    sdo([0x23, 0x06, 0x10, 0, 0xE8, 3, 0, 0]),
    sdo([0x23, 0x05, 0x10, 0, 0x80, 0, 0, 0x40]),
    Step::Wait(10),
    frame(0x100, [1, 0, 0, 0, 0, 0]),
    // Save and restore; LSS.
    sdo([0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']),
    sdo([0x23, 0x11, 0x10, 1, b'l', b'o', b'a', b'd']),
    frame(0, [2, 0]),
    frame(0x7E5, [4, 1, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [0x5A, 0, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [0x11, 2, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [0x17, 0, 0, 0, 0, 0, 0, 0]),
    frame(0x7E5, [4, 0, 0, 0, 0, 0, 0, 0]),
    frame(0, [0x81, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
