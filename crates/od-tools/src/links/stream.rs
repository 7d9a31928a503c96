//! A link over bytes: a port that transfers them, and a protocol that interprets them.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::time;

use od_wire::{Duration, Frame, Instant};

use super::stamps::{Stamp, Stamps};
use crate::error::Error;
use crate::link::{Heard, Link};

/// Maximum time to wait for the first responses of the server.
const OPENING: Duration = Duration::from_secs(2);
/// Time after which a link whose other side accepts no byte is lost.
const WRITE: Duration = Duration::from_secs(2);
/// Time that a link that is closed waits for its last bytes to be accepted, and then for the other side to close it.
const LAST: Duration = Duration::from_millis(50);
/// Limit of bytes without the end of a line or command.
const LONGEST: usize = 256;

/// Transfers bytes in both directions.
pub(super) trait Port {
    /// Reads available bytes, or waits for some; 0: the connection is closed.
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// Writes some of it, or waits until the other side accepts some.
    fn write(&mut self, bytes: &[u8], wait: Duration) -> io::Result<usize>;

    /// Says that nothing more is written. Returns whether the other side then closes the connection.
    fn finish(&mut self) -> io::Result<bool> {
        Ok(false)
    }
}

/// A message of the server.
pub(super) enum Message {
    /// A frame of the bus, and when the server received it if it says so.
    Frame(Frame, Option<Stamp>),
    /// The server expects these bytes.
    Reply(Vec<u8>),
    /// The bus is open.
    Open,
    /// A message without meaning for the link.
    Nothing,
}

/// The client's side of a protocol.
pub(super) trait Protocol {
    /// The first bytes to send, and those that continue at another bit rate in kbit/s in listen-only mode.
    fn begin(&mut self, listen_at: Option<u16>) -> Result<Vec<u8>, String>;

    /// Removes a complete message from the front of `bytes`; `None` if it is incomplete.
    ///
    /// # Errors
    /// Reason why the message cannot be read.
    fn take(&mut self, bytes: &mut Vec<u8>) -> Result<Option<Message>, String>;

    /// Adds the bytes that send a frame.
    fn write(&self, frame: &Frame, out: &mut Vec<u8>);

    /// Maximum time to wait until the bus is open, and whether it counts as open after that time.
    fn patience(&self) -> (Duration, bool) {
        (OPENING, false)
    }

    /// The bytes that restore the state of the server.
    fn end(&self) -> &'static [u8] {
        b""
    }
}

/// A connection with its protocol.
pub(super) struct Stream<P: Port, S: Protocol> {
    port: P,
    protocol: S,
    /// The name in `--link`, for messages.
    name: String,
    /// Bytes of an incomplete message.
    rest: Vec<u8>,
    /// Bytes that the other side has not accepted yet.
    unsent: Vec<u8>,
    /// Time when the link is lost if it still accepts none.
    patience: Instant,
    /// Frames that arrived while the bus was being opened.
    early: VecDeque<Heard>,
    stamps: Stamps,
    /// Origin of the link's time.
    start: time::Instant,
}

impl<P: Port, S: Protocol> Stream<P, S> {
    pub(super) fn open(port: P, protocol: S, name: String) -> Result<Self, Error> {
        let mut stream = Self {
            port,
            protocol,
            name,
            rest: Vec::new(),
            unsent: Vec::new(),
            patience: Instant::ZERO,
            early: VecDeque::new(),
            stamps: Stamps::default(),
            start: time::Instant::now(),
        };
        stream.begin(None)?;
        Ok(stream)
    }

    /// Opens the bus, and waits until it is open.
    fn begin(&mut self, listen_at: Option<u16>) -> Result<(), Error> {
        let first = self.protocol.begin(listen_at).map_err(Error::Usage)?;
        self.write(&first)?;
        let (patience, is_open_after) = self.protocol.patience();
        let until = self.now() + patience;
        loop {
            match self.hear(until)? {
                Some(Message::Open) => return Ok(()),
                Some(Message::Frame(frame, stamp)) => {
                    let heard = self.heard(frame, stamp);
                    self.early.push_back(heard);
                }
                Some(_) => {}
                None if is_open_after => return Ok(()),
                None => {
                    return Err(
                        self.lost("the server does not answer; does it speak this protocol?")
                    );
                }
            }
        }
    }

