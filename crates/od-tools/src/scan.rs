//! The nodes of a bus: heartbeats, boot-up messages, and an SDO request to each node ID.

use std::collections::{BTreeMap, BTreeSet};

use od_client::watch;
use od_model::Address;
use od_wire::nmt::State;
use od_wire::sdo::{Request, Response};
use od_wire::{CanId, Duration, Frame, Instant, NodeId, lss};

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// Number of requests without a response at the same time.
const AT_ONCE: usize = 16;
/// Time that a scan waits for nodes that responded before.
const LATE: Duration = Duration::from_millis(800);
/// Longest time to read one text of a node: some 1,000 segments.
const TEXT: Duration = Duration::from_secs(1);
/// Maximum number of frames that are read from the buffer after the time is over.
const WAITING: usize = 4096;
const DEVICE_TYPE: Address = Address::new(0x1000, 0);
const SERIAL: Address = Address::new(0x1018, 4);

/// Times of a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ScanTimes {
    /// Time to listen before the first request.
    pub listen: Duration,
    /// Maximum time to wait for a response.
    pub answer: Duration,
}

impl Default for ScanTimes {
    /// 500 ms and 200 ms: a scan of a bus without nodes takes 2.3 s.
    fn default() -> Self {
        Self {
            listen: Duration::from_millis(500),
            answer: Duration::from_millis(200),
        }
    }
}

/// A fault of the SDO responses that a scan receives from a node.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SdoFault {
    /// They are for other objects than those of the requests.
    OtherObject,
    /// They are shorter than 8 bytes (CiA 301, chapter 7.2.4.3.1).
    TooShort,
    /// Only the first request has a response: the node is too slow or gone, or another node uses its CAN-ID.
    Once,
}

/// A node that was found.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FoundNode {
    /// Node ID.
    pub node: NodeId,
    /// State in its last heartbeat; `None`: it sent none while odkit listened.
    pub state: Option<State>,
    /// It sent a boot-up message during the scan.
    pub has_booted: bool,
    /// Whether it responds to SDO requests; in Stopped it does not.
    pub answers: bool,
    /// The fault of its SDO responses, if they have one.
    pub fault: Option<SdoFault>,
    /// 1000h, device type.
    pub device_type: Option<u32>,
    /// 1018h: vendor-ID, product code, revision number, serial number.
    pub identity: [Option<u32>; 4],
    /// 1008h, 1009h, 100Ah: device name, hardware version, software version.
    pub texts: [Option<String>; 3],
    /// Serial numbers of all nodes with this node ID if several respond; else empty.
    pub conflict: Vec<u32>,
}

/// Result of a scan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Scan {
    /// The nodes, by node ID.
    pub nodes: Vec<FoundNode>,
    /// An LSS slave without a node ID is on the bus.
    pub has_unconfigured: bool,
}

/// Messages of the nodes so far.
#[derive(Default)]
struct Heard {
    states: BTreeMap<NodeId, State>,
    boot_ups: BTreeSet<NodeId>,
    answers: BTreeMap<NodeId, Vec<[u8; 8]>>,
    /// The faults of SDO responses.
    faults: BTreeMap<NodeId, SdoFault>,
    /// Index and sub-index of the requests, as in a frame: a response to an earlier request is ignored.
    asked: [u8; 3],
    has_unconfigured: bool,
}

