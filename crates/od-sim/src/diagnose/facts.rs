//! Facts of a log, in the order of its frames: the input of the rules.

use std::collections::BTreeMap;
use std::prelude::v1::*;

use od_model::{Address, Dictionary};
use od_wire::sdo::{Request, Response};
use od_wire::{Frame, Instant};

use crate::line::bits::occupied;
use crate::logs::{BusError, Record, What};
use crate::sdo::{Message, Observer, default_sdo};

/// Window in which the load is measured, in microseconds.
pub(super) const WINDOW: u64 = 100_000;
/// Distance of the records of a log without times, in microseconds.
const STEP: u64 = 1000;
/// Bit rates of CiA 301 in kbit/s.
const RATES: [u16; 9] = [10, 20, 50, 100, 125, 250, 500, 800, 1000];

/// Facts about the bus that its log does not contain.
#[derive(Clone, Copy, Default)]
pub struct BusFacts<'k> {
    /// Bit rate in kbit/s; `None`: it is estimated from frames that follow each other without a pause.
    pub bit_rate: Option<u16>,
    /// Dictionary of a node, by its EDS.
    pub dictionary: Option<&'k dyn Fn(u8) -> Option<Dictionary<'k>>>,
}

/// A frame and its place in the log.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) at: Instant,
    pub(super) place: usize,
}

/// Something that has a time. Lists of it are in the order of time.
pub(super) trait Timed {
    fn at(&self) -> Instant;
}

impl Timed for Seen {
    fn at(&self) -> Instant {
        self.at
    }
}

impl Timed for (Seen, u8) {
    fn at(&self) -> Instant {
        self.0.at
    }
}

impl Timed for (Seen, u8, u8) {
    fn at(&self) -> Instant {
        self.0.at
    }
}

impl Timed for (Seen, Address, u32) {
    fn at(&self) -> Instant {
        self.0.at
    }
}

impl Timed for Exchange {
    fn at(&self) -> Instant {
        self.request.at
    }
}

/// The entries before a moment.
pub(super) fn before<T: Timed>(all: &[T], moment: Instant) -> &[T] {
    &all[..all.partition_point(|one| one.at() < moment)]
}

/// The entries up to a moment, including it.
pub(super) fn until<T: Timed>(all: &[T], moment: Instant) -> &[T] {
    &all[..all.partition_point(|one| one.at() <= moment)]
}

/// The entries from a moment on.
pub(super) fn from<T: Timed>(all: &[T], moment: Instant) -> &[T] {
    &all[all.partition_point(|one| one.at() < moment)..]
}

/// The entries after a moment.
pub(super) fn after<T: Timed>(all: &[T], moment: Instant) -> &[T] {
    &all[all.partition_point(|one| one.at() <= moment)..]
}

/// An EMCY message.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emcy {
    pub(super) seen: Seen,
    pub(super) code: u16,
}

/// The end of an SDO exchange.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Outcome {
    /// The response came.
    Answered,
    /// The server aborted.
    Refused(u32),
    /// A response about another object came.
    Other,
    /// The client aborted, or sent the next request, before a response came.
    GaveUp,
    /// The log ended before.
    Open,
}

/// A request of a client and its end.
#[derive(Clone, Debug)]
pub(super) struct Exchange {
    pub(super) request: Seen,
    pub(super) address: Option<Address>,
    pub(super) is_download: bool,
    pub(super) outcome: Outcome,
    /// Time of the end: the response, the abort, or the next request.
    pub(super) end: Seen,
    /// Responses after the end and before the next request.
    pub(super) extra: Vec<Seen>,
    /// The client's abort, with its code.
    pub(super) aborted: Option<(Seen, u32)>,
}

/// Facts about the frames of one node ID.
#[derive(Clone, Default, Debug)]
pub(super) struct Node {
    /// Frames of error control: boot-up (0), heartbeats, responses to guarding.
    pub(super) states: Vec<(Seen, u8)>,
    /// Boot-up messages.
    pub(super) boots: Vec<Seen>,
    /// Heartbeats, without boot-up messages.
    pub(super) beats: Vec<Seen>,
    /// The period of the heartbeats, in microseconds; 0 without.
    pub(super) period: u64,
    /// Guarding requests.
    pub(super) guards: Vec<Seen>,
    pub(super) emcys: Vec<Emcy>,
    pub(super) exchanges: Vec<Exchange>,
    /// Frames that only this node sends.
    pub(super) sent: Vec<Seen>,
    /// Values that a client wrote, by expedited download.
    pub(super) writes: Vec<(Seen, Address, u32)>,
    observer: Observer,
    is_pending: bool,
    /// The client has aborted, and no request came since.
    is_aborted: bool,
    /// The client has sent segments of a block, without a response so far.
    has_segments: bool,
}

