//! Where masters come from: what `--link` says, and the ends of it.

mod can;
mod serial;

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, ToSocketAddrs};

use super::adapter::Kind;
use crate::Failure;

/// What `--link` takes, for error messages.
const FORMS: &str = "slcan:HOST:PORT, slcan:pty, slcan:DEVICE[@BAUD], socketcand:HOST:PORT, \
                     socketcan:INTERFACE, or - for standard input and output";

/// One link, as it was asked for.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Link {
    /// A TCP server that speaks this.
    Tcp(Kind, String),
    /// A pseudo-terminal that a program opens as if it were an adapter's serial port.
    Pty,
    /// An adapter's end of a serial line, with its baud rate.
    Serial(String, u32),
    /// A CAN interface of Linux.
    SocketCan(String),
    /// Standard input and output.
    Console,
}

impl Link {
    /// Reads what stands behind `--link`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        if text == "-" {
            return Ok(Self::Console);
        }
        let unknown = || format!("`{text}` is no link; there are {FORMS}");
        let (kind, place) = text.split_once(':').ok_or_else(unknown)?;
        if place.is_empty() {
            return Err(unknown());
        }
        match kind {
            "slcan" if place == "pty" => Ok(Self::Pty),
            "slcan" if is_device(place) => {
                let (path, baud) = match place.rsplit_once('@') {
                    Some((path, baud)) => (path, baud.parse().ok().filter(|baud| *baud > 0)),
                    None => (place, Some(serial::BAUD)),
                };
                let baud = baud.ok_or_else(|| format!("`{place}` has no baud rate behind @"))?;
                Ok(Self::Serial(path.to_owned(), baud))
            }
            "slcan" => Ok(Self::Tcp(Kind::Slcan, place.to_owned())),
            "socketcand" => Ok(Self::Tcp(Kind::Socketcand, place.to_owned())),
            "socketcan" => Ok(Self::SocketCan(place.to_owned())),
            _ => Err(unknown()),
        }
    }

    /// Opens it.
    pub(super) fn open(&self) -> Result<Opened, Failure> {
        match self {
            Self::Tcp(kind, place) => listen(*kind, place),
            Self::Pty => serial::pty(),
            Self::Serial(path, baud) => serial::open(path, *baud),
            Self::SocketCan(name) => can::open(name),
            Self::Console => Ok(Opened::Ends(Ends {
                name: "standard input".into(),
                kind: Kind::Lines,
                reading: Box::new(std::io::stdin()),
                writing: Box::new(std::io::stdout()),
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

/// A link that works.
pub(super) enum Opened {
    /// Clients come and go.
    Listener(Kind, TcpListener, SocketAddr),
    /// There is one client, and it is there already.
    Ends(Ends),
}

/// Both directions of a client.
pub(super) struct Ends {
    /// What to call it; for a pseudo-terminal the path that others open.
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) reading: Box<dyn Read + Send>,
    pub(super) writing: Box<dyn Write + Send>,
}

fn listen(kind: Kind, wanted: &str) -> Result<Opened, Failure> {
    let option = match kind {
        Kind::Socketcand => "--link socketcand:",
        _ => "--slcan ",
    };
    let full = match wanted.parse::<u16>() {
        Ok(port) => format!("127.0.0.1:{port}"),
        Err(_) => wanted.to_owned(),
    };
    let addresses: Vec<SocketAddr> = match full.to_socket_addrs() {
        Ok(addresses) => addresses.collect(),
        Err(_) => {
            return Err(Failure::Usage(format!(
                "`{wanted}` is no address to listen on; write {option}127.0.0.1:29536"
            )));
        }
    };
    let listener = TcpListener::bind(addresses.as_slice()).map_err(|error| {
        Failure::Failed(match error.kind() {
            ErrorKind::AddrInUse => format!(
                "{full} is in use, perhaps by another odkit; end that one, or take any free \
                 port with {option}127.0.0.1:0"
            ),
            _ => format!("{full}: {error}; choose another address with {option}HOST:PORT"),
        })
    })?;
    let address = listener.local_addr()?;
    Ok(Opened::Listener(kind, listener, address))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_link() {
        let tcp = |kind, place: &str| Ok(Link::Tcp(kind, place.into()));
        for (text, link) in [
            ("-", Ok(Link::Console)),
            ("slcan:pty", Ok(Link::Pty)),
            ("slcan:29536", tcp(Kind::Slcan, "29536")),
            ("slcan:localhost:1", tcp(Kind::Slcan, "localhost:1")),
            ("slcan:[::1]:1", tcp(Kind::Slcan, "[::1]:1")),
            ("socketcand:0.0.0.0:1", tcp(Kind::Socketcand, "0.0.0.0:1")),
            ("socketcan:vcan0", Ok(Link::SocketCan("vcan0".into()))),
            (
                "slcan:/dev/ttyUSB0",
                Ok(Link::Serial("/dev/ttyUSB0".into(), 115_200)),
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
        ] {
            assert!(Link::parse(wrong).is_err(), "{wrong}");
        }
    }
}
