//! Makes an EDS from a device: its objects with their sizes, access, values and mapping.
//!
//! Objects of the standards have the names and types of the standards. The type of any other object follows
//! from the size of its value, and a comment says so. The current value becomes the default value.

mod describe;
mod file;
mod known;
mod limits;
mod probe;
pub mod record;
mod stored;
mod types;

use std::collections::BTreeMap;

use od_eds::{Description, ObjectDescription, Spanned, Value};
use od_model::Address;
use od_wire::NodeId;

use self::known::Profiles;
use self::probe::{FoundObject, Probe, There};
use crate::conform::eds::is_touchy;
use crate::error::Error;
use crate::link::Link;

pub use self::file::{Options, Today};
pub use self::stored::{Stored, stored};

/// Result of learning a node.
#[derive(Clone, PartialEq, Debug)]
pub struct Learned {
    /// The description of all its objects.
    pub description: Description,
    /// Reason why probing stopped early; the description has the limits that were found before.
    pub left: Option<Error>,
    /// Objects whose transfer failed, in words: the node violates the protocol, or does not respond.
    pub faults: Vec<String>,
}

/// Reads all objects from 1000h to 9FFFh; `told` is called with each index that is a multiple of 1000h.
///
/// # Errors
/// The link is lost, or the node stops responding, does not respond to eight objects in a row, or violates the protocol
/// in the transfers of 64 values in a row, before all objects are read.
pub fn learn(
    link: impl Link,
    node: NodeId,
    options: Options,
    mut told: impl FnMut(u16),
) -> Result<Learned, Error> {
    let mut probe = Probe::new(link, node);
    let mut all: BTreeMap<u16, Vec<FoundObject>> = BTreeMap::new();
    for index in 0x1000..=0x9FFF {
        if index % 0x1000 == 0 {
            told(index);
        }
        let found = members(&mut probe, index)?;
        if !found.is_empty() {
            all.insert(index, found);
        }
    }
    // The other objects show the profile of an object.
    let values = all.values().flatten();
    let lengths: Vec<_> = values
        .filter_map(|one: &FoundObject| {
            let Address { index, sub } = one.address;
            Some((index, sub, one.bytes.as_ref()?.len()))
        })
        .filter(|(index, sub, _)| *sub > 0 || describe::is_whole(&all[index]))
        .collect();
    let profiles = Profiles::of(low_word(&all, 0x1000), &lengths);
    let version = low_word(&all, 0x6507);
    let heartbeat = low_word(&all, 0x1017);
    let lss = probe.lss(&identity(&all), heartbeat, options.writes)?;
    let mut left = None;
    let mut objects = BTreeMap::new();
    for (index, found) in &mut all {
        let is_whole = describe::is_whole(found);
        let guesses = types::types(&profiles, found, is_whole, version);
        let mut object = describe::describe(found, &guesses, node);
        if options.writes && left.is_none() {
            left = probe_writes(&mut probe, found, &mut object).err();
        }
        objects.insert(*index, object);
    }
    map(&mut objects);
    let sections = file::sections(&objects, node, &options, lss, &probe.faults);
    let mut description = Description { sections, objects };
    file::allow_errors(&mut description);
    Ok(Learned {
        description,
        left,
        faults: probe.faults,
    })
}

/// Bits 0 to 15 of a value; 0 if the node does not have it.
fn low_word(all: &BTreeMap<u16, Vec<FoundObject>>, index: u16) -> u16 {
    let bytes = all.get(&index).and_then(|found| found[0].bytes.as_deref());
    match bytes {
        Some([low, high, ..]) => u16::from_le_bytes([*low, *high]),
        _ => 0,
    }
}