impl Node {
    /// Returns whether a client wrote an object between two moments.
    pub(super) fn is_written(&self, index: u16, from: Instant, to: Instant) -> bool {
        let mut writes = self::from(until(&self.writes, to), from).iter();
        writes.any(|(_, address, _)| address.index == index)
    }
}

/// The facts of a log.
pub(super) struct Facts<'a> {
    pub(super) begin: Instant,
    pub(super) end: Instant,
    pub(super) records: &'a [Record],
    /// Whether the times are those of the bus; otherwise they are a [`STEP`] apart, and only their order counts.
    pub(super) has_times: bool,
    pub(super) errors: Vec<Seen>,
    /// Frames, without error frames.
    pub(super) frames: Vec<Seen>,
    pub(super) nodes: BTreeMap<u8, Node>,
    /// NMT commands: code and node ID, 0 for all.
    pub(super) commands: Vec<(Seen, u8, u8)>,
    pub(super) syncs: Vec<Seen>,
    /// Requests of an LSS master.
    pub(super) lss: Vec<Seen>,
    /// Data frames of the PDOs, by CAN-ID.
    pub(super) pdos: BTreeMap<u16, Vec<Seen>>,
    /// Bit rate in kbit/s, given or estimated.
    pub(super) rate: Option<u16>,
    /// Bits in each window of [`WINDOW`] microseconds from the beginning.
    windows: Vec<u32>,
    pub(super) known: BusFacts<'a>,
}

impl<'a> Facts<'a> {
    pub(super) fn of(records: &'a [Record], known: BusFacts<'a>) -> Self {
        let has_times = !matches!(records, [first, .., last] if first.at == last.at);
        let time = |place: usize, record: &Record| {
            if has_times {
                record.at
            } else {
                Instant::from_micros(place as u64 * STEP)
            }
        };
        let last = records.len().saturating_sub(1);
        let mut facts = Self {
            begin: records
                .first()
                .map_or(Instant::ZERO, |first| time(0, first)),
            end: records
                .last()
                .map_or(Instant::ZERO, |record| time(last, record)),
            records,
            has_times,
            errors: Vec::new(),
            frames: Vec::new(),
            nodes: BTreeMap::new(),
            commands: Vec::new(),
            syncs: Vec::new(),
            lss: Vec::new(),
            pdos: BTreeMap::new(),
            rate: known.bit_rate,
            windows: Vec::new(),
            known,
        };
        let mut lengths = Vec::new();
        for (place, record) in records.iter().enumerate() {
            let seen = Seen {
                at: time(place, record),
                place,
            };
            match &record.what {
                What::Error(_) => facts.errors.push(seen),
                What::Frame(frame) => {
                    let len = occupied(frame) as u32;
                    lengths.push((seen.at, len, *frame));
                    let window = (seen.at.micros_since(facts.begin) / WINDOW) as usize;
                    // A log of a year has 315 million windows: only those up to an hour are measured.
                    if window < 36_000 {
                        facts.windows.resize(facts.windows.len().max(window + 1), 0);
                        facts.windows[window] += len;
                    }
                    facts.frames.push(seen);
                    facts.take(seen, frame);
                }
            }
        }
        facts.rate = facts.rate.or_else(|| estimated(&lengths));
        for node in facts.nodes.values_mut() {
            node.period = median_interval(&node.beats);
        }
        facts
    }

