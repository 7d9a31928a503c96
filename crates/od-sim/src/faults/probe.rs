//! The probes of a learner: where to look, what is done on the bench for it, and what is seen.

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use od_model::{Address, values};
use od_runtime::{Frame, Instant};

use super::sight::{Answer, Edges, Language, Often, Share, Sight, Subject, named};
use crate::bench::Bench;
use crate::bus::Bus;
use crate::grammar::problem::Problem;
use crate::line::FrameError;
use crate::rig::LineEvent;

/// Time in which the learner listens, in microseconds.
const LISTEN: u64 = 3_000_000;
/// Time for the frames after an NMT command, in microseconds.
const AFTER_COMMAND: u64 = 2_500_000;
/// Time for a response, in microseconds.
const RESPONSE: u64 = 500_000;
/// Time between two readings of an object, in microseconds.
const AFTER_READ: u64 = 1_000_000;
/// Terminating resistor in ohms (ISO 11898-2).
const TERMINATOR: u16 = 120;
/// Maximum number of frames of a reading that are kept.
const KEPT: usize = 2000;

/// A place to look at. Names are those of devices on the bench.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Probe {
    /// Looks at the trace.
    Listen,
    /// Reads an object of a node by SDO.
    Read(String, Address),
    /// Reads an object twice, one second apart.
    Compare(String, Address),
    /// Resets a node by NMT.
    Reset(String),
    /// Starts a node by NMT.
    Start(String),
    /// Sends one SYNC.
    Sync,
    /// Measures the resistance between CAN_H and CAN_L.
    Resistance,
    /// Looks at the bits with an oscilloscope.
    Scope,
    /// Measures the length of the line.
    Length,
    /// Measures the supply voltage of a node.
    Supply(String),
    /// Looks at the switches of a node.
    Switches(String),
    /// Looks at the LEDs of a node.
    Leds(String),
    /// Disconnects a node and looks at the trace.
    Unplug(String),
    /// Takes a node to a desk, where only an interface is connected, which finds the bit rate of the node.
    Desk(String),
    /// Turns the shaft of an encoder by a quarter of a revolution.
    Turn(String),
    /// Stops all nodes and selects a device by its LSS address (CiA 305).
    Lss(String),
}

/// The result of a probe.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Reading {
    /// Observations, rounded so that two readings differ only if a person sees it. A cause fits a reading if all are equal.
    pub sights: Vec<Sight>,
    /// Frames and error frames, oldest first.
    pub frames: Vec<LineEvent>,
}

/// Node IDs of the devices with names, as they were on the healthy bench.
pub(super) type Nodes = BTreeMap<String, u8>;

