//! slcan in the role of the adapter, over a serial line or a pseudo-terminal.

use std::io::ErrorKind;

use super::opened::{Ends, Opened, Protocol};
use super::threads::Threads;
use crate::serve::error::Error;

/// Opens a serial port.
pub(super) fn open(path: &str, baud: u32) -> Result<Opened, Error> {
    let failed = |error: std::io::Error| {
        Error::Failed(match error.kind() {
            ErrorKind::NotFound => format!(
                "serial port {path} does not exist; for a port that another program opens, use \
                 `--link slcan:pty`"
            ),
            ErrorKind::PermissionDenied => format!(
                "{path} cannot be opened (permission denied); on Debian and Ubuntu join the group \
                 dialout with `sudo usermod -aG dialout $USER`, then log in again"
            ),
            _ => format!("{path} cannot be opened as a serial port with {baud} bit/s: {error}"),
        })
    };
    let port = serial2::SerialPort::open(path, baud).map_err(failed)?;
    let mut writing = port.try_clone().map_err(failed)?;
    // A slow host only delays the writing thread.
    writing
        .set_write_timeout(std::time::Duration::from_secs(3600))
        .map_err(failed)?;
    Ok(Opened::Ends(Ends {
        name: path.to_owned(),
        protocol: Protocol::Slcan,
        port: Box::new(Threads::new(port, writing)),
    }))
}

/// Makes a pseudo-terminal; its name is the path that a host opens.
#[cfg(unix)]
pub(super) fn open_pty() -> Result<Opened, Error> {
    let terminal = super::terminal::Terminal::open()
        .map_err(|error| Error::Failed(format!("cannot create a pseudo-terminal: {error}")))?;
    Ok(Opened::Ends(Ends {
        name: terminal.path().display().to_string(),
        protocol: Protocol::Slcan,
        port: Box::new(terminal),
    }))
}

/// Only Unix has pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn open_pty() -> Result<Opened, Error> {
    Err(Error::Failed(String::from(
        "this system does not support pseudo-terminals; use `--link slcan:127.0.0.1:29536`",
    )))
}
