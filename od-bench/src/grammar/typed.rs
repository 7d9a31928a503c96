//! Frames by name: `nmt start`, `guard`, `read 1017h`, `write 1017h = 500`.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, DataType, Dictionary, values};
use od_runtime::Frame;
use od_wire::nmt::{Command, Repr};
use od_wire::sdo::Request;

use crate::device::VirtualDevice;

/// A frame as a line names it; its bytes may depend on the present device.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Typed {
    Frame(Frame),
    /// To a node, 0 for all; `None`: to the present device.
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
pub(crate) struct Write {
    pub(crate) object: String,
    pub(crate) value: String,
    /// `u16` …; `None`: that of the object.
    pub(crate) type_name: Option<String>,
}

impl Typed {
    /// The frame, for this device.
    ///
    /// # Errors
    /// The object does not exist, or the value is not valid.
    pub(crate) fn frame(&self, device: &VirtualDevice) -> Result<Frame, String> {
        let node = device.node_id();
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
                let (address, _) = resolve(device.dictionary(), object)?;
                Request::InitiateUpload { address }
            }
            Self::Write(write) => {
                let (address, bytes) = write.bytes(device.dictionary())?;
                let len = bytes.len();
                let mut data = [0; 4];
                match data.get_mut(..len).filter(|data| !data.is_empty()) {
                    Some(data) => data.copy_from_slice(&bytes),
                    None => {
                        return Err(format!(
                            "an expedited download has 1 to 4 bytes, not {len}; write `sdo write …`"
                        ));
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
    /// Returns the address and the bytes of a value that the device takes, typed by its dictionary.
    ///
    /// # Errors
    /// The object does not exist, or the value is not valid.
    pub(crate) fn own(&self, dictionary: Dictionary<'_>) -> Result<(Address, Vec<u8>), String> {
        let entry = values::find(dictionary, &self.object)?;
        let bytes = values::parse(entry.data_type, &self.value);
        let label = || values::label(dictionary, entry.address);
        let bytes = bytes.map_err(|why| format!("{}: {why}", label()))?;
        Ok((entry.address, bytes))
    }

    /// Returns the address and the bytes to write.
    ///
    /// # Errors
    /// Reason why it cannot be written.
    pub(crate) fn bytes(&self, dictionary: Dictionary<'_>) -> Result<(Address, Vec<u8>), String> {
        let (address, own) = resolve(dictionary, &self.object)?;
        let data_type = match &self.type_name {
            Some(name) => type_named(name)?,
            None => own.unwrap_or(DataType::Unsigned32),
        };
        Ok((address, values::parse(data_type, &self.value)?))
    }
}

/// An object by address, whether the device has it or not, or by name.
pub(crate) fn resolve(
    dictionary: Dictionary<'_>,
    object: &str,
) -> Result<(Address, Option<DataType>), String> {
    match (values::find(dictionary, object), values::address(object)) {
        (Ok(entry), _) => Ok((entry.address, Some(entry.data_type))),
        (Err(_), Some(address)) => Ok((address, None)),
        (Err(why), None) => Err(why.into()),
    }
}

/// `u16`, `i8`, `UNSIGNED16` …
fn type_named(name: &str) -> Result<DataType, String> {
    let short = |data_type: &DataType| {
        let long = data_type.name();
        let short = long
            .replace("UNSIGNED", "u")
            .replace("INTEGER", "i")
            .replace("BOOLEAN", "bool");
        short.eq_ignore_ascii_case(name) || long.eq_ignore_ascii_case(name)
    };
    DataType::ALL
        .into_iter()
        .find(short)
        .ok_or_else(|| format!("type `{name}` does not exist; write u8, u16, u32, i16 …"))
}
