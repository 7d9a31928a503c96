//! Log of the calls of a device on the bench, in the bytes that the firmware reads, and of its
//! responses.
//!
//! `firmware/twin/src/twin.rs` describes the bytes.

use std::sync::{Arc, Mutex};

use od_model::Address;
use od_runtime::encoder::{Angle, Encoder, Fault, Motion, Role};
use od_runtime::storage::Storage;
use od_runtime::{BusEvent, Event, Frame, Instant};
use od_sim::VirtualDevice;
use od_sim::shaft::Shaft;
use od_sim::twin::{Before, Call, Twin};

/// Between two calls the shaft is sampled every millisecond, at most this number of times.
const SAMPLES: u64 = 2000;

/// Maximum time in microseconds between two positions of one movement.
const MOVEMENT: u64 = 20_000;

/// Bytes of a response before its frames: state, node ID, hash of the events, next deadline.
pub(crate) const HEAD: usize = 14;

/// A frame in the log: CAN-ID, DLC, data.
pub(crate) type Bytes = [u8; 13];

/// A response, without the time that it took.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub(crate) struct Answer {
    /// State, node ID, events, deadline.
    pub(crate) head: [u8; HEAD],
    /// Frames that were sent.
    pub(crate) frames: Vec<Bytes>,
    /// A hash of each value, and the EEPROM, if they were requested.
    pub(crate) rest: Vec<u8>,
}

/// A sequence of calls, and the responses of the bench's device.
#[derive(Default)]
pub(crate) struct Log {
    /// All calls, one after another.
    pub(crate) bytes: Vec<u8>,
    /// Place in `bytes` of each call that has a response.
    pub(crate) calls: Vec<usize>,
    /// The responses.
    pub(crate) answers: Vec<Answer>,
    /// The shaft at the last call.
    last: Option<Last>,
    /// Frames and events since the last call.
    sent: Vec<Bytes>,
    events: String,
    /// Switches and faults as last logged.
    world: Option<[u8; 4]>,
    /// The EEPROM when power was switched off.
    eeprom: Vec<u8>,
    /// Values in `rest` that may differ: speeds and accelerations at the end of the log, because
    /// no frame reads them.
    pub(crate) loose: Vec<usize>,
}

/// The shaft at a call.
struct Last {
    at: Instant,
    shaft: Shaft,
    sample: Angle,
    /// Time when it was moved without a speed.
    jumped: Option<Instant>,
    powered: bool,
}

/// A twin of a device: it writes the calls into a log that it shares with the caller.
pub(crate) struct Writer(pub Arc<Mutex<Log>>);

impl Twin for Writer {
    fn call(&mut self, device: Before<'_>, now: Instant, call: Call<'_>) {
        self.0
            .lock()
            .expect("nobody panicked")
            .log(device, now, call);
    }

    fn sent(&mut self, frame: &Frame) {
        self.0
            .lock()
            .expect("nobody panicked")
            .sent
            .push(bytes(frame));
    }

    fn happened(&mut self, event: &Event) {
        self.0.lock().expect("nobody panicked").events += &format!("{event:?}");
    }
}

impl Log {
    /// Adds a call.
    fn add(&mut self, letter: u8, now: Instant, what: &[u8]) {
        self.bytes.push(letter);
        self.bytes.extend(now.as_micros().to_le_bytes());
        self.bytes.extend(what);
    }

    /// Adds the response to the last call.
    fn close(&mut self, device: &Before<'_>) {
        let events = std::mem::take(&mut self.events);
        if self.answers.len() < self.calls.len() {
            let due = device.due.unwrap_or(Instant::MAX);
            let mut head = [0; HEAD];
            head[0] = device.state as u8;
            head[1] = device.node_id.raw();
            head[2..6].copy_from_slice(&hash(events.as_bytes()));
            head[6..].copy_from_slice(&due.as_micros().to_le_bytes());
            self.answers.push(Answer {
                head,
                frames: std::mem::take(&mut self.sent),
                rest: Vec::new(),
            });
        }
    }