impl Probe {
    /// Reads a line such as `read suspect 1000h`.
    ///
    /// # Errors
    /// The line is not a probe.
    pub fn parse(line: u32, text: &str) -> Result<Self, Problem> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let name = |one: &str| one.to_owned();
        Ok(match *words.as_slice() {
            ["listen"] => Self::Listen,
            ["sync"] => Self::Sync,
            ["resistance"] => Self::Resistance,
            ["scope"] => Self::Scope,
            ["length"] => Self::Length,
            ["read", device, object] => match values::address(object) {
                Some(address) => Self::Read(name(device), address),
                None => return Err(unknown(line, text)),
            },
            ["compare", device, object] => match values::address(object) {
                Some(address) => Self::Compare(name(device), address),
                None => return Err(unknown(line, text)),
            },
            ["reset", device] => Self::Reset(name(device)),
            ["start", device] => Self::Start(name(device)),
            ["supply", device] => Self::Supply(name(device)),
            ["switches", device] => Self::Switches(name(device)),
            ["leds", device] => Self::Leds(name(device)),
            ["unplug", device] => Self::Unplug(name(device)),
            ["desk", device] => Self::Desk(name(device)),
            ["turn", device] => Self::Turn(name(device)),
            ["lss", device] => Self::Lss(name(device)),
            _ => return Err(unknown(line, text)),
        })
    }

    /// The device that it needs.
    pub(super) fn device(&self) -> Option<&str> {
        match self {
            Self::Listen | Self::Sync | Self::Resistance | Self::Scope | Self::Length => None,
            Self::Read(device, _)
            | Self::Compare(device, _)
            | Self::Reset(device)
            | Self::Start(device)
            | Self::Supply(device)
            | Self::Switches(device)
            | Self::Leds(device)
            | Self::Unplug(device)
            | Self::Desk(device)
            | Self::Turn(device)
            | Self::Lss(device) => Some(device),
        }
    }

    /// Action of the learner, in words.
    pub(super) fn words(&self, nodes: &Nodes, language: Language) -> String {
        let node = self.device().and_then(|device| nodes.get(device));
        let node = node.copied().unwrap_or_default();
        let (english, german) = match self {
            Self::Listen => (
                "Look at the trace for 3 s".into(),
                "Den Trace 3 s lang ansehen".into(),
            ),
            Self::Read(_, address) => {
                let object = named(*address);
                (
                    format!("Read {object} of node {node} by SDO"),
                    format!("{object} von Knoten {node} mit SDO lesen"),
                )
            }
            Self::Compare(_, address) => {
                let object = named(*address);
                (
                    format!("Read {object} of node {node} by SDO twice, one second apart"),
                    format!(
                        "{object} von Knoten {node} mit SDO zweimal lesen, mit einer Sekunde Abstand"
                    ),
                )
            }
            Self::Reset(_) => (
                format!("Reset node {node} by NMT and look for its boot-up message"),
                format!(
                    "Knoten {node} mit NMT zurücksetzen und auf seine Boot-up-Nachricht achten"
                ),
            ),
            Self::Start(_) => (
                format!("Start node {node} by NMT and look at the trace"),
                format!("Knoten {node} mit NMT starten und den Trace ansehen"),
            ),
            Self::Sync => (
                "Send one SYNC and look at the trace".into(),
                "Ein SYNC senden und den Trace ansehen".into(),
            ),
            Self::Resistance => (
                "Measure the resistance between CAN_H and CAN_L, power off".into(),
                "Den Widerstand zwischen CAN_H und CAN_L messen, ohne Versorgung".into(),
            ),
            Self::Scope => (
                "Look at the bits with an oscilloscope".into(),
                "Die Bits mit einem Oszilloskop ansehen".into(),
            ),
            Self::Length => (
                "Measure the length of the bus line".into(),
                "Die Länge der Busleitung messen".into(),
            ),
            Self::Supply(_) => (
                format!("Measure the supply voltage of node {node}"),
                format!("Die Versorgungsspannung von Knoten {node} messen"),
            ),
            Self::Switches(_) => (
                format!("Open node {node} and look at its switches"),
                format!("Knoten {node} öffnen und seine Schalter ansehen"),
            ),
            Self::Leds(_) => (
                format!("Look at the LEDs of node {node}"),
                format!("Die LEDs von Knoten {node} ansehen"),
            ),
            Self::Unplug(_) => (
                format!("Unplug node {node} and look at the trace"),
                format!("Knoten {node} abstecken und den Trace ansehen"),
            ),
            Self::Desk(_) => (
                format!(
                    "Take node {node} to a desk and start it alone with an interface that finds its bit rate"
                ),
                format!(
                    "Knoten {node} ausbauen und auf dem Tisch allein mit einem Interface starten, das seine Bitrate findet"
                ),
            ),
            Self::Turn(_) => (
                format!(
                    "Turn the shaft of node {node} by a quarter of a revolution and compare the position value"
                ),
                format!(
                    "Die Welle von Knoten {node} um eine Viertelumdrehung drehen und den Positionswert vergleichen"
                ),
            ),
            Self::Lss(_) => (
                format!(
                    "Stop the nodes and select node {node} by LSS, with the serial number on its label"
                ),
                format!(
                    "Die Knoten stoppen und Knoten {node} mit LSS auswählen, mit der Seriennummer von seinem Typenschild"
                ),
            ),
        };
        language.of(english, german)
    }

    /// Makes the probe on a copy of the bench.
    pub(super) fn play(&self, bench: &Bench, nodes: &Nodes) -> Reading {
        let mut bench = bench.clone();
        let place = self.device().and_then(|device| bench.device(device));
        let node = self.device().and_then(|device| nodes.get(device));
        let node = node.copied().unwrap_or_default();
        let place = place.unwrap_or_default();
        let bus = &mut bench.bus;
        let mut reading = Reading::default();
        match self {
            Self::Listen => reading.listens(bus, None, LISTEN),
            Self::Sync => reading.listens(bus, Some(Frame::standard(0x080, &[])), RESPONSE),
            Self::Reset(_) => reading.listens(bus, Some(nmt(0x81, node)), AFTER_COMMAND),
            Self::Start(_) => reading.listens(bus, Some(nmt(0x01, node)), AFTER_COMMAND),
            Self::Read(_, address) => {
                let answers = reading.upload(bus, node, *address);
                let object = *address;
                reading.sights.insert(
                    0,
                    Sight::Answers {
                        node,
                        object,
                        answers,
                    },
                );
            }
            Self::Compare(_, address) => {
                let first = reading.upload(bus, node, *address);
                reading.pass(bus, AFTER_READ);
                let second = reading.upload(bus, node, *address);
                let same = first == second;
                let object = *address;
                reading.sights = Vec::from([Sight::Compared { node, object, same }]);
            }
            Self::Turn(_) => reading.turn(bus, place, node),
            Self::Unplug(_) => {
                bus.line.set_plugged(place + 1, false);
                reading.listens(bus, None, LISTEN);
            }
            Self::Desk(_) => {
                for station in 1..=bus.devices().len() {
                    bus.line.set_plugged(station, station == place + 1);
                }
                bus.line.terminators = 2;
                #[cfg(feature = "training")]
                {
                    bus.line.cable.length = 0;
                    bus.line.cable.shorted = false;
                }
                bus.set_power(place, false);
                reading.pass(bus, RESPONSE);
                reading.frames.clear();
                bus.line.restart(0);
                bus.set_power(place, true);
                // The interface adapts to the bit rate of the node.
                let rate = bus
                    .devices()
                    .get(place)
                    .and_then(|device| device.bit_rate());
                bus.line.bit_rate = rate;
                reading.sights.extend(rate.map(Sight::BitRate));
                reading.listens(bus, None, AFTER_COMMAND);
            }
            Self::Resistance => {
                let ohms = match u16::from(bus.line.terminators) {
                    _ if bus.line.is_shorted() => Some(0),
                    0 => None,
                    count => Some(TERMINATOR / count),
                };
                reading.sights.push(Sight::Resistance(ohms));
            }
            Self::Lss(_) => reading.select(bus, place),
            Self::Scope => reading.scope(bus),
            Self::Length => {
                #[cfg(feature = "training")]
                reading.sights.push(Sight::Metres(bus.line.cable.length));
            }
            Self::Supply(_) => {
                let on = bus.devices().get(place).is_some_and(|one| one.is_powered());
                reading.sights.push(Sight::Supply { node, on });
            }
            Self::Switches(_) => {
                let switches = bus.devices().get(place).map(|one| one.switches());
                let (id, rate) = switches.unwrap_or_default();
                let rate = SWITCHED.get(usize::from(rate)).copied().unwrap_or_default();
                reading.sights.push(Sight::Switches { id, rate });
            }
            Self::Leds(_) => {
                let leds = bus.devices().get(place).map(|one| one.leds());
                if let Some((green, red)) = leds {
                    reading.sights.push(Sight::Leds { green, red });
                }
            }
        }
        reading
    }
}