    fn take(&mut self, seen: Seen, frame: &Frame) {
        let Some(id) = frame.id().as_standard() else {
            return;
        };
        let node = (id & 0x7F) as u8;
        match (id, frame.is_remote(), frame.data()) {
            (0, false, [code, node, ..]) => self.commands.push((seen, *code, *node)),
            (0x80, false, _) => self.syncs.push(seen),
            (0x81..=0xFF, false, [low, high, ..]) => {
                let code = u16::from_le_bytes([*low, *high]);
                let it = self.nodes.entry(node).or_default();
                it.emcys.push(Emcy { seen, code });
                it.sent.push(seen);
            }
            (0x181..=0x57F, false, _) => {
                self.pdos.entry(id).or_default().push(seen);
                // TPDOs of the predefined connection set: 180h, 280h, 380h, 480h plus the node ID.
                if id & 0x80 != 0 && node != 0 {
                    self.nodes.entry(node).or_default().sent.push(seen);
                }
            }
            (0x581..=0x67F, false, _) => {
                if let Some((node, is_response)) = default_sdo(frame) {
                    let it = self.nodes.entry(node).or_default();
                    if is_response {
                        it.sent.push(seen);
                    }
                    it.sdo(seen, frame, is_response);
                }
            }
            (0x7E5, false, _) => self.lss.push(seen),
            (0x701..=0x77F, true, _) => self.nodes.entry(node).or_default().guards.push(seen),
            (0x701..=0x77F, false, [state, ..]) => {
                let it = self.nodes.entry(node).or_default();
                it.states.push((seen, *state));
                let list = if *state == 0 {
                    &mut it.boots
                } else {
                    &mut it.beats
                };
                list.push(seen);
                it.sent.push(seen);
            }
            _ => {}
        }
    }

    /// Load of each window, 0 to 1; `None` if the bit rate is not known.
    pub(super) fn loads(&self) -> Option<Vec<(Instant, f64)>> {
        let room = f64::from(self.rate?) * 1000.0 * WINDOW as f64 / 1e6;
        let loads = self.windows.iter().enumerate().map(|(number, bits)| {
            let at = self.begin.plus_micros(number as u64 * WINDOW);
            (at, f64::from(*bits) / room)
        });
        Some(loads.collect())
    }

    /// The NMT commands to a node between two times.
    pub(super) fn commands_to(
        &self,
        node: u8,
        from: Instant,
        to: Instant,
    ) -> impl Iterator<Item = u8> {
        let between = self::from(until(&self.commands, to), from).iter();
        let own = between.filter(move |(_, _, target)| *target == node || *target == 0);
        own.map(|(_, code, _)| *code)
    }

    /// Returns whether a command to a node between two times makes it start again: NMT, or 1F51h, which starts and stops a program
    /// (CiA 302-3); a bootloader is a program, too.
    pub(super) fn is_reset(&self, node: u8, from: Instant, to: Instant) -> bool {
        let mut codes = self.commands_to(node, from, to);
        let facts = self.nodes.get(&node);
        codes.any(|code| matches!(code, 0x81 | 0x82))
            || facts.is_some_and(|facts| facts.is_written(0x1F51, from, to))
    }

    /// Returns whether frames of other nodes were logged between two times, so the log continued.
    pub(super) fn goes_on(&self, node: u8, from: Instant, to: Instant) -> bool {
        let sent = self.nodes.get(&node).map_or(&[][..], |node| &node.sent);
        let count = |all: &[Seen]| {
            let first = all.partition_point(|seen| seen.at <= from);
            all.partition_point(|seen| seen.at < to)
                .saturating_sub(first)
        };
        count(&self.frames) + count(&self.errors) > count(sent)
    }

    pub(super) fn error(&self, place: usize) -> Option<BusError> {
        match self.records.get(place)?.what {
            What::Error(error) => Some(error),
            What::Frame(_) => None,
        }
    }

    pub(super) fn frame(&self, place: usize) -> Option<&Frame> {
        match &self.records.get(place)?.what {
            What::Frame(frame) => Some(frame),
            What::Error(_) => None,
        }
    }

    pub(super) fn dictionary(&self, node: u8) -> Option<Dictionary<'a>> {
        self.known.dictionary.and_then(|of| of(node))
    }

    /// The value of an object: what a client wrote last before a time, otherwise the default of the
    /// EDS.
    pub(super) fn value(&self, node: u8, address: Address, before: Instant) -> Option<u32> {
        let writes = self.nodes.get(&node).map_or(&[][..], |node| &node.writes);
        let mut written = until(writes, before).iter().rev();
        let written = written.find(|(_, own, _)| *own == address);
        if let Some((_, _, value)) = written {
            return Some(*value);
        }
        let entry = self.dictionary(node)?.entry(address.index, address.sub)?;
        u32::try_from(entry.default.integer(node)?).ok()
    }
}

