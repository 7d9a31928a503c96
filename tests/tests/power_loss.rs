//! Power goes at every byte of a save, on every device: the next start has the values that its
//! manual promises, all of them, and never a mixture.
//!
//! GX keeps the last complete set; EAM and EN580C say that a cut save gives the factory values
//! (DECISIONS U-33).

use std::sync::{Arc, Mutex, PoisonError};

use od_bench::{Bus, VirtualDevice};
use od_devices::DEVICES;
use od_model::{Address, Group};
use od_runtime::DeviceKind;
use od_runtime::storage::{Memory, Storage, StorageError};
use od_runtime::{CutSave, Frame, NodeId};

/// An EEPROM that outlives its device, and whose power can be cut.
#[derive(Clone)]
struct Eeprom(Arc<Mutex<Memory<Vec<u8>>>>);

impl Eeprom {
    fn with<R>(&self, act: impl FnOnce(&mut Memory<Vec<u8>>) -> R) -> R {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Storage for Eeprom {
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

type Values = Vec<(Address, Vec<u8>)>;

struct Bench {
    kind: &'static DeviceKind,
    bus: Bus,
}

impl Bench {
    fn start(kind: &'static DeviceKind, bytes: Vec<u8>) -> (Self, Eeprom) {
        let eeprom = Eeprom(Arc::new(Mutex::new(Memory::new(bytes))));
        let device = VirtualDevice::new(kind, NodeId::ONE).with_storage(Box::new(eeprom.clone()));
        let mut bus = Bus::new();
        bus.add(device);
        bus.start(0);
        let mut bench = Self { kind, bus };
        bench.wait(300);
        (bench, eeprom)
    }

    fn wait(&mut self, millis: u64) {
        self.bus.advance(self.bus.now().plus_millis(millis));
        while self.bus.poll().is_some() {}
    }

    /// What a master can save.
    fn values(&mut self) -> Values {
        let entries = self.kind.dictionary.entries().iter();
        let saved = entries.filter(|entry| entry.access.writable() && entry.group != Group::None);
        saved
            .map(|entry| {
                let value = self
                    .bus
                    .with(0, |device, now| device.read(entry.address, now));
                (entry.address, value.unwrap_or_default())
            })
            .collect()
    }

    fn write(&mut self, index: u16, sub: u8, value: u32) {
        let Some(entry) = self.kind.dictionary.entry(index, sub) else {
            return;
        };
        let len = entry.data_type.size().unwrap_or(4).min(4);
        self.send(0x23 | (4 - len as u8) << 2, index, sub, value);
    }

    fn send(&mut self, command: u8, index: u16, sub: u8, value: u32) {
        let ([low, high], [a, b, c, d]) = (index.to_le_bytes(), value.to_le_bytes());
        let data = [command, low, high, sub, a, b, c, d];
        self.bus.receive(&Frame::standard(0x601, &data));
        self.wait(1);
    }

    /// Values all over the dictionary, that depend on `with`.
    fn change(&mut self, with: u32) {
        self.write(0x1017, 0, 100 + with);
        self.write(0x1800, 2, 1 + with);
        self.write(0x1800, 5, 50 + with);
        self.write(0x2110, 0, 8 + (with % 2));
        for sub in 1..=8 {
            self.write(0x2300, sub, 0x1000 + 16 * with + u32::from(sub));
        }
        self.write(0x6001, 0, 0x400 + with);
        self.write(0x6003, 0, 10 * with);
        self.wait(10);
    }

    /// Saves all groups, and takes as long as the slowest family needs.
    fn save(&mut self) {
        self.send(0x23, 0x1010, 1, u32::from_le_bytes(*b"save"));
        self.wait(1500);
    }
}

/// The values after a start with these bytes.
fn values_of(kind: &'static DeviceKind, bytes: Vec<u8>) -> Values {
    Bench::start(kind, bytes).0.values()
}

fn difference(a: &Values, b: &Values) -> Vec<Address> {
    let pairs = a.iter().zip(b).filter(|(a, b)| a != b);
    pairs.map(|(a, _)| a.0).collect()
}

fn cut_everywhere(kind: &'static DeviceKind) {
    let name = kind.name;
    let capacity = VirtualDevice::new(kind, NodeId::ONE).storage_needed();
    let factory = values_of(kind, vec![0xFF; capacity]);
    // A device that has been saved once before.
    let (mut bench, eeprom) = Bench::start(kind, vec![0xFF; capacity]);
    bench.change(1);
    bench.save();
    let first = eeprom.with(|memory| memory.bytes().to_vec());
    let before = values_of(kind, first.clone());
    bench.change(2);
    bench.save();
    let second = eeprom.with(|memory| memory.bytes().to_vec());
    let after = values_of(kind, second);
    assert!(
        difference(&factory, &before).len() >= 8,
        "{name}: nothing was saved"
    );
    assert!(
        difference(&before, &after).len() >= 8,
        "{name}: nothing changed"
    );
    let kept = match kind.profile.store.cut {
        CutSave::LastSet => &before,
        CutSave::Factory => &factory,
    };
    let mut cuts = 0;
    for cut in 0.. {
        let (mut bench, eeprom) = Bench::start(kind, first.clone());
        bench.change(2);
        eeprom.with(|memory| memory.cut_after(cut));
        bench.save();
        let (bytes, was_cut) = eeprom.with(|memory| (memory.bytes().to_vec(), memory.is_cut()));
        let now = values_of(kind, bytes);
        if !was_cut {
            assert_eq!(difference(&now, &after), [], "{name}: the whole save");
            break;
        }
        cuts += 1;
        // Before its first byte a save has not begun, and behind its last one it is complete.
        let untouched = cut == 0 && now == before;
        let complete = now == after;
        assert!(
            now == *kept || untouched || complete,
            "{name}, cut after {cut} bytes: {:?} are not what they were before, {:?} not the \
             factory's, {:?} not the new ones",
            difference(&now, &before),
            difference(&now, &factory),
            difference(&now, &after)
        );
    }
    assert!(cuts > 200, "{name}: only {cuts} cuts");
}

#[test]
fn power_can_go_at_any_byte_of_a_save() {
    std::thread::scope(|scope| {
        for kind in DEVICES {
            let thread = std::thread::Builder::new().name(kind.name.into());
            let spawned = thread.spawn_scoped(scope, move || cut_everywhere(kind));
            assert!(spawned.is_ok(), "no thread for {}", kind.name);
        }
    });
}
