//! The smallest node: NMT, boot-up, heartbeat, expedited SDO, EMCY, two TPDOs, 16 objects.
#![no_std]
#![no_main]

use odkit::storage::NoStorage;
use odkit::{Address, Application, Context, Emcy, Frame, Instant, NodeId};
use odkit_firmware::board::Once;
use odkit_firmware::master::{self, Step, frame, sdo};

odkit::object_dictionary! {
    /// A thermometer with two inputs.
    mod thermometer {
        without lss, segmented, block, rpdos, changes, guarding, consumer, storage, behaviour, events, sync_length;
        errors = 4;

        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1005 { name = "COB-ID SYNC message"; type = u32; access = rw; default = 0x80 }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; access = rw; default = $NODEID + 0x80 }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 1000 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018sub2 { name = "Product code"; type = u32; default = 1 }
        add 0x1018sub3 { name = "Revision number"; type = u32; default = 1 }
        add 0x1018sub4 { name = "Serial number"; type = u32; default = 1 }
        add 0x1800 { code = record; name = "TPDO communication parameter 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 1 }
        add 0x1801 { code = record; name = "TPDO communication parameter 2" }
        add 0x1801sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x280 }
        add 0x1801sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1801sub5 { name = "Event timer"; type = u16; access = rw; default = 100 }
        add 0x1A00 { code = record; name = "TPDO mapping parameter 1" }
        add 0x1A00sub0 { name = "Mapped objects"; type = u8; access = const; default = 1 }
        add 0x1A00sub1 { name = "Application object 1"; type = u32; access = const; default = 0x2003_0020 }
        add 0x1A01 { code = record; name = "TPDO mapping parameter 2" }
        add 0x1A01sub0 { name = "Mapped objects"; type = u8; access = const; default = 2 }
        add 0x1A01sub1 { name = "Application object 1"; type = u32; access = const; default = 0x2000_0010 }
        add 0x1A01sub2 { name = "Application object 2"; type = u32; access = const; default = 0x2001_0008 }
        add 0x2000 { name = "Temperature"; type = i16; mappable = true; default = 215 }
        add 0x2001 { name = "Inputs"; type = u8; mappable = true }
        add 0x2002 { name = "Offset"; type = i16; access = rw; low = -100; high = 100 }
        add 0x2003 { name = "Counter"; type = u32; mappable = true; default = 4711 }
        add 0x2004 { name = "Upper limit"; type = i16; access = rw; default = 800 }
        add 0x2005 { name = "Lower limit"; type = i16; access = rw; default = 0 }
    }
}

/// Reports an error with each change.
struct Thermometer;

impl Application for Thermometer {
    fn is_live(&self, _: Address) -> bool {
        false
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let inputs = cx.store.get(thermometer::INPUTS);
        cx.store.set(thermometer::INPUTS, inputs ^ 1);
        let info = [0; 5];
        match inputs {
            0 => cx.signals.raise(Emcy {
                code: 0x4200,
                register: 0x09,
                info,
            }),
            _ => cx.signals.clear(0x4200, info),
        }
        None
    }
}

static NODE: Once<thermometer::Node<Thermometer>> = Once::new(thermometer::Node::new(
    thermometer::Device,
    NodeId::ONE,
    Thermometer,
    NoStorage,
));

#[unsafe(link_section = ".script")]
static UPLOAD: Frame = Frame::standard(0x601, &[0x40, 0x03, 0x20, 0, 0, 0, 0, 0]);
#[unsafe(link_section = ".script")]
static SCRIPT: [Step; 9] = [
    sdo([0x40, 0x18, 0x10, 1, 0, 0, 0, 0]),
    sdo([0x2B, 0x02, 0x20, 0, 50, 0, 0, 0]),
    sdo([0x2B, 0x02, 0x20, 0, 101, 0, 0, 0]),
    sdo([0x2B, 0x17, 0x10, 0, 200, 0, 0, 0]),
    Step::Wait(1000),
    Step::Change,
    Step::Wait(1000),
    Step::Change,
    frame(0, [0x82, 0]),
];

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    master::run(NODE.take(), &UPLOAD, &SCRIPT)
}
