//! Bytes to and from a client, without waiting.

use std::io::{self, Read, Write};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant as Clock;

use mio::net::TcpStream;
use mio::{Interest, Registry, Token, Waker};

/// Both directions.
pub(super) const BOTH: Interest = Interest::READABLE.add(Interest::WRITABLE);

/// Both directions of a client. Neither waits: it returns [`WouldBlock`](io::ErrorKind::WouldBlock)
/// for what is impossible now, and an event reports when to try again.
pub(in crate::serve) trait Port {
    /// Registers the port: its events have this `token`; a port with threads of its own calls `waker`.
    fn register(&mut self, events: &Registry, token: Token, waker: &Arc<Waker>) -> io::Result<()>;

    /// Reads into `buffer`, whole messages if the port has some. 0: the other end has left.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize>;

    /// Writes as many of `bytes` as possible.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;

    /// Returns how many frames the system dropped because odkit did not read them in time.
    fn missed(&self) -> u64 {
        0
    }

    /// Returns whether another host can come after the other end has left.
    fn outlives_hosts(&self) -> bool {
        false
    }

    /// Returns when [`check`](Self::check) is due; `None` if events report everything.
    fn next_check(&self) -> Option<Clock> {
        None
    }

    /// Checks at `now` what no event reports.
    fn check(&mut self, now: Clock) {
        let _ = now;
    }

    /// Waits until all written bytes have arrived, or `stopped` is set.
    fn finish(&mut self, stopped: &AtomicBool) -> io::Result<()> {
        let _ = stopped;
        Ok(())
    }
}

impl Port for TcpStream {
    fn register(&mut self, events: &Registry, token: Token, _: &Arc<Waker>) -> io::Result<()> {
        events.register(self, token, BOTH)
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        Read::read(self, buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Write::write(self, bytes)
    }
}

#[cfg(unix)]
impl Port for mio::net::UnixStream {
    fn register(&mut self, events: &Registry, token: Token, _: &Arc<Waker>) -> io::Result<()> {
        events.register(self, token, BOTH)
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        Read::read(self, buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Write::write(self, bytes)
    }
}
