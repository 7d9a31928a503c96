//! Writes with the types of a node's objects, and the values after them.

use alloc::format;
use alloc::string::String;

use super::concise::Write;
use super::node::Node;
use crate::description::Value;
use crate::span::Spanned;
use od_model::{Address, DataType};

/// A value that the device of a node cannot have.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Unfit {
    /// The value.
    pub address: Address,
    /// The reason, in words, with the name of the node.
    pub why: String,
}

impl Unfit {
    /// A value that no device can have, for this reason.
    pub(super) fn new(node: &Node, index: u16, sub: u8, why: impl core::fmt::Display) -> Self {
        Self {
            address: Address::new(index, sub),
            why: format!("{}: {why}", node.name),
        }
    }
}

impl Node {
    /// The write of a number to an object of this node, by the object's type.
    ///
    /// # Errors
    /// The object does not exist, or the number is invalid.
    pub(super) fn write(&self, index: u16, sub: u8, number: i128) -> Result<Write, Unfit> {
        let address = Address::new(index, sub);
        let unfit = |why: String| Unfit::new(self, index, sub, why);
        let data_type = match self.description.entry(address) {
            Some(entry) => entry.data_type.map(|data_type| *data_type),
            // A record whose count is not in the file.
            None if sub == 0 && self.has(index) => Some(DataType::Unsigned8),
            None => return Err(unfit(format!("object {address} does not exist"))),
        };
        let data_type =
            data_type.ok_or_else(|| unfit(format!("{address} has no valid DataType")))?;
        Write::new(address, data_type, number).map_err(|why| unfit(format!("{why}")))
    }

    /// Sets the objects to the values after the writes.
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
