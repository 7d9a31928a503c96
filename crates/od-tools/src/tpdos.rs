//! The TPDOs that a node has at present, read from its parameters (CiA 301, chapters 7.5.2.37 and 7.5.2.38).

use od_model::{Address, TransmissionType};
use od_wire::{CanId, CobId};

/// Number of TPDOs of which each is asked for. TPDOs after a later gap are rare, and reading all 512 takes seconds.
const COMMON: u16 = 4;

/// A valid TPDO of a node.
///
/// ```
/// use od_tools::tpdos::read;
/// use od_model::Address;
///
/// // 1800h:01 is 181h, and 1A00h has one entry; the node has no other TPDO.
/// let found = read(|Address { index, sub }| {
///     Ok::<_, ()>(match (index, sub) {
///         (0x1800, 1) => Some(0x181),
///         (0x1A00, 0) => Some(1),
///         (0x1A00, 1) => Some(0x6004_0020),
///         _ => None,
///     })
/// });
/// let tpdo = &found.expect("the TPDOs")[0];
/// assert_eq!((tpdo.number, tpdo.mapping.as_slice()), (1, &[0x6004_0020][..]));
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Tpdo {
    /// Its number, from 1.
    pub number: u16,
    /// Its CAN-ID.
    pub id: CanId,
    /// Its transmission type; `None` if the node does not have it.
    pub transmission: Option<TransmissionType>,
    /// Its mapping entries, as in 1A00h.
    pub mapping: Vec<u32>,
}

/// Reads the valid TPDOs of a node. `number` reads a number of the node; `None` if the node does not have it.
///
/// # Errors
/// Those of `number`.
pub fn read<E>(mut number: impl FnMut(Address) -> Result<Option<u32>, E>) -> Result<Vec<Tpdo>, E> {
    let mut found = Vec::new();
    for at in 0..0x200_u16 {
        let (communication, mapping) = (0x1800 + at, 0x1A00 + at);
        let Some(cob_id) = number(Address::new(communication, 1))?.map(CobId::new) else {
            if at < COMMON {
                continue;
            }
            break;
        };
        if !cob_id.is_valid() {
            continue;
        }
        let transmission = number(Address::new(communication, 2))?;
        let transmission = transmission.and_then(|raw| u8::try_from(raw).ok());
        let count = number(Address::new(mapping, 0))?.unwrap_or(0);
        let mut entries = Vec::new();
        for sub in 1..=count.min(64) as u8 {
            entries.extend(number(Address::new(mapping, sub))?);
        }
        found.push(Tpdo {
            number: at + 1,
            id: cob_id.can_id(),
            transmission: transmission.map(TransmissionType::new),
            mapping: entries,
        });
    }
    Ok(found)
}
