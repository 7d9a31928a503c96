//! A frame in words, and what its service is called.

use std::format;
use std::prelude::v1::*;

use od_model::Address;

/// Service of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
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
    /// Service.
    pub service: Service,
    /// The node it is from or for; `None` where it is for all.
    pub node: Option<u8>,
    /// The object it is about.
    pub address: Option<Address>,
    /// Is it an abort, an emergency, an error?
    pub error: bool,
    /// An abort with its reason first, for those who read one line; `None` for everything else.
    pub reason_first: Option<String>,
    /// The meaning, without the service and the node.
    pub text: String,
}

impl Words {
    pub(super) fn new(service: Service, node: Option<u8>, text: impl Into<String>) -> Self {
        Self {
            service,
            node,
            address: None,
            error: false,
            reason_first: None,
            text: text.into(),
        }
    }

    pub(super) fn about(mut self, address: Address) -> Self {
        self.address = Some(address);
        self
    }

    pub(super) fn error(mut self) -> Self {
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

/// `1 byte`, `2 bytes`.
pub(super) fn bytes(count: usize) -> String {
    plural(count, "byte")
}

/// `1 frame`, `2 frames`.
pub(crate) fn plural(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
