//! A port that cannot be polled, such as standard input and output or a serial line. One thread reads, one writes.

use std::io::{self, ErrorKind, Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, TrySendError};
use std::thread;
use std::time::Duration;

use mio::{Registry, Token, Waker};

use super::port::Port;

/// Limit of waiting pieces in each direction.
const PIECES: usize = 4;
/// Longest piece, in bytes.
const PIECE: usize = 4096;

/// Both directions, with one thread each.
pub(super) struct Threads {
    /// The threads take them when they start.
    ends: Option<(Box<dyn Read + Send>, Box<dyn Write + Send>)>,
    /// Input, nothing at its end, or the error that ended input or output.
    input: Option<Receiver<io::Result<Vec<u8>>>>,
    /// Input that did not fit into the buffer of the reader.
    rest: Vec<u8>,
    output: Option<SyncSender<Vec<u8>>>,
    /// Reports that everything is written, or the error.
    done: Option<Receiver<io::Result<()>>>,
}

impl Threads {
    pub(super) fn new(
        reading: impl Read + Send + 'static,
        writing: impl Write + Send + 'static,
    ) -> Self {
        Self {
            ends: Some((Box::new(reading), Box::new(writing))),
            input: None,
            rest: Vec::new(),
            output: None,
            done: None,
        }
    }
}

impl Port for Threads {
    fn register(&mut self, _: &Registry, _: Token, waker: &Arc<Waker>) -> io::Result<()> {
        let Some((reading, writing)) = self.ends.take() else {
            return Ok(());
        };
        let (heard, input) = sync_channel(PIECES);
        let (output, said) = sync_channel(PIECES);
        let (ended, done) = sync_channel(1);
        (self.input, self.output, self.done) = (Some(input), Some(output), Some(done));
        let (failed, calls) = (heard.clone(), Arc::clone(waker));
        thread::Builder::new().spawn(move || {
            let written = write(writing, &said, &calls);
            if let Err(error) = &written {
                // Nothing else wakes up a reader of standard input when standard output closes.
                let _ = failed.send(Err(io::Error::new(error.kind(), error.to_string())));
                let _ = calls.wake();
            }
            let _ = ended.send(written);
        })?;
        let calls = Arc::clone(waker);
        thread::Builder::new().spawn(move || read(reading, &heard, &calls))?;
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.rest.is_empty() {
            let input = self.input.as_ref().map(Receiver::try_recv);
            self.rest = match input {
                Some(Ok(input)) => input?,
                Some(Err(TryRecvError::Empty)) => return Err(ErrorKind::WouldBlock.into()),
                Some(Err(TryRecvError::Disconnected)) | None => return Ok(0),
            };
        }
        let len = self.rest.len().min(buffer.len());
        buffer[..len].copy_from_slice(&self.rest[..len]);
        self.rest.drain(..len);
        Ok(len)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let piece = &bytes[..bytes.len().min(PIECE)];
        let sent = self
            .output
            .as_ref()
            .map(|output| output.try_send(piece.to_vec()));
        match sent {
            Some(Ok(())) => Ok(piece.len()),
            Some(Err(TrySendError::Full(_))) => Err(ErrorKind::WouldBlock.into()),
            // The reader receives the error.
            Some(Err(TrySendError::Disconnected(_))) | None => Ok(bytes.len()),
        }
    }

    fn finish(&mut self, stopped: &AtomicBool) -> io::Result<()> {
        self.output = None;
        let Some(done) = &self.done else {
            return Ok(());
        };
        loop {
            match done.recv_timeout(Duration::from_millis(100)) {
                Ok(written) => return written,
                Err(RecvTimeoutError::Timeout) if !stopped.load(Ordering::Relaxed) => {}
                Err(_) => return Ok(()),
            }
        }
    }
}

fn read(mut reading: impl Read, heard: &SyncSender<io::Result<Vec<u8>>>, waker: &Waker) {
    let mut buffer = [0; PIECE];
    loop {
        let (piece, is_last) = match reading.read(&mut buffer) {
            Ok(len) => (Ok(buffer[..len].to_vec()), len == 0),
            Err(error) if passes(&error) => continue,
            Err(error) => (Err(error), true),
        };
        // The bench has ended when the channel is closed.
        if heard.send(piece).is_err() || waker.wake().is_err() || is_last {
            break;
        }
    }
}

/// For a serial line a time-out without data is not an error.
fn passes(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::Interrupted | ErrorKind::TimedOut | ErrorKind::WouldBlock
    )
}

fn write(mut writing: impl Write, said: &Receiver<Vec<u8>>, waker: &Waker) -> io::Result<()> {
    while let Ok(piece) = said.recv() {
        writing.write_all(&piece).and_then(|()| writing.flush())?;
        let _ = waker.wake();
    }
    Ok(())
}
