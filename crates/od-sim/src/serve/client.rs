//! A client of the bus: its port, its codec, and its waiting bytes.

use std::io::{self, ErrorKind};
use std::time::{Duration, Instant as Clock};

use od_runtime::{Frame, Instant};

use super::http::Opening;
use super::links::opened::Protocol;
use super::links::port::Port;
use super::outbox::Outbox;
use super::terminal::note;
use crate::links::Codec;
use crate::words::plural;

/// Limit of bytes that wait for one client. At the limit the newest lines are dropped, so that no other
/// client has to wait and memory stays bounded.
const WAITING: usize = 1024 * 1024;
/// Lower limit of the waiting bytes of a client, however many clients there are.
const FEWEST: usize = 16 * 1024;
/// Bytes that may wait for all clients together.
const TOTAL: usize = 8 * 1024 * 1024;
/// Shortest time between two messages about a client that does not read.
const AGAIN: Duration = Duration::from_secs(10);

/// Limit of waiting bytes for each of `count` clients.
pub(super) fn room(count: usize) -> usize {
    (TOTAL / count.max(1)).clamp(FEWEST, WAITING)
}

/// A client of the bus.
pub(super) struct Client {
    pub(super) number: usize,
    /// Name in messages.
    pub(super) name: String,
    pub(super) protocol: Protocol,
    pub(super) codec: Box<dyn Codec>,
    pub(super) port: Box<dyn Port>,
    /// First bytes of a client of unknown kind.
    opening: Option<Opening>,
    outbox: Outbox,
    /// The port may have more to read.
    pub(super) readable: bool,
    /// The port may have room to write.
    writable: bool,
    /// The time of its last byte; bytes that wait are still sent.
    pub(super) ended: Option<Clock>,
    /// It does not read; `true` after this was reported.
    deaf: Option<bool>,
    /// Dropped messages that the client was not told about yet.
    dropped: usize,
    /// All dropped messages.
    pub(super) lost: u64,
    /// Time of the last report that it does not read.
    told: Option<Clock>,
}

