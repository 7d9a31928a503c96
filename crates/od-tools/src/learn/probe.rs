//! Requests that find the properties of one value.

use od_client::watch;
use od_eds::outline::specified;
use od_model::Address;
use od_wire::AbortCode::{
    InvalidCommand, NoObject, NoSubIndex, ReadOnly, UnsupportedAccess, WriteOnly,
};
use od_wire::nmt::{Command, State};
use od_wire::{CanId, Duration, Frame, NodeId, lss, sdo};

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;
use crate::nmt;

/// A value with the properties that the node shows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct FoundObject {
    pub(super) address: Address,
    /// The bytes; `None` if the node has no data at present.
    pub(super) bytes: Option<Vec<u8>>,
    pub(super) is_write_only: bool,
    /// Access; `None` if only a write can show it.
    pub(super) writable: Option<bool>,
    /// Lengths that a download may have; `None` if not tested, or if the node does not show them.
    pub(super) room: Option<Room>,
}

/// Lengths that a download may have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Room {
    /// A number of this many bytes.
    Bytes(usize),
    /// Any length: a string.
    Some,
    /// At least [`LONG`]: a DOMAIN.
    Any,
}

const DEVICE_TYPE: Address = Address::new(0x1000, 0);
/// A sub-index that no object has.
const BEYOND: u8 = 0xFE;
/// Maximum time to wait for the response of a selected LSS slave.
const SELECTED: Duration = Duration::from_millis(200);
/// Maximum time to wait for the response to a request of node guarding.
const GUARDED: Duration = Duration::from_millis(200);
/// Time in which a node follows an NMT command.
const SETTLE: Duration = Duration::from_millis(100);

/// A length that no string of a device has.
const LONG: u32 = 1 << 16;

/// A number that nearly every device has: a node that checks lengths refuses another length for it.
const NUMBERS: [(u16, u8); 5] = [
    (0x1017, 0),
    (0x1800, 2),
    (0x1400, 2),
    (0x1016, 1),
    (0x1029, 1),
];

/// Whether an address exists.
pub(super) enum There {
    NoObject,
    NoSubIndex,
    Value(FoundObject),
}

/// Whether the node is an LSS slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Lss {
    Yes,
    No,
    /// It did not respond in its NMT state, and was not stopped.
    Unknown,
}

/// Asks one node.
pub(super) struct Probe<L> {
    master: Master<L>,
    node: NodeId,
    /// Whether the node checks the announced length; `None`: not known yet.
    minds: Option<bool>,
    /// Whether the node refuses a download to a read-only object at initiate; `None`: not known yet.
    checks_access: Option<bool>,
    /// Whether the node responds to sub-indices that an object cannot have; `None`: not known yet.
    ignores_sub: Option<bool>,
    /// Objects that could not be read, in words.
    pub(super) faults: Vec<String>,
    /// Number of objects in a row without a response.
    silent: u8,
    /// Number of values in a row in whose transfer the node violates the protocol.
    wrong: u8,
}

/// Number of objects in a row without a response after which a node is not asked for more.
const SILENT: u8 = 8;

/// Number of values in a row in whose transfer a node violates the protocol after which it is not asked for more. With
/// short responses to all requests, it would seem to have 36,864 objects.
const WRONG: u8 = 64;

impl<L: Link> Probe<L> {
    pub(super) fn new(link: L, node: NodeId) -> Self {
        Self {
            master: Master::new(link, node),
            node,
            minds: None,
            checks_access: None,
            ignores_sub: None,
            faults: Vec::new(),
            silent: 0,
            wrong: 0,
        }
    }

