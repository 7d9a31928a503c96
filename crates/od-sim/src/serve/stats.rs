//! Figures of a live bench: frames, load, and the frames of each client.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::{Duration, Instant as Clock};

use od_runtime::Frame;
use serde::Serialize;

use super::greeting::node;
use super::ready::line;
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::line::bits::occupied;
use crate::words::plural;

/// Load and frames per second are measured over this time.
const WINDOW: Duration = Duration::from_secs(1);

/// Frames of a client.
#[derive(Clone, Copy, Default)]
pub(super) struct Sent {
    pub(super) frames: u64,
    /// SDO requests, and the aborts in response to them.
    pub(super) requests: u64,
    pub(super) aborts: u64,
}

/// A client in a report.
pub(super) struct Guest<'c> {
    pub(super) number: usize,
    pub(super) name: &'c str,
    pub(super) protocol: &'static str,
    /// Messages that odkit dropped because the client does not read.
    pub(super) dropped: u64,
    /// Frames of its link that the system dropped before odkit read them.
    pub(super) missed: u64,
}

/// The figures, for programs: seconds, bit/s, a load from 0 to 1.
#[derive(Serialize)]
struct Report<'g> {
    version: u8,
    uptime: f64,
    frames: u64,
    frames_per_second: u64,
    bit_rate: u32,
    load: f64,
    dropped: u64,
    nodes: Vec<Node>,
    clients: Vec<Traffic<'g>>,
}

#[derive(Serialize)]
struct Node {
    /// Counted from 1.
    number: usize,
    node_id: Option<u8>,
    state: String,
}

/// Frames that a client sent, and frames of the bus that it missed.
#[derive(Serialize)]
struct Traffic<'g> {
    name: &'g str,
    protocol: &'static str,
    frames: u64,
    dropped: u64,
    missed: u64,
    sdo_requests: u64,
    sdo_aborts: u64,
}

/// The figures.
pub(super) struct Stats {
    start: Clock,
    /// Bit rate for a bus without one, in bit/s.
    bit_rate: u32,
    pub(super) frames: u64,
    sent: BTreeMap<usize, Sent>,
    /// The current window and the one before it: frames and bits.
    since: Clock,
    now: (u64, u64),
    before: (u64, u64),
}

impl Stats {
    pub(super) fn new(bit_rate: u32) -> Self {
        let start = Clock::now();
        Self {
            start,
            bit_rate,
            frames: 0,
            sent: BTreeMap::new(),
            since: start,
            now: (0, 0),
            before: (0, 0),
        }
    }

    /// Counts a frame of the bus. `from`: the client that sent it; `cause`: the client that caused it.
    pub(super) fn frame(&mut self, frame: &Frame, from: Option<usize>, cause: Option<usize>) {
        self.roll(Clock::now());
        self.frames += 1;
        self.now.0 += 1;
        self.now.1 += occupied(frame);
        let id = frame.id().as_standard().unwrap_or_default();
        if let Some(sent) = from.map(|from| self.sent.entry(from).or_default()) {
            sent.frames += 1;
            sent.requests += u64::from(matches!(id, 0x601..=0x67F));
        } else if let Some(cause) = cause
            && matches!(id, 0x581..=0x5FF)
            && frame.data().first() == Some(&0x80)
        {
            self.sent.entry(cause).or_default().aborts += 1;
        }
    }

    /// Removes a client that has left.
    pub(super) fn forget(&mut self, client: usize) {
        self.sent.remove(&client);
    }

    fn roll(&mut self, clock: Clock) {
        let passed = clock.duration_since(self.since);
        if passed < WINDOW {
            return;
        }
        let now = std::mem::take(&mut self.now);
        self.before = if passed < 2 * WINDOW { now } else { (0, 0) };
        self.since = clock;
    }

    /// The figures as one line of JSON.
    pub(super) fn json(&mut self, bus: &Bus, guests: &[Guest<'_>]) -> String {
        let (bit_rate, frames_per_second, load) = self.load(bus);
        let nodes = (1..).zip(bus.devices()).map(|(number, device)| Node {
            number,
            node_id: device.is_configured().then(|| device.node_id().raw()),
            state: state(device),
        });
        let clients = guests.iter().map(|guest| {
            let sent = self.of(guest);
            Traffic {
                name: guest.name,
                protocol: guest.protocol,
                frames: sent.frames,
                dropped: guest.dropped,
                missed: guest.missed,
                sdo_requests: sent.requests,
                sdo_aborts: sent.aborts,
            }
        });
        line(&Report {
            version: 1,
            uptime: rounded(self.start.elapsed().as_secs_f64(), 1e3),
            frames: self.frames,
            frames_per_second,
            bit_rate,
            load: rounded(load, 1e4),
            dropped: dropped(guests),
            nodes: nodes.collect(),
            clients: clients.collect(),
        })
    }

    /// The figures as lines for a person.
    pub(super) fn text(&mut self, bus: &Bus, guests: &[Guest<'_>]) -> String {
        let (rate, per_second, load) = self.load(bus);
        let up = self.start.elapsed().as_secs_f64();
        let dropped = dropped(guests);
        let mut text = format!(
            "up {up:.1} s, {}, {per_second} per second, load {:.1} % of {} kbit/s, {dropped} dropped\n",
            plural(self.frames as usize, "frame"),
            load * 100.0,
            rate / 1000,
        );
        for (number, device) in (1..).zip(bus.devices()) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{number}  {}: {}", node(device), state(device));
        }
        for guest in guests {
            let sent = self.of(guest);
            let _ = writeln!(
                text,
                "{} ({}): {} sent, {} dropped, {} missed, {}, {}",
                guest.name,
                guest.protocol,
                plural(sent.frames as usize, "frame"),
                guest.dropped,
                guest.missed,
                plural(sent.requests as usize, "SDO request"),
                plural(sent.aborts as usize, "abort"),
            );
        }
        text
    }

    fn of(&self, guest: &Guest<'_>) -> Sent {
        self.sent.get(&guest.number).copied().unwrap_or_default()
    }

    /// Bit rate in bit/s, frames per second, and the load from 0 to 1.
    fn load(&mut self, bus: &Bus) -> (u32, u64, f64) {
        self.roll(Clock::now());
        let rate = bus.line.bit_rate.or(bus.bit_rate());
        let rate = rate.map_or(self.bit_rate, |kbit| u32::from(kbit) * 1000);
        let is_first = self.start == self.since;
        let (frames, bits) = if is_first { self.now } else { self.before };
        (rate, frames, bits as f64 / f64::from(rate.max(1)))
    }
}

fn dropped(guests: &[Guest<'_>]) -> u64 {
    guests.iter().map(|guest| guest.dropped).sum()
}

/// `operational`, or `off`.
fn state(device: &VirtualDevice) -> String {
    if device.is_powered() {
        device.state().to_string()
    } else {
        String::from("off")
    }
}

fn rounded(number: f64, parts: f64) -> f64 {
    (number * parts).round() / parts
}
