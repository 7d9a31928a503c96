//! Plays a recording: delays frames of the node, and reports values and errors when they are due.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::prelude::v1::*;

use od_model::Address;
use od_runtime::{Frame, Instant, NodeId};
use od_wire::AbortCode;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;
use od_wire::sdo::{Request, Response};

use super::Recorded;
use super::pace::Pace;

/// Limit of delayed frames.
const HELD: usize = 256;

/// A recording that is being played.
#[derive(Clone, Debug)]
pub(crate) struct Playing {
    recorded: Recorded,
    /// Time of the boot-up message.
    started: Option<Instant>,
    /// The next value, and the start of the present repetition.
    value: (usize, Option<Instant>),
    /// The next error.
    error: usize,
    /// Delayed frames, by their time.
    held: VecDeque<(Instant, Frame)>,
    heartbeat: Option<Pace>,
    tpdos: BTreeMap<u16, Pace>,
    /// Frames that are sent at their measured periods now: TPDOs and [`HEARTBEAT`].
    paced: BTreeSet<u16>,
}

/// Number of the heartbeat, which no TPDO has.
const HEARTBEAT: u16 = 0;

/// An event that is due.
pub(crate) enum Due {
    Value(Address, Vec<u8>),
    Error(Emcy),
}

impl Playing {
    /// `configured` returns the configured period of an object and sub-index.
    pub(crate) fn new(recorded: Recorded, configured: impl Fn(u16, u8) -> u64) -> Self {
        let tpdo = |(tpdo, period): (&u16, &u64)| {
            (*tpdo, Pace::new(*period, configured(0x17FF + tpdo, 5)))
        };
        Self {
            tpdos: recorded.tpdos.iter().map(tpdo).collect(),
            heartbeat: recorded
                .heartbeat
                .map(|period| Pace::new(period, configured(0x1017, 0))),
            recorded,
            started: None,
            value: (0, None),
            error: 0,
            held: VecDeque::new(),
            paced: BTreeSet::new(),
        }
    }

    /// The power is switched off.
    pub(crate) fn stop(&mut self) {
        self.started = None;
        self.held.clear();
        self.tpdos
            .values_mut()
            .chain(&mut self.heartbeat)
            .for_each(Pace::forget);
    }

    /// Finds the frames that are sent at the measured period: those with the same configuration as in the recording.
    /// `stored` returns the value of an object and sub-index.
    pub(crate) fn look(&mut self, state: State, stored: impl Fn(u16, u8) -> Option<u64>) {
        self.paced.clear();
        if let Some(pace) = &mut self.heartbeat {
            if stored(0x1017, 0) == Some(pace.configured) {
                _ = self.paced.insert(HEARTBEAT)
            } else {
                pace.forget()
            }
        }
        for (tpdo, pace) in &mut self.tpdos {
            let index = 0x17FF + tpdo;
            let is_paced = state == State::Operational
                && stored(index, 1).is_some_and(|cob_id| cob_id & 0x8000_0000 == 0)
                && stored(index, 2).is_some_and(|kind| kind >= 254)
                && stored(index, 5) == Some(pace.configured);
            if is_paced {
                _ = self.paced.insert(*tpdo)
            } else {
                pace.forget()
            }
        }
    }

    /// Numbers of the TPDOs with a period.
    pub(crate) fn tpdos(&self) -> impl Iterator<Item = u16> {
        self.tpdos.keys().copied()
    }

    /// Handles a request to the node. If the device refused it, the recorded response is sent, and the node does
    /// not receive the request.
    pub(crate) fn refuses(&mut self, now: Instant, node: NodeId, frame: &Frame) -> bool {
        if frame.id() != node.plus(0x600) || frame.is_remote() || frame.dlc() != 8 {
            return false;
        }
        let address = match Request::parse(frame.bytes()) {
            Request::InitiateUpload { address } => address,
            Request::InitiateBlockUpload { address, .. } => address,
            _ => return false,
        };
        let Some(code) = self.recorded.aborts.get(&address).copied() else {
            return false;
        };
        let response = Response::Abort { address, code };
        let frame = Frame::full(node.plus(0x580), response.emit());
        self.hold(now.plus_micros(self.recorded.answer), frame);
        true
    }

