//! A server, on a port or a path, and its clients.

use std::io;

use mio::net::{TcpListener, TcpStream};
#[cfg(unix)]
use mio::net::{UnixListener, UnixStream};
use mio::{Interest, Registry, Token};

use super::opened::Protocol;
use super::port::Port;
use super::tcp;

/// A server.
pub(in crate::serve) enum Listener {
    Tcp(TcpListener),
    #[cfg(unix)]
    Unix(UnixListener),
}

/// A client of a server.
pub(in crate::serve) enum Stream {
    Tcp(TcpStream),
    #[cfg(unix)]
    Unix(UnixStream),
}

impl Listener {
    /// Registers the server: its events have this `token`.
    pub(in crate::serve) fn register(&mut self, events: &Registry, token: Token) -> io::Result<()> {
        match self {
            Self::Tcp(listener) => events.register(listener, token, Interest::READABLE),
            #[cfg(unix)]
            Self::Unix(listener) => events.register(listener, token, Interest::READABLE),
        }
    }

    /// The next client, and its name in messages.
    pub(in crate::serve) fn accept(&self) -> io::Result<(Stream, String)> {
        match self {
            Self::Tcp(listener) => {
                let (stream, address) = listener.accept()?;
                Ok((Stream::Tcp(stream), address.to_string()))
            }
            #[cfg(unix)]
            Self::Unix(listener) => {
                let (stream, _) = listener.accept()?;
                Ok((Stream::Unix(stream), "a control client".into()))
            }
        }
    }
}

impl Stream {
    /// Prepares an accepted client.
    pub(in crate::serve) fn prepare(&self) -> io::Result<()> {
        match self {
            Self::Tcp(stream) => tcp::prepare(stream),
            #[cfg(unix)]
            Self::Unix(_) => Ok(()),
        }
    }

    /// Tells a client why it is refused, if its protocol has a way to do so.
    pub(in crate::serve) fn refuse(self, protocol: Protocol, why: &str) {
        match self {
            Self::Tcp(stream) => tcp::refuse(stream, protocol, why),
            #[cfg(unix)]
            Self::Unix(mut stream) => {
                let _ = io::Write::write_all(&mut stream, protocol.refusal(why).as_bytes());
            }
        }
    }

    pub(in crate::serve) fn into_port(self) -> Box<dyn Port> {
        match self {
            Self::Tcp(stream) => Box::new(stream),
            #[cfg(unix)]
            Self::Unix(stream) => Box::new(stream),
        }
    }
}
