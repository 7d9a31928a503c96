//! Power is cut at every byte of a save on every device, and at every step of a save on NOR flash.
//! The next start has all values that the manual promises, and never a mixture of old and new ones.
//!
//! GX keeps the last complete set; on EAM and EN580C a cut save gives the factory values
//! (MANUALS.md U-33).

use std::sync::{Arc, Mutex, PoisonError};

use od_devices::encoders;
use od_model::{Address, Group};
use od_runtime::DeviceKind;
use od_runtime::storage::{Geometry, Memory, Storage, StorageError, image};
use od_runtime::{CutSave, Frame, NodeId};
use od_sim::{Bus, VirtualDevice};

#[path = "../../crates/od-runtime/tests/all/nor.rs"]
mod nor;

use nor::Nor;

/// A memory that outlives its device, and whose power can be cut.
struct Shared<S>(Arc<Mutex<S>>);

impl<S> Shared<S> {
    fn with<R>(&self, act: impl FnOnce(&mut S) -> R) -> R {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl<S: Storage> Storage for Shared<S> {
    fn capacity(&self) -> usize {
        self.with(|memory| memory.capacity())
    }

    fn geometry(&self) -> Geometry {
        self.with(|memory| memory.geometry())
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.with(|memory| memory.read(offset, to))
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.with(|memory| memory.write(offset, bytes))
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        self.with(|memory| memory.erase(offset))
    }
}

type Values = Vec<(Address, Vec<u8>)>;

struct Bench {
    kind: &'static DeviceKind,
    bus: Bus,
}

impl Bench {
    fn start<S: Storage + Send + 'static>(
        kind: &'static DeviceKind,
        memory: S,
    ) -> (Self, Shared<S>) {
        let shared = Shared(Arc::new(Mutex::new(memory)));
        let lent = Shared(shared.0.clone());
        let device = VirtualDevice::new(kind, NodeId::ONE).with_storage(Box::new(lent));
        let mut bus = Bus::new();
        bus.add(device);
        bus.start(0);
        let mut bench = Self { kind, bus };
        bench.wait(300);
        (bench, shared)
    }

    fn wait(&mut self, millis: u64) {
        self.bus.advance(self.bus.now().plus_millis(millis));
        while self.bus.poll().is_some() {}
    }

    /// The values that 1010h saves.
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

    /// Values for the whole dictionary that depend on `with`.
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

    /// Saves all groups, and waits as long as the slowest family needs.
    fn save(&mut self) {
        self.send(0x23, 0x1010, 1, u32::from_le_bytes(*b"save"));
        self.wait(1500);
    }
}

/// The values after a start with this memory.
fn values_of(kind: &'static DeviceKind, memory: impl Storage + Send + 'static) -> Values {
    Bench::start(kind, memory).0.values()
}

fn difference(a: &Values, b: &Values) -> Vec<Address> {
    let pairs = a.iter().zip(b).filter(|(a, b)| a != b);
    pairs.map(|(a, _)| a.0).collect()
}

/// A memory that loses its power in the step after a number of complete steps.
trait Cut: Storage + Clone + Send + 'static {
    fn cut_after(&mut self, steps: usize);
    fn is_cut(&self) -> bool;
    fn restore(&mut self);
}

impl Cut for Memory<Vec<u8>> {
    fn cut_after(&mut self, steps: usize) {
        Memory::cut_after(self, steps);
    }

    fn is_cut(&self) -> bool {
        Memory::is_cut(self)
    }

    fn restore(&mut self) {
        self.restore_power();
    }
}

impl Cut for Nor {
    fn cut_after(&mut self, steps: usize) {
        Nor::cut_after(self, steps, steps as u64);
    }

    fn is_cut(&self) -> bool {
        self.is_cut
    }

    fn restore(&mut self) {
        self.restore_power();
    }
}

fn cut_everywhere<S: Cut>(kind: &'static DeviceKind, erased: S, least: usize) {
    let name = kind.name;
    let factory = values_of(kind, erased.clone());
    // A device that has already been saved once.
    let (mut bench, memory) = Bench::start(kind, erased);
    bench.change(1);
    bench.save();
    let first = memory.with(|memory| memory.clone());
    let before = values_of(kind, first.clone());
    bench.change(2);
    bench.save();
    let after = values_of(kind, memory.with(|memory| memory.clone()));
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
        let (mut bench, memory) = Bench::start(kind, first.clone());
        bench.change(2);
        memory.with(|memory| memory.cut_after(cut));
        bench.save();
        let was_cut = memory.with(|memory| memory.is_cut());
        let now = values_of(
            kind,
            memory.with(|memory| {
                memory.restore();
                memory.clone()
            }),
        );
        if !was_cut {
            let differs = difference(&now, &after);
            assert!(differs.is_empty(), "{name}: the whole save: {differs:?}");
            break;
        }
        cuts += 1;
        // Before its first step a save has not begun, and after its last one it is complete.
        let untouched = cut == 0 && now == before;
        let complete = now == after;
        assert!(
            now == *kept || untouched || complete,
            "{name}, cut after {cut} steps: the values are a mixture; {:?} differ from those before the save, \
             {:?} from the factory values, {:?} from the new ones",
            difference(&now, &before),
            difference(&now, &factory),
            difference(&now, &after)
        );
    }
    assert!(cuts > least, "{name}: only {cuts} cuts");
}

#[test]
fn a_power_cut_at_any_byte_or_word_of_a_save() {
    std::thread::scope(|scope| {
        for kind in encoders() {
            let thread = std::thread::Builder::new().name(kind.name.into());
            let spawned = thread.spawn_scoped(scope, move || {
                let capacity = VirtualDevice::new(kind, NodeId::ONE).storage_needed();
                cut_everywhere(kind, Memory::new(vec![0xFF; capacity]), 200);
                let capacity = image::capacity_on(&kind.dictionary, 256, 8);
                cut_everywhere(kind, Nor::new(capacity, 256, 8), 25);
            });
            assert!(spawned.is_ok(), "no thread for {}", kind.name);
        }
    });
}