    /// Reads a value, and if it exists, tests whether it can be written. A transfer in which the node violates the
    /// protocol shows that the object exists.
    pub(super) fn read(&mut self, address: Address) -> Result<There, Error> {
        let read = match self.master.upload(address) {
            Err(Error::Protocol(why)) => {
                self.wrong += 1;
                if self.wrong == WRONG {
                    return Err(Error::Protocol(why));
                }
                self.faults
                    .push(format!("{why}; the file has the object without its value"));
                return Ok(There::Value(FoundObject {
                    address,
                    bytes: None,
                    is_write_only: false,
                    writable: None,
                    room: None,
                }));
            }
            Err(Error::Node(why)) => {
                self.silent += 1;
                if self.silent == SILENT || !self.master.is_alive()? {
                    return Err(Error::Node(why));
                }
                let node = self.node;
                self.faults.push(format!(
                    "node {node} does not respond to the request for {address}; the file does not have the object"
                ));
                return Ok(if address.sub == 0 {
                    There::NoObject
                } else {
                    There::NoSubIndex
                });
            }
            read => Error::or_abort(read)?,
        };
        (self.silent, self.wrong) = (0, 0);
        let (bytes, is_write_only) = match read {
            Ok(bytes) => (Some(bytes), false),
            Err(code) if code == NoObject.code() => return Ok(There::NoObject),
            Err(code) if code == NoSubIndex.code() => return Ok(There::NoSubIndex),
            Err(code) => (None, code == WriteOnly.code()),
        };
        let writable = if is_write_only {
            Some(true)
        } else if address.index == 0x1F50 {
            // A download to a program erases it at once.
            None
        } else {
            self.writable(address, bytes.as_deref())?
        };
        let room = match writable {
            Some(true) if specified(address.index).is_none() => {
                self.room(address, bytes.as_deref())?
            }
            _ => None,
        };
        Ok(There::Value(FoundObject {
            address,
            bytes,
            is_write_only,
            writable,
            room,
        }))
    }

    /// Returns whether the index has no object, by one request: most of the 36,864 indices have none.
    pub(super) fn lacks(&mut self, index: u16) -> Result<bool, Error> {
        let answer = self.ask(request(0x40, Address::new(index, 0), [0; 4]))?;
        // End the upload that this began, since some servers abort the next request otherwise.
        let is_begun = |answer: &[u8; 8]| answer[0] & 0xE2 == 0x40;
        if answer.as_ref().is_some_and(is_begun) {
            self.give_up(Address::new(index, 0))?;
        }
        Ok(answer.as_ref().and_then(code) == Some(NoObject.code()))
    }

    /// Returns whether an object is a VAR: by the standard, or because the node responds with the same value to a
    /// sub-index that the object cannot have.
    pub(super) fn is_var(&mut self, whole: &FoundObject) -> Result<bool, Error> {
        let index = whole.address.index;
        if specified(index).is_some_and(|known| !known.code.has_members()) {
            return Ok(true);
        }
        if self.ignores_sub.is_none() {
            let beyond = self.bytes(Address::new(DEVICE_TYPE.index, BEYOND))?;
            self.ignores_sub = Some(beyond.is_some());
        }
        if self.ignores_sub == Some(false) || whole.bytes.is_none() {
            return Ok(false);
        }
        Ok(self.bytes(Address::new(index, BEYOND))? == whole.bytes)
    }

    /// Writes the current value, and returns whether the node accepts it; `None` if it cannot be read.
    pub(super) fn takes_its_value(&mut self, found: &FoundObject) -> Result<Option<bool>, Error> {
        let Some(bytes) = found.bytes.as_deref().filter(|bytes| !bytes.is_empty()) else {
            return Ok(None);
        };
        match self.master.download(found.address, bytes) {
            Ok(()) => Ok(Some(true)),
            Err(Error::Abort(code)) => Ok(is_fixed(code).then_some(false)),
            Err(Error::Protocol(_)) => Ok(None),
            Err(other) => Err(other),
        }
    }