impl Node {
    fn sdo(&mut self, seen: Seen, frame: &Frame, is_response: bool) {
        let Some(message) = self.observer.read(is_response, frame) else {
            return;
        };
        match message {
            Message::Request(Request::Abort { code, .. }) => {
                self.is_aborted = true;
                if let Some(last) = self.exchanges.last_mut() {
                    last.aborted.get_or_insert((seen, code));
                }
                self.end(seen, Outcome::GaveUp);
            }
            Message::Request(Request::EndBlockUpload) => {}
            Message::Segment { .. } => self.has_segments = !is_response,
            // The response to the segments of a block.
            Message::Response(Response::BlockDownloadResponse { .. })
                if core::mem::take(&mut self.has_segments) => {}
            // A server that aborts a transfer, too, which its client has aborted.
            Message::Response(Response::Abort { .. }) if self.is_aborted && !self.is_pending => {}
            // A log that begins in the middle of a transfer.
            Message::Request(Request::DownloadSegment(_) | Request::UploadSegment { .. })
                if self.exchanges.is_empty() && self.observer.object.is_none() => {}
            Message::Request(request) => {
                self.is_aborted = false;
                self.end(seen, Outcome::GaveUp);
                let is_download = matches!(
                    request,
                    Request::InitiateDownload { .. }
                        | Request::DownloadSegment(_)
                        | Request::InitiateBlockDownload { .. }
                        | Request::EndBlockDownload { .. }
                );
                let [command, low, high, sub, value @ ..] = *frame.bytes();
                let address = Address::new(u16::from_le_bytes([low, high]), sub);
                if command & 0xE2 == 0x22 {
                    let unused = if command & 1 == 1 {
                        command >> 2 & 3
                    } else {
                        0
                    };
                    let value = u32::from_le_bytes(value) & (u32::MAX >> (8 * u32::from(unused)));
                    self.writes.push((seen, address, value));
                }
                self.exchanges.push(Exchange {
                    request: seen,
                    address: self.observer.object,
                    is_download,
                    outcome: Outcome::Open,
                    end: seen,
                    extra: Vec::new(),
                    aborted: None,
                });
                self.is_pending = true;
            }
            Message::Response(response) => {
                if !self.is_pending {
                    match &mut self.exchanges[..] {
                        // Of two equal requests, the first response belongs to the first.
                        [.., one, again]
                            if one.outcome == Outcome::GaveUp
                                && one.extra.is_empty()
                                && one.address == again.address
                                && one.is_download == again.is_download =>
                        {
                            one.extra.push(again.end);
                            again.end = seen;
                        }
                        [.., last] => last.extra.push(seen),
                        [] => {}
                    }
                    return;
                }
                let named = named(&response, frame);
                let wanted = self.exchanges.last().and_then(|exchange| exchange.address);
                let outcome = match response {
                    Response::Abort { .. } => {
                        let [_, _, _, _, a, b, c, d] = *frame.bytes();
                        Outcome::Refused(u32::from_le_bytes([a, b, c, d]))
                    }
                    _ if named.is_some() && wanted.is_some() && named != wanted => Outcome::Other,
                    _ => Outcome::Answered,
                };
                self.end(seen, outcome);
            }
        }
    }

    fn end(&mut self, seen: Seen, outcome: Outcome) {
        if core::mem::take(&mut self.is_pending)
            && let Some(last) = self.exchanges.last_mut()
        {
            (last.outcome, last.end) = (outcome, seen);
        }
    }
}

/// The object that a response names.
fn named(response: &Response, frame: &Frame) -> Option<Address> {
    let [command, low, high, sub, ..] = *frame.bytes();
    let is_first = match response {
        Response::UploadSegment(_) | Response::DownloadSegment { .. } => false,
        _ => matches!(command >> 5, 2 | 3),
    };
    is_first.then(|| Address::new(u16::from_le_bytes([low, high]), sub))
}

