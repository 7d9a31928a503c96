//! What a node answers about one value.

use od_model::Address;
use od_wire::AbortCode::{
    InvalidCommand, NoObject, NoSubIndex, ReadOnly, UnsupportedAccess, WriteOnly,
};
use od_wire::{Duration, Frame, NodeId, sdo};

use crate::fault::Fault;
use crate::link::Link;
use crate::master::Master;

/// A value as the node shows it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Found {
    pub(super) address: Address,
    /// The bytes; `None` where there are none now.
    pub(super) bytes: Option<Vec<u8>>,
    pub(super) is_write_only: bool,
    /// `None`: it cannot be told without a write.
    pub(super) writable: Option<bool>,
}

/// Whether there is something at an address.
pub(super) enum There {
    NoObject,
    NoSubIndex,
    Value(Found),
}

/// Asks one node.
pub(super) struct Probe<L> {
    master: Master<L>,
    node: NodeId,
}

impl<L: Link> Probe<L> {
    pub(super) fn new(link: L, node: NodeId) -> Self {
        Self {
            master: Master::new(link, node),
            node,
        }
    }

    /// Reads a value; of one that is there, tries whether it can be written.
    pub(super) fn read(&mut self, address: Address) -> Result<There, Fault> {
        let (bytes, is_write_only) = match self.master.upload(address)? {
            Ok(bytes) => (Some(bytes), false),
            Err(code) if code == NoObject.code() => return Ok(There::NoObject),
            Err(code) if code == NoSubIndex.code() => return Ok(There::NoSubIndex),
            Err(code) => (None, code == WriteOnly.code()),
        };
        let writable = match is_write_only {
            true => Some(true),
            false => self.writable(address, bytes.as_deref())?,
        };
        Ok(There::Value(Found {
            address,
            bytes,
            is_write_only,
            writable,
        }))
    }

    /// Whether there is no object, by one request: of 36,864 indices most have none.
    pub(super) fn lacks(&mut self, index: u16) -> Result<bool, Fault> {
        let answer = self.ask(request(0x40, Address::new(index, 0), [0; 4]))?;
        // A segmented upload that this began ends with the next request.
        Ok(answer.as_ref().and_then(code) == Some(NoObject.code()))
    }

    /// Reads the value again.
    pub(super) fn bytes(&mut self, address: Address) -> Result<Option<Vec<u8>>, Fault> {
        Ok(self.master.upload(address)?.ok())
    }

    /// Writes a value; whether it was accepted.
    pub(super) fn write(&mut self, address: Address, bytes: &[u8]) -> Result<bool, Fault> {
        Ok(self.master.download(address, bytes)?.is_ok())
    }

    /// Begins a download that writes nothing: segmented, and aborted as soon as it is confirmed. A
    /// server without segments refuses one byte for a value of more, and takes the value that it has.
    fn writable(&mut self, address: Address, bytes: Option<&[u8]>) -> Result<Option<bool>, Fault> {
        let bytes = bytes.unwrap_or(&[0]);
        let size = (bytes.len().max(1) as u32).to_le_bytes();
        let answer = self.ask(request(0x21, address, size))?;
        let Some(answer) = answer else {
            return Ok(None);
        };
        if answer[0] == 0x60 {
            self.tell(request(0x80, address, 0x0800_0000u32.to_le_bytes()))?;
            return Ok(Some(true));
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
                // Taken all the same: the value is made sure of.
                if self.bytes(address)?.as_deref() != Some(bytes) {
                    self.write(address, bytes)?;
                }
                Some(true)
            }
            None => None,
        })
    }

    fn tell(&mut self, data: [u8; 8]) -> Result<(), Fault> {
        let frame = Frame::full(self.node.plus(0x600), data);
        self.master.link().send(&frame)
    }

    fn ask(&mut self, data: [u8; 8]) -> Result<Option<[u8; 8]>, Fault> {
        self.tell(data)?;
        let id = self.node.plus(0x580);
        let link = self.master.link();
        let until = link.now() + Duration::from_secs(1);
        while let Some(heard) = link.receive(until)? {
            if heard.frame.id() == id && heard.frame.dlc() == 8 {
                return Ok(Some(*heard.frame.bytes()));
            }
        }
        Ok(None)
    }
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
