//! A concise DCF: the writes that configure a node, in the form of 1F22h (CiA 302-3).

use alloc::format;
use alloc::vec::Vec;

use od_model::{Address, DataType, Kind, Refused};

/// One write to an object of a node.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Write {
    /// The object.
    pub address: Address,
    /// Its value, in the encoding of an SDO.
    pub data: Vec<u8>,
}

impl Write {
    /// A write of a number of this type.
    ///
    /// # Errors
    /// The number is not valid for the type, or the type has no numbers; in words.
    pub fn new(address: Address, data_type: DataType, number: i128) -> Result<Self, Refused> {
        let refused = || format!("{address}: {number} is not a valid {}", data_type.name());
        let data = match (
            data_type.kind(),
            data_type.integer_range(),
            data_type.size(),
        ) {
            (Kind::Real, _, Some(4)) => (number as f32).to_le_bytes().to_vec(),
            (Kind::Real, ..) => (number as f64).to_le_bytes().to_vec(),
            // dcfgen writes a BOOLEAN with the 8 bits of an SDO.
            (Kind::Boolean, ..) => u8::try_from(number)
                .map(|byte| [byte].to_vec())
                .map_err(|_| refused())?,
            (_, Some((low, high)), Some(size)) if (low..=high).contains(&number) => {
                number.to_le_bytes()[..size].to_vec()
            }
            _ => return Err(refused().into()),
        };
        Ok(Self { address, data })
    }
}

/// The bytes of a concise DCF: the number of writes, then each with its length.
pub fn bytes(writes: &[Write]) -> Vec<u8> {
    let mut out = (writes.len() as u32).to_le_bytes().to_vec();
    for Write { address, data } in writes {
        out.extend(address.index.to_le_bytes());
        out.push(address.sub);
        out.extend((data.len() as u32).to_le_bytes());
        out.extend(data);
    }
    out
}
