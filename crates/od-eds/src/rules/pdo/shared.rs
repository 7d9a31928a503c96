//! Parts of several rules about PDOs: the entries of a mapping.

use alloc::vec::Vec;

use od_model::{Address, DataType, TransmissionType};

use crate::description::Value;
use crate::fact::Fact;
use crate::finding::{Finding, Rule};
use crate::rules::values::shared::DECLARED;
use crate::span::{Span, Spanned};
use crate::subject::{Entry, Object, shown, start_number, start_value};

/// Returns whether this object is the mapping of an RPDO; `None` if it is not a mapping.
pub(crate) const fn maps_rpdo(index: u16) -> Option<bool> {
    match index {
        0x1600..=0x17FF => Some(true),
        0x1A00..=0x1BFF => Some(false),
        _ => None,
    }
}

/// Returns whether this is the communication parameter of a PDO.
pub(crate) const fn is_communication(index: u16) -> bool {
    matches!(index, 0x1400..=0x15FF | 0x1800..=0x19FF)
}

/// The transmission type of a PDO, in the object of its communication parameter.
pub(super) fn transmission_type(object: &Object<'_>) -> Option<Spanned<TransmissionType>> {
    let given = start_number(object.description, Address::new(object.index, 2))?;
    let kind = u8::try_from(given.value).ok()?;
    is_communication(object.index).then(|| Spanned::new(TransmissionType::new(kind), given.span))
}

/// Number of objects in a mapping; an error if they do not fit into a PDO. The content of a
/// multiplexed PDO (254, 255) and of a mapping without a number is not known.
pub(super) fn count(object: &Object<'_>) -> Result<u8, Spanned<u64>> {
    let address = Address::new(object.index, 0);
    let Some(count) = start_number(object.description, address) else {
        return Ok(0);
    };
    match u8::try_from(count.value) {
        Ok(count @ ..=64) => Ok(count),
        Ok(254 | 255) => Ok(0),
        _ => Err(count),
    }
}

/// The entries of a mapping up to its number.
pub(super) fn counted<'a>(object: &Object<'a>) -> impl Iterator<Item = Entry<'a>> + use<'a> {
    let is_mapping = maps_rpdo(object.index).is_some() && object.code.has_members();
    let count = if is_mapping {
        count(object).unwrap_or(0)
    } else {
        0
    };
    let entries = object.entries();
    entries.filter(move |entry| (1..=count).contains(&entry.address.sub))
}

/// The numbers of the entries that can contain one.
pub(super) fn numbers<'a>(
    object: &Object<'a>,
) -> impl Iterator<Item = (Entry<'a>, Spanned<u32>)> + use<'a> {
    counted(object).filter_map(|entry| {
        let typed = entry
            .data_type
            .is_none_or(|given| *given == DataType::Unsigned32);
        let number = start_number(entry.description, entry.address).filter(|_| typed)?;
        let span = number.span.or(entry.span);
        Some((entry, Spanned::new(u32::try_from(number.value).ok()?, span)))
    })
}

/// A mapping entry with its object.
pub(super) struct Mapped<'a> {
    pub(super) entry: Entry<'a>,
    pub(super) span: Span,
    pub(super) number: u32,
    /// Whether it is mapped into an RPDO.
    pub(super) rpdo: bool,
    pub(super) target: Address,
    pub(super) bits: u8,
}

/// The entries of a mapping.
pub(super) fn mapped<'a>(object: &Object<'a>) -> Vec<Mapped<'a>> {
    let rpdo = maps_rpdo(object.index) == Some(true);
    let numbers = numbers(object).filter(|(_, number)| number.value != 0);
    let mapped = numbers.map(|(entry, number)| {
        let [bits, sub, low, high] = number.to_le_bytes();
        Mapped {
            entry,
            span: number.span,
            number: number.value,
            rpdo,
            target: Address::new(u16::from_le_bytes([low, high]), sub),
            bits,
        }
    });
    mapped.collect()
}

/// The sentence for an entry with another length.
pub(super) const WRONG_LENGTH: &str =
    "{object} is mapped with {bits:bit|bits} but is {right:bit|bits} long";

/// The help for an entry with another length.
pub(super) const WRITE_ENTRY: &str = "write `{entry}`{fix}";

