//! TCP clients: one thread reads, one writes, and neither waits for another client.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
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
    /// Ctrl-C.
    Stop,
}

/// Messages that may wait for a slow client. Past that the newest are dropped, so that
/// nobody else has to wait and memory stays bounded.
const QUEUE: usize = 4096;
/// So much of a queue goes into one write.
const BATCH: usize = 16 * 1024;

/// A client, as the bus sees it.
pub(super) struct Client {
    pub(super) number: u64,
    pub(super) address: SocketAddr,
    queue: SyncSender<Vec<u8>>,
    dropped: u64,
}

impl Client {
    /// Whole lines for the client. They wait their turn, or are dropped where too many wait.
    pub(super) fn send(&mut self, lines: Vec<u8>) {
        if lines.is_empty() {
            return;
        }
        match self.queue.try_send(lines) {
            Ok(()) if self.dropped > 0 => {
                let (address, dropped) = (self.address, self.dropped);
                note!("{address} reads again; {dropped} messages were dropped");
                self.dropped = 0;
            }
            // A client that is gone is reported by its reader.
            Ok(()) | Err(TrySendError::Disconnected(_)) => {}
            Err(TrySendError::Full(_)) => {
                if self.dropped == 0 {
                    note!("{} does not read; frames for it are dropped", self.address);
                }
                self.dropped += 1;
            }
        }
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
    thread::Builder::new().spawn(move || write(stream, &waiting))?;
    let client = Client {
        number,
        address,
        queue,
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

fn write(mut stream: TcpStream, waiting: &Receiver<Vec<u8>>) {
    while let Ok(mut lines) = waiting.recv() {
        while lines.len() < BATCH {
            match waiting.try_recv() {
                Ok(more) => lines.extend_from_slice(&more),
                Err(_) => break,
            }
        }
        if stream.write_all(&lines).is_err() {
            break;
        }
    }
    // The reader of this client wakes up and reports it gone.
    let _ = stream.shutdown(Shutdown::Both);
}