    /// The next message; `None` if none arrives in time.
    fn hear(&mut self, until: Instant) -> Result<Option<Message>, Error> {
        loop {
            match self.protocol.take(&mut self.rest) {
                Ok(Some(Message::Reply(bytes))) => self.write(&bytes)?,
                Ok(Some(message)) => return Ok(Some(message)),
                Ok(None) if self.rest.len() > LONGEST => {
                    let shown = shown(&self.rest[..40]);
                    return Err(self.lost(&format!("unexpected bytes `{shown}` …")));
                }
                Ok(None) => {
                    let left = Duration::from_micros(until.micros_since(self.now()));
                    let mut bytes = [0; 4096];
                    match self.port.read(&mut bytes, left) {
                        Ok(0) => return Err(self.lost("the other side closed the connection")),
                        Ok(count) => self.rest.extend_from_slice(&bytes[..count]),
                        Err(error) if error.kind() == ErrorKind::Interrupted => {}
                        Err(error) if is_time_out(&error) => {
                            if self.now() >= until {
                                return Ok(None);
                            }
                        }
                        Err(error) => return Err(self.lost(&error.to_string())),
                    }
                }
                Err(why) => return Err(self.lost(&why)),
            }
        }
    }

    /// A frame that has just arrived.
    fn heard(&mut self, frame: Frame, stamp: Option<Stamp>) -> Heard {
        let now = self.now();
        let at = stamp.map_or(now, |stamp| self.stamps.place(now, stamp));
        Heard { at, frame }
    }

    /// Writes all of it.
    fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.queue(bytes);
        while !self.flush(self.patience)? {}
        Ok(())
    }

    /// Adds bytes to those that have to be written.
    fn queue(&mut self, bytes: &[u8]) {
        self.unsent.extend_from_slice(bytes);
        self.patience = self.now() + WRITE;
    }

    /// Writes what is left, until a moment; returns whether nothing is left.
    fn flush(&mut self, until: Instant) -> Result<bool, Error> {
        while !self.unsent.is_empty() {
            let wait = Duration::from_micros(until.micros_since(self.now()));
            match self.port.write(&self.unsent, wait) {
                Ok(0) => return Err(self.lost("the other side closed the connection")),
                Ok(count) => {
                    self.unsent.drain(..count);
                    self.patience = self.now() + WRITE;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if is_time_out(&error) => {
                    let now = self.now();
                    if now >= self.patience {
                        return Err(self.lost("the other side no longer accepts bytes"));
                    }
                    if now >= until {
                        return Ok(false);
                    }
                }
                Err(error) => return Err(self.lost(&error.to_string())),
            }
        }
        Ok(true)
    }

    /// Reads until the other side closes the connection. A connection that is closed with bytes unread is reset, and the
    /// other side may then lose the last frames.
    fn drain(&mut self) {
        let mut bytes = [0; 4096];
        let until = self.now() + LAST;
        while self.now() < until {
            let wait = Duration::from_micros(until.micros_since(self.now()));
            match self.port.read(&mut bytes, wait) {
                Ok(count) if count > 0 => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => break,
            }
        }
    }

    fn lost(&self, why: &str) -> Error {
        Error::Link(format!("{}: {why}", self.name))
    }
}

impl<P: Port, S: Protocol> Link for Stream<P, S> {
    fn now(&self) -> Instant {
        Instant::ZERO + self.start.elapsed()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.begin_send(frame)?;
        while !self.flush(self.patience)? {}
        Ok(())
    }

    fn begin_send(&mut self, frame: &Frame) -> Result<(), Error> {
        let mut bytes = Vec::new();
        self.protocol.write(frame, &mut bytes);
        self.queue(&bytes);
        Ok(())
    }

    fn finish_send(&mut self, until: Instant) -> Result<bool, Error> {
        self.flush(until)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        if let Some(heard) = self.early.pop_front() {
            return Ok(Some(heard));
        }
        loop {
            match self.hear(until)? {
                Some(Message::Frame(frame, stamp)) => return Ok(Some(self.heard(frame, stamp))),
                Some(_) => {}
                None => return Ok(None),
            }
        }
    }

    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        self.early.clear();
        self.begin(Some(kbit))
    }
}

impl<P: Port, S: Protocol> Drop for Stream<P, S> {
    fn drop(&mut self) {
        self.queue(self.protocol.end());
        // Without a connection there is nothing to restore, and without a reader no thread to restore it.
        let until = self.now() + LAST;
        if self.flush(until).is_ok() && self.port.finish().is_ok_and(|closes| closes) {
            self.drain();
        }
    }
}

/// Bytes in a message.
pub(super) fn shown(bytes: &[u8]) -> String {
    bytes.escape_ascii().to_string()
}

fn is_time_out(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut)
}
