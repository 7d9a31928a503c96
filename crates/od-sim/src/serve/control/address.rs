//! Address of the control socket of a bench: a path, or a port of this computer.

use od_model::Refused;
use std::fmt;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream, ToSocketAddrs};
use std::path::PathBuf;

/// Address of the control socket of a bench.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum ControlAddress {
    /// A Unix socket.
    Unix(PathBuf),
    /// `HOST:PORT` of this computer.
    Tcp(String),
}

/// Both directions of a connection.
pub trait Connection: Read + Write {}

impl<T: Read + Write> Connection for T {}

impl ControlAddress {
    /// Reads `unix:PATH`, `tcp:HOST:PORT`, or a path.
    ///
    /// # Errors
    /// The message contains the text to write instead.
    pub fn parse(text: &str) -> Result<Self, Refused> {
        let wrong =
            || format!("`{text}` is not a control socket; write unix:PATH or tcp:127.0.0.1:PORT");
        match text.split_once(':') {
            Some(("unix", path)) if !path.is_empty() => Ok(Self::Unix(path.into())),
            Some(("tcp", address)) => {
                let (host, port) = address.rsplit_once(':').unwrap_or(("127.0.0.1", address));
                let port: u16 = port.parse().map_err(|_| wrong())?;
                if host.is_empty() {
                    Err(wrong().into())
                } else {
                    Ok(Self::Tcp(format!("{host}:{port}")))
                }
            }
            _ if text.contains('/') || !text.is_empty() && !text.contains(':') => {
                Ok(Self::Unix(text.into()))
            }
            _ => Err(wrong().into()),
        }
    }

    /// Connects to the socket.
    ///
    /// # Errors
    /// Reason why no bench answers.
    pub fn connect(&self) -> io::Result<Box<dyn Connection>> {
        Ok(match self {
            #[cfg(unix)]
            Self::Unix(path) => Box::new(std::os::unix::net::UnixStream::connect(path)?),
            #[cfg(not(unix))]
            Self::Unix(_) => return Err(io::ErrorKind::Unsupported.into()),
            Self::Tcp(address) => {
                let stream = TcpStream::connect(address)?;
                stream.set_nodelay(true)?;
                Box::new(stream)
            }
        })
    }

    /// The socket addresses of `HOST:PORT`, which must be this computer's own.
    ///
    /// # Errors
    /// A sentence: the host is unknown, or other computers could connect.
    pub(super) fn own_addresses(address: &str) -> Result<Vec<SocketAddr>, String> {
        let addresses: Vec<SocketAddr> = match address.to_socket_addrs() {
            Ok(addresses) => addresses.collect(),
            Err(error) => return Err(format!("the host of `{address}` is unknown ({error})")),
        };
        if addresses.iter().all(|address| address.ip().is_loopback()) {
            Ok(addresses)
        } else {
            Err(format!(
                "`{address}` can be reached from other computers; write tcp:127.0.0.1:PORT"
            ))
        }
    }
}

impl fmt::Display for ControlAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::Tcp(address) => write!(f, "tcp:{address}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ControlAddress;

    #[test]
    fn a_place_is_a_path_or_a_port_of_this_computer() {
        for (text, shown) in [
            ("unix:a.sock", Some("unix:a.sock")),
            ("unix:/tmp/a:b", Some("unix:/tmp/a:b")),
            ("./a", Some("unix:./a")),
            ("tcp:127.0.0.1:5", Some("tcp:127.0.0.1:5")),
            ("tcp:5", Some("tcp:127.0.0.1:5")),
            ("tcp:[::1]:0", Some("tcp:[::1]:0")),
            ("unix:", None),
            ("tcp:", None),
            ("tcp::5", None),
            ("tcp:127.0.0.1:99999", None),
            ("127.0.0.1:5", None),
            ("a.sock", Some("unix:a.sock")),
            ("", None),
        ] {
            let place = ControlAddress::parse(text)
                .ok()
                .map(|place| place.to_string());
            assert_eq!(place.as_deref(), shown, "{text}");
        }
        assert!(ControlAddress::own_addresses("127.0.0.1:5").is_ok());
        assert!(ControlAddress::own_addresses("0.0.0.0:5").is_err());
    }
}
