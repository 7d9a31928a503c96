//! A client, as the bus sees it: its codec, and what waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

use od_runtime::{Frame, Instant};

use super::links::opened::Protocol;
use super::terminal::note;
use crate::links::Codec;

/// Messages and bytes that may wait for a slow client. Past that the newest lines are
/// dropped, so that nobody else has to wait and memory stays bounded.
const QUEUE: usize = 4096;
const WAITING: usize = 1024 * 1024;

/// Work for the thread that writes.
pub(super) enum Message {
    Bytes(Vec<u8>),
    Pause,
}

/// A client, as the bus sees it.
pub(super) struct Client {
    pub(super) number: u64,
    /// Name in messages.
    pub(super) name: String,
    pub(super) protocol: Protocol,
    pub(super) codec: Box<dyn Codec>,
    queue: SyncSender<Message>,
    /// Bytes in the queue.
    queued: Arc<AtomicUsize>,
    /// Bytes of this turn so far.
    gathered: Vec<u8>,
    dropped: usize,
}

/// The other ends of a client, for the thread that writes.
pub(super) struct Waiting {
    pub(super) messages: Receiver<Message>,
    /// Bytes in the queue.
    pub(super) queued: Arc<AtomicUsize>,
}

/// Frames in the forms that several clients get alike, each with its bytes.
pub(super) type Encoded = Vec<(&'static str, Vec<u8>)>;

impl Client {
    /// A client that speaks `protocol`, and the ends for the thread that writes to it.
    pub(super) fn new(number: u64, name: String, protocol: Protocol) -> (Self, Waiting) {
        Self::with_room(number, name, protocol, QUEUE)
    }

    fn with_room(number: u64, name: String, protocol: Protocol, room: usize) -> (Self, Waiting) {
        let (queue, messages) = sync_channel(room);
        let queued = Arc::new(AtomicUsize::new(0));
        let waiting = Waiting {
            messages,
            queued: Arc::clone(&queued),
        };
        let client = Self {
            number,
            name,
            protocol,
            codec: protocol.codec(),
            queue,
            queued,
            gathered: Vec::new(),
            dropped: 0,
        };
        (client, waiting)
    }

    /// A frame of the bus for the client, whose time of day is `stamp` in microseconds. `encoded`
    /// keeps the bytes for further clients.
    pub(super) fn hear(&mut self, frame: &Frame, now: Instant, stamp: u64, encoded: &mut Encoded) {
        let Some(form) = self.codec.form() else {
            let mut own = Vec::new();
            self.codec.encode(frame, now, stamp, &mut own);
            return self.push(&own);
        };
        let place = match encoded.iter().position(|(known, _)| *known == form) {
            Some(place) => place,
            None => {
                let mut bytes = Vec::new();
                self.codec.encode(frame, now, stamp, &mut bytes);
                encoded.push((form, bytes));
                encoded.len() - 1
            }
        };
        self.push(&encoded[place].1);
    }

    /// Whole lines for the client, behind those before them. They go out with
    /// [`flush`](Self::flush), or are dropped where too much waits.
    pub(super) fn push(&mut self, lines: &[u8]) {
        if lines.is_empty() {
            return;
        }
        let waiting = self.queued.load(Ordering::Relaxed) + self.gathered.len();
        // Half of the room is free again before a client counts as reading.
        let room = if self.dropped == 0 {
            WAITING
        } else {
            WAITING / 2
        };
        if waiting + lines.len() > room {
            self.drop_lines(lines);
            return;
        }
        if self.dropped > 0 {
            let (name, dropped) = (&self.name, self.dropped);
            note(&format!(
                "{name} reads again; {dropped} messages were dropped"
            ));
            self.dropped = 0;
        }
        self.gathered.extend_from_slice(lines);
    }

    /// All that was gathered goes out, as one message.
    pub(super) fn flush(&mut self) {
        if self.gathered.is_empty() {
            return;
        }
        let lines = std::mem::take(&mut self.gathered);
        let len = lines.len();
        // First counted, then sent: the writer takes off what it has seen.
        self.queued.fetch_add(len, Ordering::Relaxed);
        match self.queue.try_send(Message::Bytes(lines)) {
            // A client that is gone is reported by its reader.
            Ok(()) | Err(TrySendError::Disconnected(_)) => {}
            Err(TrySendError::Full(message)) => {
                self.queued.fetch_sub(len, Ordering::Relaxed);
                if let Message::Bytes(lines) = message {
                    self.drop_lines(&lines);
                }
            }
        }
    }

    /// Sends the pushed bytes as one message, with a short pause after it.
    pub(super) fn pause(&mut self) {
        self.flush();
        // A client for which so much waits does not read one by one anyway.
        let _ = self.queue.try_send(Message::Pause);
    }

    fn drop_lines(&mut self, lines: &[u8]) {
        if self.dropped == 0 {
            note(&format!(
                "{} does not read; frames for it are dropped",
                self.name
            ));
        }
        let ends = lines
            .iter()
            .filter(|byte| matches!(byte, b'\r' | b'\n' | b'>' | 7));
        self.dropped += ends.count().max(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(messages: usize) -> (Client, Waiting) {
        Client::with_room(0, "somebody".into(), Protocol::Slcan, messages)
    }

    #[track_caller]
    fn bytes(waiting: &Waiting) -> Vec<u8> {
        match waiting.messages.try_recv() {
            Ok(Message::Bytes(bytes)) => bytes,
            _ => panic!("no bytes"),
        }
    }

    #[test]
    fn a_turn_is_one_message_in_order() {
        let (mut client, waiting) = client(QUEUE);
        client.flush();
        client.push(b"z\r");
        client.push(b"t70110\r");
        client.push(b"");
        client.push(b"\x07");
        client.flush();
        client.flush();
        assert_eq!(bytes(&waiting), b"z\rt70110\r\x07");
        client.push(b"< ok >");
        client.pause();
        assert_eq!(bytes(&waiting), b"< ok >");
        assert!(matches!(waiting.messages.try_recv(), Ok(Message::Pause)));
        assert!(waiting.messages.try_recv().is_err());
    }

    #[test]
    fn what_waits_is_bounded_in_bytes_and_in_messages() {
        let (mut client, waiting) = client(2);
        let line = [b'0'; 1023]
            .iter()
            .chain(b"\r")
            .copied()
            .collect::<Vec<_>>();
        for _ in 0..WAITING / 1024 {
            client.push(&line);
        }
        assert_eq!(client.dropped, 0);
        client.push(b"z\r");
        client.flush();
        client.push(b"z\rz\r");
        assert_eq!(client.dropped, 3);
        let message = bytes(&waiting);
        assert_eq!(message.len(), WAITING);
        client.queued.fetch_sub(message.len(), Ordering::Relaxed);
        for _ in 0..3 {
            client.push(b"z\r");
            assert_eq!(client.dropped, 0);
            client.flush();
        }
        assert_eq!(client.dropped, 1);
        assert_eq!(client.queued.load(Ordering::Relaxed), 4);
    }
}
