//! A TCP server whose clients come and go.

use std::io::{self, ErrorKind, Write};
use std::net::{SocketAddr, ToSocketAddrs};

use mio::net::{TcpListener, TcpStream};

use super::opened::{Opened, Protocol};
use crate::serve::error::Error;

/// Size of the system's queue to a client: bytes in it can no longer be dropped.
#[cfg(unix)]
const QUEUE: usize = 64 * 1024;

/// Listens at `HOST:PORT`.
pub(super) fn listen(protocol: Protocol, full: &str) -> Result<Opened, Error> {
    let option = match protocol {
        Protocol::Socketcand => "--link socketcand:",
        Protocol::WebSocket(_) => "--link ws:",
        _ => "--slcan ",
    };
    let addresses: Vec<SocketAddr> = match full.to_socket_addrs() {
        Ok(addresses) => addresses.collect(),
        Err(error) => {
            return Err(Error::Usage(format!(
                "the host of `{full}` is unknown ({error}); write `{option}127.0.0.1:29536`"
            )));
        }
    };
    let bound = std::net::TcpListener::bind(addresses.as_slice());
    let listener = bound.map_err(|error| {
        Error::Failed(match error.kind() {
            ErrorKind::AddrInUse => format!(
                "{full} is in use, perhaps by another odkit; end that one, or take any free \
                 port with {option}127.0.0.1:0"
            ),
            _ => format!("{full}: {error}; choose another address with {option}HOST:PORT"),
        })
    })?;
    listener.set_nonblocking(true)?;
    let address = listener.local_addr()?;
    let listener = TcpListener::from_std(listener);
    Ok(Opened::Listener(protocol, listener, address))
}

/// Prepares an accepted client.
pub(super) fn prepare(stream: &TcpStream) -> io::Result<()> {
    #[cfg(unix)]
    nix::sys::socket::setsockopt(stream, nix::sys::socket::sockopt::SndBuf, &QUEUE)?;
    stream.set_nodelay(true)
}

/// Tells a client why it is refused, if its protocol has a way to do so.
pub(super) fn refuse(mut stream: TcpStream, protocol: Protocol, why: &str) {
    // If the message does not arrive, the client still sees the end of the connection.
    let _ = stream.write_all(protocol.refusal(why).as_bytes());
    let _ = stream.shutdown(std::net::Shutdown::Write);
}
