//! A log file of the bus, with a thread of its own, so that a slow disk never stops the bus.

use std::fs::{File, OpenOptions};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::{Duration, Instant as Clock};

use od_runtime::{Frame, Instant};

use super::error::Error;
use super::files;
use super::terminal::note;
use crate::logs::{Format, Record, What};
use crate::words::plural;

/// Limit of records that wait for the disk; further ones are left out.
const WAITING: usize = 65_536;
/// Longest time that a record waits before it is written.
const PATIENCE: Duration = Duration::from_millis(250);
/// Limit of bytes in one write.
const PIECE: usize = 64 * 1024;
/// Longest time that the end of the program waits for the disk.
const FAREWELL: Duration = Duration::from_secs(5);

/// A log file that grows.
pub(super) struct Log {
    records: Option<SyncSender<Record>>,
    /// It disconnects when everything is written.
    done: Receiver<()>,
    name: String,
    left_out: usize,
}

/// Chooses the format of a log file by its name: pcapng, otherwise candump.
///
/// # Errors
/// The name belongs to another format.
pub(super) fn format(path: &Path) -> Result<Format, String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let format = Format::of_ending(&ending.to_ascii_lowercase()).unwrap_or(Format::Candump);
    if format.grows() {
        Ok(format)
    } else {
        Err("write a name that ends in .log (candump) or .pcapng".into())
    }
}

impl Log {
    /// Creates an empty file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn create(path: &Path) -> Result<Self, Error> {
        let name = path.display().to_string();
        let failed = |why: String| Error::Failed(format!("--log {name}: {why}"));
        let format = format(path).map_err(failed)?;
        files::replaces_log(path, format).map_err(|why| failed(why.into()))?;
        // Opening a named pipe waits for its reader.
        if is_pipe(path) {
            return Err(failed("it is a named pipe; give the name of a file".into()));
        }
        let mut options = OpenOptions::new();
        let options = options.write(true).create(true).truncate(true);
        let file = options.open(path).map_err(|why| failed(why.to_string()))?;
        let (records, waiting) = sync_channel(WAITING);
        let (alive, done) = sync_channel(1);
        let path = PathBuf::from(path);
        thread::Builder::new().spawn(move || {
            if let Err(error) = write(file, format, &waiting) {
                let name = path.display();
                note(&format!(
                    "{name}: {error}; the log ends here, the bus continues"
                ));
            }
            drop(alive);
        })?;
        Ok(Self {
            records: Some(records),
            done,
            name,
            left_out: 0,
        })
    }

    /// Adds a frame with its time of day in microseconds.
    pub(super) fn add(&mut self, stamp: u64, frame: &Frame) {
        let record = Record {
            at: Instant::from_micros(stamp),
            sent: false,
            what: What::Frame(*frame),
        };
        match self
            .records
            .as_ref()
            .map(|records| records.try_send(record))
        {
            Some(Err(TrySendError::Full(_))) => {
                if self.left_out == 0 {
                    note(&format!(
                        "{}: the disk is too slow; the log has gaps",
                        self.name
                    ));
                }
                self.left_out += 1;
            }
            // The thread has already reported the reason.
            Some(Err(TrySendError::Disconnected(_))) => self.records = None,
            _ => {}
        }
    }

    /// Waits until everything is written, up to a time limit.
    pub(super) fn finish(mut self) {
        self.records = None;
        let _ = self.done.recv_timeout(FAREWELL);
        if self.left_out > 0 {
            let frames = plural(self.left_out, "frame");
            note(&format!("{}: {frames} are not in the log", self.name));
        }
    }
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    path.metadata().is_ok_and(|file| file.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}

/// Writes records until the channel is closed.
fn write(mut file: File, format: Format, records: &Receiver<Record>) -> std::io::Result<()> {
    let mut bytes = format.head();
    let mut due = Some(Clock::now());
    let mut written = 0;
    loop {
        let now = Clock::now();
        if bytes.len() >= PIECE || due.is_some_and(|due| due <= now) {
            write_whole(&mut file, format, &bytes, &mut written)?;
            bytes.clear();
            due = None;
        }
        let patience = due.map_or(Duration::from_secs(3600), |due| due - now);
        match records.recv_timeout(patience) {
            Ok(record) => {
                format.add(&mut bytes, &record);
                due.get_or_insert(now + PATIENCE);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return write_whole(&mut file, format, &bytes, &mut written);
            }
        }
    }
}

/// Writes records after the first `written` bytes. If only some of them fit on the disk, the file
/// ends with the last whole record.
fn write_whole(
    file: &mut File,
    format: Format,
    bytes: &[u8],
    written: &mut u64,
) -> std::io::Result<()> {
    if let Err(error) = file.write_all(bytes) {
        let end = file.stream_position().unwrap_or(*written);
        let room = usize::try_from(end.saturating_sub(*written)).unwrap_or(0);
        let whole = format.whole(&bytes[..room.min(bytes.len())]);
        let _ = file.set_len(*written + whole as u64);
        return Err(error);
    }
    *written += bytes.len() as u64;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_decides_the_format() {
        for (name, expected) in [
            ("a.log", Some(Format::Candump)),
            ("a", Some(Format::Candump)),
            ("a.PCAPNG", Some(Format::Pcapng)),
            ("a.asc", None),
            ("a.trc", None),
        ] {
            assert_eq!(format(Path::new(name)).ok(), expected, "{name}");
        }
    }
}