    fn log(&mut self, device: Before<'_>, now: Instant, call: Call<'_>) {
        self.close(&device);
        let encoder = device.encoder.expect("these devices are encoders");
        if self.last.is_none() {
            let number = encoder.serial_number();
            let mut new = vec![device.node_id.raw(), u8::from(number.is_some())];
            new.extend(number.unwrap_or_default().to_le_bytes());
            self.add(b'N', now, &new);
            self.eeprom = vec![0xFF; device.storage.capacity()];
        }
        self.look_around(encoder, device.is_powered, now, call);
        if let Call::PowerOn = call {
            let eeprom = content(device.storage);
            if eeprom != self.eeprom {
                self.add(b'E', now, &eeprom);
            }
        }
        self.calls.push(self.bytes.len());
        match call {
            Call::PowerOn => self.add(b'+', now, &[]),
            Call::PowerOff => {
                self.eeprom = content(device.storage);
                self.add(b'-', now, &[]);
            }
            Call::Frame(frame) => self.add(b'F', now, &bytes(frame)),
            Call::Timeout => self.add(b'T', now, &[]),
            Call::Change => self.add(b'C', now, &[]),
            Call::Boot => self.add(b'I', now, &[]),
            Call::Bus(event) => {
                let number = match event {
                    BusEvent::Active => 0,
                    BusEvent::Warning => 1,
                    BusEvent::Passive => 2,
                    BusEvent::Off => 3,
                    BusEvent::Overrun => 4,
                    _ => panic!("{event:?} has no number in a log"),
                };
                self.add(b'B', now, &[number]);
            }
            Call::Value(address, value) => {
                let [low, high] = address.index.to_le_bytes();
                let len = u8::try_from(value.len()).expect("no value here is that long");
                let head = [low, high, address.sub, len];
                self.add(b'V', now, &[&head, value].concat());
            }
            Call::Error(error, on) => {
                let [low, high] = error.code.to_le_bytes();
                let head = [low, high, error.register];
                let all = [&head, &error.info[..], &[u8::from(on)]].concat();
                self.add(b'X', now, &all);
            }
            Call::End => {
                self.add(b'D', now, &[]);
                self.close(&device);
            }
        }
    }

    /// Adds changes of switches, faults and shaft.
    fn look_around(
        &mut self,
        encoder: &Encoder<Shaft>,
        is_powered: bool,
        now: Instant,
        call: Call<'_>,
    ) {
        let mut faults = 0u16;
        for (at, (fault, _)) in Fault::NAMES.iter().enumerate() {
            faults |= u16::from(encoder.is_broken(*fault)) << at;
        }
        let (switches, [low, high]) = (encoder.switches(), faults.to_le_bytes());
        let world = [switches.node_id, switches.bit_rate, low, high];
        if self.world != Some(world) {
            self.add(b'W', now, &world);
            self.world = Some(world);
        }
        let mut shaft = encoder.shaft.clone();
        if let Call::PowerOn = call {
            // Revolutions that were not counted are lost.
            shaft.start(now, encoder.profile().counter, encoder.sensor());
        }
        let sample = shaft.seen(now);
        let mut letter = match call {
            Call::PowerOn | Call::Change | Call::Boot => Some(b'S'),
            _ => None,
        };
        let mut jumped = None;
        if let Some(last) = self.last.take() {
            jumped = last.jumped;
            let turned = last.shaft.seen(now);
            if turned != last.sample {
                letter = Some(b'S');
                self.sample(&last, now);
            }
            if turned != sample {
                // A shaft that is moved again within this time turns; one that is moved once jumps.
                let moves = |at: Instant| at < now && now.micros_since(at) <= MOVEMENT;
                letter = Some(if jumped.is_some_and(moves) {
                    b'S'
                } else {
                    b'J'
                });
                jumped = Some(now);
            }
        }
        if let Some(letter) = letter {
            self.add(letter, now, &sample.fractions().to_le_bytes());
        }
        self.last = Some(Last {
            at: now,
            shaft,
            sample,
            jumped,
            powered: match call {
                Call::PowerOn => true,
                Call::PowerOff => false,
                _ => is_powered,
            },
        });
    }

