//! Calls of a device of the bench, in the format that `crates/od-capi/examples/c/virtual.c` reads, and the
//! responses of the device.

use std::sync::{Arc, Mutex};

use od_model::Address;
use od_runtime::storage::Storage;
use od_runtime::{BusEvent, Event, Frame, Instant};
use od_sim::VirtualDevice;
use od_sim::twin::{Before, Call, Twin};

/// Frame as it is written: CAN-ID with flags, length, data.
pub(crate) type Bytes = [u8; 13];

/// A sequence of calls, and the responses of the bench's device.
#[derive(Default)]
pub(crate) struct Log {
    calls: Vec<u8>,
    /// Frames with their times in microseconds.
    pub(crate) frames: Vec<(u64, Bytes)>,
    /// Bit rates in kbit/s that LSS activated.
    pub(crate) rates: Vec<u32>,
    /// Values at the end.
    pub(crate) values: Vec<(Address, Vec<u8>)>,
    /// The EEPROM at the end.
    pub(crate) eeprom: Vec<u8>,
    /// Time of the last call.
    now: Instant,
    /// Node ID before the first start.
    node_id: Option<u8>,
}

/// The twin of a device: it writes a log, which the caller also has.
pub(crate) struct Writer(pub Arc<Mutex<Log>>);

impl Twin for Writer {
    fn call(&mut self, device: Before<'_>, now: Instant, call: Call<'_>) {
        self.0
            .lock()
            .expect("nobody panicked")
            .add(device, now, call);
    }

    fn sent(&mut self, frame: &Frame) {
        let mut log = self.0.lock().expect("nobody panicked");
        let now = log.now.as_micros();
        log.frames.push((now, bytes(frame)));
    }

    fn happened(&mut self, event: &Event) {
        if let Event::BitRate(index) = *event {
            let kbit = od_wire::lss::kbit(index).unwrap_or_default();
            self.0
                .lock()
                .expect("nobody panicked")
                .rates
                .push(kbit.into());
        }
    }
}

impl Log {
    fn call(&mut self, letter: u8, now: Instant, what: &[u8]) {
        self.now = now;
        self.calls.push(letter);
        self.calls.extend(now.as_micros().to_le_bytes());
        self.calls.extend(what);
    }

    fn add(&mut self, device: Before<'_>, now: Instant, call: Call<'_>) {
        if self.node_id.is_none() {
            self.node_id = Some(device.node_id.raw());
            self.eeprom = vec![0xFF; device.storage.capacity()];
            let len = u32::try_from(self.eeprom.len()).expect("an EEPROM");
            self.call(b'N', now, &len.to_le_bytes());
        }
        match call {
            Call::End => {}
            Call::PowerOn => {
                let eeprom = content(device.storage);
                if eeprom != self.eeprom {
                    self.call(b'E', now, &eeprom);
                }
                self.call(b'+', now, &[self.node_id.unwrap_or(1)]);
            }
            Call::PowerOff => {
                self.eeprom = content(device.storage);
                self.call(b'-', now, &[]);
            }
            Call::Frame(frame) => self.call(b'F', now, &bytes(frame)),
            Call::Timeout | Call::Boot => self.call(b'T', now, &[]),
            Call::Change => self.call(b'C', now, &[]),
            Call::Bus(event) => {
                let number = match event {
                    BusEvent::Active => 0,
                    BusEvent::Warning => 1,
                    BusEvent::Passive => 2,
                    BusEvent::Off => 3,
                    BusEvent::Overrun => 4,
                    _ => panic!("{event:?} has no number in C"),
                };
                self.call(b'B', now, &[number]);
            }
            Call::Value(address, value) => {
                let [low, high] = address.index.to_le_bytes();
                let len = u8::try_from(value.len()).expect("no value of a script is that long");
                self.call(b'V', now, &[&[low, high, address.sub, len], value].concat());
            }
            Call::Error(error, on) => {
                let [low, high] = error.code.to_le_bytes();
                let head = [low, high, error.register];
                self.call(
                    b'X',
                    now,
                    &[&head, &error.info[..], &[u8::from(on)]].concat(),
                );
            }
        }
    }

    /// Ends the log with the values and the EEPROM of the device.
    pub(crate) fn end(&mut self, device: &mut VirtualDevice, now: Instant) {
        if device.is_powered() {
            let entries = device.dictionary().entries();
            let addresses: Vec<Address> = entries.map(|entry| entry.address).collect();
            for address in addresses {
                let [low, high] = address.index.to_le_bytes();
                self.call(b'G', now, &[low, high, address.sub]);
                self.values.push((address, device.read(address, now)));
            }
        }
        self.call(b'D', now, &[]);
        self.eeprom = device.eeprom();
    }

    /// All calls.
    pub(crate) fn told(&self) -> impl Iterator<Item = u8> {
        self.calls.iter().copied()
    }
}

/// All bytes of a memory.
fn content(storage: &mut dyn Storage) -> Vec<u8> {
    let mut bytes = vec![0; storage.capacity()];
    storage.read(0, &mut bytes).expect("the EEPROM can be read");
    bytes
}

/// A frame in the format of the log.
fn bytes(frame: &Frame) -> Bytes {
    let id = frame.id().raw()
        | u32::from(frame.id().is_extended()) << 31
        | u32::from(frame.is_remote()) << 30;
    let all = [&id.to_le_bytes()[..], &[frame.dlc()], frame.bytes()].concat();
    all.try_into().expect("4, 1 and 8 bytes")
}

/// A frame and its time, to display.
pub(crate) fn shown(frame: Option<&(u64, Bytes)>) -> String {
    let Some((at, [a, b, c, d, len, data @ ..])) = frame else {
        return String::from("nothing");
    };
    let id = u32::from_le_bytes([*a, *b, *c, *d]);
    let data: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
    format!("({at} us) {id:03X} [{len}] {data}")
}
