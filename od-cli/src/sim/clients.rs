//! TCP clients: one thread reads, one writes, and neither waits for another client.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread;

use crate::output::note;

/// What the threads tell the bus.
pub(super) enum Input {
    /// A client is there.
    Connected(Client),
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

/// A client, as the bus sees it.
pub(super) struct Client {
    pub(super) number: u64,
    pub(super) address: SocketAddr,
    queue: SyncSender<Vec<u8>>,
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
            let (address, dropped) = (self.address, self.dropped);
            note!("{address} reads again; {dropped} messages were dropped");
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
        match self.queue.try_send(lines) {
            // A client that is gone is reported by its reader.
            Ok(()) | Err(TrySendError::Disconnected(_)) => {}
            Err(TrySendError::Full(lines)) => {
                self.queued.fetch_sub(len, Ordering::Relaxed);
                self.drop_lines(&lines);
            }
        }
    }

    fn drop_lines(&mut self, lines: &[u8]) {
        if self.dropped == 0 {
            note!("{} does not read; frames for it are dropped", self.address);
        }
        let ends = lines.iter().filter(|byte| matches!(byte, b'\r' | 7));
        self.dropped += ends.count();
    }
}

/// Takes clients for as long as the program runs.
pub(super) fn accept(listener: TcpListener, inputs: SyncSender<Input>) {
    thread::spawn(move || {
        for number in 0.. {
            let (stream, address) = match listener.accept() {
                Ok(accepted) => accepted,
                // The client went before it was taken, or too many files are open.
                Err(_) => {
                    thread::sleep(std::time::Duration::from_millis(50));
                    continue;
                }
            };
            if let Err(error) = serve(stream, address, number, &inputs) {
                note!("{address}: {error}");
            }
        }
    });
}

fn serve(
    stream: TcpStream,
    address: SocketAddr,
    number: u64,
    inputs: &SyncSender<Input>,
) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    let reading = stream.try_clone()?;
    let (queue, waiting) = sync_channel(QUEUE);
    let queued = Arc::new(AtomicUsize::new(0));
    let written = Arc::clone(&queued);
    thread::Builder::new().spawn(move || write(stream, &waiting, &written))?;
    let client = Client {
        number,
        address,
        queue,
        queued,
        gathered: Vec::new(),
        dropped: 0,
    };
    // The bus ends with the program only, and then nobody needs this client.
    let _ = inputs.send(Input::Connected(client));
    let inputs = inputs.clone();
    thread::Builder::new().spawn(move || {
        read(reading, number, &inputs);
        let _ = inputs.send(Input::Gone(number));
    })?;
    Ok(())
}

fn read(mut stream: TcpStream, number: u64, inputs: &SyncSender<Input>) {
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
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(_) => return,
        }
    }
}

fn write(mut stream: TcpStream, waiting: &Receiver<Vec<u8>>, queued: &AtomicUsize) {
    while let Ok(mut lines) = waiting.recv() {
        while lines.len() < BATCH {
            match waiting.try_recv() {
                Ok(more) => lines.extend_from_slice(&more),
                Err(_) => break,
            }
        }
        queued.fetch_sub(lines.len(), Ordering::Relaxed);
        if stream.write_all(&lines).is_err() {
            break;
        }
    }
    // The reader of this client wakes up and reports it gone.
    let _ = stream.shutdown(Shutdown::Both);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(messages: usize) -> (Client, Receiver<Vec<u8>>) {
        let (queue, waiting) = sync_channel(messages);
        let client = Client {
            number: 0,
            address: SocketAddr::from(([127, 0, 0, 1], 1)),
            queue,
            queued: Arc::default(),
            gathered: Vec::new(),
            dropped: 0,
        };
        (client, waiting)
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
        assert_eq!(waiting.try_recv().as_deref(), Ok(&b"z\rt70110\r\x07"[..]));
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
        let message = waiting.recv().expect("a message");
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
