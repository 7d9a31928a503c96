//! Parts of an encoder around its node: the shaft with its sensor, and the EEPROM.

use odkit::Instant;
use odkit::encoder::{Angle, Counter, Fault, Gain, Motion, Sampled, Sensor};
use odkit::storage::{Geometry, Memory, Storage, StorageError};

/// A shaft whose samples come by an interrupt, so the node need not wake up for them.
pub struct Shaft(pub Sampled<Angle, 128>);

impl Motion for Shaft {
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault> {
        self.0.angle(now)
    }

    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        self.0.speed(now, interval, gain)
    }

    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        self.0.acceleration(now, interval, gain)
    }

    fn look_back(&mut self, interval: u32) {
        self.0.look_back(interval);
    }

    fn start(&mut self, now: Instant, counter: Counter, sensor: Sensor) {
        self.0.start(now, counter, sensor);
    }

    fn power_off(&mut self, now: Instant) {
        self.0.power_off(now);
    }
}

/// An EEPROM that can break; a broken one accepts no byte.
pub struct Eeprom {
    /// Its content.
    pub memory: Memory<&'static mut [u8]>,
    /// Whether it is broken.
    pub broken: bool,
}

impl Eeprom {
    /// An EEPROM with this content.
    pub const fn new(bytes: &'static mut [u8]) -> Self {
        Self {
            memory: Memory::new(bytes),
            broken: false,
        }
    }
}

impl Storage for Eeprom {
    fn capacity(&self) -> usize {
        self.memory.capacity()
    }

    fn geometry(&self) -> Geometry {
        self.memory.geometry()
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.memory.read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if self.broken {
            Err(StorageError::Device)
        } else {
            self.memory.write(offset, bytes)
        }
    }
}
