//! A device, and helpers of several test files.
#![allow(dead_code, unreachable_pub)] // each test file uses its own part

use odkit::board::Owner;
use odkit::{Application, Frame, Instant};

odkit::object_dictionary! {
    /// A thermometer that sends its temperature when it changes.
    pub mod thermometer {
        without lss;
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1005 { name = "COB-ID SYNC message"; type = u32; access = rw; default = 0x80 }
        add 0x1010 { code = array; name = "Store parameters" }
        add 0x1010sub1 { name = "Save all parameters"; type = u32; access = rw; default = 1 }
        add 0x1011 { code = array; name = "Restore default parameters" }
        add 0x1011sub1 { name = "Restore all defaults"; type = u32; access = rw; default = 1 }
        add 0x1016 { code = array; name = "Consumer heartbeat time" }
        add 0x1016sub1 { name = "Consumer 1"; type = u32; access = rw; default = 0 }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1400 { code = record; name = "RPDO communication parameter 1" }
        add 0x1400sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x200 }
        add 0x1400sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1600 { code = record; name = "RPDO mapping parameter 1" }
        add 0x1600sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x2001_0010 }
        add 0x1800 { code = record; name = "TPDO communication parameter 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 254 }
        add 0x1A00 { code = record; name = "TPDO mapping parameter 1" }
        add 0x1A00sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x2000_0010 }
        add 0x2000 { name = "Temperature"; type = i16; mappable = true; default = 215 }
        add 0x2001 { name = "Target"; type = i16; access = rww; mappable = true; default = 0 }
        rename 0x2000 = TEMPERATURE;
        rename 0x2001 = TARGET;
    }
}

/// Counts the calls of the node.
#[derive(Debug, Default)]
pub struct Heater {
    pub ticks: u32,
}

impl Heater {
    pub const fn new() -> Self {
        Self { ticks: 0 }
    }
}

impl Application for Heater {
    fn tick(&mut self, _: &mut odkit::Context<'_, '_>) -> Option<Instant> {
        self.ticks += 1;
        None
    }
}

/// All frames that the node has, as text.
pub fn sent(owner: &mut impl Owner, now: Instant) -> Vec<String> {
    std::iter::from_fn(|| owner.poll_transmit(now))
        .map(|frame| frame.to_string())
        .collect()
}

pub fn frame(text: &str) -> Frame {
    let (id, data) = text.split_once('#').expect("a frame");
    let id = odkit::CanId::standard(u16::from_str_radix(id, 16).expect("hex"));
    let bytes: Vec<u8> = (0..data.len())
        .step_by(2)
        .map(|at| u8::from_str_radix(&data[at..at + 2], 16).expect("hex"))
        .collect();
    Frame::new(id, &bytes).expect("eight bytes at most")
}

/// Random numbers that are the same in every run.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) % end
    }

    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u64) as usize]
    }
}