    /// Finds out whether the node is an LSS slave. Some respond in Stopped only, so a node in Pre-operational is stopped
    /// for a moment if `may_stop`. `heartbeat` is its producer heartbeat time in milliseconds.
    pub(super) fn lss(
        &mut self,
        identity: &Option<[u32; 4]>,
        heartbeat: u16,
        may_stop: bool,
    ) -> Result<Lss, Error> {
        let Some(identity) = identity else {
            return Ok(Lss::No);
        };
        if self.is_selected(identity)? {
            return Ok(Lss::Yes);
        }
        if !may_stop || self.shown_state(heartbeat)? != Some(State::PreOperational) {
            return Ok(Lss::Unknown);
        }
        let node = Some(self.node);
        let link = self.master.link();
        let stopped = nmt::command(link, node, Command::Stop, SETTLE);
        let is_slave = stopped.and_then(|_| self.is_selected(identity));
        let link = self.master.link();
        // After Ctrl-C, too.
        link.resume();
        nmt::command(link, node, Command::EnterPreOperational, SETTLE)?;
        Ok(if is_slave? { Lss::Yes } else { Lss::No })
    }

    /// As [`state`](Self::state); a node without heartbeat and node guarding gets a heartbeat for a moment.
    fn shown_state(&mut self, heartbeat: u16) -> Result<Option<State>, Error> {
        let shown = self.state(heartbeat)?;
        let time = Address::new(0x1017, 0);
        if shown.is_some() || heartbeat > 0 || !self.write(time, &[50, 0])? {
            return Ok(shown);
        }
        let shown = self.state(50);
        self.resume();
        self.put_back(time, &[0, 0])?;
        shown
    }

    /// The NMT state, by the heartbeat, or without one by node guarding; `None` if the node shows neither.
    fn state(&mut self, heartbeat: u16) -> Result<Option<State>, Error> {
        let node = self.node;
        let link = self.master.link();
        if heartbeat == 0
            && let Some(request) = Frame::remote(node.plus(0x700), 1)
        {
            link.send(&request)?;
        }
        let until = link.now() + GUARDED + Duration::from_millis(heartbeat.into());
        while let Some(heard) = link.receive(until)? {
            match watch::parse(&heard.frame) {
                Some((from, state)) if from == node => return Ok(Some(state)),
                _ if heard.at > until => break,
                _ => {}
            }
        }
        Ok(None)
    }

    /// Returns whether an LSS slave has this LSS address. The slave is in LSS waiting state afterwards.
    fn is_selected(&mut self, identity: &[u32; 4]) -> Result<bool, Error> {
        let link = self.master.link();
        let mut tell = |request: lss::Request| {
            let id = CanId::standard(lss::MASTER);
            link.send(&Frame::full(id, request.emit()))
        };
        let waiting = lss::Request::SwitchGlobal {
            configuration: false,
        };
        tell(waiting)?;
        for (part, value) in lss::Part::ALL.into_iter().zip(*identity) {
            tell(lss::Request::SwitchSelective { part, value })?;
        }
        let until = link.now() + SELECTED;
        let mut is_there = false;
        while let Some(heard) = link.receive(until)? {
            if heard.frame.id().as_standard() == Some(lss::SLAVE) {
                let answer = lss::Response::parse(heard.frame.data());
                is_there |= matches!(answer, Some(lss::Response::Selected { .. }));
            }
            if is_there || heard.at > until {
                break;
            }
        }
        let id = CanId::standard(lss::MASTER);
        link.send(&Frame::full(id, waiting.emit()))?;
        Ok(is_there)
    }

    /// Reads the value again; `None` after an abort, or if the node violates the protocol.
    pub(super) fn bytes(&mut self, address: Address) -> Result<Option<Vec<u8>>, Error> {
        done(self.master.upload(address))
    }

    /// Writes a value, and returns whether the node accepts it.
    pub(super) fn write(&mut self, address: Address, bytes: &[u8]) -> Result<bool, Error> {
        Ok(done(self.master.download(address, bytes))?.is_some())
    }

    /// Lets the master wait again after Ctrl-C.
    pub(super) fn resume(&mut self) {
        self.master.link().resume();
    }