/// Finds the nodes of a bus: listens, reads 1000h of each of the 127 node IDs, and reads the identity of those that
/// respond. Changes nothing on the bus.
///
/// `progress` receives the percentage done.
///
/// # Errors
/// The link is lost.
pub fn scan(
    link: &mut impl Link,
    times: ScanTimes,
    mut progress: impl FnMut(u8),
) -> Result<Scan, Error> {
    let mut heard = Heard::default();
    heard.listen(link, times.listen)?;
    link.send(&Frame::full(
        CanId::standard(lss::MASTER),
        lss::Request::IdentifyNonConfigured.emit(),
    ))?;
    let all: Vec<NodeId> = (1..=127).filter_map(NodeId::new).collect();
    for (done, batch) in all.chunks(AT_ONCE).enumerate() {
        progress((done * 10) as u8);
        heard.ask(link, batch, DEVICE_TYPE, times.answer)?;
    }
    // The last nodes have as much time for a late response as the others had.
    heard.listen(link, times.answer)?;
    let mut types = core::mem::take(&mut heard.answers);
    let there: Vec<NodeId> = types.keys().copied().collect();
    for batch in there.chunks(AT_ONCE) {
        // Two nodes of one type send the same response at the same time, which is one frame. Their
        // serial numbers differ.
        heard.ask(link, batch, SERIAL, times.answer)?;
    }
    let until = link.now() + LATE;
    while link.now() < until && heard.answers.len() < there.len() {
        heard.listen(link, times.answer)?;
    }
    let mut serials = core::mem::take(&mut heard.answers);
    let mut found = BTreeMap::new();
    for (at, node) in there.iter().enumerate() {
        progress(80 + (20 * at / there.len()) as u8);
        let types = types.remove(node).unwrap_or_default();
        let serials = serials.remove(node).unwrap_or_default();
        let mut one = FoundNode::new(*node);
        one.answers = true;
        one.device_type = types.first().and_then(number);
        if types.len() > 1 || serials.len() > 1 {
            one.conflict = serials.iter().filter_map(number).collect();
            one.conflict.sort_unstable();
            one.conflict.resize(one.conflict.len().max(2), 0);
        } else {
            one.identity[3] = serials.first().and_then(number);
            one.read(&mut *link)?;
        }
        found.insert(*node, one);
    }
    // Frames that arrived while nodes were read.
    heard.listen(link, Duration::ZERO)?;
    for node in heard.states.keys().chain(&heard.boot_ups) {
        found.entry(*node).or_insert_with(|| FoundNode::new(*node));
    }
    for (node, fault) in heard.faults {
        let one = found.entry(node).or_insert_with(|| FoundNode::new(node));
        if !one.answers {
            one.fault = Some(fault);
        }
    }
    for (node, one) in &mut found {
        one.state = heard.states.get(node).copied();
        one.has_booted = heard.boot_ups.contains(node);
    }
    Ok(Scan {
        nodes: found.into_values().collect(),
        has_unconfigured: heard.has_unconfigured,
    })
}

impl FoundNode {
    fn new(node: NodeId) -> Self {
        Self {
            node,
            state: None,
            has_booted: false,
            answers: false,
            fault: None,
            device_type: None,
            identity: [None; 4],
            texts: [None, None, None],
            conflict: Vec::new(),
        }
    }

    /// Reads identity and texts of a node.
    fn read(&mut self, link: &mut impl Link) -> Result<(), Error> {
        let mut master = Master::new(link, self.node).within(TEXT);
        for (part, sub) in self.identity.iter_mut().zip(1..=3) {
            let read = master.upload(Address::new(0x1018, sub));
            if matches!(read, Err(Error::Node(_))) && !master.is_alive()? {
                self.fault = Some(SdoFault::Once);
                return Ok(());
            }
            *part = optional(read)?.and_then(|bytes| {
                let bytes = bytes.as_slice().try_into().ok()?;
                Some(u32::from_le_bytes(bytes))
            });
        }
        let until = master.link().now() + TEXT;
        for (text, index) in self.texts.iter_mut().zip(0x1008..) {
            let bytes = optional(master.upload(Address::new(index, 0)))?;
            if bytes.is_none() && master.link().now() > until {
                // Each further text would take this time, too.
                break;
            }
            *text = bytes.map(|bytes| {
                let text = String::from_utf8_lossy(&bytes);
                text.trim_end_matches(['\0', ' ']).to_owned()
            });
        }
        Ok(())
    }
}

