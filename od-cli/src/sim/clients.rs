//! Clients: one thread reads, one writes, and neither waits for another client.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::Duration;

use super::adapter::Kind;
use crate::output::note;

/// What the threads tell the bus.
pub(super) enum Input {
    /// A client is there, and speaks this.
    Connected(Client, Kind),
    /// It sent bytes.
    Bytes(u64, Vec<u8>),
    /// It is gone.
    Gone(u64),
    /// Ctrl-C: look at the flag.
    Stop,
}

/// Messages and bytes that may wait for a slow client. Past that the newest lines are
/// dropped, so that nobody else has to wait and memory stays bounded.
const QUEUE: usize = 4096;
const WAITING: usize = 1024 * 1024;
/// So much of a queue goes into one write.
const BATCH: usize = 16 * 1024;
/// So long nothing follows what a client has to read alone.
const PAUSE: Duration = Duration::from_millis(100);

/// What waits for the thread that writes.
pub(super) enum Message {
    Bytes(Vec<u8>),
    Pause,
}

/// A client, as the bus sees it.
pub(super) struct Client {
    pub(super) number: u64,
    /// What to call it.
    pub(super) name: String,
    queue: SyncSender<Message>,
    /// Bytes in the queue.
    queued: Arc<AtomicUsize>,
    /// What this turn of the bus has brought so far.
    gathered: Vec<u8>,
    dropped: usize,
}

impl Client {
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
            note!("{name} reads again; {dropped} messages were dropped");
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

    /// What was pushed goes out alone, and nothing follows it for a moment.
    pub(super) fn pause(&mut self) {
        self.flush();
        // A client for which so much waits does not read one by one anyway.
        let _ = self.queue.try_send(Message::Pause);
    }

    fn drop_lines(&mut self, lines: &[u8]) {
        if self.dropped == 0 {
            note!("{} does not read; frames for it are dropped", self.name);
        }
        let ends = lines
            .iter()
            .filter(|byte| matches!(byte, b'\r' | b'\n' | b'>' | 7));
        self.dropped += ends.count().max(1);
    }
}

/// Takes clients that speak `kind` for as long as the program runs.
pub(super) fn accept(
    listener: TcpListener,
    kind: Kind,
    numbers: Arc<AtomicUsize>,
    inputs: SyncSender<Input>,
) {
    thread::spawn(move || {
        loop {
            let (stream, address) = match listener.accept() {
                Ok(accepted) => accepted,
                // The client went before it was taken, or too many files are open.
                Err(_) => {
                    thread::sleep(Duration::from_millis(50));
                    continue;
                }
            };
            let number = next(&numbers);
            if let Err(error) = serve(stream, address.to_string(), kind, number, &inputs) {
                note!("{address}: {error}");
            }
        }
    });
}

/// A number that no other client has.
pub(super) fn next(numbers: &AtomicUsize) -> u64 {
    numbers.fetch_add(1, Ordering::Relaxed) as u64
}

fn serve(
    stream: TcpStream,
    name: String,
    kind: Kind,
    number: u64,
    inputs: &SyncSender<Input>,
) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    let reading = stream.try_clone()?;
    let closing = stream.try_clone()?;
    let close = move || {
        // The reader of this client wakes up and reports it gone.
        let _ = closing.shutdown(Shutdown::Both);
    };
    join(number, name, kind, reading, stream, close, inputs).map(|_| ())
}

/// Two threads for a client. `close` is called when it can no longer be written to.
/// The answer tells when everything that was pushed has been written: it disconnects.
pub(super) fn join(
    number: u64,
    name: String,
    kind: Kind,
    reading: impl Read + Send + 'static,
    writing: impl Write + Send + 'static,
    close: impl FnOnce() + Send + 'static,
    inputs: &SyncSender<Input>,
) -> std::io::Result<Receiver<()>> {
    let (queue, waiting) = sync_channel(QUEUE);
    let queued = Arc::new(AtomicUsize::new(0));
    let written = Arc::clone(&queued);
    let (alive, done) = sync_channel(1);
    let whole = kind.message_len();
    thread::Builder::new().spawn(move || {
        write(writing, whole, &waiting, &written);
        close();
        drop(alive);
    })?;
    let client = Client {
        number,
        name,
        queue,
        queued,
        gathered: Vec::new(),
        dropped: 0,
    };
    // The bus ends with the program only, and then nobody needs this client.
    let _ = inputs.send(Input::Connected(client, kind));
    let inputs = inputs.clone();
    thread::Builder::new().spawn(move || {
        read(reading, number, &inputs);
        let _ = inputs.send(Input::Gone(number));
    })?;
    Ok(done)
}

fn read(mut stream: impl Read, number: u64, inputs: &SyncSender<Input>) {
    let mut buffer = [0; 4096];
    loop {
        match stream.read(&mut buffer) {
            Ok(0) => return,
            Ok(len) => {
                if inputs
                    .send(Input::Bytes(number, buffer[..len].to_vec()))
                    .is_err()
                {
                    return;
                }
            }
            Err(error) if passes(&error) => {}
            // An interface that is down comes back; the next read says so, or waits.
            Err(error) if error.kind() == ErrorKind::NetworkDown => {
                thread::sleep(Duration::from_millis(500));
            }
            Err(_) => return,
        }
    }
}

/// A serial line that says nothing for a while is well.
fn passes(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::Interrupted | ErrorKind::TimedOut | ErrorKind::WouldBlock
    )
}

fn write(
    mut stream: impl Write,
    whole: Option<usize>,
    waiting: &Receiver<Message>,
    queued: &AtomicUsize,
) {
    while let Ok(message) = waiting.recv() {
        let Message::Bytes(mut lines) = message else {
            thread::sleep(PAUSE);
            continue;
        };
        let mut pause = false;
        while lines.len() < BATCH && !pause {
            match waiting.try_recv() {
                Ok(Message::Bytes(more)) => lines.extend_from_slice(&more),
                Ok(Message::Pause) => pause = true,
                Err(_) => break,
            }
        }
        queued.fetch_sub(lines.len(), Ordering::Relaxed);
        let written = match whole {
            None => stream.write_all(&lines).and_then(|()| stream.flush()),
            Some(len) => lines.chunks(len).try_for_each(|one| send(&mut stream, one)),
        };
        if written.is_err() {
            return;
        }
        if pause {
            thread::sleep(PAUSE);
        }
    }
}

/// One frame to a CAN interface. It waits where the interface's queue is full; what is sent
/// while the interface is down is lost, as on a real bus.
fn send(stream: &mut impl Write, frame: &[u8]) -> std::io::Result<()> {
    /// "No buffer space available", which has no kind of its own.
    const ENOBUFS: i32 = 105;
    loop {
        match stream.write(frame) {
            Ok(_) => return Ok(()),
            Err(error) if passes(&error) || error.raw_os_error() == Some(ENOBUFS) => {
                thread::sleep(Duration::from_micros(500));
            }
            Err(error) if error.kind() == ErrorKind::NetworkDown => return Ok(()),
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(messages: usize) -> (Client, Receiver<Message>) {
        let (queue, waiting) = sync_channel(messages);
        let client = Client {
            number: 0,
            name: "somebody".into(),
            queue,
            queued: Arc::default(),
            gathered: Vec::new(),
            dropped: 0,
        };
        (client, waiting)
    }

    #[track_caller]
    fn bytes(waiting: &Receiver<Message>) -> Vec<u8> {
        match waiting.try_recv() {
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
        assert!(matches!(waiting.try_recv(), Ok(Message::Pause)));
        assert!(waiting.try_recv().is_err());
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
