//! Calls of a device, and its answers.
//!
//! The file `calls` is a row of calls: a letter, the time in microseconds (8 bytes), and the arguments; numbers are little-endian.
//!
//! | | call | and |
//! |---|---|---|
//! | `N` | a new device, without power, its EEPROM empty | node ID, 1 if it has a serial number, serial number (4) |
//! | `E` | the EEPROM has these bytes | as many as it has |
//! | `W` | switches and faults | node ID, bit rate, a bit for each fault (2) |
//! | `S` | a sample of the shaft | 2⁻³² revolutions (8) |
//! | `J` | the same, of a shaft that jumped | 2⁻³² revolutions (8) |
//! | `+`, `-` | power on, power off | |
//! | `F` | a frame | CAN-ID (4, bit 31: 29 bits), DLC with bit 7 for a remote frame, data (8) |
//! | `T`, `C`, `I` | time-out, change outside, initialisation ends | |
//! | `B` | the state of the CAN controller changes | 0 to 4: active, warning, passive, off, overrun |
//! | `V` | the device sets a value | index (2), sub-index, length, value |
//! | `X` | the device reports an error | code (2), register, information (5), 1 if the error begins |
//! | `D` | all values and the EEPROM are requested | |
//!
//! Each call except the first five has an answer: state, node ID, hash of the events (4), next
//! deadline in microseconds (8), ticks of the clock (4), number of frames, and the frames as above.
//! `D` adds a hash of each value (4) and the bytes of the EEPROM.

use odkit::encoder::{Angle, Encoder, Family, Fault, Motion, Sampled, Switches};
use odkit::{
    Address, Application, BusEvent, CanId, Context, Device, Duration, Emcy, Frame, Instant, Node,
    NodeId, Signals,
};
use odkit_firmware::board;

use crate::files::{Input, Output};
use crate::parts::{Eeprom, Shaft};

/// Maximum number of frames of an answer; the longest is a block of 127 segments.
const FRAMES: usize = 160;

/// FNV-1a of 32 bits.
struct Hash(u32);

impl Hash {
    const fn new() -> Self {
        Self(0x811C_9DC5)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u32::from(*byte)).wrapping_mul(0x0100_0193);
        }
    }
}

impl core::fmt::Write for Hash {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.add(text.as_bytes());
        Ok(())
    }
}

/// The node of a device; the type of the device is also its family.
pub type Slave<D> = Node<D, Encoder<Shaft, D>, Eeprom>;

/// A node without power, with an EEPROM of 0 bytes.
pub const fn slave<D: Device + Family>(device: D, node_id: NodeId) -> Slave<D> {
    let shaft = Sampled::new(Angle::ZERO, Duration::from_millis(1));
    let encoder = Encoder::of_family(Shaft(shaft));
    Node::new(device, node_id, encoder, Eeprom::new(&mut []))
}

/// A node and its environment.
struct Twin<'b, D: Device> {
    node: &'b mut Slave<D>,
    calls: Input,
    answers: Output,
    frames: [Frame; FRAMES],
    /// Ticks between two consecutive reads of the clock.
    overhead: u32,
}

/// Handles all calls.
pub fn run<D: Device + Family + Copy>(node: &mut Slave<D>, eeprom: &'static mut [u8]) -> ! {
    node.storage = Eeprom::new(eeprom);
    board::start_clock();
    let before = board::clock();
    let overhead = since(before);
    let mut twin = Twin {
        node,
        calls: Input::open(c"calls"),
        answers: Output::open(c"answers"),
        frames: [Frame::standard(0, &[]); FRAMES],
        overhead,
    };
    while let Some(call) = twin.calls.byte() {
        if twin.call(call).is_none() {
            board::exit(false);
        }
    }
    twin.answers.write();
    board::exit(true)
}

/// Ticks since the clock was read.
fn since(before: u32) -> u32 {
    before.wrapping_sub(board::clock()) & 0xFF_FFFF
}

