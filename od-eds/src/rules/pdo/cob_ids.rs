//! The COB-IDs of a device that are in use.

use od_model::Address;

use crate::description::{Description, Value};
use crate::finding::{Finding, Rule};
use crate::rules::pdo::shared::is_communication;
use crate::span::Span;
use crate::subject::{Entry, Object, start_value};

/// The bit of a COB-ID that says "not valid"; of 1005h and 1012h it says "producer".
const INVALID: u32 = 1 << 31;
/// The bit that says 29-bit identifier.
const EXTENDED: u32 = 1 << 29;

/// A COB-ID that is valid.
pub(super) struct CobId<'a> {
    pub(super) entry: Entry<'a>,
    pub(super) span: Span,
    /// With the flags in bits 29 to 31.
    pub(super) value: u32,
    /// Without them.
    pub(super) identifier: u32,
    pub(super) extended: bool,
    /// Does it depend on the node ID?
    pub(super) formula: bool,
}

impl CobId<'_> {
    /// Does the identifier have more bits than bit 29 says?
    pub(super) const fn is_too_long(&self) -> bool {
        !self.extended && self.identifier > 0x7FF
    }

    /// Is it an identifier that CiA 301 keeps for another service?
    pub(super) const fn is_restricted(&self) -> bool {
        !self.extended && !self.formula && od_model::is_restricted(self.identifier)
    }

    /// Is it the COB-ID of a PDO that can be used?
    pub(super) const fn is_pdo(&self) -> bool {
        self.entry.address.sub == 1 && !self.is_too_long() && !self.is_restricted()
    }

    /// A finding about it.
    pub(super) fn finding(&self, rule: &'static Rule) -> Finding {
        rule.on(&self.entry, self.span)
    }
}

/// The valid COB-IDs of SYNC, TIME, EMCY and the PDOs.
pub(super) fn cob_ids(description: &Description) -> impl Iterator<Item = CobId<'_>> {
    let pdos = description
        .objects
        .range(0x1400..=0x19FF)
        .map(|(index, _)| *index);
    let pdos = pdos.filter(|index| is_communication(*index));
    let addresses = [0x1005, 0x1012, 0x1014].map(|index| Address::new(index, 0));
    let addresses = addresses
        .into_iter()
        .chain(pdos.map(|index| Address::new(index, 1)));
    addresses.filter_map(|address| {
        let object = Object::of(description, address.index)?;
        let entry = object.entries().find(|entry| entry.address == address)?;
        let value = start_value(entry.entry)?;
        let (number, formula) = match value.value {
            Value::Unsigned(number) => (u32::try_from(number).ok()?, false),
            Value::NodeId(offset) => (offset, true),
            _ => return None,
        };
        let span = value.span.or(entry.span);
        let valid = number & INVALID == 0 || matches!(address.index, 0x1005 | 0x1012);
        valid.then_some(CobId {
            entry,
            span,
            value: number,
            identifier: number & 0x1FFF_FFFF,
            extended: number & EXTENDED != 0,
            formula,
        })
    })
}
