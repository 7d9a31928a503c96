//! A link that works: who speaks what over it.

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
    /// slcan in a WebSocket, behind a gate that is there as long as the program.
    WebSocket(&'static Gate),
    /// `struct can_frame` of Linux.
    CanFrame,
    /// Lines of the script language in, a candump log out.
    Lines,
    /// Lines of the script language in, an answer to each out.
    Control,
}

impl PartialEq for Protocol {
    /// Two of one kind are alike, whatever their gates.
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

    /// Its name, as `--link` has it.
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
            // A host counts the bell as an answer, and skips a line that it does not know.
            _ => format!("\x07odkit: {why}\r"),
        }
    }
}

/// A link that works.
pub(in crate::serve) enum Opened {
    /// Clients come and go.
    Listener(Protocol, TcpListener, SocketAddr),
    /// There is one client, and it is there already.
    Ends(Ends),
}

/// The client of a link that has one.
pub(in crate::serve) struct Ends {
    /// Name in messages; for a pseudo-terminal the path that others open.
    pub(in crate::serve) name: String,
    pub(in crate::serve) protocol: Protocol,
    pub(in crate::serve) port: Box<dyn Port>,
}
