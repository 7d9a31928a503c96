//! Two threads for each client: one reads, one writes, and neither waits for another client.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use super::client::{Client, Message, Waiting};
use super::links::opened::Protocol;
use super::terminal::note;

/// Message from a thread to the bus.
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

/// So much of a queue goes into one write.
const BATCH: usize = 16 * 1024;
/// Pause after a message that a client has to read separately.
const PAUSE: Duration = Duration::from_millis(100);

/// Takes clients that speak `protocol` for as long as the program runs.
pub(super) fn accept(
    listener: TcpListener,
    protocol: Protocol,
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
            if let Err(error) = serve(stream, address.to_string(), protocol, number, &inputs) {
                note(&format!("{address}: {error}"));
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
    protocol: Protocol,
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
    let (client, waiting) = Client::new(number, name, protocol);
    join(client, waiting, reading, stream, close, inputs).map(|_| ())
}

/// Two threads for a client. `close` is called when it can no longer be written to.
/// The answer tells when everything that was pushed has been written: it disconnects.
pub(super) fn join(
    client: Client,
    waiting: Waiting,
    reading: impl Read + Send + 'static,
    writing: impl Write + Send + 'static,
    close: impl FnOnce() + Send + 'static,
    inputs: &SyncSender<Input>,
) -> std::io::Result<Receiver<()>> {
    let (number, whole) = (client.number, client.protocol.message_len());
    let (alive, done) = sync_channel(1);
    thread::Builder::new().spawn(move || {
        write(writing, whole, &waiting);
        close();
        drop(alive);
    })?;
    // The bus ends with the program only, and then nobody needs this client.
    let _ = inputs.send(Input::Connected(client));
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

fn write(mut stream: impl Write, whole: Option<usize>, Waiting { messages, queued }: &Waiting) {
    while let Ok(message) = messages.recv() {
        let Message::Bytes(mut lines) = message else {
            thread::sleep(PAUSE);
            continue;
        };
        let mut pause = false;
        while lines.len() < BATCH && !pause {
            match messages.try_recv() {
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