    /// Restores a value.
    pub(super) fn put_back(&mut self, address: Address, bytes: &[u8]) -> Result<(), Error> {
        match Error::or_abort(self.master.download(address, bytes))? {
            Ok(()) => Ok(()),
            Err(code) => Err(Error::Node(format!(
                "node {}: could not put back {address} = {}: abort {code:08X}h",
                self.node,
                od_model::values::hex(bytes)
            ))),
        }
    }

    /// Lengths that a download may have, if the value does not determine them.
    fn room(&mut self, address: Address, bytes: Option<&[u8]>) -> Result<Option<Room>, Error> {
        let is_clear = |bytes: &[u8]| {
            let is_text = bytes.iter().any(|byte| byte.is_ascii_graphic());
            matches!(bytes.len(), 1 | 2) || matches!(bytes.len(), 3 | 4 | 8) && !is_text
        };
        if bytes.is_some_and(is_clear) || !self.minds()? {
            return Ok(None);
        }
        if self.admits(address, LONG)? {
            return Ok(Some(Room::Any));
        }
        if bytes.is_some_and(|bytes| bytes.len() > 8) || self.admits(address, 9)? {
            return Ok(Some(Room::Some));
        }
        for size in (1..=8).rev() {
            if self.admits(address, size)? {
                let is_string = size > 1 && self.admits(address, size - 1)?;
                let room = Room::Bytes(size as usize);
                return Ok(Some(if is_string { Room::Some } else { room }));
            }
        }
        Ok(None)
    }

    /// Returns whether the node refuses a number with a wrong length.
    fn minds(&mut self) -> Result<bool, Error> {
        if let Some(minds) = self.minds {
            return Ok(minds);
        }
        for (index, sub) in NUMBERS {
            let address = Address::new(index, sub);
            let Some(bytes) = self.bytes(address)? else {
                continue;
            };
            if self.admits(address, bytes.len() as u32)? {
                let minds = !self.admits(address, LONG)?;
                self.minds = Some(minds);
                return Ok(minds);
            }
        }
        self.minds = Some(false);
        Ok(false)
    }

    /// Returns whether the node confirms a download of this length; the download is then aborted.
    fn admits(&mut self, address: Address, size: u32) -> Result<bool, Error> {
        let answer = self.ask(request(0x21, address, size.to_le_bytes()))?;
        let is_confirmed = answer.is_some_and(|answer| answer[0] == 0x60);
        if is_confirmed {
            self.give_up(address)?;
        }
        Ok(is_confirmed)
    }

    /// Returns whether the node refuses a request because of its command; a transfer that begins is aborted.
    pub(super) fn lacks_command(&mut self, command: u8, address: Address) -> Result<bool, Error> {
        let answer = self.ask(request(command, address, [2, 0, 0, 0]))?;
        match answer.as_ref().map(code) {
            Some(Some(code)) => Ok(code == InvalidCommand.code()),
            _ => self.give_up(address).map(|()| false),
        }
    }

    fn give_up(&mut self, address: Address) -> Result<(), Error> {
        self.tell(request(0x80, address, 0x0800_0000u32.to_le_bytes()))
    }

    /// Begins a download that writes nothing: segmented, and aborted as soon as the node confirms it. With a
    /// server that has no segments, the test writes one byte to a longer value, which is refused, or the current value.
    fn writable(&mut self, address: Address, bytes: Option<&[u8]>) -> Result<Option<bool>, Error> {
        let bytes = bytes.unwrap_or(&[0]);
        let size = (bytes.len().max(1) as u32).to_le_bytes();
        let answer = self.ask(request(0x21, address, size))?;
        let Some(answer) = answer else {
            return Ok(None);
        };
        if answer[0] == 0x60 {
            self.give_up(address)?;
            // A node that confirms a download to any object checks the access later.
            return Ok(self.checks_access()?.then_some(true));
        }
        match code(&answer) {
            Some(code) if is_fixed(code) => return Ok(Some(false)),
            Some(code) if code != InvalidCommand.code() => return Ok(Some(true)),
            _ => {}
        }
        let mut data = [0; 4];
        let len = bytes.len().min(4);
        data[..len].copy_from_slice(&bytes[..len]);
        let command = if len == 1 { 0x23 } else { 0x2F };
        let answer = self.ask(request(command, address, data))?;
        Ok(match answer.as_ref().map(code) {
            Some(Some(code)) => Some(!is_fixed(code)),
            Some(None) => {
                // The node accepted it, so the value is restored.
                if self.bytes(address)?.as_deref() != Some(bytes) {
                    self.write(address, bytes)?;
                }
                Some(true)
            }
            None => None,
        })
    }

