//! slcan over a pseudo-terminal, which a program opens like the serial port of an adapter.

use super::opened::Opened;
use crate::serve::failure::Failure;

/// Makes a pseudo-terminal; its name is the path that a host opens.
#[cfg(unix)]
pub(super) fn open() -> Result<Opened, Failure> {
    let terminal = super::terminal::Terminal::open()
        .map_err(|error| Failure::Failed(format!("cannot create a pseudo-terminal: {error}")))?;
    Ok(Opened::Ends(super::opened::Ends {
        name: terminal.path().display().to_string(),
        protocol: super::opened::Protocol::Slcan,
        port: Box::new(terminal),
    }))
}

/// Only Unix has pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn open() -> Result<Opened, Failure> {
    Err(Failure::Failed(String::from(
        "this system does not support pseudo-terminals; use `--link slcan:127.0.0.1:29536`",
    )))
}