/// An object that is mapped with another length than its own.
pub(super) struct WrongLength {
    /// The object in a sentence.
    shown: Fact,
    right: u8,
    data_type: Option<Spanned<DataType>>,
}

impl<'a> Mapped<'a> {
    /// Returns whether a data type is mapped as a gap.
    pub(super) fn is_dummy(&self) -> bool {
        (1..=0x1F).contains(&self.target.index)
    }

    /// The value that is mapped; `None` if it is a dummy or does not exist.
    pub(super) fn value(&self) -> Option<Entry<'a>> {
        let description = self.entry.description;
        let object = Object::of(description, self.target.index)?;
        let mut entries = object.entries().filter(|_| !self.is_dummy());
        entries.find(|entry| entry.address == self.target)
    }

    /// Returns whether the value can be mapped in this direction.
    pub(super) fn takes(&self, value: &Entry<'_>) -> bool {
        let direction = if self.rpdo {
            value.access.maps_to_rpdo()
        } else {
            value.access.maps_to_tpdo()
        };
        *value.mappable && direction
    }

    /// The correct length, if it differs; `None` for a value that cannot be mapped.
    pub(super) fn wrong_length(&self) -> Option<WrongLength> {
        let (shown, data_type, own) = match self.value() {
            Some(value) if self.takes(&value) => {
                let data_type = value.data_type?;
                (
                    shown(value.object, self.target),
                    *data_type,
                    Some(data_type),
                )
            }
            None if self.is_dummy() && self.rpdo => {
                let index = self.target.index;
                (Fact::Index(index), DataType::from_code(index)?, None)
            }
            _ => return None,
        };
        let right = data_type.bits().filter(|right| *right != self.bits)?;
        Some(WrongLength {
            shown,
            right,
            data_type: own,
        })
    }

    /// A finding about this entry.
    pub(super) fn finding(&self, rule: &'static Rule) -> Finding {
        rule.on(&self.entry, self.span)
    }
}

impl WrongLength {
    /// Returns whether it is a BOOLEAN mapped as a byte.
    pub(super) const fn is_boolean(&self, mapped: &Mapped<'_>) -> bool {
        self.right == 1 && mapped.bits == 8
    }

    /// The finding about it.
    pub(super) fn finding(self, rule: &'static Rule, mapped: &Mapped<'_>) -> Finding {
        let Address { index, sub } = mapped.target;
        let right = alloc::format!("0x{index:04X}{sub:02X}{:02X}", self.right);
        let fix = crate::fix::Fix::unsafe_fix().replace(mapped.span, right.as_str());
        let finding = mapped.finding(rule).fact("object", self.shown);
        let finding = finding.fact("right", self.right).fact("bits", mapped.bits);
        let finding = finding.fact("entry", right).fix(fix);
        match self.data_type {
            Some(data_type) => finding
                .fact("type", *data_type)
                .related(data_type.span, DECLARED),
            None => finding,
        }
    }
}

/// A COB-ID of the default SDO that differs from the standard.
pub(super) struct DefaultSdo {
    pub(super) span: Span,
    /// Number to which the node ID is added.
    pub(super) base: u32,
    /// Whether it is a number without the node ID.
    pub(super) lacks_node_id: bool,
}

/// The COB-ID of the default SDO at this entry, if it differs from the standard.
pub(super) fn default_sdo(entry: &Entry<'_>) -> Option<DefaultSdo> {
    let base = match (entry.address.index, entry.address.sub) {
        (0x1200, 1) => 0x600,
        (0x1200, 2) => 0x580,
        _ => return None,
    };
    let value = start_value(entry.entry)?;
    let (right, lacks_node_id) = match value.value {
        Value::NodeId(offset) => (offset == base, false),
        Value::Unsigned(number) => {
            let id = entry.description.commissioned_node_id();
            let right = id.is_some_and(|id| number == u64::from(base) + u64::from(id));
            (
                right,
                (u64::from(base)..=u64::from(base) + 127).contains(&number),
            )
        }
        _ => return None,
    };
    let span = value.span;
    (!right).then_some(DefaultSdo {
        span,
        base,
        lacks_node_id,
    })
}