fn unknown(line: u32, text: &str) -> Problem {
    let help = "write `listen`, `read DEVICE 1000h`, `compare DEVICE 6004h`, `reset DEVICE`, `start DEVICE`, `sync`, `resistance`, `scope`, `length`, \
                `supply DEVICE`, `switches DEVICE`, `leds DEVICE`, `unplug DEVICE`, `desk DEVICE`, `turn DEVICE` or `lss DEVICE`";
    Problem::new(line, format!("`{text}` is not a probe"), help)
}

/// Bit rates in kbit/s of the DIP switches of a bus cover.
const SWITCHED: [u16; 8] = [10, 20, 50, 125, 250, 500, 800, 1000];

fn nmt(command: u8, node: u8) -> Frame {
    Frame::standard(0, &[command, node])
}

impl Reading {
    /// Sends a frame, lets time pass and notes the frames that come.
    fn listens(&mut self, bus: &mut Bus, frame: Option<Frame>, micros: u64) {
        if let Some(frame) = frame {
            self.send(bus, frame);
        }
        self.pass(bus, micros);
        self.sum_up(frame, micros);
    }

    fn send(&mut self, bus: &mut Bus, frame: Frame) {
        let at = bus.now();
        // On a real line it is polled after its transmission.
        if bus.receive(&frame) {
            let device = None;
            self.frames.push(LineEvent::Frame { at, device, frame });
        }
    }

