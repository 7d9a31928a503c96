//! LSS frames (CiA 305): 7E5h from the master, 7E4h from the slave, eight bytes each.

/// CAN-ID of the master's frames.
pub const MASTER: u16 = 0x7E5;
/// CAN-ID of the slaves' frames.
pub const SLAVE: u16 = 0x7E4;

/// Returns the bit rate in kbit/s at an index of the standard bit timing table; `None` for
/// index 5, which is reserved, and above 8 (CiA 305, chapter 6.4.3).
pub const fn kbit(index: u8) -> Option<u16> {
    Some(match index {
        0 => 1000,
        1 => 800,
        2 => 500,
        3 => 250,
        4 => 125,
        6 => 50,
        7 => 20,
        8 => 10,
        _ => return None,
    })
}

/// The four numbers of the LSS address, in the order of 1018h.
///
/// ```
/// use od_wire::lss::Part;
///
/// assert_eq!(Part::ALL.map(|part| part as u8), [0, 1, 2, 3]);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(u8)]
pub enum Part {
    /// 1018h:01.
    Vendor = 0,
    /// 1018h:02.
    Product = 1,
    /// 1018h:03.
    Revision = 2,
    /// 1018h:04.
    Serial = 3,
}

impl Part {
    /// All four, in order.
    pub const ALL: [Self; 4] = [Self::Vendor, Self::Product, Self::Revision, Self::Serial];

    fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0 => Self::Vendor,
            1 => Self::Product,
            2 => Self::Revision,
            3 => Self::Serial,
            _ => return None,
        })
    }
}

/// Frame of an LSS master.
///
/// ```
/// use od_wire::lss::Request;
///
/// let request = Request::SwitchGlobal { configuration: true };
/// assert_eq!(request.emit(), [0x04, 1, 0, 0, 0, 0, 0, 0]);
/// assert_eq!(Request::parse(&request.emit()), Some(request));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs)] // the fields are the protocol's own
pub enum Request {
    /// 04h: switch state global, to configuration or back to waiting.
    SwitchGlobal { configuration: bool },
    /// 11h: configure node ID.
    ConfigureNodeId { node_id: u8 },
    /// 13h: configure bit timing.
    ConfigureBitTiming { table: u8, index: u8 },
    /// 15h: activate bit timing after a delay in ms.
    ActivateBitTiming { delay_ms: u16 },
    /// 17h: store configuration.
    Store,
    /// 40h–43h: switch state selective.
    SwitchSelective { part: Part, value: u32 },
    /// 46h–4Bh: identify remote slave; the step is 0–5.
    IdentifyRemote { step: u8, value: u32 },
    /// 4Ch: identify non-configured remote slave.
    IdentifyNonConfigured,
    /// 51h: fastscan. `next` is the part that is scanned after this one.
    Fastscan {
        number: u32,
        bit: u8,
        part: u8,
        next: u8,
    },
    /// 5Ah–5Dh: inquire a number of the LSS address.
    Inquire { part: Part },
    /// 5Eh: inquire node ID.
    InquireNodeId,
}

impl Request {
    /// Reads the bytes of a frame; `None` unless there are eight and the first is known.
    pub fn parse(data: &[u8]) -> Option<Self> {
        let &[command, a, b, c, d, e, f, g] = data else {
            return None;
        };
        let value = u32::from_le_bytes([a, b, c, d]);
        Some(match command {
            0x04 => match a {
                0 | 1 => Self::SwitchGlobal {
                    configuration: a == 1,
                },
                _ => return None,
            },
            0x11 => Self::ConfigureNodeId { node_id: a },
            0x13 => Self::ConfigureBitTiming { table: a, index: b },
            0x15 => Self::ActivateBitTiming {
                delay_ms: u16::from_le_bytes([a, b]),
            },
            0x17 => Self::Store,
            0x40..=0x43 => Self::SwitchSelective {
                part: Part::from_code(command - 0x40)?,
                value,
            },
            0x46..=0x4B => Self::IdentifyRemote {
                step: command - 0x46,
                value,
            },
            0x4C => Self::IdentifyNonConfigured,
            0x51 => Self::Fastscan {
                number: value,
                bit: e,
                part: f,
                next: g,
            },
            0x5A..=0x5D => Self::Inquire {
                part: Part::from_code(command - 0x5A)?,
            },
            0x5E => Self::InquireNodeId,
            _ => return None,
        })
    }

