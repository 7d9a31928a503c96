//! Links for masters: the values of `--link`, and their ends.

mod can;
#[cfg(target_os = "linux")]
mod interface;
pub(super) mod listener;
pub(super) mod opened;
pub(super) mod port;
mod pty;
mod serial;
pub(super) mod tcp;
#[cfg(unix)]
mod terminal;
mod threads;
pub(super) mod web_socket;

use super::failure::Failure;
use od_model::Refused;
use opened::{Ends, Opened, Protocol};
use threads::Threads;

/// Forms of `--link`, for error messages.
const FORMS: &str = "slcan:HOST:PORT, slcan:pty, slcan:DEVICE[@BAUD], socketcand:HOST:PORT, \
                     socketcan:INTERFACE, ws:HOST:PORT, or - for standard input and output";

/// Most links of one bench; as clients they have the numbers below this one.
pub(super) const LINKS: usize = 64;

/// One link, as it was asked for.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Link {
    /// An slcan server on TCP.
    Slcan(String),
    /// A socketcand server on TCP.
    Socketcand(String),
    /// A pseudo-terminal that a program opens as if it were an adapter's serial port.
    Pty,
    /// An adapter's end of a serial line, with its baud rate.
    Serial(String, u32),
    /// A CAN interface of Linux.
    SocketCan(String),
    /// A WebSocket server for pages, and its token if it shall have a known one.
    WebSocket(String, Option<String>),
    /// Standard input and output.
    Console,
}

impl Link {
    /// An slcan server on TCP at `HOST:PORT`.
    pub fn slcan(place: &str) -> Self {
        Self::Slcan(place.to_owned())
    }

    /// Reads the value of `--link`.
    ///
    /// # Errors
    /// The text is not a valid link; the message lists the forms.
    pub fn parse(text: &str) -> Result<Self, Refused> {
        if text == "-" {
            return Ok(Self::Console);
        }
        let unknown = || format!("`{text}` is not a valid link; write {FORMS}");
        let (kind, place) = text.split_once(':').ok_or_else(unknown)?;
        if place.is_empty() {
            return Err(unknown().into());
        }
        match kind {
            "slcan" if place == "pty" => Ok(Self::Pty),
            "slcan" if is_device(place) => {
                let (path, baud) = match place.rsplit_once('@') {
                    Some((path, baud)) => (path, baud.parse().ok().filter(|baud| *baud > 0)),
                    None => (place, Some(serial::BAUD)),
                };
                let baud = baud.ok_or_else(|| format!("`{place}` has no bit rate after `@`"))?;
                Ok(Self::Serial(path.to_owned(), baud))
            }
            "slcan" => Ok(Self::Slcan(tcp::check(place)?)),
            "socketcand" => Ok(Self::Socketcand(tcp::check(place)?)),
            "socketcan" => Ok(Self::SocketCan(place.to_owned())),
            "ws" => Ok(web_socket::parse(place).map(|(at, token)| Self::WebSocket(at, token))?),
            _ => Err(unknown().into()),
        }
    }

    /// Opens it.
    pub(super) fn open(&self, origins: &[String]) -> Result<Opened, Failure> {
        match self {
            Self::Slcan(place) => tcp::listen(Protocol::Slcan, place),
            Self::Socketcand(place) => tcp::listen(Protocol::Socketcand, place),
            Self::Pty => pty::open(),
            Self::Serial(path, baud) => serial::open(path, *baud),
            Self::SocketCan(name) => can::open(name),
            Self::WebSocket(place, token) => web_socket::listen(place, token.as_deref(), origins),
            Self::Console => Ok(Opened::Ends(Ends {
                name: "standard input and output".into(),
                protocol: Protocol::Lines,
                port: Box::new(Threads::new(std::io::stdin(), std::io::stdout())),
            })),
        }
    }
}

/// A path, or a port of Windows.
fn is_device(place: &str) -> bool {
    place.starts_with('/')
        || place.starts_with('.')
        || place.to_ascii_uppercase().starts_with("COM")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_link() {
        let slcan = |place| Ok(Link::slcan(place));
        for (text, link) in [
            ("-", Ok(Link::Console)),
            ("slcan:pty", Ok(Link::Pty)),
            ("slcan:29536", slcan("127.0.0.1:29536")),
            ("slcan:localhost:1", slcan("localhost:1")),
            ("slcan:[::1]:1", slcan("[::1]:1")),
            (
                "socketcand:0.0.0.0:1",
                Ok(Link::Socketcand("0.0.0.0:1".into())),
            ),
            ("socketcan:vcan0", Ok(Link::SocketCan("vcan0".into()))),
            (
                "slcan:/dev/ttyUSB0",
                Ok(Link::Serial("/dev/ttyUSB0".into(), 115_200)),
            ),
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
            ("slcan:COM3@9600", Ok(Link::Serial("COM3".into(), 9600))),
        ] {
            assert_eq!(Link::parse(text), link, "{text}");
        }
        for wrong in [
            "",
            "slcan",
            "slcan:",
            "can0",
            "udp:1",
            "slcan:/dev/ttyS0@",
            "slcan:/dev/x@0",
            "slcan:127.0.0.1:99999",
            "slcan:99999",
            "slcan:nowhere",
            "slcan::1",
            "socketcand:127.0.0.1:-1",
            "ws:1?token=short",
            "ws:1?token=what&ever-it-may-be",
            "ws:1?origin=x",
        ] {
            assert!(Link::parse(wrong).is_err(), "{wrong}");
        }
    }
}
