//! A TCP server whose clients come and go.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, ToSocketAddrs};

use super::opened::{Opened, Protocol};
use crate::serve::failure::Failure;

/// Listens at `HOST:PORT`, or at a port of this machine.
pub(super) fn listen(protocol: Protocol, wanted: &str) -> Result<Opened, Failure> {
    let option = match protocol {
        Protocol::Socketcand => "--link socketcand:",
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
                "`{wanted}` is not a valid address; write `{option}127.0.0.1:29536`"
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
    Ok(Opened::Listener(protocol, listener, address))
}