    /// Returns whether the node refuses a download to 1000h, 1001h or 1018h:01 at initiate. A confirmed initiate then
    /// shows that an object can be written.
    fn checks_access(&mut self) -> Result<bool, Error> {
        if let Some(checks) = self.checks_access {
            return Ok(checks);
        }
        let mut checks = true;
        for address in [
            DEVICE_TYPE,
            Address::new(0x1001, 0),
            Address::new(0x1018, 1),
        ] {
            let Some(bytes) = self.bytes(address)? else {
                continue;
            };
            checks = !self.admits(address, bytes.len() as u32)?;
            break;
        }
        self.checks_access = Some(checks);
        Ok(checks)
    }

    fn tell(&mut self, data: [u8; 8]) -> Result<(), Error> {
        let frame = Frame::full(self.node.plus(0x600), data);
        self.master.link().send(&frame)
    }

    fn ask(&mut self, data: [u8; 8]) -> Result<Option<[u8; 8]>, Error> {
        self.tell(data)?;
        let id = self.node.plus(0x580);
        let link = self.master.link();
        let until = link.now() + Duration::from_secs(1);
        loop {
            match link.receive(until) {
                Ok(Some(heard))
                    if heard.frame.id() == id
                        && heard.frame.dlc() == 8
                        && belongs(heard.frame.bytes(), &data) =>
                {
                    return Ok(Some(*heard.frame.bytes()));
                }
                Ok(Some(_)) => {}
                Ok(None) => {
                    // A late response begins nothing.
                    let mut abort = data;
                    abort[0] = 0x80;
                    abort[4..].copy_from_slice(&0x0504_0000u32.to_le_bytes());
                    self.tell(abort)?;
                    return Ok(None);
                }
                Err(Error::Interrupted) => {
                    // The node is told that the transfer has ended.
                    let mut abort = data;
                    abort[0] = 0x80;
                    abort[4..].copy_from_slice(&0x0800_0000u32.to_le_bytes());
                    self.tell(abort)?;
                    return Err(Error::Interrupted);
                }
                Err(fault) => return Err(fault),
            }
        }
    }
}

/// The result of a transfer; `None` after an abort, or if the node violates the protocol.
fn done<T>(result: Result<T, Error>) -> Result<Option<T>, Error> {
    match result {
        Ok(done) => Ok(Some(done)),
        Err(Error::Abort(_) | Error::Protocol(_)) => Ok(None),
        Err(other) => Err(other),
    }
}

/// Returns whether the response belongs to this request, and not to an earlier one. An abort because of the command
/// may name any object.
fn belongs(answer: &[u8; 8], request: &[u8; 8]) -> bool {
    answer[1..4] == request[1..4] || code(answer) == Some(InvalidCommand.code())
}

fn is_fixed(code: u32) -> bool {
    code == ReadOnly.code() || code == UnsupportedAccess.code()
}

fn code(answer: &[u8; 8]) -> Option<u32> {
    match sdo::Response::parse(answer) {
        sdo::Response::Abort { code, .. } => Some(code),
        _ => None,
    }
}

fn request(command: u8, address: Address, rest: [u8; 4]) -> [u8; 8] {
    let [low, high] = address.index.to_le_bytes();
    let [a, b, c, d] = rest;
    [command, low, high, address.sub, a, b, c, d]
}
