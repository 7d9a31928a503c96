//! A concise DCF: the writes that configure a node, as 1F22h has them (CiA 302-2).

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::node::Node;
use crate::description::Value;
use crate::span::Spanned;
use od_model::{Address, DataType, Kind};

/// One write to an object of a node.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Write {
    /// The object.
    pub address: Address,
    /// Its value, as an SDO carries it.
    pub data: Vec<u8>,
}

impl Write {
    /// A write of a number of this type.
    ///
    /// # Errors
    /// The number is not one of the type, or the type has no numbers; in words.
    pub fn new(address: Address, data_type: DataType, number: i128) -> Result<Self, String> {
        let refused = || format!("{address}: {number} is not a valid {}", data_type.name());
        let data = match (
            data_type.kind(),
            data_type.integer_range(),
            data_type.size(),
        ) {
            (Kind::Real, _, Some(4)) => (number as f32).to_le_bytes().to_vec(),
            (Kind::Real, ..) => (number as f64).to_le_bytes().to_vec(),
            // dcfgen gives a BOOLEAN the 8 bits that it has in an SDO.
            (Kind::Boolean, ..) => u8::try_from(number)
                .map(|byte| [byte].to_vec())
                .map_err(|_| refused())?,
            (_, Some((low, high)), Some(size)) if (low..=high).contains(&number) => {
                number.to_le_bytes()[..size].to_vec()
            }
            _ => return Err(refused()),
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

impl Node {
    /// The write of a number to an object of this node, by the object's type.
    ///
    /// # Errors
    /// The object does not exist, or the number is not valid; in words.
    pub(super) fn write(&self, index: u16, sub: u8, number: i128) -> Result<Write, String> {
        let address = Address::new(index, sub);
        let name = &self.name;
        let data_type = match self.description.entry(address) {
            Some(entry) => entry.data_type.map(|data_type| *data_type),
            // A record whose count is not in the file.
            None if sub == 0 && self.has(index) => Some(DataType::Unsigned8),
            None => return Err(format!("{name}: object {address} does not exist")),
        };
        let data_type =
            data_type.ok_or_else(|| format!("{name}: {address} has no valid DataType"))?;
        Write::new(address, data_type, number).map_err(|why| format!("{name}: {why}"))
    }

    /// Gives the objects the values that the writes leave in them.
    pub fn apply(&mut self) {
        for write in &self.writes {
            let Address { index, sub } = write.address;
            let object = self.description.objects.get_mut(&index);
            let entry = object.and_then(|object| object.entries.get_mut(&sub));
            let Some(entry) = entry else { continue };
            if let Some(data_type) = entry.data_type {
                let value = Value::from_wire(*data_type, write.data.clone());
                entry.parameter = Some(Spanned::from(value));
            }
        }
    }
}