    /// Lets time pass and keeps the frames.
    fn pass(&mut self, bus: &mut Bus, micros: u64) {
        let end = bus.now().plus_micros(micros);
        loop {
            let sent = bus.advance_until_sent(end);
            while let Some(one) = bus.line.poll() {
                // The learner does not see the attempts of a node that is not on the line.
                let station = one.device.map_or(0, |device| device + 1);
                if bus.line.is_plugged(station) {
                    self.frames.push(LineEvent::Disturbed(one));
                }
            }
            while let Some(one) = bus.poll() {
                let (at, device, frame) = (one.at, one.device, one.frame);
                self.frames.push(LineEvent::Frame { at, device, frame });
            }
            if !sent || self.frames.len() >= KEPT {
                break;
            }
        }
        self.frames.sort_by_key(time);
    }

    /// Reads an object by an expedited upload; returns the different answers.
    fn upload(&mut self, bus: &mut Bus, node: u8, address: Address) -> Vec<Answer> {
        let [low, high] = address.index.to_le_bytes();
        let request = [0x40, low, high, address.sub, 0, 0, 0, 0];
        let from = self.frames.len();
        self.send(bus, Frame::standard(0x600 + u16::from(node), &request));
        self.pass(bus, RESPONSE);
        let mut answers = Vec::new();
        for seen in &self.frames[from..] {
            if let LineEvent::Frame { frame, .. } = seen
                && frame.id().as_standard() == Some(0x580 + u16::from(node))
                && let Some(answer) = Answer::of(frame)
                && !answers.contains(&answer)
            {
                answers.push(answer);
            }
        }
        self.errors(from);
        answers
    }

    /// Reads the position value before and after a quarter of a revolution.
    fn turn(&mut self, bus: &mut Bus, place: usize, node: u8) {
        const POSITION: Address = Address {
            index: 0x6004,
            sub: 0,
        };
        let value = |answers: Vec<Answer>| match answers.as_slice() {
            [Answer::Value(value)] => Some(i64::from(*value)),
            _ => None,
        };
        let before = value(self.upload(bus, node, POSITION));
        bus.with(place, |device, now| device.turn(0.25, now));
        self.pass(bus, RESPONSE);
        let after = value(self.upload(bus, node, POSITION));
        let by = before.zip(after).map(|(before, after)| after - before);
        self.sights = Vec::from([Sight::Turned { node, by }]);
    }