impl<D: Device + Family + Copy> Twin<'_, D> {
    /// Handles a call; `None` if it is not valid.
    fn call(&mut self, call: u8) -> Option<()> {
        let now = Instant::from_micros(u64::from_le_bytes(self.calls.array()?));
        match call {
            b'N' => self.renew()?,
            b'E' => self.calls.fill(self.node.storage.memory.bytes_mut())?,
            b'W' => self.turn_switches()?,
            b'S' | b'J' => {
                let angle = i64::from_le_bytes(self.calls.array()?);
                self.node.application.shaft.0.source = Angle::from_fractions(angle);
                if call == b'J' {
                    // The angle between the last sample and this one is unknown.
                    self.node.application.shaft.power_off(now);
                }
                if self.node.is_powered() {
                    // Samples have no faults here.
                    let _ = self.node.application.shaft.angle(now);
                }
            }
            b'D' => {
                self.answer(now, |_| ());
                self.show(now);
            }
            _ => self.act(call, now)?,
        }
        Some(())
    }

    fn renew(&mut self) -> Option<()> {
        let [node_id, has_number, number @ ..] = self.calls.array::<6>()?;
        let device = *self.node.device();
        let mut new = slave(device, NodeId::new(node_id)?);
        new.application = new.application.with_sensor_of(device.dictionary());
        if has_number != 0 {
            new.application = new
                .application
                .with_serial_number(u32::from_le_bytes(number));
        }
        core::mem::swap(&mut new.storage, &mut self.node.storage);
        new.storage.memory.bytes_mut().fill(0xFF);
        *self.node = new;
        Some(())
    }

    fn turn_switches(&mut self) -> Option<()> {
        let [node_id, bit_rate, faults @ ..] = self.calls.array::<4>()?;
        let faults = u16::from_le_bytes(faults);
        self.node
            .application
            .set_switches(Switches { node_id, bit_rate });
        for (at, (fault, _)) in Fault::NAMES.iter().enumerate() {
            let broken = faults >> at & 1 != 0;
            // A watchdog that is set twice resets twice.
            if self.node.application.is_broken(*fault) != broken {
                self.node.application.set_fault(*fault, broken);
            }
        }
        self.node.storage.broken = self.node.application.is_broken(Fault::Memory);
        Some(())
    }

    /// Handles the calls that have an answer.
    fn act(&mut self, call: u8, now: Instant) -> Option<()> {
        match call {
            b'F' => {
                let frame = frame(self.calls.array()?)?;
                self.answer(now, |node| node.handle_frame(now, &frame));
            }
            b'T' => self.answer(now, |node| node.handle_timeout(now)),
            b'C' => self.answer(now, |node| node.handle_change(now)),
            b'I' => self.answer(now, |node| node.boot_at_once(now)),
            b'B' => {
                let event = match self.calls.byte()? {
                    0 => BusEvent::Active,
                    1 => BusEvent::Warning,
                    2 => BusEvent::Passive,
                    3 => BusEvent::Off,
                    _ => BusEvent::Overrun,
                };
                self.answer(now, |node| node.handle_bus(now, event));
            }
            b'+' => self.answer(now, |node| node.power_on(now)),
            b'-' => {
                self.node.application.power_off(now);
                self.answer(now, |node| node.power_off());
            }
            b'V' => {
                let [low, high, sub, len] = self.calls.array()?;
                let address = Address::new(u16::from_le_bytes([low, high]), sub);
                let mut value = [0; 255];
                let value = value.get_mut(..len.into())?;
                self.calls.fill(value)?;
                self.answer(now, |node| {
                    // The bench refuses the same calls.
                    let _ = node.set_value(now, address, value);
                });
            }
            b'X' => {
                let [low, high, register, info @ .., on] = self.calls.array::<9>()?;
                let code = u16::from_le_bytes([low, high]);
                let error = Emcy {
                    code,
                    register,
                    info,
                };
                self.answer(now, |node| {
                    match on {
                        0 => node.clear(now, error),
                        _ => node.raise(now, error),
                    };
                });
            }
            _ => return None,
        }
        Some(())
    }

    /// Calls the node, takes the frames that it sends, and writes the answer.
    fn answer(&mut self, now: Instant, call: impl FnOnce(&mut Slave<D>)) {
        let before = board::clock();
        call(self.node);
        let mut ticks = since(before).saturating_sub(self.overhead);
        let mut events = Hash::new();
        while let Some(event) = self.node.poll_event() {
            // A hash takes all.
            let _ = core::fmt::write(&mut events, format_args!("{event:?}"));
        }
        let mut count = 0;
        let before = board::clock();
        while let Some(frame) = self.node.poll_transmit(now) {
            if let Some(room) = self.frames.get_mut(count) {
                *room = frame;
                count += 1;
            }
        }
        ticks += since(before).saturating_sub(self.overhead);
        let due = self.node.poll_timeout().unwrap_or(Instant::MAX);
        let out = &mut self.answers;
        out.put(&[self.node.state() as u8, self.node.node_id().raw()]);
        out.put(&events.0.to_le_bytes());
        out.put(&due.as_micros().to_le_bytes());
        out.put(&ticks.to_le_bytes());
        out.put(&[count as u8]);
        for frame in self.frames.iter().take(count) {
            let id = frame.id().raw() | u32::from(frame.id().is_extended()) << 31;
            out.put(&id.to_le_bytes());
            out.put(&[frame.dlc() | u8::from(frame.is_remote()) << 7]);
            out.put(frame.bytes());
        }
    }

    /// Writes every present value, and the EEPROM.
    fn show(&mut self, now: Instant) {
        let Self { node, answers, .. } = self;
        let (device, is_powered) = (*node.device(), node.is_powered());
        node.look(|encoder, store| {
            for entry in device.dictionary().entries() {
                if is_powered && entry.address.index >= 0x2000 {
                    let mut context = Context {
                        store,
                        now,
                        signals: &mut Signals::default(),
                    };
                    // Without a new value, the last one is shown.
                    let _ = encoder.refresh(&mut context, entry.address);
                }
                let mut hash = Hash::new();
                hash.add(store.bytes(&entry, &mut [0; 8]));
                answers.put(&hash.0.to_le_bytes());
            }
        });
        answers.put(node.storage.memory.bytes());
    }
}

/// A frame in its written form.
fn frame(bytes: [u8; 13]) -> Option<Frame> {
    let [a, b, c, d, dlc, data @ ..] = bytes;
    let raw = u32::from_le_bytes([a, b, c, d]);
    let id = match raw >> 31 {
        0 => CanId::standard(raw as u16),
        _ => CanId::extended(raw),
    };
    match dlc >> 7 {
        0 => Some(Frame::with_dlc(id, data, dlc)),
        _ => Frame::remote(id, dlc & 15),
    }
}
