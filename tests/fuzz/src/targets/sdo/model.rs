//! A model of the dictionary.
//!
//! It learns a value from a confirmed download, and from a reset or a restore, which
//! reset values; no other frame may change anything except the objects that the
//! manual links with the written one.

use std::collections::{BTreeMap, VecDeque};

use od_model::{Access, Address, Entry};
use od_runtime::{Event, Frame};
use od_sim::Bus;
use od_wire::nmt::State;

use super::super::bench;
use super::changes;
use super::input::LIVE;
use crate::harness::trace;
use crate::target::Enough;

/// A segmented upload in progress.
#[derive(Default)]
struct Upload {
    address: Option<Address>,
    bytes: Vec<u8>,
}

/// A segmented download in progress.
struct Download {
    address: Address,
    bytes: Vec<u8>,
}

/// A download to 1010h.
fn is_save(request: &[u8; 8]) -> bool {
    request[1..3] == [0x10, 0x10] && request[0] >> 5 == 1
}

/// The device, and its expected responses.
pub(super) struct Model {
    bus: Bus,
    pub(super) entries: Vec<Entry>,
    shadow: BTreeMap<Address, Vec<u8>>,
    upload: Upload,
    download: Option<Download>,
    /// The download that a block transfer is about.
    block: Option<Address>,
    /// Requests that may still get a response, oldest first.
    requests: VecDeque<[u8; 8]>,
    /// A save takes time; until its end responses are later than their requests.
    is_saving: bool,
    /// The first of the requests is that of the save, not one that waits for its end.
    is_awaited: bool,
    /// Segments of a block that may still be sent.
    segments: u32,
    block_upload: bool,
    min_dlc: u8,
}

impl Model {
    pub(super) fn new(number: usize) -> Self {
        let device = bench::device(number);
        let entries = device.dictionary().entries().collect::<Vec<_>>();
        let mut bus = Bus::new();
        bus.add(device);
        bus.start(0);
        let min_dlc = od_devices::DEVICES
            .get(number)
            .map_or(8, |kind| kind.profile.sdo.min_dlc);
        let mut model = Self {
            bus,
            entries,
            shadow: BTreeMap::new(),
            upload: Upload::default(),
            download: None,
            block: None,
            requests: VecDeque::new(),
            is_saving: false,
            is_awaited: false,
            segments: 0,
            block_upload: false,
            min_dlc,
        };
        model.wait(1_000_000);
        model.learn_all();
        model
    }

    pub(super) fn node(&self) -> u8 {
        self.bus.devices()[0].node_id().raw()
    }

    fn state(&self) -> State {
        self.bus.devices()[0].state()
    }

    fn read(&mut self, address: Address) -> Vec<u8> {
        let value = self.bus.with(0, |device, now| device.read(address, now));
        value.unwrap_or_default()
    }

    fn learn_all(&mut self) {
        self.shadow.clear();
        for at in 0..self.entries.len() {
            let entry = self.entries[at];
            let is_kept = entry.access != Access::Ro && entry.access != Access::Wo;
            if is_kept && !LIVE.contains(&entry.address.index) {
                let value = self.read(entry.address);
                self.shadow.insert(entry.address, value);
            }
        }
        self.check_identifiers();
    }

    pub(super) fn send(&mut self, frame: &Frame) {
        let own = Frame::standard(0x600 + u16::from(self.node()), &[]).id();
        let talks = matches!(self.state(), State::PreOperational | State::Operational);
        // During a block download every command except 80h is a segment.
        let is_abort = match self.block {
            Some(_) if !self.is_saving => frame.bytes()[0] == 0x80,
            _ => frame.bytes()[0] >> 5 == 4,
        };
        let is_heard =
            frame.id() == own && !frame.is_remote() && frame.dlc() >= self.min_dlc && talks;
        let is_request = is_heard && !is_abort;
        if is_request {
            // While a device saves, the newest request replaces the waiting one.
            self.requests.truncate(usize::from(self.is_awaited));
            self.requests.push_back(*frame.bytes());
            self.segments = if frame.bytes()[0] >> 5 == 5 { 127 } else { 0 };
        }
        let may_change = changes::by_frame(&self.bus.devices()[0], frame);
        self.bus.receive(frame);
        self.events();
        self.answers(is_request, &format!("{frame}"));
        if !self.is_saving {
            self.settle();
        }
        if let Some(objects) = may_change {
            self.compare(&format!("by {frame}"), &objects);
        }
        if is_heard && is_abort {
            self.requests.clear();
            self.is_awaited = false;
            self.forget();
        }
        if self.state() == State::Stopped {
            self.forget();
        }
    }