/// The values of an object.
fn members<L: Link>(probe: &mut Probe<L>, index: u16) -> Result<Vec<FoundObject>, Error> {
    let mut all = Vec::new();
    if probe.lacks(index)? {
        return Ok(all);
    }
    match probe.read(Address::new(index, 0))? {
        There::NoObject => return Ok(all),
        There::NoSubIndex => {}
        There::Value(found) => all.push(found),
    }
    if let [whole] = all.as_slice()
        && probe.is_var(whole)?
    {
        return Ok(all);
    }
    // Sub-index 0 of an object with sub-objects is probably their number.
    let count = match all.first().map(|first| first.bytes.as_deref()) {
        Some(Some([count])) => *count,
        Some(_) => 0,
        None => 8,
    };
    for sub in 1..=0xFE {
        match probe.read(Address::new(index, sub))? {
            There::Value(found) => all.push(found),
            // There may be unused entries after this number.
            _ if sub > count => break,
            _ => {}
        }
        if all.len() == 1 && sub > 8 {
            break;
        }
    }
    Ok(all)
}

/// The four numbers of 1018h; `None` if the node lacks one.
fn identity(all: &BTreeMap<u16, Vec<FoundObject>>) -> Option<[u32; 4]> {
    let number = |sub: u8| {
        let mut found = all.get(&0x1018)?.iter();
        let one = found.find(|one| one.address.sub == sub)?;
        let bytes = one.bytes.as_deref()?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes))
    };
    Some([number(1)?, number(2)?, number(3)?, number(4)?])
}

/// Finds access and limits by writing.
fn probe_writes<L: Link>(
    probe: &mut Probe<L>,
    found: &mut [FoundObject],
    object: &mut ObjectDescription,
) -> Result<(), Error> {
    for one in found {
        if one.writable.is_none() && !is_touchy(one.address) {
            one.writable = probe.takes_its_value(one)?;
            if let (Some(writable), Some(entry)) =
                (one.writable, object.entries.get_mut(&one.address.sub))
            {
                describe::set_access(entry, writable);
            }
        }
        if one.writable == Some(true) {
            probe_limits(probe, one, object)?;
        }
    }
    Ok(())
}

fn probe_limits<L: Link>(
    probe: &mut Probe<L>,
    one: &FoundObject,
    object: &mut ObjectDescription,
) -> Result<(), Error> {
    let Some(entry) = object.entries.get_mut(&one.address.sub) else {
        return Ok(());
    };
    let Some(data_type) = entry.data_type.as_ref().map(|given| given.value) else {
        return Ok(());
    };
    if is_touchy(one.address) {
        return Ok(());
    }
    let is_guess = |(key, text): &(String, String)| key == ";Learned" && text.contains("type");
    let is_sure = !entry.extra.iter().any(is_guess);
    let learned = limits::limits(probe, one, data_type, is_sure)?;
    let value = |number: i128| match u64::try_from(number) {
        Ok(number) => Value::Unsigned(number),
        Err(_) => Value::Signed(number as i64),
    };
    if learned.data_type != data_type {
        entry.data_type = Some(Spanned::from(learned.data_type));
        entry.default = learned.value.map(|now| Spanned::from(value(now)));
    }
    entry.low = learned.low.map(|low| Spanned::from(value(low)));
    entry.high = learned.high.map(|high| Spanned::from(value(high)));
    for (key, text) in &mut entry.extra {
        if key == ";Learned" {
            *text = text.replace("limits", "numbers between the limits");
        }
    }
    Ok(())
}

/// Marks the objects that PDOs map as mappable.
fn map(objects: &mut BTreeMap<u16, ObjectDescription>) {
    let mappings = objects.range(0x1600..=0x1BFF);
    let entries = mappings.flat_map(|(_, object)| object.entries.iter());
    let mapped: Vec<u64> = entries
        .filter(|(sub, _)| **sub > 0)
        .filter_map(|(_, entry)| match entry.default.as_ref()?.value {
            Value::Unsigned(raw) => Some(raw),
            _ => None,
        })
        .collect();
    for raw in mapped {
        let object = objects.get_mut(&((raw >> 16) as u16));
        if let Some(entry) = object.and_then(|object| object.entries.get_mut(&((raw >> 8) as u8))) {
            entry.mappable = Spanned::from(true);
        }
    }
}