/// Encoded frames that several clients receive in the same form.
pub(super) type Encoded = Vec<(&'static str, Vec<u8>)>;

impl Client {
    /// A client of `protocol`. `is_guest`: it came over a network, and its kind is unknown.
    pub(super) fn new(
        number: usize,
        name: String,
        protocol: Protocol,
        port: Box<dyn Port>,
        is_guest: bool,
    ) -> Self {
        Self {
            number,
            name,
            protocol,
            codec: protocol.codec(),
            port,
            opening: match protocol {
                // The codec of a WebSocket checks the origin of a page itself.
                Protocol::WebSocket(_) => None,
                Protocol::Control => is_guest.then(Opening::of_lines),
                _ => is_guest.then(Opening::default),
            },
            outbox: Outbox::default(),
            readable: true,
            writable: true,
            ended: None,
            deaf: None,
            dropped: 0,
            lost: 0,
            told: None,
        }
    }

    /// Notes the events of its port.
    pub(super) fn wake(&mut self, readable: bool, writable: bool) {
        self.readable |= readable && self.ended.is_none();
        self.writable |= writable;
    }

    /// Reads into `buffer`. `None`: no bytes are waiting. 0 bytes: the client has ended.
    pub(super) fn read(&mut self, buffer: &mut [u8]) -> io::Result<Option<usize>> {
        match self.port.read(buffer) {
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                self.readable = false;
                Ok(None)
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(None),
            read => read.map(Some),
        }
    }

    /// Starts again for the next host, without the state of the previous one.
    pub(super) fn restart(&mut self) {
        self.codec = self.protocol.codec();
        self.outbox = Outbox::default();
        self.deaf = None;
    }

    /// Takes the next bytes, and returns whether a browser sent them.
    pub(super) fn is_http(&mut self, bytes: &[u8]) -> bool {
        let opening = self.opening.as_mut();
        opening.is_some_and(|opening| opening.is_http(bytes))
    }

    /// Sends a frame of the bus with the time of day `stamp` in microseconds. `own`: no other client
    /// caused it. `encoded` keeps the bytes for further clients.
    pub(super) fn hear(
        &mut self,
        frame: &Frame,
        now: Instant,
        stamp: u64,
        encoded: &mut Encoded,
        (own, room): (bool, usize),
    ) {
        let hears = match self.protocol {
            Protocol::Lines => true,
            Protocol::Control => false,
            _ => self.ended.is_none(),
        };
        if !hears {
            return;
        }
        let Some(form) = self.codec.form() else {
            let mut bytes = Vec::new();
            self.codec.encode(frame, now, stamp, &mut bytes);
            return self.push(&bytes, own, room);
        };
        // Keep the cost of hundreds of clients that do not read near zero.
        if !own && self.deaf.is_some() && self.outbox.len() > room / 4 {
            self.dropped += 1;
            return;
        }
        let place = match encoded.iter().position(|(known, _)| *known == form) {
            Some(place) => place,
            None => {
                let mut bytes = Vec::new();
                self.codec.encode(frame, now, stamp, &mut bytes);
                encoded.push((form, bytes));
                encoded.len() - 1
            }
        };
        self.push(&encoded[place].1, own, room);
    }

    /// Queues complete lines. [`flush`](Self::flush) sends them; if too many bytes wait, they are
    /// dropped. Half of the `room` is reserved for lines that the client caused itself (`own`), so
    /// that a flood from other clients does not displace its answers.
    pub(super) fn push(&mut self, lines: &[u8], own: bool, room: usize) {
        if lines.is_empty() {
            return;
        }
        let waiting = self.outbox.len();
        // A client counts as reading again when half of that is free.
        let reads = waiting <= room / 4;
        let most = if own {
            room
        } else if reads || self.deaf.is_none() {
            room / 2
        } else {
            room / 4
        };
        if waiting + lines.len() > most {
            return self.drop_lines(lines);
        }
        if reads
            && let Some(was_told) = self.deaf.take()
            && was_told
        {
            let (name, dropped) = (&self.name, plural(self.dropped, "message"));
            note(&format!("{name} reads again; odkit dropped {dropped}"));
            self.dropped = 0;
        }
        self.outbox.push(lines);
    }

    /// Adds a short pause after the queued bytes.
    pub(super) fn pause(&mut self) {
        self.outbox.pause();
    }

    /// Returns whether everything is written.
    pub(super) fn is_flushed(&self) -> bool {
        self.outbox.is_empty()
    }

    /// Writes as much as its port takes.
    pub(super) fn flush(&mut self) -> io::Result<()> {
        if !self.writable || self.outbox.is_empty() {
            return Ok(());
        }
        let now = Clock::now();
        loop {
            let bytes = self.outbox.next(now);
            if bytes.is_empty() {
                return Ok(());
            }
            match self.port.write(bytes) {
                Ok(count) => self.outbox.wrote(count, now),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    self.writable = false;
                    return Ok(());
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// The next time when [`check`](Self::check) has something to do; no event reports it.
    pub(super) fn deadline(&self) -> Option<Clock> {
        let pause = self.outbox.deadline().into_iter();
        pause.chain(self.port.next_check()).min()
    }

    /// Does the work that is due at `now`.
    pub(super) fn check(&mut self, now: Clock) {
        if self.port.next_check().is_some_and(|at| at <= now) {
            self.port.check(now);
            self.writable = true;
        }
    }

    fn drop_lines(&mut self, lines: &[u8]) {
        if self.deaf.is_none() {
            let is_told = self.told.is_none_or(|told| told.elapsed() > AGAIN);
            self.deaf = Some(is_told);
            if is_told {
                let name = &self.name;
                note(&format!("{name} does not read; odkit drops frames for it"));
                self.told = Some(Clock::now());
            }
        }
        let ends = lines
            .iter()
            .filter(|byte| matches!(byte, b'\r' | b'\n' | b'>' | 7));
        let count = ends.count().max(1);
        self.dropped += count;
        self.lost += count as u64;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use mio::{Registry, Token, Waker};

    use super::*;

    /// A port that accepts this number of bytes.
    struct Narrow(usize);

    impl Port for Narrow {
        fn register(&mut self, _: &Registry, _: Token, _: &Arc<Waker>) -> io::Result<()> {
            Ok(())
        }

        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(ErrorKind::WouldBlock.into())
        }

        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let len = bytes.len().min(self.0);
            self.0 -= len;
            match len {
                0 => Err(ErrorKind::WouldBlock.into()),
                _ => Ok(len),
            }
        }
    }

    #[test]
    fn a_flood_from_others_does_not_displace_an_answer() {
        let port = Box::new(Narrow(0));
        let mut client = Client::new(0, "somebody".into(), Protocol::Slcan, port, false);
        let line = [&[b'0'; 1023][..], b"\r"].concat();
        let room = 64 * 1024;
        for _ in 0..100 {
            client.push(&line, false, room);
        }
        assert_eq!((client.outbox.len(), client.dropped), (room / 2, 100 - 32));
        for _ in 0..100 {
            client.push(&line, true, room);
        }
        assert_eq!((client.outbox.len(), client.dropped), (room, 200 - 64));
        // It reads a little, then more.
        for (bytes, left) in [(room / 2, room / 2), (room / 4, room / 4 + 1024)] {
            client.port = Box::new(Narrow(bytes));
            client.wake(false, true);
            client.flush().expect("it writes");
            client.push(&line, false, room);
            assert_eq!(client.outbox.len(), left);
        }
        assert_eq!(client.deaf, None);
    }

    #[test]
    fn many_clients_have_less_room_each() {
        assert_eq!(room(0), WAITING);
        assert_eq!(room(8), WAITING);
        assert_eq!(room(500), TOTAL / 500);
        assert_eq!(room(100_000), FEWEST);
    }
}
