//! The description of a frame, and the name of its service.

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
    /// PDO sent by a device.
    Tpdo,
    /// PDO received by a device.
    Rpdo,
    /// SDO, client to server.
    SdoRequest,
    /// SDO, server to client.
    SdoResponse,
    /// Boot-up, heartbeat, guarding.
    ErrorControl,
    /// Layer setting.
    Lss,
    /// A frame without a known service.
    Unknown,
}

impl Service {
    /// Returns a short name: `NMT`, `SYNC`, `PDO` …
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nmt => "NMT",
            Self::Sync => "SYNC",
            Self::Time => "TIME",
            Self::Emcy => "EMCY",
            Self::Tpdo | Self::Rpdo => "PDO",
            Self::SdoRequest | Self::SdoResponse => "SDO",
            Self::ErrorControl => "NMT EC",
            Self::Lss => "LSS",
            Self::Unknown => "?",
        }
    }
}

/// The description of a frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Words {
    /// Service.
    pub service: Service,
    /// Its sender or receiver; `None` for a frame to all nodes.
    pub node: Option<u8>,
    /// Its object.
    pub address: Option<Address>,
    /// Whether it is an abort, an emergency or an error.
    pub error: bool,
    /// For an abort, a text that begins with its reason, for displays of one line; `None` otherwise.
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

    /// Adds a remark to the text.
    pub(super) fn remark(mut self, remark: &str) -> Self {
        self.text.push_str(remark);
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
pub(crate) fn bytes(count: usize) -> String {
    plural(count, "byte")
}

/// `1 frame`, `2 frames`.
pub(crate) fn plural(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