    /// No transfer is in progress.
    fn forget(&mut self) {
        self.upload = Upload::default();
        self.download = None;
        self.block = None;
        self.block_upload = false;
    }

    pub(super) fn wait(&mut self, micros: u64) {
        let end = self.bus.now().plus_micros(micros);
        self.bus.advance(end);
        let saves = self.events();
        self.answers(self.is_saving, "time");
        match saves {
            0 => {}
            1 => self.settle(),
            // The waiting request has ended, too.
            _ => {
                self.requests.clear();
                self.settle();
            }
        }
    }

    /// No save is in progress, but a request without a response may have started one.
    fn settle(&mut self) {
        self.is_saving = self.requests.back().is_some_and(is_save);
        self.is_awaited = self.is_saving;
        if !self.is_saving {
            self.requests.clear();
        }
    }

    /// Checks all sent frames.
    fn answers(&mut self, may_answer: bool, cause: &str) {
        let mut count = 0;
        while let Some(sent) = self.bus.poll() {
            trace(|| format!("< {:?} {}", sent.at, sent.frame));
            count += 1;
            assert!(count < 100_000, "{cause} makes it send without end");
            let Some(id) = sent.frame.id().as_standard() else {
                continue;
            };
            if id != 0x580 + u16::from(self.node()) || sent.frame.is_remote() {
                continue;
            }
            assert!(may_answer, "{cause} is answered with {}", sent.frame);
            assert_eq!(sent.frame.dlc(), 8, "an answer of {}", sent.frame);
            self.answer(*sent.frame.bytes(), cause);
        }
    }

    /// The request of this response. Earlier requests were given up for it.
    fn take_request(&mut self, answer: &[u8; 8], cause: &str) -> [u8; 8] {
        let about = |request: &[u8; 8]| request[1..4] == answer[1..4];
        let fits = |request: &[u8; 8]| match (answer[0], request[0] >> 5) {
            (0x80, _) => true,
            (0x40..=0x4F, 2) | (0x60, 1) => about(request),
            (0x00..=0x1F, 3) | (0x20 | 0x30, 0) => true,
            // A segment of a block may have the bytes of any request.
            (0xA0..=0xDF, _) => true,
            _ => false,
        };
        let Some(at) = self.requests.iter().position(fits) else {
            panic!("{cause} is answered with {answer:02X?}, for which nobody asked");
        };
        let request = self.requests[at];
        self.requests.drain(..=at);
        request
    }

    /// A master may give a PDO or EMCY the CAN-ID of the responses; from then on they cannot be
    /// distinguished, and the input ends.
    fn check_identifiers(&self) {
        let device = &self.bus.devices()[0];
        let own = 0x580 + u64::from(device.node_id().raw());
        let pdos = (0x1800..0x1810).map(|index| (index, 1));
        let mut all = [(0x1014, 0), (0x1005, 0)].into_iter().chain(pdos);
        let is_ambiguous = all.any(|(index, sub)| {
            // Valid, and 11 bits long.
            let value = device.stored(index, sub).unwrap_or(0);
            value & 0xA000_0000 == 0 && value & 0x7FF == own
        });
        if is_ambiguous {
            Enough::give_up();
        }
    }

