//! The client's side of slcan over TCP: an adapter's server, or `odkit sim`.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time;

use od_bench::links::slcan;
use od_wire::{Duration, Frame, Instant};

use crate::fault::Fault;
use crate::link::{Heard, Link};

/// A connection to an adapter's server.
pub(super) struct Tcp {
    stream: TcpStream,
    address: String,
    /// Bytes of an incomplete line.
    rest: Vec<u8>,
    /// Origin of the link's time.
    start: time::Instant,
}

impl Tcp {
    pub(super) fn open(address: &str) -> Result<Self, Fault> {
        // A port without a host is a port of this computer.
        let address = match address.parse::<u16>() {
            Ok(port) => format!("127.0.0.1:{port}"),
            Err(_) => address.to_owned(),
        };
        let fail = |error: std::io::Error| {
            Fault::Link(format!(
                "slcan:{address}: {error}; start a CAN adapter server or `odkit sim` at this address"
            ))
        };
        let stream = TcpStream::connect(&address).map_err(fail)?;
        stream.set_nodelay(true).map_err(fail)?;
        let mut client = Self {
            stream,
            address,
            rest: Vec::new(),
            start: time::Instant::now(),
        };
        client.write(b"C\rO\r")?;
        Ok(client)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        let blocking = self.stream.set_nonblocking(false);
        let written = blocking.and_then(|()| self.stream.write_all(bytes));
        written.map_err(|error| self.lost(&error.to_string()))
    }

    fn lost(&self, why: &str) -> Fault {
        Fault::Link(format!("slcan:{}: {why}", self.address))
    }

    /// The next frame among the whole lines that are here.
    fn take(&mut self) -> Option<Frame> {
        while let Some(end) = self.rest.iter().position(|b| matches!(b, b'\r' | 0x07)) {
            let line: Vec<u8> = self.rest.drain(..=end).collect();
            if let Some(frame) = slcan::frame_of(&line[..end]) {
                return Some(frame);
            }
        }
        None
    }
}

impl Link for Tcp {
    fn now(&self) -> Instant {
        Instant::ZERO + self.start.elapsed()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Fault> {
        let mut line = Vec::new();
        slcan::write_frame(frame, &mut line);
        line.push(b'\r');
        self.write(&line)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Fault> {
        loop {
            if let Some(frame) = self.take() {
                let at = self.now();
                return Ok(Some(Heard { at, frame }));
            }
            let left = Duration::from_micros(until.micros_since(self.now()));
            // A time-out of zero would mean none at all.
            let set = self.stream.set_nonblocking(left.is_zero()).and_then(|()| {
                let wait = Some(left).filter(|left| !left.is_zero());
                self.stream.set_read_timeout(wait)
            });
            set.map_err(|error| self.lost(&error.to_string()))?;
            let mut bytes = [0; 4096];
            match self.stream.read(&mut bytes) {
                Ok(0) => return Err(self.lost("the peer closed the connection")),
                Ok(count) => self.rest.extend_from_slice(&bytes[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
                {
                    return Ok(None);
                }
                Err(error) => return Err(self.lost(&error.to_string())),
            }
        }
    }
}