/// The bit rate, estimated from frames that follow each other without a pause; `None` if there are
/// too few of them.
fn estimated(lengths: &[(Instant, u32, Frame)]) -> Option<u16> {
    let mut rates: Vec<f64> = lengths
        .windows(2)
        .filter(|pair| !is_reaction(&pair[0].2, &pair[1].2))
        .filter_map(|pair| {
            let micros = pair[1].0.micros_since(pair[0].0);
            (micros > 0).then(|| f64::from(pair[1].1) * 1000.0 / micros as f64)
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    // The shortest distances have no pause; a few are shorter than possible, because of the time
    // stamps of an adapter.
    let fast = *rates.get(rates.len().saturating_sub(rates.len() / 50 + 1))?;
    let near = rates
        .iter()
        .filter(|rate| (**rate / fast - 1.0).abs() < 0.1)
        .count();
    if near < 10 {
        return None;
    }
    let rate = RATES
        .into_iter()
        .find(|rate| (fast / f64::from(*rate) - 1.0).abs() < 0.1)?;
    Some(rate)
}

/// Returns whether a frame may be the reaction of a node to the one before: the other side of an SDO, a response to a remote
/// frame or to an LSS request, a PDO after SYNC. The time between them is that of a node, which may be constant, too.
fn is_reaction(frame: &Frame, next: &Frame) -> bool {
    let sdo = |frame: &Frame| default_sdo(frame).map(|(node, _)| node);
    let is_lss = |frame: &Frame| matches!(frame.id().raw(), 0x7E4 | 0x7E5);
    frame.is_remote()
        || frame.id().raw() == 0x80
        || is_lss(frame) && is_lss(next)
        || sdo(frame).is_some() && sdo(frame) == sdo(next)
}

/// The median gap in microseconds; 0 without gaps.
pub(super) fn median_interval(all: &[Seen]) -> u64 {
    let mut gaps: Vec<u64> = all
        .windows(2)
        .map(|pair| pair[1].at.micros_since(pair[0].at))
        .collect();
    gaps.sort_unstable();
    gaps.get(gaps.len() / 2).copied().unwrap_or(0)
}

/// The frames from the first to the last stretch in which two senders alternate; empty: nowhere. A second device may be
/// switched on late, or for a while.
pub(super) fn interleaved(all: &[Seen]) -> &[Seen] {
    /// Frames in a stretch, and between the starts of two.
    const STRETCH: usize = 24;
    const STEP: usize = 8;
    if is_interleaved(all) {
        return all;
    }
    let stretches = all.windows(STRETCH).step_by(STEP);
    let found: Vec<bool> = stretches.map(is_interleaved).collect();
    // One alone may be a disturbance of one sender.
    let both = |number: &usize| found[*number] && found[*number + 1];
    let mut pairs = (0..found.len().saturating_sub(1)).filter(both);
    let Some(first) = pairs.next() else {
        return &[];
    };
    let last = pairs.next_back().unwrap_or(first) + 1;
    &all[first * STEP..last * STEP + STRETCH]
}

/// Returns whether two senders alternate: the distance to the frame after the next is constant, the
/// distance to the next is not.
fn is_interleaved(all: &[Seen]) -> bool {
    if all.len() < 8 {
        return false;
    }
    let seconds: Vec<Seen> = all.iter().step_by(2).copied().collect();
    let period = median_interval(&seconds);
    let is_off = |gap: u64, wanted: u64| gap.abs_diff(wanted) * 20 > wanted;
    let steady = all
        .windows(3)
        .filter(|three| !is_off(three[2].at.micros_since(three[0].at), period));
    let uneven = all.windows(2).filter(|pair| {
        let gap = pair[1].at.micros_since(pair[0].at);
        gap.abs_diff(period / 2) * 8 > period / 2
    });
    period > 0
        && steady.count() * 10 >= (all.len() - 2) * 8
        && uneven.count() * 10 >= (all.len() - 1) * 8
}

/// Microseconds as a text.
pub(super) fn millis(micros: u64) -> String {
    match micros {
        0..10_000 => std::format!("{}.{} ms", micros / 1000, micros % 1000 / 100),
        10_000..10_000_000 => std::format!("{} ms", micros / 1000),
        _ => std::format!("{} s", micros / 1_000_000),
    }
}