/// Reads an object that a device may lack; a node that stops responding counts as lacking it.
fn optional(read: Result<Vec<u8>, Error>) -> Result<Option<Vec<u8>>, Error> {
    match read {
        Ok(bytes) => Ok(Some(bytes)),
        Err(Error::Abort(_) | Error::Node(_) | Error::Protocol(_)) => Ok(None),
        Err(fault) => Err(fault),
    }
}

impl Heard {
    /// Sends a request to each of these nodes, and collects the responses.
    fn ask(
        &mut self,
        link: &mut impl Link,
        nodes: &[NodeId],
        address: Address,
        wait: Duration,
    ) -> Result<(), Error> {
        let request = Request::InitiateUpload { address }.emit();
        self.asked = [request[1], request[2], request[3]];
        for node in nodes {
            let id = CanId::standard(0x600 + u16::from(node.raw()));
            link.send(&Frame::full(id, request))?;
        }
        self.listen(link, wait)
    }

    fn listen(&mut self, link: &mut impl Link, wait: Duration) -> Result<(), Error> {
        let until = link.now() + wait;
        while let Some(heard) = link.receive(until)? {
            self.frame(&heard.frame);
            // A full bus does not delay the scan.
            if link.now() > until {
                break;
            }
        }
        // If the program had to wait for the processor, the frames that arrived in time are still
        // in the buffer.
        for _ in 0..WAITING {
            match link.receive(Instant::ZERO)? {
                Some(heard) => self.frame(&heard.frame),
                None => break,
            }
        }
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) {
        if let Some((node, state)) = watch::parse(frame) {
            match state {
                State::Initialising => {
                    self.boot_ups.insert(node);
                }
                state => {
                    self.states.insert(node, state);
                }
            }
        }
        let Some(id) = frame.id().as_standard() else {
            return;
        };
        if id == lss::SLAVE {
            let answer = lss::Response::parse(frame.data());
            self.has_unconfigured |= answer == Some(lss::Response::NonConfigured);
        }
        let node = id
            .checked_sub(0x580)
            .and_then(|node| u8::try_from(node).ok());
        if let Some(node) = node.and_then(NodeId::new)
            && !frame.is_remote()
            && self.asked != [0; 3]
        {
            let [_, low, high, sub, ..] = *frame.bytes();
            if frame.dlc() < 8 {
                self.faults.insert(node, SdoFault::TooShort);
            } else if [low, high, sub] == self.asked {
                self.answers.entry(node).or_default().push(*frame.bytes());
            } else if u16::from_le_bytes([low, high]) != DEVICE_TYPE.index {
                // A late response to the request for 1000h is not wrong.
                self.faults.insert(node, SdoFault::OtherObject);
            }
        }
    }
}

/// The number in an expedited response.
fn number(answer: &[u8; 8]) -> Option<u32> {
    match Response::parse(answer) {
        Response::InitiateUpload { .. } => {
            let [_, _, _, _, bytes @ ..] = *answer;
            Some(u32::from_le_bytes(bytes))
        }
        _ => None,
    }
}

/// Bit rates of CiA 301 in kbit/s, the most common ones first.
pub const RATES: [u16; 8] = [500, 250, 125, 1000, 800, 50, 20, 10];

/// Finds the bit rate by listening: the first at which a frame arrives. `try_` is called with each bit rate, before
/// it listens for `wait`. `None` if no frame arrives at any.
///
/// # Errors
/// The link cannot listen without acknowledging frames, or is lost.
pub fn detect(
    link: &mut impl Link,
    wait: Duration,
    mut try_: impl FnMut(u16),
) -> Result<Option<u16>, Error> {
    for rate in RATES {
        try_(rate);
        link.listen_at(rate)?;
        let until: Instant = link.now() + wait;
        if link.receive(until)?.is_some() {
            return Ok(Some(rate));
        }
    }
    Ok(None)
}
