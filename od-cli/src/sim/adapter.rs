//! What stands between a client's bytes and the bus's frames.

use od_bench::links::{Step, can_frame, slcan, socketcand};
use od_bench::logs::candump;
use od_runtime::{Frame, Instant};

/// What a client speaks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Slcan,
    Socketcand,
    /// `struct can_frame` of Linux.
    CanFrame,
    /// Lines of the script language in, a candump log out.
    Lines,
}

impl Kind {
    /// How long a message is, where it has to be written in one piece.
    pub(super) fn message_len(self) -> Option<usize> {
        (self == Self::CanFrame).then_some(can_frame::SIZE)
    }
}

/// Texts of a frame that several clients get alike.
pub(super) const FORMS: usize = 5;

/// One client's adapter.
pub(super) enum Adapter {
    Slcan(slcan::Channel),
    Socketcand(Box<socketcand::Session>),
    CanFrame,
    /// A line that has not ended yet.
    Lines(Vec<u8>),
}

/// What the adapter makes of bytes.
pub(super) enum Taken {
    Step(Step),
    /// A line for the console.
    Line(String),
}

/// The longest line that a console takes.
const LONGEST: usize = 4096;

impl Adapter {
    pub(super) fn new(kind: Kind) -> Self {
        match kind {
            Kind::Slcan => Self::Slcan(slcan::Channel::default()),
            Kind::Socketcand => Self::Socketcand(Box::default()),
            Kind::CanFrame => Self::CanFrame,
            Kind::Lines => Self::Lines(Vec::new()),
        }
    }

    /// What a client hears first.
    pub(super) fn hello(&self) -> &'static [u8] {
        match self {
            Self::Socketcand(_) => socketcand::Session::HELLO,
            _ => b"",
        }
    }

    pub(super) fn receive(&mut self, bytes: &[u8], now: Instant) -> Vec<Taken> {
        let mut steps = Vec::new();
        match self {
            Self::Slcan(channel) => channel.receive(bytes, &mut steps),
            Self::Socketcand(session) => session.receive(bytes, now, &mut steps),
            Self::CanFrame => steps.extend(can_frame::decode(bytes).map(Step::Frame)),
            Self::Lines(line) => return lines(line, bytes),
        }
        steps.into_iter().map(Taken::Step).collect()
    }

    /// Which of the shared texts this client gets, where it gets one.
    pub(super) fn form(&self) -> Option<usize> {
        match self {
            Self::Slcan(channel) if channel.is_open() => Some(usize::from(channel.stamps())),
            Self::Slcan(_) => None,
            Self::Socketcand(session) => session.is_raw().then_some(2),
            Self::CanFrame => Some(3),
            Self::Lines(_) => Some(4),
        }
    }

    /// The frame as this client gets it. `epoch` is the time of day at the origin of time,
    /// in microseconds.
    pub(super) fn encode(&mut self, frame: &Frame, now: Instant, epoch: u64, out: &mut Vec<u8>) {
        match self {
            Self::Slcan(channel) => channel.encode(frame, now.as_micros() / 1000, out),
            Self::Socketcand(session) => session.encode(frame, now, epoch + now.as_micros(), out),
            Self::CanFrame => can_frame::encode(frame, out),
            Self::Lines(_) => {
                out.extend_from_slice(candump::format_line(now, "can0", frame).as_bytes());
                out.push(b'\n');
            }
        }
    }

    /// When [`wake`](Self::wake) is due.
    pub(super) fn deadline(&self) -> Option<Instant> {
        match self {
            Self::Socketcand(session) => session.deadline(),
            _ => None,
        }
    }

    pub(super) fn wake(&mut self, now: Instant, epoch: u64) -> Vec<Taken> {
        let mut steps = Vec::new();
        if let Self::Socketcand(session) = self {
            session.wake(now, epoch + now.as_micros(), &mut steps);
        }
        steps.into_iter().map(Taken::Step).collect()
    }

    /// The end of what the client says: a last line need not end.
    pub(super) fn finish(&mut self) -> Vec<Taken> {
        match self {
            Self::Lines(line) if !line.is_empty() => lines(line, b"\n"),
            _ => Vec::new(),
        }
    }
}

fn lines(line: &mut Vec<u8>, bytes: &[u8]) -> Vec<Taken> {
    let mut taken = Vec::new();
    for byte in bytes {
        match byte {
            b'\n' => {
                taken.push(Taken::Line(String::from_utf8_lossy(line).into_owned()));
                line.clear();
            }
            // The rest of a longer line would say something else than the whole.
            _ if line.len() > LONGEST => {}
            _ => line.push(*byte),
        }
    }
    taken
}
