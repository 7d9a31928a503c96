//! Frames in plain words, with the names of the objects.
//!
//! [`explain`] knows a frame by itself; a [`Decoder`] also remembers which object a
//! segmented or block transfer is about.

mod control;
mod emcy;
mod fields;
pub mod fold;
mod lss;
mod pdo;
mod sdo;
mod tag;

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use od_model::Address;
use od_runtime::Frame;

pub(crate) use control::command_text as command;
pub use emcy::code_text;
pub use fields::{Field, fields};
pub use pdo::layout;
pub use tag::{TAGS, Tag, tag};

use crate::device::VirtualDevice;

/// What a frame is for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Service {
    /// NMT command.
    Nmt,
    /// SYNC.
    Sync,
    /// TIME.
    Time,
    /// Emergency.
    Emcy,
    /// Process data of a device.
    Tpdo,
    /// Process data for a device.
    Rpdo,
    /// SDO, client to server.
    SdoRequest,
    /// SDO, server to client.
    SdoAnswer,
    /// Boot-up, heartbeat, guarding.
    ErrorControl,
    /// Layer setting.
    Lss,
    /// Nothing that this bus knows.
    Unknown,
}

impl Service {
    /// A short name: `NMT`, `SYNC`, `PDO` …
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nmt => "NMT",
            Self::Sync => "SYNC",
            Self::Time => "TIME",
            Self::Emcy => "EMCY",
            Self::Tpdo | Self::Rpdo => "PDO",
            Self::SdoRequest | Self::SdoAnswer => "SDO",
            Self::ErrorControl => "NMT EC",
            Self::Lss => "LSS",
            Self::Unknown => "?",
        }
    }
}

/// A frame in words.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Words {
    /// What it is for.
    pub service: Service,
    /// The node it is from or for; `None` where it is for all.
    pub node: Option<u8>,
    /// The object it is about.
    pub address: Option<Address>,
    /// Is it an abort, an emergency, an error?
    pub error: bool,
    /// What it says, without the service and the node.
    pub text: String,
}

impl Words {
    fn new(service: Service, node: Option<u8>, text: impl Into<String>) -> Self {
        Self {
            service,
            node,
            address: None,
            error: false,
            text: text.into(),
        }
    }

    fn about(mut self, address: Address) -> Self {
        self.address = Some(address);
        self
    }

    fn error(mut self) -> Self {
        self.error = true;
        self
    }
}

impl core::fmt::Display for Words {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.node {
            Some(node) => write!(f, "{} node {node}: {}", self.service.name(), self.text),
            None => write!(f, "{}: {}", self.service.name(), self.text),
        }
    }
}

/// A frame in words, taken by itself.
pub fn explain(devices: &[VirtualDevice], frame: &Frame) -> Words {
    Decoder::default().explain(devices, frame)
}

/// Frames in words, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    transfers: BTreeMap<u8, sdo::Transfer>,
}

impl Decoder {
    /// The next frame of the bus in words. `devices` gives names and mappings; frames of
    /// nodes that are not among them are explained by the predefined connection set.
    pub fn explain(&mut self, devices: &[VirtualDevice], frame: &Frame) -> Words {
        if let Some(words) = pdo::explain(devices, frame).or_else(|| emcy::explain(devices, frame))
        {
            return words;
        }
        let Some(id) = frame.id().as_standard() else {
            return Words::new(Service::Unknown, None, "no service has this identifier");
        };
        let node = (id & 0x7F) as u8;
        match id {
            0x000 => control::nmt(frame),
            0x080 => control::sync(frame),
            0x100 => Words::new(Service::Time, None, "time stamp"),
            0x081..=0x0FF => emcy::words(node, frame),
            0x181..=0x57F => pdo::by_identifier(id, frame),
            0x581..=0x5FF | 0x601..=0x67F => {
                let device = devices.iter().find(|device| device.node_id().raw() == node);
                let transfer = self.transfers.entry(node).or_default();
                sdo::explain(transfer, device, id < 0x600, node, frame)
            }
            0x701..=0x77F => control::error_control(node, frame),
            0x7E4 => lss::answer(frame),
            0x7E5 => lss::request(frame),
            _ => Words::new(Service::Unknown, None, "no service has this identifier"),
        }
    }
}

fn bytes(count: usize) -> String {
    plural(count, "byte")
}

/// `1 frame`, `2 frames`.
pub(crate) fn plural(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
