//! Parts of several rules about sub-index 0 and the highest sub-index.

use alloc::format;
use alloc::string::ToString;

use od_model::{DataType, ObjectCode};

use crate::description::{Description, ObjectDescription};
use crate::finding::{Finding, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::maps_rpdo;
use crate::span::{Spanned, token_of};
use crate::subject::{Entry, Object, start_number};

/// Returns whether the object has sub-objects that sub-index 0 must count.
pub(super) fn counts(object: &Object<'_>) -> bool {
    let described = object.code.has_members() && *object.code != ObjectCode::DefStruct;
    described && !object.object.entries.is_empty()
}

/// The highest sub-index that exists. FFh does not count: it describes the object.
pub(super) fn highest(object: &Object<'_>) -> u8 {
    let subs = object.object.entries.range(..255);
    subs.map(|(sub, _)| *sub).next_back().unwrap_or(0)
}

/// A sub-index whose section has a decimal number, and the intended one: `sub10` after sub-index 9.
pub(super) fn decimal(object: &ObjectDescription) -> Option<(u8, u8)> {
    let mut subs = object.entries.keys().zip(object.entries.keys().skip(1));
    let (before, sub) = subs.find(|(before, sub)| u16::from(**before) + 1 < u16::from(**sub))?;
    let meant = format!("{sub:X}").parse::<u8>().ok()?;
    (meant == before + 1 && *sub != meant).then_some((*sub, meant))
}

/// Returns whether a section is about the object and is not a sub-object. Its name is probably
/// wrong, so the number of sub-objects does not include it.
pub(super) fn has_lost(description: &Description, index: u16) -> bool {
    let start = format!("{index:04X}");
    description.sections.iter().any(|section| {
        let own = section.name.get(..4);
        own.is_some_and(|own| own.eq_ignore_ascii_case(&start))
    })
}

/// Sub-index 0, if there is one.
pub(super) fn sub_index_0<'a>(object: &Object<'a>) -> Option<Entry<'a>> {
    let first = object.entries().next().filter(|_| counts(object));
    first.filter(|entry| entry.address.sub == 0)
}

/// Objects whose sub-index 0 changes with their content.
pub(super) const fn counts_in_use(index: u16) -> bool {
    index == 0x1003 || maps_rpdo(index).is_some()
}

/// The value of sub-index 0, and the highest sub-index that exists.
pub(super) struct Count<'a> {
    pub(super) entry: Entry<'a>,
    pub(super) given: Spanned<u64>,
    pub(super) highest: u8,
}

impl<'a> Count<'a> {
    /// The number in sub-index 0 of an object; `None` if there is none, or if it is not the number
    /// of sub-objects.
    pub(super) fn of(object: &Object<'a>) -> Option<Self> {
        let entry = sub_index_0(object)?;
        if entry
            .data_type
            .is_some_and(|given| *given != DataType::Unsigned8)
        {
            return None;
        }
        let given = start_number(object.description, entry.address)?;
        // 254 and 255 are multiplexed PDOs.
        if counts_in_use(object.index) && matches!(given.value, 254 | 255) {
            return None;
        }
        let highest = highest(object);
        Some(Self {
            entry,
            given,
            highest,
        })
    }

    /// Returns whether it is higher than the highest sub-index.
    pub(super) fn is_too_high(&self) -> bool {
        self.given.value > u64::from(self.highest)
    }

    /// Returns whether it is an error: a PDO cannot consist of entries that do not exist, and the
    /// author of a macro call can correct its values.
    pub(super) fn is_error(&self) -> bool {
        maps_rpdo(self.entry.address.index).is_some() || token_of(self.given.span).is_some()
    }

    /// The finding that it is wrong. It has no fix if the sub-objects are probably wrong: a
    /// CompactSubObj beside sections, a sub-index in decimal, or a misspelled name of a section.
    pub(super) fn finding(&self, rule: &'static Rule) -> Finding {
        let object = self.entry.object;
        let compact = object
            .entries
            .values()
            .any(|entry| entry.span == object.span);
        let finding = rule
            .on(&self.entry, self.given.span)
            .fact("given", self.given.value)
            .fact("highest", self.highest);
        let index = self.entry.address.index;
        let wrong = compact || decimal(object).is_some();
        if wrong || has_lost(self.entry.description, index) {
            finding
        } else {
            let fix = Fix::unsafe_fix().replace(self.given.span, self.highest.to_string());
            finding.fix(fix)
        }
    }
}
