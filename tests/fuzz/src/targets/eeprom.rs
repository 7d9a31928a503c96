//! An EEPROM with any bytes: the device starts, its values are within their limits, and the values that it
//! saves are loaded at the next start.

use std::sync::{Arc, Mutex, PoisonError};

use od_model::{Access, Address};
use od_runtime::Frame;
use od_runtime::storage::{Memory, Storage, StorageError};
use od_sim::{Bus, VirtualDevice};

use super::bench;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "eeprom",
    run,
    seeds: || (0..bench::kinds()).flat_map(images).collect(),
    longest: 16_384,
    ..Target::PLAIN
};

/// Bytes that outlive the device that uses them as EEPROM.
#[derive(Clone)]
struct Shared(Arc<Mutex<Memory<Vec<u8>>>>);

impl Shared {
    fn with<R>(&self, act: impl FnOnce(&mut Memory<Vec<u8>>) -> R) -> R {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Storage for Shared {
    fn capacity(&self) -> usize {
        self.with(|memory| memory.capacity())
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.with(|memory| memory.read(offset, to))
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.with(|memory| memory.write(offset, bytes))
    }
}

/// A device with this memory, powered for two seconds.
fn start(number: usize, memory: &Shared) -> Bus {
    let mut bus = Bus::new();
    bus.add(bench::device(number).with_storage(Box::new(memory.clone())));
    bus.start(0);
    bus.advance(bus.now().plus_millis(2000));
    bus
}

fn send(bus: &mut Bus, data: &[u8; 8]) {
    let node = u16::from(bus.devices()[0].node_id().raw());
    bus.receive(&Frame::standard(0x600 + node, data));
    bus.advance(bus.now().plus_millis(2000));
}

const SAVE: [u8; 8] = [0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e'];

/// The images that a device writes: an empty memory, one save, and a second one after writes.
fn images(number: usize) -> Vec<Vec<u8>> {
    let memory = Shared(Arc::new(Mutex::new(Memory::new(vec![
        0xFF;
        bench::device(number)
            .storage_needed()
    ]))));
    let mut images = Vec::new();
    let mut keep = |memory: &Shared| {
        let mut image = vec![number as u8];
        memory.with(|memory| image.extend_from_slice(memory.bytes()));
        images.push(image);
    };
    keep(&memory);
    let mut bus = start(number, &memory);
    send(&mut bus, &SAVE);
    keep(&memory);
    for (index, sub, value) in [
        (0x1017_u16, 0, 50_u8),
        (0x6003, 0, 77),
        (0x2300, 1, 5),
        (0x1800, 2, 1),
    ] {
        let [low, high] = index.to_le_bytes();
        let len = bus.devices()[0]
            .dictionary()
            .entry(index, sub)
            .and_then(|entry| entry.data_type.size());
        let command = 0x23 | (4 - len.unwrap_or(4).min(4) as u8) << 2;
        send(&mut bus, &[command, low, high, sub, value, 0, 0, 0]);
    }
    send(&mut bus, &SAVE);
    keep(&memory);
    images
}

fn run(input: &[u8]) {
    let Some((number, image)) = input.split_first() else {
        return;
    };
    let number = usize::from(*number) % bench::kinds();
    let mut bytes = image.to_vec();
    bytes.resize(bench::device(number).storage_needed(), 0xFF);
    let memory = Shared(Arc::new(Mutex::new(Memory::new(bytes))));
    let mut bus = start(number, &memory);
    let device = &bus.devices()[0];
    let (node, entries) = (
        device.node_id(),
        device.dictionary().entries().collect::<Vec<_>>(),
    );
    for entry in &entries {
        let (Some(value), true) = (
            device.stored(entry.address.index, entry.address.sub),
            entry.access.writable(),
        ) else {
            continue;
        };
        // Signed values are compared as numbers, not as bits.
        let size = entry.data_type.size().unwrap_or(8) as u32 * 8;
        let is_signed = entry
            .data_type
            .integer_range()
            .is_some_and(|(low, _)| low < 0);
        let value = if is_signed {
            i128::from((value << (64 - size)) as i64 >> (64 - size))
        } else {
            i128::from(value)
        };
        let limit = |literal: od_model::Literal| literal.integer(node.raw());
        let low = limit(entry.low).is_none_or(|low| value >= low);
        let high = limit(entry.high).is_none_or(|high| value <= high);
        assert!(
            low && high,
            "{} is {value}, outside its limits",
            entry.address
        );
    }
    // A save is loaded again, with the same node ID.
    send(&mut bus, &SAVE);
    let before: Vec<_> = kept(&mut bus, &entries);
    bus.with(0, VirtualDevice::power_off);
    let mut again = start(number, &memory);
    assert_eq!(again.devices()[0].node_id(), node);
    for (address, value) in before {
        let now = read(&mut again, address);
        assert_eq!(now, value, "{address} was saved as something else");
    }
}

fn read(bus: &mut Bus, address: Address) -> Vec<u8> {
    let value = bus.with(0, |device, now| device.read(address, now));
    value.unwrap_or_default()
}

fn kept(bus: &mut Bus, entries: &[od_model::Entry]) -> Vec<(Address, Vec<u8>)> {
    let saved = |entry: &&od_model::Entry| {
        entry.access == Access::Rw && entry.group != od_model::Group::None
    };
    let addresses: Vec<Address> = entries
        .iter()
        .filter(saved)
        .map(|entry| entry.address)
        .collect();
    addresses
        .into_iter()
        .map(|address| (address, read(bus, address)))
        .collect()
}
