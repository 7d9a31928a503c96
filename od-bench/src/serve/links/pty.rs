//! slcan over a pseudo-terminal, which a program opens as if it were an adapter's serial port.

use super::opened::Opened;
use crate::serve::failure::Failure;

/// Makes a pseudo-terminal; its name is the path that a host opens.
#[cfg(unix)]
pub(super) fn open() -> Result<Opened, Failure> {
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
        .map_err(|error| Failure::Failed(format!("cannot create a pseudo-terminal: {error}")))?;
    let reading = File::from(pair.master);
    let writing = reading.try_clone()?;
    Ok(Opened::Ends(super::opened::Ends {
        name: path.display().to_string(),
        protocol: super::opened::Protocol::Slcan,
        reading: Box::new(Held {
            reading,
            _other: pair.slave,
        }),
        writing: Box::new(writing),
    }))
}

/// Only Unix has pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn open() -> Result<Opened, Failure> {
    Err(Failure::Failed(String::from(
        "this system does not support pseudo-terminals; use `--link slcan:127.0.0.1:29536`",
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
