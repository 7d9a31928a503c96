//! Facts about a node: its dictionary, and its TPDOs.

use od_client::pdo::{Mapping, decode};
use od_eds::{Description, Tables};
use od_model::{Address, DataType, Dictionary, values};
use od_wire::{CanId, CobId};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A TPDO of a node.
#[derive(Clone)]
pub(crate) struct Tpdo {
    pub(crate) node: u8,
    /// From 1.
    pub(crate) number: u16,
    pub(crate) id: CanId,
    pub(crate) mapping: Vec<u32>,
}

/// A value in a PDO: address, name, type, bits, bytes.
pub(crate) struct Field {
    pub(crate) address: Address,
    pub(crate) name: String,
    pub(crate) data_type: Option<DataType>,
    pub(crate) bits: u8,
    pub(crate) bytes: Vec<u8>,
}

/// The dictionary of a node.
pub(crate) struct Known {
    tables: Tables,
}

impl Known {
    pub(crate) fn new(description: &Description) -> Self {
        Self {
            tables: Tables::new(description),
        }
    }

    pub(crate) fn dictionary(&self) -> Dictionary<'_> {
        self.tables.dictionary()
    }

    /// The type of an object; `None` if the description lacks it.
    pub(crate) fn type_of(&self, address: Address) -> Option<DataType> {
        let entry = self.dictionary().find(address).ok()?;
        Some(entry.data_type)
    }

    /// The TPDOs by the description: the valid ones, with their default mapping.
    pub(crate) fn tpdos(&self, node: u8) -> Vec<Tpdo> {
        let dictionary = self.dictionary();
        let one = |number: u16| {
            let cob_id = dictionary
                .entry(0x1800 + number, 1)?
                .default
                .integer(node)?;
            let mapping = Mapping::of(&dictionary, 0x1A00 + number)?;
            Some(Tpdo {
                node,
                number: number + 1,
                id: can_id(u32::try_from(cob_id).ok()?)?,
                mapping: mapping.entries().to_vec(),
            })
        };
        (0..0x200).filter_map(one).collect()
    }
}

/// The CAN-ID of a COB-ID; `None` if the PDO is not valid.
fn can_id(cob_id: u32) -> Option<CanId> {
    let cob_id = CobId::new(cob_id);
    cob_id.is_valid().then(|| cob_id.can_id())
}

/// The values in a PDO; empty if it is shorter than its mapping.
pub(crate) fn fields(known: Option<&Known>, tpdo: &Tpdo, data: &[u8]) -> Vec<Field> {
    let dictionary = known.map_or(Dictionary::EMPTY, |known| known.dictionary());
    let Ok(fields) = decode(&dictionary, &tpdo.mapping, data) else {
        return Vec::new();
    };
    fields
        .filter(|field| !field.is_dummy())
        .map(|field| Field {
            address: field.address,
            name: match &field.entry {
                Some(entry) => values::name(dictionary, entry),
                None => field.address.to_string(),
            },
            data_type: field.data_type(),
            bits: field.bits,
            bytes: field.bytes()[..field.len()].to_vec(),
        })
        .collect()
}

/// The address of `0x6004`, `"1018h:02"`, or of a name if the node has a description.
///
/// # Errors
/// `ValueError`: the name is not known, or it is another kind of key.
pub(crate) fn address(
    known: Option<&Known>,
    object: &Bound<'_, PyAny>,
    sub: u8,
) -> PyResult<Address> {
    if let Ok(index) = object.extract::<u16>() {
        return Ok(Address::new(index, sub));
    }
    if let Ok((index, sub)) = object.extract::<(u16, u8)>() {
        return Ok(Address::new(index, sub));
    }
    let text: String = object.extract()?;
    match (known, values::address(&text)) {
        (_, Some(address)) => Ok(address),
        (Some(known), None) => values::find(known.dictionary(), &text)
            .map(|entry| entry.address)
            .map_err(|why| crate::faults::Fault::from(why).into()),
        (None, None) => Err(PyValueError::new_err(format!(
            "`{text}` is a name, and the node has no description; give it one: `client.node(5, \"drive.eds\")`"
        ))),
    }
}
