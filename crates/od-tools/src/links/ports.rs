//! Ports that carry bytes: TCP and serial lines.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream, ToSocketAddrs};

use od_wire::Duration;
use serial2::SerialPort;

use super::stream::Port;
use crate::error::Error;

/// Longest time until a server accepts a connection.
const CONNECT: Duration = Duration::from_secs(5);

/// Connects to `HOST:PORT`.
pub(super) fn connect(kind: &str, place: &str) -> Result<(TcpStream, String), Error> {
    let name = format!("{kind}:{place}");
    let addresses = place.to_socket_addrs().map_err(|error| {
        Error::Usage(format!(
            "{name}: {error}; write `{kind}:HOST:PORT`, such as `{kind}:127.0.0.1:29536`"
        ))
    })?;
    let mut last = io::Error::from(ErrorKind::NotFound);
    for address in addresses {
        match TcpStream::connect_timeout(&address, CONNECT) {
            Ok(stream) => match stream.set_nodelay(true) {
                Ok(()) => return Ok((stream, name)),
                Err(error) => last = error,
            },
            Err(error) => last = error,
        }
    }
    Err(Error::Link(format!(
        "{name}: {last}; start a CAN adapter server or `odkit sim` at this address"
    )))
}

impl Port for TcpStream {
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        // A time-out of zero would mean no time-out.
        self.set_nonblocking(wait.is_zero())?;
        self.set_read_timeout(Some(wait).filter(|wait| !wait.is_zero()))?;
        Read::read(self, buffer)
    }

    fn write(&mut self, bytes: &[u8], wait: Duration) -> io::Result<usize> {
        // A time-out of zero would mean no time-out.
        self.set_nonblocking(wait.is_zero())?;
        self.set_write_timeout(Some(wait).filter(|wait| !wait.is_zero()))?;
        Write::write(self, bytes)
    }

    fn finish(&mut self) -> io::Result<bool> {
        self.shutdown(Shutdown::Write)?;
        Ok(true)
    }
}

/// Opens a serial port at a baud rate.
pub(super) fn serial(path: &str, baud: u32) -> Result<SerialPort, Error> {
    let failed = |error: io::Error| {
        Error::Link(match error.kind() {
            ErrorKind::NotFound => {
                format!("serial port {path} does not exist; is the adapter plugged in?")
            }
            ErrorKind::PermissionDenied => format!(
                "{path} cannot be opened (permission denied); on Debian and Ubuntu join the group \
                 dialout with `sudo usermod -aG dialout $USER`, then log in again"
            ),
            _ => format!("{path} cannot be opened as a serial port with {baud} bit/s: {error}"),
        })
    };
    SerialPort::open(path, baud).map_err(failed)
}

/// The system counts the time-outs of a serial port in milliseconds.
fn whole_millis(wait: Duration) -> Duration {
    Duration::from_millis(u64::try_from(wait.as_micros().div_ceil(1000)).unwrap_or(u64::MAX))
}

impl Port for SerialPort {
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.set_read_timeout(whole_millis(wait))?;
        Self::read(self, buffer)
    }

    fn write(&mut self, bytes: &[u8], wait: Duration) -> io::Result<usize> {
        self.set_write_timeout(whole_millis(wait))?;
        Self::write(self, bytes)
    }
}
