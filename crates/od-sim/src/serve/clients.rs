//! All clients: it accepts them, gives them turns, and sends frames to them.

use std::io;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant as Clock};

use mio::Token;
use od_runtime::{Frame, Instant};

use super::client::{Client, Encoded, room};
use super::door::Door;
use super::events::Events;
use super::links::LINKS;
use super::links::listener::{Listener, Stream};
use super::links::opened::{Ends, Protocol};
use crate::words::plural;

/// A client that has ended has this long to read its waiting bytes.
const FAREWELL: Duration = Duration::from_secs(10);

/// Limit of clients of the control socket.
const CONTROLS: usize = 16;
/// Bytes that one client may cause to be sent to all others in a turn.
const WORK: usize = 256 * 1024;
/// A turn is a multiple of this number of bytes, which fits the message size of every port.
const WHOLE: usize = 64;
/// Smallest turn, in bytes.
const LEAST: usize = 512;

/// The clients, and the servers that accept further ones.
pub(super) struct Clients {
    events: Events,
    /// By number, the oldest first.
    list: Vec<Client>,
    doors: Vec<Door>,
    /// Number of the next link or client.
    next: (usize, usize),
    /// Number of the client with the last turn.
    last: usize,
    /// Limit of clients at all servers together.
    max: usize,
}

impl Clients {
    pub(super) fn new(events: Events, max: usize) -> Self {
        Self {
            events,
            list: Vec::new(),
            doors: Vec::new(),
            next: (0, LINKS),
            last: 0,
            max,
        }
    }

    /// A link, or the control socket, with clients that come and go.
    pub(super) fn open(&mut self, protocol: Protocol, listener: Listener) -> io::Result<()> {
        let number = self.next.0;
        self.next.0 += 1;
        let door = Door::new(number, protocol, listener, self.events.registry())?;
        self.doors.push(door);
        Ok(())
    }

    /// A link that is a client itself.
    pub(super) fn join(&mut self, ends: Ends) -> io::Result<()> {
        let number = self.next.0;
        self.next.0 += 1;
        let client = Client::new(number, ends.name, ends.protocol, ends.port, false);
        self.add(client)
    }

    /// Returns whether further clients can come.
    pub(super) fn has_doors(&self) -> bool {
        let mut doors = self.doors.iter();
        doors.any(|door| door.protocol != Protocol::Control)
    }

    fn add(&mut self, mut client: Client) -> io::Result<()> {
        let (events, token) = (&self.events, Token(client.number));
        client
            .port
            .register(events.registry(), token, events.waker())?;
        let place = self.place(client.number).unwrap_or_else(|place| place);
        self.list.insert(place, client);
        Ok(())
    }

    fn place(&self, number: usize) -> Result<usize, usize> {
        self.list
            .binary_search_by_key(&number, |client| client.number)
    }

    pub(super) fn get(&mut self, number: usize) -> Option<&mut Client> {
        let place = self.place(number).ok()?;
        Some(&mut self.list[place])
    }

    pub(super) fn remove(&mut self, number: usize) {
        if let Ok(place) = self.place(number) {
            self.list.remove(place);
        }
    }

    /// Ends a client. Last bytes that its port does not take at once are lost.
    pub(super) fn dismiss(&mut self, number: usize) {
        if let Some(client) = self.get(number) {
            let _ = client.flush();
        }
        self.remove(number);
    }

    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Client> {
        self.list.iter_mut()
    }

    /// Returns whether bytes wait for standard output.
    pub(super) fn console_waits(&self) -> bool {
        let mut consoles = self.list.iter();
        consoles.any(|one| one.protocol == Protocol::Lines && !one.is_flushed())
    }

    /// Waits until all ports have written everything. Returns those that have not, with the reason.
    pub(super) fn finish(&mut self, stopped: &AtomicBool) -> Vec<(usize, io::Error)> {
        let ports = self.list.iter_mut();
        let lost = ports.filter_map(|one| Some((one.number, one.port.finish(stopped).err()?)));
        lost.collect()
    }

    /// The next time when a codec has something to do.
    pub(super) fn codecs_due(&self) -> Option<Instant> {
        let codecs = self.list.iter().map(|client| client.codec.deadline());
        codecs.flatten().min()
    }

