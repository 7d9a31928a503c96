//! Frames by name: `nmt start`, `guard`, `read 1017h`, `write 1017h = 500`.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, DataType, Dictionary, Refused, values};
use od_runtime::{Frame, NodeId};
use od_wire::nmt::{Command, Repr};
use od_wire::sdo::Request;

use super::problem::Problem;
use super::tokens::Tokens;
use crate::device::VirtualDevice;

/// A frame by name; its bytes may depend on the current device.
#[derive(Clone, PartialEq, Debug)]
pub enum NamedFrame {
    /// By its CAN-ID and bytes.
    Frame(Frame),
    /// NMT command to a node, 0 for all; `None`: to the current device.
    Nmt(Command, Option<u8>),
    /// Node guarding request.
    Guard,
    /// SDO upload request.
    Read(String),
    /// SDO download request, expedited.
    Write(Write),
}

/// A value for an object.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Write {
    /// Address or name.
    pub object: String,
    /// The text as written.
    pub value: String,
    /// The type in `as u16` …; `None`: that of the object.
    pub data_type: Option<DataType>,
}

impl NamedFrame {
    /// Returns the frame for this device.
    ///
    /// # Errors
    /// Like [`frame`](Self::frame).
    pub(crate) fn of(&self, device: &VirtualDevice) -> Result<Frame, Refused> {
        self.frame(device.node_id(), device.dictionary())
    }

    /// Returns the frame for a node with this dictionary.
    ///
    /// # Errors
    /// The object does not exist, or the value is invalid.
    pub fn frame(&self, node: NodeId, dictionary: Dictionary<'_>) -> Result<Frame, Refused> {
        let request = match self {
            Self::Frame(frame) => return Ok(*frame),
            Self::Nmt(command, to) => {
                let node = to.unwrap_or(node.raw());
                let command = *command;
                return Ok(Frame::standard(0, &Repr { command, node }.emit()));
            }
            Self::Guard => {
                let frame = Frame::remote(node.plus(0x700), 1);
                return frame.ok_or_else(|| "a remote frame has 0 to 8 bytes".into());
            }
            Self::Read(object) => {
                let (address, _) = resolve(dictionary, object)?;
                Request::InitiateUpload { address }
            }
            Self::Write(write) => {
                let (address, bytes) = write.bytes(dictionary)?;
                let len = bytes.len();
                let mut data = [0; 4];
                match data.get_mut(..len).filter(|data| !data.is_empty()) {
                    Some(data) => data.copy_from_slice(&bytes),
                    None => {
                        return Err(format!(
                            "an expedited download has 1 to 4 bytes, not {len}; write `sdo write …`"
                        )
                        .into());
                    }
                }
                Request::InitiateDownload {
                    address,
                    size: Some(len as u32),
                    expedited: Some(data),
                }
            }
        };
        Ok(Frame::full(node.plus(0x600), request.emit()))
    }
}

impl Write {
    /// Returns the address and the bytes of a value for the device, with the type from its dictionary.
    ///
    /// # Errors
    /// The object does not exist, or the value is invalid.
    pub(crate) fn own(&self, dictionary: Dictionary<'_>) -> Result<(Address, Vec<u8>), Refused> {
        let entry = values::find(dictionary, &self.object)?;
        let bytes = values::parse(entry.data_type, &self.value);
        let label = || values::label(dictionary, entry.address);
        let bytes = bytes.map_err(|why| format!("{}: {why}", label()))?;
        Ok((entry.address, bytes))
    }

    /// Returns the address and the bytes to write.
    ///
    /// # Errors
    /// Reason why the value cannot be written.
    pub fn bytes(&self, dictionary: Dictionary<'_>) -> Result<(Address, Vec<u8>), Refused> {
        let (address, own) = resolve(dictionary, &self.object)?;
        let data_type = self.data_type.or(own).unwrap_or(DataType::Unsigned32);
        Ok((address, values::parse(data_type, &self.value)?))
    }
}

/// Returns an object by address, even if the dictionary lacks it, or by name.
///
/// # Errors
/// The object does not exist.
pub fn resolve(
    dictionary: Dictionary<'_>,
    object: &str,
) -> Result<(Address, Option<DataType>), Refused> {
    match (values::find(dictionary, object), values::address(object)) {
        (Ok(entry), _) => Ok((entry.address, Some(entry.data_type))),
        (Err(_), Some(address)) => Ok((address, None)),
        (Err(why), None) => Err(why),
    }
}

/// `6001h = 4096 as u32`.
pub(super) fn write(tokens: &mut Tokens<'_>) -> Result<Write, Problem> {
    let object = match tokens.split_at_equals() {
        Some(object) if !object.is_empty() => object.rest().to_owned(),
        _ => return Err(tokens.wrong("the object is missing")),
    };
    let value = tokens.split_at_word(&["as"]);
    if value.is_empty() {
        return Err(tokens.wrong("the value is missing"));
    }
    let data_type = if tokens.take("as") {
        Some(type_named(tokens)?)
    } else {
        None
    };
    tokens.end()?;
    Ok(Write {
        object,
        value: value.rest().to_owned(),
        data_type,
    })
}

/// `u16`, `i8`, `UNSIGNED16` …
fn type_named(tokens: &mut Tokens<'_>) -> Result<DataType, Problem> {
    let here = *tokens;
    let name = tokens.next();
    let short = |data_type: &DataType| {
        let long = data_type.name();
        let short = long
            .replace("UNSIGNED", "u")
            .replace("INTEGER", "i")
            .replace("BOOLEAN", "bool");
        short.eq_ignore_ascii_case(name) || long.eq_ignore_ascii_case(name)
    };
    let message = || format!("type `{name}` does not exist");
    let found = DataType::ALL.into_iter().find(short);
    found.ok_or_else(|| here.problem(message(), "write u8, u16, u32, i16 …"))
}
