//! An open link and its protocol.

use std::net::SocketAddr;

use mio::net::TcpListener;
use tungstenite::http::StatusCode;

use super::port::Port;
use crate::links::Codec;
use crate::links::can_frame::CanSocket;
use crate::links::lines::Lines;
use crate::links::slcan::Channel;
use crate::links::socketcand::Session;
use crate::links::web_socket::{self, Gate, WebSocket};

/// Protocol of a client.
#[derive(Clone, Copy, Debug)]
pub(in crate::serve) enum Protocol {
    Slcan,
    Socketcand,
    /// slcan in a WebSocket, with a gate that exists as long as the program.
    WebSocket(&'static Gate),
    /// `struct can_frame` of Linux.
    CanFrame,
    /// Lines of the script language as input, a candump log as output.
    Lines,
    /// Lines of the script language as input, an answer to each as output.
    Control,
}

impl PartialEq for Protocol {
    /// Two protocols of one kind are equal, whatever their gates.
    fn eq(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl Protocol {
    /// Makes the codec of one client.
    pub(in crate::serve) fn codec(self) -> Box<dyn Codec> {
        match self {
            Self::Slcan => Box::<Channel>::default(),
            Self::Socketcand => Box::<Session>::default(),
            Self::WebSocket(gate) => Box::new(WebSocket::new(gate)),
            Self::CanFrame => Box::new(CanSocket),
            Self::Lines | Self::Control => Box::<Lines>::default(),
        }
    }

    /// Its name in `--link`.
    pub(in crate::serve) fn name(self) -> &'static str {
        match self {
            Self::Slcan => "slcan",
            Self::Socketcand => "socketcand",
            Self::WebSocket(_) => "ws",
            Self::CanFrame => "socketcan",
            Self::Lines => "-",
            Self::Control => "control",
        }
    }

    /// Bytes that tell a client why it is refused.
    pub(in crate::serve) fn refusal(self, why: &str) -> String {
        match self {
            Self::Socketcand => format!("< error {why} >"),
            Self::WebSocket(_) => web_socket::refusal(StatusCode::SERVICE_UNAVAILABLE, why),
            Self::Control => format!("failed {why}\n"),
            // A host takes the bell as an answer, and skips an unknown line.
            _ => format!("\x07odkit: {why}\r"),
        }
    }
}

/// An open link.
pub(in crate::serve) enum Opened {
    /// A server: clients come and go.
    Listener(Protocol, TcpListener, SocketAddr),
    /// A link with one client from the start.
    Ends(Ends),
}

/// The client of a link with one client.
pub(in crate::serve) struct Ends {
    /// Name in messages; for a pseudo-terminal the path for the other program.
    pub(in crate::serve) name: String,
    pub(in crate::serve) protocol: Protocol,
    pub(in crate::serve) port: Box<dyn Port>,
}