    /// Adds samples of the shaft between the last call and now.
    fn sample(&mut self, last: &Last, now: Instant) {
        let pause = now.micros_since(last.at);
        let step = (pause / SAMPLES).max(1000);
        for after in (step..pause).step_by(step as usize) {
            if last.powered {
                let at = last.at.plus_micros(after);
                self.add(b'S', at, &last.shaft.seen(at).fractions().to_le_bytes());
            }
        }
    }

    /// Adds the values of the device and its EEPROM to the last response, which belongs to
    /// [`Call::End`].
    pub(crate) fn end(&mut self, device: &mut VirtualDevice, now: Instant) {
        let addresses: Vec<_> = (device.dictionary().entries().iter())
            .map(|entry| entry.address)
            .collect();
        let encoder = device.encoder().expect("these devices are encoders");
        let moves = |at: &Address| {
            let role = encoder.profile().role(*at);
            matches!(role, Some(Role::Movement(_)))
        };
        self.loose = (0..addresses.len())
            .filter(|index| moves(&addresses[*index]))
            .collect();
        let values = addresses.iter().map(|at| hash(&device.read(*at, now)));
        let mut rest = values.collect::<Vec<_>>().concat();
        rest.extend(device.eeprom());
        if let Some(answer) = self.answers.last_mut() {
            answer.rest = rest;
        }
    }

    /// Returns whether a response of the firmware equals that of the bench.
    pub(crate) fn agrees(&self, own: &Answer, its: &Answer) -> bool {
        let (heads, frames) = (own.head == its.head, own.frames == its.frames);
        let mut pairs = own.rest.iter().zip(&its.rest).enumerate();
        let rests = pairs.all(|(at, (own, its))| own == its || self.loose.contains(&(at / 4)));
        heads && frames && own.rest.len() == its.rest.len() && rests
    }

    /// A call in words.
    pub(crate) fn describe(&self, call: usize) -> String {
        let (Some(start), end) = (self.calls.get(call), self.calls.get(call + 1)) else {
            return String::from("nothing");
        };
        let bytes = &self.bytes[*start..end.copied().unwrap_or(self.bytes.len())];
        let at = bytes[1..9].try_into().map_or(0, u64::from_le_bytes);
        let at = Instant::from_micros(at);
        let letter = char::from(bytes[0]);
        match bytes.get(9..22).map(<[u8; 13]>::try_from) {
            Some(Ok(frame)) if letter == 'F' => format!("({at:?}) F {}", shown(&frame)),
            _ => format!("({at:?}) {letter}"),
        }
    }
}

/// The bytes of an EEPROM.
fn content(storage: &mut dyn Storage) -> Vec<u8> {
    let mut bytes = vec![0; storage.capacity()];
    let read = storage.read(0, &mut bytes);
    read.expect("power is not cut here");
    bytes
}

/// FNV-1a of 32 bits.
fn hash(bytes: &[u8]) -> [u8; 4] {
    let add = |hash: u32, byte: &u8| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193);
    bytes.iter().fold(0x811C_9DC5, add).to_le_bytes()
}

/// A frame in the format of the log.
fn bytes(frame: &Frame) -> Bytes {
    let id = frame.id().raw() | u32::from(frame.id().is_extended()) << 31;
    let dlc = frame.dlc() | u8::from(frame.is_remote()) << 7;
    let all = [&id.to_le_bytes()[..], &[dlc], frame.bytes()].concat();
    all.try_into().expect("4, 1 and 8 bytes")
}

/// A frame, to display.
pub(crate) fn shown(bytes: &Bytes) -> String {
    let [a, b, c, d, dlc, data @ ..] = bytes;
    let id = u32::from_le_bytes([*a, *b, *c, *d]);
    let len = usize::from(dlc & 15).min(8);
    let data: String = data[..len]
        .iter()
        .map(|byte| format!("{byte:02X}"))
        .collect();
    match dlc >> 7 {
        0 => format!("{id:03X}#{data}"),
        _ => format!("{id:03X}#R{len}"),
    }
}
