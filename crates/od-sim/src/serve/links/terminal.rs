//! The adapter side of a pseudo-terminal.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::{AsRawFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mio::unix::SourceFd;
use mio::{Registry, Token, Waker};
use nix::errno::Errno;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::pty::openpty;
use nix::sys::termios::{FlushArg, SetArg, cfmakeraw, tcflush, tcgetattr, tcsetattr};

use super::port::{BOTH, Port};
use crate::serve::terminal::note;

/// A pseudo-terminal whose hosts come and go.
pub(super) struct Terminal {
    /// Our end, and the events it is registered with; `None` while no end is open.
    end: Option<File>,
    path: PathBuf,
    events: Option<(Registry, Token)>,
    /// Only Linux reports that the last host has left. Elsewhere the other end stays open.
    _other: Option<OwnedFd>,
    /// A host has sent something since the previous one left.
    used: bool,
}

impl Terminal {
    pub(super) fn open() -> io::Result<Self> {
        let pair = openpty(None, None)?;
        let mut settings = tcgetattr(&pair.slave)?;
        // Raw bytes: no echo, no signals, no conversion of line ends.
        cfmakeraw(&mut settings);
        tcsetattr(&pair.slave, SetArg::TCSANOW, &settings)?;
        fcntl(&pair.master, FcntlArg::F_SETFL(OFlag::O_NONBLOCK))?;
        Ok(Self {
            path: nix::unistd::ttyname(&pair.slave)?,
            end: Some(File::from(pair.master)),
            events: None,
            _other: (!cfg!(target_os = "linux")).then_some(pair.slave),
            used: false,
        })
    }

    /// The path that a host opens.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    fn end(&mut self) -> io::Result<&mut File> {
        let gone = || io::Error::other("the pseudo-terminal is gone");
        self.end.as_mut().ok_or_else(gone)
    }

    /// Prepares the terminal for the next host, which must not read the bytes of the previous one.
    fn tidy(&mut self) -> io::Result<()> {
        let flags = (OFlag::O_NOCTTY | OFlag::O_NONBLOCK).bits();
        let other = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(flags)
            .open(&self.path);
        // An slcand that was killed leaves the line discipline of the kernel and its network interface
        // in place, and no write works there. Only a new terminal removes both.
        let is_usable = other.and_then(|mut other| {
            // The bytes to the previous host. Those from the next one, which may be there already, stay.
            tcflush(&other, FlushArg::TCIFLUSH)?;
            other.write(b"")
        });
        match is_usable {
            Ok(_) => Ok(()),
            Err(_) => self.renew(),
        }
    }

    fn renew(&mut self) -> io::Result<()> {
        // After the old one is closed, the new one gets its path, unless another program is faster.
        drop(self.end.take());
        let mut new = Self::open()?;
        if let Some((events, token)) = self.events.take() {
            new.enrol(events, token)?;
        }
        if new.path != self.path {
            let (old, new) = (self.path.display(), new.path.display());
            note(&format!("the pseudo-terminal {old} is now {new}"));
        }
        *self = new;
        Ok(())
    }

    fn enrol(&mut self, events: Registry, token: Token) -> io::Result<()> {
        let number = self.end()?.as_raw_fd();
        events.register(&mut SourceFd(&number), token, BOTH)?;
        self.events = Some((events, token));
        Ok(())
    }
}

impl Port for Terminal {
    fn register(&mut self, events: &Registry, token: Token, _: &Arc<Waker>) -> io::Result<()> {
        self.enrol(events.try_clone()?, token)
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.end()?.read(buffer) {
            Ok(len) if len > 0 => {
                self.used = true;
                return Ok(len);
            }
            Err(error) if error.raw_os_error() != Some(Errno::EIO as i32) => return Err(error),
            // The other end is not open.
            _ => {}
        }
        if !std::mem::take(&mut self.used) {
            return Err(ErrorKind::WouldBlock.into());
        }
        self.tidy()?;
        Ok(0)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.end()?.write(bytes)
    }

    fn outlives_hosts(&self) -> bool {
        true
    }
}
