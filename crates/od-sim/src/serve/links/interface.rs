//! The raw socket of a CAN interface.

use std::io::{self, ErrorKind, IoSliceMut, Write};
use std::os::fd::AsRawFd;
use std::sync::Arc;
use std::time::{Duration, Instant as Clock};

use mio::unix::SourceFd;
use mio::{Registry, Token, Waker};
use nix::cmsg_space;
use nix::errno::Errno;
use nix::sys::socket::{ControlMessageOwned, MsgFlags, recvmsg, setsockopt, sockopt};
use socketcan::{CanSocket, Socket};

use super::port::{BOTH, Port};
use crate::links::can_frame::SIZE;
use crate::serve::terminal::note;
use crate::words::plural;

/// Buffer for unread frames, in bytes; the system may allow less.
const BUFFER: usize = 64 * 1024 * 1024;
/// Time until the next attempt when the queue of the interface is full.
const FULL: Duration = Duration::from_millis(1);
/// Period for checking an interface that is down.
const DOWN: Duration = Duration::from_millis(250);
/// Shortest time between two reports of dropped frames.
const DROPS: Duration = Duration::from_secs(1);

/// Returns whether a CAN interface of Linux is up; `None` if the system does not say. An interface that comes up
/// later works, too.
pub fn is_up(interface: &str) -> Option<bool> {
    const IFF_UP: u32 = 1;
    let flags = std::fs::read_to_string(format!("/sys/class/net/{interface}/flags")).ok()?;
    let flags = u32::from_str_radix(flags.trim().strip_prefix("0x")?, 16).ok()?;
    Some(flags & IFF_UP != 0)
}

/// A CAN interface.
pub(super) struct Interface {
    name: String,
    socket: CanSocket,
    /// The next time to check whether it is up again, if it is down.
    down: Option<Clock>,
    /// The next time to write, if its queue is full.
    full: Option<Clock>,
    /// Dropped frames by the count of the kernel.
    dropped: u32,
    /// The number of the last report, and the time of the next one.
    told: (u32, Clock),
    /// An error that came after frames.
    failed: Option<io::Error>,
}

impl Interface {
    pub(super) fn open(name: &str) -> io::Result<Self> {
        // A socket for all interfaces shows whether the kernel supports CAN.
        CanSocket::open_iface(0)?;
        let socket = CanSocket::open(name)?;
        socket.set_nonblocking(true)?;
        // A larger buffer than the system's limit needs a special right.
        if setsockopt(&socket, sockopt::RcvBufForce, &BUFFER).is_err() {
            let _ = setsockopt(&socket, sockopt::RcvBuf, &BUFFER);
        }
        setsockopt(&socket, sockopt::RxqOvfl, &1)?;
        let mut interface = Self {
            name: name.to_owned(),
            socket,
            down: None,
            full: None,
            dropped: 0,
            told: (0, Clock::now()),
            failed: None,
        };
        if is_up(name) == Some(false) {
            interface.goes_down();
        }
        Ok(interface)
    }

    fn goes_down(&mut self) {
        if self.down.replace(Clock::now() + DOWN).is_none() {
            let name = &self.name;
            note(&format!(
                "{name} is down; start it with `sudo ip link set {name} up`"
            ));
        }
    }

    /// Reads a frame; other messages have another length than `SIZE`.
    fn receive(&mut self, frame: &mut [u8]) -> io::Result<usize> {
        let mut space = cmsg_space!(u32);
        let mut slices = [IoSliceMut::new(frame)];
        let socket = self.socket.as_raw_fd();
        let message = recvmsg::<()>(
            socket,
            &mut slices,
            Some(&mut space),
            MsgFlags::MSG_DONTWAIT,
        )?;
        for part in message.cmsgs()? {
            if let ControlMessageOwned::RxqOvfl(count) = part {
                self.dropped = count;
            }
        }
        Ok(message.bytes)
    }

    /// Reports the number of frames that the kernel dropped, at most once a second.
    fn tell_drops(&mut self, now: Clock) {
        let (told, next) = self.told;
        if told == self.dropped || now < next {
            return;
        }
        let count = plural(self.dropped.wrapping_sub(told) as usize, "frame");
        note(&format!(
            "{}: the kernel dropped {count} because odkit did not read fast enough; {} in total",
            self.name, self.dropped
        ));
        self.told = (self.dropped, now + DROPS);
    }

    /// An error that ends the link; `None` for one that does not.
    fn fatal(&mut self, error: io::Error) -> Option<io::Error> {
        match Errno::from_raw(error.raw_os_error().unwrap_or(0)) {
            Errno::EINTR => None,
            Errno::ENETDOWN => {
                self.goes_down();
                None
            }
            Errno::ENODEV | Errno::ENXIO => Some(io::Error::other("the interface was removed")),
            _ => Some(error),
        }
    }
}

impl Port for Interface {
    fn missed(&self) -> u64 {
        self.dropped.into()
    }

    fn register(&mut self, events: &Registry, token: Token, _: &Arc<Waker>) -> io::Result<()> {
        events.register(&mut SourceFd(&self.socket.as_raw_fd()), token, BOTH)
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        let mut len = 0;
        while let Some(room) = buffer.get_mut(len..len + SIZE) {
            match self.receive(room) {
                Ok(SIZE) => len += SIZE,
                Ok(_) => {}
                Err(error) => match self.fatal(error) {
                    None => {}
                    Some(error) if len == 0 => return Err(error),
                    Some(error) => {
                        self.failed = Some(error);
                        break;
                    }
                },
            }
        }
        if self.dropped != self.told.0 {
            self.tell_drops(Clock::now());
        }
        Ok(len)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let frame = &bytes[..SIZE.min(bytes.len())];
        match self.socket.as_raw_socket().write(frame) {
            Err(error) if error.raw_os_error() == Some(Errno::ENOBUFS as i32) => {
                // No event reports new room in the queue.
                self.full = Some(Clock::now() + FULL);
                Err(ErrorKind::WouldBlock.into())
            }
            // Frames for an interface that is down are lost, as on a real bus.
            Err(error) => self.fatal(error).map_or(Ok(frame.len()), Err),
            written => written,
        }
    }

    fn next_check(&self) -> Option<Clock> {
        let drops = (self.told.0 != self.dropped).then_some(self.told.1);
        [self.full, self.down, drops].into_iter().flatten().min()
    }

    fn check(&mut self, now: Clock) {
        self.full = self.full.filter(|at| now < *at);
        self.tell_drops(now);
        if self.down.is_none_or(|at| now < at) {
            return;
        }
        self.down = Some(now + DOWN);
        if is_up(&self.name) == Some(true) {
            self.down = None;
            note(&format!("{} is up again", self.name));
        }
    }
}
