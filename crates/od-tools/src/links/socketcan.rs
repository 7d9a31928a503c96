//! A CAN interface of Linux.

use std::io::{self, ErrorKind, Read, Write};
use std::time;

use od_sim::links::can_frame;
use od_wire::{Duration, Frame, Instant};
use socketcan::{CanSocket, Socket};

use crate::error::Error;
use crate::link::{Heard, Link};

/// How long to wait while the send queue of the interface is full.
const FULL: Duration = Duration::from_millis(1000);

// Numbers of the system, the same on every Linux.
const ENETDOWN: i32 = 100;
const ENOBUFS: i32 = 105;
const ENODEV: i32 = 19;
const ENXIO: i32 = 6;

/// A raw socket of an interface.
pub(super) struct Interface {
    socket: CanSocket,
    name: String,
    /// Origin of the link's time.
    start: time::Instant,
}

impl Interface {
    pub(super) fn open(name: &str) -> Result<Self, Error> {
        let failed = |error: io::Error| Error::Link(advice(name, &error));
        // A socket for all interfaces shows whether the kernel supports CAN.
        CanSocket::open_iface(0).map_err(failed)?;
        let socket = CanSocket::open(name).map_err(failed)?;
        let interface = Self {
            socket,
            name: name.to_owned(),
            start: time::Instant::now(),
        };
        match can_frame::is_up(name) {
            Some(false) => Err(interface.lost(&io::Error::from_raw_os_error(ENETDOWN))),
            _ => Ok(interface),
        }
    }

    fn lost(&self, error: &io::Error) -> Error {
        Error::Link(advice(&self.name, error))
    }
}

impl Link for Interface {
    fn now(&self) -> Instant {
        Instant::ZERO + self.start.elapsed()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let mut bytes = Vec::new();
        can_frame::encode(frame, &mut bytes);
        let until = self.now() + FULL;
        loop {
            match self.socket.as_raw_socket().write(&bytes) {
                Ok(_) => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.raw_os_error() == Some(ENOBUFS) => {
                    if self.now() >= until {
                        return Err(Error::Link(format!(
                            "{}: no frame leaves the interface; is another node on the bus, at this \
                             bit rate, and is the bus terminated?",
                            self.name
                        )));
                    }
                    std::thread::sleep(Duration::from_millis(1));
                }
                Err(error) => return Err(self.lost(&error)),
            }
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            let left = Duration::from_micros(until.micros_since(self.now()));
            // A time-out of zero would mean no time-out.
            let set = self.socket.set_nonblocking(left.is_zero()).and_then(|()| {
                let wait = Some(left).filter(|left| !left.is_zero());
                self.socket.set_read_timeout(wait)
            });
            set.map_err(|error| self.lost(&error))?;
            let mut bytes = [0; can_frame::SIZE];
            match self.socket.as_raw_socket().read(&mut bytes) {
                Ok(count) => {
                    if let Some(frame) = can_frame::decode(&bytes[..count]) {
                        let at = self.now();
                        return Ok(Some(Heard { at, frame }));
                    }
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
                {
                    return Ok(None);
                }
                Err(error) => return Err(self.lost(&error)),
            }
        }
    }

    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        let name = &self.name;
        Err(Error::Usage(format!(
            "the system sets the bit rate of {name}; to listen at {kbit} kbit/s write `sudo ip link set \
             {name} type can bitrate {kbit}000 listen-only on`"
        )))
    }
}

/// Error text with the commands that correct the cause.
fn advice(name: &str, error: &io::Error) -> String {
    match error.raw_os_error() {
        Some(ENETDOWN) => format!("{name} is down; start it with `sudo ip link set {name} up`"),
        Some(ENODEV | ENXIO) => format!(
            "CAN interface `{name}` does not exist; `ip link show type can` lists the real ones"
        ),
        _ if error.kind() == ErrorKind::PermissionDenied => format!(
            "{name} cannot be opened: {error}; give odkit the right to use raw sockets, such as \
             with `sudo setcap cap_net_raw+ep $(command -v odkit)`"
        ),
        Some(93 | 97) => String::from(
            "this kernel does not support SocketCAN; load it with `sudo modprobe can-raw`",
        ),
        _ => format!("{name}: {error}; `ip -details link show {name}` shows its configuration"),
    }
}