    /// Stops all nodes, sends the LSS address of a device, and notes whether it responds (CiA 305, switch state selective).
    fn select(&mut self, bus: &mut Bus, place: usize) {
        let address = bus.devices().get(place).map(|one| one.lss_address());
        self.send(bus, nmt(0x02, 0));
        self.pass(bus, RESPONSE);
        for (command, part) in (0x40..).zip(address.unwrap_or_default()) {
            let [a, b, c, d] = part.to_le_bytes();
            self.send(bus, Frame::standard(0x7E5, &[command, a, b, c, d, 0, 0, 0]));
            self.pass(bus, RESPONSE);
        }
        let responds = self.frames.iter().any(|seen| match seen {
            LineEvent::Frame { frame, .. } => {
                frame.id().as_standard() == Some(0x7E4) && frame.data().first() == Some(&0x44)
            }
            _ => false,
        });
        self.sights = Vec::from([Sight::Selected(responds)]);
    }

    /// Notes the lengths of the bits of each sender, and their edges.
    fn scope(&mut self, bus: &mut Bus) {
        self.pass(bus, LISTEN);
        let mut rates = Vec::new();
        for seen in &self.frames {
            let (LineEvent::Frame { device, .. }
            | LineEvent::Heard { device, .. }
            | LineEvent::Disturbed(crate::line::Disturbance { device, .. })) = seen;
            let Some(device) = *device else { continue };
            let rate = bus.devices().get(device).and_then(|one| one.bit_rate());
            let rate = rate.or(bus.line.bit_rate).unwrap_or(500);
            #[cfg(feature = "training")]
            let deviation = bus.line.cable.deviation(device + 1);
            #[cfg(not(feature = "training"))]
            let deviation = 0;
            rates.push((rate, deviation / 1000));
        }
        rates.sort_unstable();
        rates.dedup();
        let bit = |(rate, tenths)| Sight::BitTime { rate, tenths };
        let edges = match bus.line.terminators {
            _ if bus.line.is_shorted() => Edges::Flat,
            2 => Edges::Clean,
            0 | 1 => Edges::Ringing,
            _ => Edges::Low,
        };
        if edges != Edges::Flat {
            self.sights.extend(rates.into_iter().map(bit));
        }
        self.sights.push(Sight::Edges(edges));
    }

    /// Notes the CAN-IDs that came, and the error frames.
    fn sum_up(&mut self, request: Option<Frame>, micros: u64) {
        let mut subjects: Vec<(Subject, u32, &Frame, bool)> = Vec::new();
        for seen in &self.frames {
            let LineEvent::Frame { frame, device, .. } = seen else {
                continue;
            };
            if device.is_none() && Some(*frame) == request {
                continue;
            }
            let Some(subject) = Subject::of(frame) else {
                continue;
            };
            match subjects.iter_mut().find(|(one, ..)| *one == subject) {
                Some((_, count, first, changes)) => {
                    *count += 1;
                    *changes |= first.data() != frame.data();
                }
                None => subjects.push((subject, 1, frame, false)),
            }
        }
        subjects.sort_by_key(|(subject, ..)| *subject);
        let sight = |(subject, count, _, changes)| Sight::Frames {
            subject,
            often: Often::of(count, micros),
            changes,
        };
        let sights: Vec<_> = subjects.into_iter().map(sight).collect();
        if sights.is_empty() {
            self.sights.push(Sight::NoFrames);
        }
        self.sights.extend(sights);
        self.errors(0);
    }

    /// Notes how many of the frames from this place on were error frames.
    fn errors(&mut self, from: usize) {
        let (mut failed, mut all, mut unheard) = (0, 0, 0);
        for seen in &self.frames[from..] {
            all += 1;
            if let LineEvent::Disturbed(one) = seen {
                failed += 1;
                unheard += usize::from(one.error == FrameError::NoAcknowledge);
            }
        }
        let share = Share::of(failed, all);
        let unacknowledged = failed > 0 && unheard * 2 > failed;
        self.sights.push(Sight::ErrorFrames {
            share,
            unacknowledged,
        });
    }
}

/// The time of a frame or an error frame.
fn time(seen: &LineEvent) -> Instant {
    match seen {
        LineEvent::Frame { at, .. } | LineEvent::Heard { at, .. } => *at,
        LineEvent::Disturbed(one) => one.at,
    }
}
