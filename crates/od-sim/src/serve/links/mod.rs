//! Links for masters: the values of `--link`, and their ends.

mod can;
#[cfg(target_os = "linux")]
mod interface;
pub(super) mod listener;
pub(super) mod opened;
pub(super) mod port;
mod serial;
pub(super) mod tcp;
#[cfg(unix)]
mod terminal;
mod threads;
pub(super) mod web_socket;

#[cfg(target_os = "linux")]
pub use interface::is_up;

use super::error::Error;
use crate::links::address::Address;
use od_model::Refused;
use opened::{Ends, Opened, Protocol};
use threads::Threads;

/// Forms of `--link`, for error messages.
const FORMS: &str = "slcan:HOST:PORT, slcan:pty, slcan:DEVICE[@BAUD], socketcand:HOST:PORT, \
                     socketcan:INTERFACE, ws:HOST:PORT, or - for standard input and output";

/// Limit of links of one bench; as clients they have the numbers below this one.
pub(super) const LINKS: usize = 64;

/// One link of the command line.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Link {
    /// A server on TCP, the adapter side of a serial line, or a CAN interface.
    At(Address),
    /// A pseudo-terminal that a program opens like the serial port of an adapter.
    Pty,
    /// A WebSocket server for pages, and its token if one is given.
    WebSocket(String, Option<String>),
    /// Standard input and output.
    Console,
}

impl Link {
    /// An slcan server on TCP at `HOST:PORT`.
    pub fn slcan(place: &str) -> Self {
        Self::At(Address::Slcan(place.to_owned()))
    }

    /// Reads the value of `--link`.
    ///
    /// # Errors
    /// The text is not a valid link; the message lists the forms.
    pub fn parse(text: &str) -> Result<Self, Refused> {
        match text.split_once(':') {
            None if text == "-" => Ok(Self::Console),
            Some(("slcan", "pty")) => Ok(Self::Pty),
            Some(("ws", place)) if !place.is_empty() => {
                let (at, token) = web_socket::parse(place)?;
                Ok(Self::WebSocket(at, token))
            }
            _ => Address::parse(text, FORMS).map(Self::At),
        }
    }

    /// Opens the link.
    pub(super) fn open(&self, origins: &[String]) -> Result<Opened, Error> {
        match self {
            Self::At(Address::Slcan(place)) => tcp::listen(Protocol::Slcan, place),
            Self::At(Address::Socketcand(place)) => tcp::listen(Protocol::Socketcand, place),
            Self::At(Address::Serial(path, baud)) => serial::open(path, *baud),
            Self::At(Address::SocketCan(name)) => can::open(name),
            Self::Pty => serial::open_pty(),
            Self::WebSocket(place, token) => web_socket::listen(place, token.as_deref(), origins),
            Self::Console => Ok(Opened::Ends(Ends {
                name: "standard input and output".into(),
                protocol: Protocol::Lines,
                port: Box::new(Threads::new(std::io::stdin(), std::io::stdout())),
            })),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_link() {
        for (text, link) in [
            ("-", Ok(Link::Console)),
            ("slcan:pty", Ok(Link::Pty)),
            ("slcan:29536", Ok(Link::slcan("127.0.0.1:29536"))),
            (
                "ws:29538",
                Ok(Link::WebSocket("127.0.0.1:29538".into(), None)),
            ),
            (
                "ws:localhost:0?token=a-long-one-12345",
                Ok(Link::WebSocket(
                    "localhost:0".into(),
                    Some("a-long-one-12345".into()),
                )),
            ),
        ] {
            assert_eq!(Link::parse(text), link, "{text}");
        }
        for wrong in [
            "",
            "slcan:",
            "ws:",
            "can0",
            "ws:1?token=short",
            "ws:1?token=what&ever-it-may-be",
            "ws:1?origin=x",
        ] {
            assert!(Link::parse(wrong).is_err(), "{wrong}");
        }
    }
}