    fn answer(&mut self, data: [u8; 8], cause: &str) {
        // Segments of a block may have any bytes.
        let asks_for_block = |request: &[u8; 8]| request[0] >> 5 == 5 && request[0] & 2 != 0;
        if self.block_upload && self.requests.back().is_some_and(asks_for_block) {
            assert!(
                self.segments > 0,
                "{cause}: a block of more than 127 segments"
            );
            self.segments -= 1;
            return;
        }
        let request = self.take_request(&data, cause);
        let address = Address::new(u16::from_le_bytes([data[1], data[2]]), data[3]);
        self.block_upload = request[0] >> 5 == 5;
        match data[0] {
            0x80 => self.forget(),
            // Expedited upload: the value itself.
            command @ (0x43 | 0x47 | 0x4B | 0x4F | 0x42) => {
                self.upload = Upload::default();
                self.download = None;
                let len = if command == 0x42 {
                    4
                } else {
                    4 - usize::from(command >> 2 & 3)
                };
                self.check_read(address, &data[4..4 + len]);
            }
            0x40 | 0x41 => {
                self.download = None;
                self.upload = Upload {
                    address: Some(address),
                    bytes: Vec::new(),
                };
            }
            command @ 0x00..=0x1F => {
                let len = 7 - usize::from(command >> 1 & 7);
                self.upload.bytes.extend_from_slice(&data[1..=len]);
                if command & 1 != 0 {
                    let done = std::mem::take(&mut self.upload);
                    if let Some(address) = done.address {
                        self.check_read(address, &done.bytes);
                    }
                }
            }
            0x60 => {
                self.upload = Upload::default();
                self.block = None;
                if request[0] & 2 != 0 {
                    let len = match request[0] & 1 {
                        1 => 4 - usize::from(request[0] >> 2 & 3),
                        _ => 4,
                    };
                    self.wrote(address, Some(&request[4..4 + len]));
                } else {
                    self.download = Some(Download {
                        address,
                        bytes: Vec::new(),
                    });
                }
            }
            0x20 | 0x30 => {
                let len = 7 - usize::from(request[0] >> 1 & 7);
                if let Some(download) = &mut self.download {
                    download.bytes.extend_from_slice(&request[1..=len]);
                }
                if request[0] & 1 != 0
                    && let Some(done) = self.download.take()
                {
                    self.wrote(done.address, Some(&done.bytes));
                }
            }
            0xA4 | 0xA0 => {
                self.upload = Upload::default();
                self.download = None;
                self.block = Some(address);
            }
            0xA1 => {
                if let Some(address) = self.block.take() {
                    self.wrote(address, None);
                }
            }
            _ => {}
        }
    }

    fn check_read(&mut self, address: Address, value: &[u8]) {
        if let Some(known) = self.shadow.get(&address) {
            assert_eq!(
                value, known,
                "{address} reads as something that nobody wrote"
            );
        }
    }

    /// A download was confirmed: the object has this value now, and linked objects have theirs.
    fn wrote(&mut self, address: Address, bytes: Option<&[u8]>) {
        self.check_identifiers();
        let now = self.read(address);
        // With the gear on, resolution and range are computed: a download is accepted without effect
        // (MANUALS.md U-14).
        let gear = Address::new(0x2001, 1);
        let default = self.entries.iter().find(|entry| entry.address == gear);
        let default = default.and_then(|entry| entry.default.integer(0));
        let is_geared = default.is_some_and(|off| self.read(gear) != [off as u8]);
        let is_free = !(is_geared && matches!(address.index, 0x6001 | 0x6002));
        if let (Some(bytes), true) = (bytes, is_free && self.shadow.contains_key(&address)) {
            let len = now.len().min(bytes.len());
            assert_eq!(
                now[..len],
                bytes[..len],
                "{address} was acknowledged and is something else"
            );
        }
        // Requests that were held back during the save may have been carried out now.
        let held = self.requests.iter();
        let held = held.map(|data| u16::from_le_bytes([data[1], data[2]]));
        let written: Vec<u16> = held.chain([address.index]).collect();
        self.compare(
            &format!("by a write to {address}"),
            &changes::coupled(&written),
        );
    }

    /// Only these objects may have changed.
    pub(super) fn compare(&mut self, cause: &str, but: &[u16]) {
        let known: Vec<Address> = self.shadow.keys().copied().collect();
        for address in known {
            let now = self.read(address);
            if but.contains(&address.index) {
                self.shadow.insert(address, now);
            } else {
                assert_eq!(now, self.shadow[&address], "{address} has changed {cause}");
            }
        }
    }

    /// A reset and a restore reset values. Returns the number of saves that have ended.
    fn events(&mut self) -> usize {
        let events = self.bus.with(0, |device, _| {
            std::iter::from_fn(|| device.poll_event()).collect::<Vec<_>>()
        });
        let events = events.unwrap_or_default();
        let is_reset = |event: &Event| matches!(event, Event::Reset(..));
        let takes_back = |event: &Event| is_reset(event) || matches!(event, Event::Restored(_));
        if events.iter().any(takes_back) {
            self.learn_all();
        }
        if self.state() == State::Initialising || events.iter().any(is_reset) {
            self.forget();
            self.requests.clear();
            self.is_saving = false;
            self.is_awaited = false;
        }
        let ends = |event: &&Event| matches!(event, Event::Saved(_) | Event::NotSaved);
        events.iter().filter(ends).count()
    }
}
