//! slcan over a serial line, in the role of the adapter.

use std::io::ErrorKind;

use super::opened::{Ends, Opened, Protocol};
use super::threads::Threads;
use crate::serve::failure::Failure;

/// Opens a serial port.
pub(super) fn open(path: &str, baud: u32) -> Result<Opened, Failure> {
    let failed = |error: std::io::Error| {
        Failure::Failed(match error.kind() {
            ErrorKind::NotFound => format!(
                "serial port {path} does not exist; for a port that another program opens, use \
                 `--link slcan:pty`"
            ),
            ErrorKind::PermissionDenied => format!(
                "{path} cannot be opened (permission denied); on Debian and Ubuntu join the group \
                 dialout with `sudo usermod -aG dialout $USER`, then log in again"
            ),
            _ => format!("{path} at {baud} bit/s: {error}"),
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