    /// Handles a frame of the node; `tpdo` is the number of a TPDO.
    pub(crate) fn sent(&mut self, now: Instant, node: NodeId, frame: Frame, tpdo: Option<u16>) {
        let id = frame.id();
        let frame = if id == node.plus(0x580) {
            self.filled(node, frame)
        } else {
            frame
        };
        let at = if id == node.plus(0x580) {
            now.plus_micros(self.recorded.answer)
        } else {
            now
        };
        let pace = match tpdo {
            Some(tpdo) if self.paced.contains(&tpdo) => self.tpdos.get_mut(&tpdo),
            None if id == node.plus(0x700) && frame.data() == [0] => {
                self.stop();
                self.started = Some(now);
                self.value = (0, Some(now));
                self.error = 0;
                None
            }
            None if id == node.plus(0x700) && self.paced.contains(&HEARTBEAT) => {
                self.heartbeat.as_mut()
            }
            _ => None,
        };
        if pace.is_none_or(|pace| pace.passes(now, &frame)) {
            self.hold(at, frame);
        }
    }

    /// The response, with the recorded value if the node has no data.
    fn filled(&self, node: NodeId, frame: Frame) -> Frame {
        let Response::Abort { address, code } = Response::parse(frame.bytes()) else {
            return frame;
        };
        let bytes = self.recorded.empty.get(&address);
        let Some(bytes) = bytes.filter(|_| code == AbortCode::NoData.code()) else {
            return frame;
        };
        let mut wide = [0; 4];
        wide[..bytes.len()].copy_from_slice(bytes);
        let response = Response::InitiateUpload {
            address,
            size: Some(bytes.len() as u32),
            expedited: Some(wide),
        };
        Frame::full(node.plus(0x580), response.emit())
    }

    fn hold(&mut self, at: Instant, frame: Frame) {
        if self.held.len() < HELD {
            let place = self.held.partition_point(|(other, _)| *other <= at);
            self.held.insert(place, (at, frame));
        }
    }

    /// The next frame that is due now.
    pub(crate) fn take(&mut self, now: Instant, node: NodeId, state: State) -> Option<Frame> {
        if self.held.front().is_some_and(|(at, _)| *at <= now) {
            return self.held.pop_front().map(|(_, frame)| frame);
        }
        let beat = self.heartbeat.as_mut().and_then(|pace| pace.take(now));
        if beat.is_some() {
            // The NMT state may have changed since the node made the frame.
            return Frame::new(node.plus(0x700), &[state as u8]);
        }
        self.tpdos.values_mut().find_map(|pace| pace.take(now))
    }

    /// Time of the next frame or event.
    pub(crate) fn due(&self) -> Option<Instant> {
        let held = self.held.front().map(|(at, _)| *at);
        let paces = self.tpdos.values().chain(&self.heartbeat);
        let paced = paces.filter_map(Pace::due).min();
        let next = [held, paced, self.next_value(), self.next_error()];
        next.into_iter().flatten().min()
    }

    fn next_value(&self) -> Option<Instant> {
        let (at, row) = self.value;
        let (offset, ..) = self.recorded.values.get(at)?;
        self.started.and(row).map(|row| row.plus_micros(*offset))
    }

    fn next_error(&self) -> Option<Instant> {
        let (offset, _) = self.recorded.errors.get(self.error)?;
        self.started.map(|started| started.plus_micros(*offset))
    }

    /// The event that is due now.
    pub(crate) fn happens(&mut self, now: Instant) -> Option<Due> {
        if self.next_error().is_some_and(|at| at <= now) {
            self.error += 1;
            let (_, error) = self.recorded.errors[self.error - 1];
            return Some(Due::Error(error));
        }
        if self.next_value().is_none_or(|at| at > now) {
            return None;
        }
        let (at, row) = self.value;
        let (last, address, bytes) = &self.recorded.values[at];
        self.value.0 += 1;
        if self.value.0 == self.recorded.values.len() {
            // The values begin again, at least one millisecond later.
            let length = self.recorded.length.max(last + 1000);
            self.value = (0, row.map(|row| row.plus_micros(length)));
        }
        Some(Due::Value(*address, bytes.clone()))
    }
}
