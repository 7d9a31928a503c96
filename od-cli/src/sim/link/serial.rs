//! slcan as an adapter speaks it: over a serial line, or over a pseudo-terminal.

use std::io::ErrorKind;

use super::{Ends, Kind, Opened};
use crate::Failure;

/// The rate that a serial line has where none is asked for.
pub(super) const BAUD: u32 = 115_200;

/// Opens a serial port.
pub(super) fn open(path: &str, baud: u32) -> Result<Opened, Failure> {
    let failed = |error: std::io::Error| {
        Failure::Failed(match error.kind() {
            ErrorKind::NotFound => format!(
                "there is no serial port {path}; for a port that another program opens, use \
                 --link slcan:pty"
            ),
            ErrorKind::PermissionDenied => format!(
                "{path} may not be opened; on Debian and Ubuntu its users are in the group \
                 dialout: `sudo usermod -aG dialout $USER`, then log in again"
            ),
            _ => format!("{path} at {baud} baud: {error}"),
        })
    };
    let port = serial2::SerialPort::open(path, baud).map_err(failed)?;
    let mut writing = port.try_clone().map_err(failed)?;
    // A host that reads slowly holds up the thread that writes, and nothing else.
    writing
        .set_write_timeout(std::time::Duration::from_secs(3600))
        .map_err(failed)?;
    Ok(Opened::Ends(Ends {
        name: path.to_owned(),
        kind: Kind::Slcan,
        reading: Box::new(port),
        writing: Box::new(writing),
    }))
}

/// Makes a pseudo-terminal; its name is the path that a host opens.
#[cfg(unix)]
pub(super) fn pty() -> Result<Opened, Failure> {
    use std::fs::File;

    use nix::pty::{OpenptyResult, openpty};
    use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};

    let make = || -> Result<(OpenptyResult, std::path::PathBuf), nix::Error> {
        let pair = openpty(None, None)?;
        let mut settings = tcgetattr(&pair.slave)?;
        // Bytes as they are: no echo, no signals, no line ends.
        cfmakeraw(&mut settings);
        tcsetattr(&pair.slave, SetArg::TCSANOW, &settings)?;
        let path = nix::unistd::ttyname(&pair.slave)?;
        Ok((pair, path))
    };
    let (pair, path) = make()
        .map_err(|error| Failure::Failed(format!("no pseudo-terminal can be made: {error}")))?;
    let reading = File::from(pair.master);
    let writing = reading.try_clone()?;
    Ok(Opened::Ends(Ends {
        name: path.display().to_string(),
        kind: Kind::Slcan,
        reading: Box::new(Held {
            reading,
            _other: pair.slave,
        }),
        writing: Box::new(writing),
    }))
}

/// Only Unix has pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn pty() -> Result<Opened, Failure> {
    Err(Failure::Failed(String::from(
        "there are no pseudo-terminals here; use --link slcan:127.0.0.1:29536",
    )))
}

/// Our end; with the other end open as well, hosts may come and go.
#[cfg(unix)]
struct Held {
    reading: std::fs::File,
    _other: std::os::fd::OwnedFd,
}

#[cfg(unix)]
impl std::io::Read for Held {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.reading.read(buffer)
    }
}
