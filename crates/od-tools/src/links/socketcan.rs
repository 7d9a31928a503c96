//! A CAN interface of Linux.

use std::io::{self, ErrorKind, Write};
use std::time;

use od_sim::links::can_frame;
use od_sim::serve::links::is_up;
use od_wire::{CanId, Duration, Frame, Instant};
use socketcan::{CanFrame, CanSocket, EmbeddedFrame, Socket, SocketOptions};

use crate::error::Error;
use crate::link::{Heard, Link};

/// Maximum time to wait while the send queue of the interface is full.
const FULL: Duration = Duration::from_millis(1000);

// Numbers of the system, the same on every Linux.
const ENETDOWN: i32 = 100;
const ENOBUFS: i32 = 105;
const ENODEV: i32 = 19;
const ENXIO: i32 = 6;

/// A raw socket of an interface.
pub(super) struct Interface {
    socket: CanSocket,
    /// A frame that the interface has not accepted yet, and when it began to wait.
    unsent: Option<(Vec<u8>, Instant)>,
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
        // The moment at which the driver handed a frame over.
        socket.set_recv_timestamp(true).map_err(failed)?;
        let interface = Self {
            socket,
            unsent: None,
            name: name.to_owned(),
            start: time::Instant::now(),
        };
        match is_up(name) {
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
        self.begin_send(frame)?;
        while !self.finish_send(self.now() + FULL)? {}
        Ok(())
    }

    fn begin_send(&mut self, frame: &Frame) -> Result<(), Error> {
        // A frame that is still waiting goes first.
        while !self.finish_send(self.now() + FULL)? {}
        let mut bytes = Vec::new();
        can_frame::encode(frame, &mut bytes);
        self.unsent = Some((bytes, self.now()));
        Ok(())
    }

    fn finish_send(&mut self, until: Instant) -> Result<bool, Error> {
        while let Some((bytes, since)) = &self.unsent {
            match self.socket.as_raw_socket().write(bytes) {
                Ok(_) => self.unsent = None,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.raw_os_error() == Some(ENOBUFS) => {
                    let now = self.now();
                    if now >= *since + FULL {
                        return Err(Error::Link(format!(
                            "{}: no frame leaves the interface; is another node on the bus, at this \
                             bit rate, and is the bus terminated?",
                            self.name
                        )));
                    }
                    if now >= until {
                        return Ok(false);
                    }
                    std::thread::sleep(Duration::from_millis(1));
                }
                Err(error) => return Err(self.lost(&error)),
            }
        }
        Ok(true)
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
            match self.socket.read_frame_with_timestamps() {
                Ok((frame, stamps)) => {
                    if let Some(frame) = taken(&frame) {
                        // Stamps are in the time of day, which may be set at any time.
                        let age = stamps.socket.and_then(|stamp| stamp.elapsed().ok());
                        let at = self.start.elapsed().saturating_sub(age.unwrap_or_default());
                        let at = Instant::ZERO + at;
                        return Ok(Some(Heard { at, frame }));
                    }
                }
                // A frame of CAN FD.
                Err(error) if error.kind() == ErrorKind::InvalidData => {}
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

/// The frame, unless it is an error message of the controller.
fn taken(frame: &CanFrame) -> Option<Frame> {
    let id = match frame.id() {
        socketcan::Id::Standard(id) => CanId::standard(id.as_raw()),
        socketcan::Id::Extended(id) => CanId::extended(id.as_raw()),
    };
    match frame {
        CanFrame::Data(frame) => Frame::new(id, frame.data()),
        CanFrame::Remote(frame) => Frame::remote(id, u8::try_from(frame.dlc()).ok()?),
        CanFrame::Error(_) => None,
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