    /// Waits for bytes, at most for `patience`.
    pub(super) fn wait(&mut self, patience: Duration) -> io::Result<()> {
        let busy = self.list.iter().any(|client| client.readable)
            || self
                .doors
                .iter()
                .any(|door| door.ready && door.deadline().is_none());
        let now = Clock::now();
        let clients = self.list.iter().filter_map(Client::deadline);
        let due = clients.chain(self.doors.iter().filter_map(Door::deadline));
        let due = due.min().map(|at| at.saturating_duration_since(now));
        let patience = if busy {
            Duration::ZERO
        } else {
            patience.min(due.unwrap_or(patience))
        };
        for ready in self.events.wait(patience)? {
            let Some(number) = ready.number else {
                // A thread woke the loop without naming its port.
                for client in self.list.iter_mut().filter(|client| client.number < LINKS) {
                    client.wake(true, true);
                }
                continue;
            };
            if let Some(door) = self.doors.iter_mut().find(|door| door.number == number) {
                door.ready = true;
            } else if let Ok(place) = self
                .list
                .binary_search_by_key(&number, |client| client.number)
            {
                self.list[place].wake(ready.readable, ready.writable);
            }
        }
        let now = Clock::now();
        for client in &mut self.list {
            client.check(now);
        }
        Ok(())
    }

    /// Accepts clients, and returns the names and numbers of the new ones.
    pub(super) fn accept(&mut self) -> Vec<(usize, String)> {
        let mut came = Vec::new();
        for at in 0..self.doors.len() {
            while self.doors[at].is_wanted() {
                let protocol = self.doors[at].protocol;
                let full = self.full(protocol == Protocol::Control);
                let Some((stream, name)) = self.doors[at].accept(full.as_deref()) else {
                    break;
                };
                came.extend(self.welcome(protocol, stream, name));
            }
        }
        came
    }

    /// Reason why no further client is accepted at the control socket or at a link.
    fn full(&self, control: bool) -> Option<String> {
        let guests = self.list.iter().filter(|client| client.number >= LINKS);
        let guests = guests.filter(|client| (client.protocol == Protocol::Control) == control);
        let (max, help) = if control {
            (CONTROLS, "try again when one has left")
        } else {
            (self.max, "raise it with `--max-clients`")
        };
        let full = guests.count() >= max;
        full.then(|| format!("the limit is {}; {help}", plural(max, "client")))
    }

    fn welcome(
        &mut self,
        protocol: Protocol,
        stream: Stream,
        name: String,
    ) -> Option<(usize, String)> {
        let number = self.next.1;
        self.next.1 += 1;
        let client = Client::new(number, name.clone(), protocol, stream.into_port(), true);
        // A connection that is already broken is not a client.
        self.add(client).ok()?;
        Some((number, name))
    }

    /// Numbers of the clients that may have sent something, the one with the longest wait first.
    pub(super) fn ready(&self) -> Vec<usize> {
        let ready = self.list.iter().filter(|client| client.readable);
        let mut ready: Vec<usize> = ready.map(|client| client.number).collect();
        let had_turn = ready.partition_point(|number| *number <= self.last);
        ready.rotate_left(had_turn);
        ready
    }

    /// Bytes of a turn. More clients that receive each frame make it smaller, so that a turn takes the same time.
    pub(super) fn turn(&self) -> usize {
        (WORK / self.list.len().max(1)).max(LEAST) / WHOLE * WHOLE
    }

    /// Reads the bytes of a client, at most one turn. `Ok(None)`: there are none.
    pub(super) fn read(&mut self, number: usize, buffer: &mut [u8]) -> io::Result<Option<usize>> {
        self.last = number;
        self.get(number)
            .map_or(Ok(None), |client| client.read(buffer))
    }

    /// Sends a frame of the bus to every client except `from`. `cause`: the client that
    /// caused it.
    pub(super) fn hear(
        &mut self,
        frame: &Frame,
        (at, stamp): (Instant, u64),
        from: Option<usize>,
        cause: Option<usize>,
    ) {
        let room = room(self.list.len());
        let mut encoded = Encoded::new();
        for client in &mut self.list {
            if Some(client.number) != from {
                let own = cause.is_none_or(|cause| cause == client.number);
                client.hear(frame, at, stamp, &mut encoded, (own, room));
            }
        }
    }

    /// Queues lines for one client, as an answer to its own.
    pub(super) fn answer(&mut self, number: usize, lines: &[u8]) {
        let room = room(self.list.len());
        if let Some(client) = self.get(number) {
            client.push(lines, true, room);
        }
    }

    /// Writes as much as the ports take. Returns the clients with a failed port, with the reason.
    pub(super) fn flush(&mut self) -> Vec<(usize, io::Error)> {
        let mut lost = Vec::new();
        for client in &mut self.list {
            if let Err(error) = client.flush() {
                lost.push((client.number, error));
            }
        }
        self.list.retain(|client| match client.ended {
            Some(at) if client.number >= LINKS => !client.is_flushed() && at.elapsed() < FAREWELL,
            _ => true,
        });
        lost
    }
}
