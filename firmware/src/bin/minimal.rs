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
        eds = "../../eds/minimal.eds";
        without lss, segmented, block, rpdos, changes, guarding, consumer, storage, behaviour, events, sync_length;
        errors = 4;
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