    /// The bytes of the master's frame.
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::SwitchGlobal { configuration } => with(0x04, configuration.into()),
            Self::ConfigureNodeId { node_id } => with(0x11, node_id.into()),
            Self::ConfigureBitTiming { table, index } => {
                with(0x13, u16::from_le_bytes([table, index]).into())
            }
            Self::ActivateBitTiming { delay_ms } => with(0x15, delay_ms.into()),
            Self::Store => with(0x17, 0),
            Self::SwitchSelective { part, value } => with(0x40 + part as u8, value),
            Self::IdentifyRemote { step, value } => with(0x46 + step.min(5), value),
            Self::IdentifyNonConfigured => with(0x4C, 0),
            Self::Fastscan {
                number,
                bit,
                part,
                next,
            } => {
                let [command, a, b, c, d, ..] = with(0x51, number);
                [command, a, b, c, d, bit, part, next]
            }
            Self::Inquire { part } => with(0x5A + part as u8, 0),
            Self::InquireNodeId => with(0x5E, 0),
        }
    }
}

/// Frame of an LSS slave.
///
/// ```
/// use od_wire::lss::Response;
///
/// let response = Response::parse(&[0x5E, 5, 0, 0, 0, 0, 0, 0]);
/// assert_eq!(response, Some(Response::NodeId { node_id: 5 }));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs)] // the fields are the protocol's own
pub enum Response {
    /// 44h: the slave is in the configuration state now. Byte 1 is reserved in CiA 305; some
    /// devices send the state in it.
    Selected { state: u8 },
    /// 11h, 13h, 17h: success (0), or an error code.
    Configured { command: u8, error: u8 },
    /// 4Fh: a slave with this LSS address exists.
    Identified,
    /// 50h: a slave without a node ID exists.
    NonConfigured,
    /// 5Ah–5Dh: a number of the LSS address.
    Number { part: Part, value: u32 },
    /// 5Eh: the node ID.
    NodeId { node_id: u8 },
}

impl Response {
    /// Reads the bytes of a frame; `None` unless there are eight and the first is known.
    pub fn parse(data: &[u8]) -> Option<Self> {
        let &[command, a, b, c, d, _, _, _] = data else {
            return None;
        };
        Some(match command {
            0x44 => Self::Selected { state: a },
            0x11 | 0x13 | 0x17 => Self::Configured { command, error: a },
            0x4F => Self::Identified,
            0x50 => Self::NonConfigured,
            0x5A..=0x5D => Self::Number {
                part: Part::from_code(command - 0x5A)?,
                value: u32::from_le_bytes([a, b, c, d]),
            },
            0x5E => Self::NodeId { node_id: a },
            _ => return None,
        })
    }

    /// The bytes of the slave's frame.
    pub fn emit(self) -> [u8; 8] {
        match self {
            Self::Selected { state } => with(0x44, state.into()),
            Self::Configured { command, error } => with(command, error.into()),
            Self::Identified => with(0x4F, 0),
            Self::NonConfigured => with(0x50, 0),
            Self::Number { part, value } => with(0x5A + part as u8, value),
            Self::NodeId { node_id } => with(0x5E, node_id.into()),
        }
    }
}

/// The bytes of a command with a number.
fn with(command: u8, number: u32) -> [u8; 8] {
    let [a, b, c, d] = number.to_le_bytes();
    [command, a, b, c, d, 0, 0, 0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_survives_a_round_trip() {
        for command in 0..=0xFF {
            let bytes = [command, 1, 0, 0, 0, 0, 0, 0];
            if let Some(request) = Request::parse(&bytes) {
                assert_eq!(
                    Request::parse(&request.emit()),
                    Some(request),
                    "{command:02X}"
                );
            }
            if let Some(response) = Response::parse(&bytes) {
                assert_eq!(
                    Response::parse(&response.emit()),
                    Some(response),
                    "{command:02X}"
                );
            }
        }
        assert_eq!(
            Request::parse(&[0x04, 1]),
            None,
            "eight bytes, CiA 305 says"
        );
    }
}
