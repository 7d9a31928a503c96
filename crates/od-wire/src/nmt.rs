//! NMT commands, and the state byte of boot-up, heartbeat and guarding (CiA 301, chapters 7.2.8 and 7.3.2).

use core::fmt;

/// The NMT commands.
///
/// ```
/// use od_wire::nmt::Command;
///
/// assert_eq!(Command::from_code(0x81), Some(Command::ResetNode));
/// ```
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(u8)]
pub enum Command {
    /// Start remote node: to Operational.
    Start = 0x01,
    /// Stop remote node: to Stopped.
    Stop = 0x02,
    /// Enter Pre-operational.
    EnterPreOperational = 0x80,
    /// Reset node.
    ResetNode = 0x81,
    /// Reset communication.
    ResetCommunication = 0x82,
}

impl Command {
    /// Returns the command with this specifier; `None` for other numbers.
    pub const fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0x01 => Self::Start,
            0x02 => Self::Stop,
            0x80 => Self::EnterPreOperational,
            0x81 => Self::ResetNode,
            0x82 => Self::ResetCommunication,
            _ => return None,
        })
    }
}

/// The states of an NMT slave (CiA 301, chapter 7.3.2.1); the number is the one in a heartbeat.
///
/// ```
/// use od_wire::nmt::State;
///
/// assert_eq!(State::from_code(0x7F), Some(State::PreOperational));
/// ```
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(u8)]
pub enum State {
    /// Between reset and boot-up; as a heartbeat it is the boot-up message.
    Initialising = 0x00,
    /// Only NMT, error control and LSS.
    Stopped = 0x04,
    /// All services, including PDOs.
    Operational = 0x05,
    /// All services except PDOs.
    PreOperational = 0x7F,
}

impl State {
    /// Returns the state with this number; `None` for other numbers.
    pub const fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0x00 => Self::Initialising,
            0x04 => Self::Stopped,
            0x05 => Self::Operational,
            0x7F => Self::PreOperational,
            _ => return None,
        })
    }

    /// Returns the name in the standard.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Initialising => "Initialising",
            Self::Stopped => "Stopped",
            Self::Operational => "Operational",
            Self::PreOperational => "Pre-operational",
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// NMT message (CAN-ID 000h): a command for one node or for all.
///
/// ```
/// use od_wire::nmt::{Command, Repr};
///
/// // Node 0 addresses all nodes.
/// let start = Repr { command: Command::Start, node: 0 };
/// assert_eq!(start.emit(), [1, 0]);
/// assert_eq!(Repr::parse(&[1, 0]), Some(start));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Repr {
    /// The command.
    pub command: Command,
    /// The node ID, 0 for every node.
    pub node: u8,
}

impl Repr {
    /// Reads the data of a frame; `None` unless it is a valid command and one further byte.
    pub fn parse(data: &[u8]) -> Option<Self> {
        let &[command, node] = data else { return None };
        Some(Self {
            command: Command::from_code(command)?,
            node,
        })
    }

    /// Returns the data of the frame.
    pub const fn emit(self) -> [u8; 2] {
        [self.command as u8, self.node]
    }
}
