//! The configuration of a node: reads it, and writes all of it or nothing.

use std::collections::{BTreeMap, BTreeSet};

use od_model::{Address, DataType, Dictionary};

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// Bit 31 of a PDO's COB-ID: the PDO is not valid.
const NOT_VALID: u32 = 1 << 31;

/// A value of a node's configuration.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Setting {
    /// Address.
    pub address: Address,
    /// Value in the byte order of the bus.
    pub bytes: Vec<u8>,
}

/// A difference between a wanted and an actual value.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Wrong {
    /// The wanted value.
    pub setting: Setting,
    /// The actual value, or the reason why the transfer failed: an abort, or a violation of the protocol.
    pub found: Result<Vec<u8>, Error>,
}

/// Result of [`apply`].
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Applied {
    /// Number of values that did not have to change.
    pub equal: usize,
    /// Values that were written.
    pub written: usize,
    /// Values that the node refused, or that it did not keep.
    pub wrong: Vec<Wrong>,
    /// Whether all written values were restored.
    pub is_put_back: bool,
    /// Values that could not be restored, or of which it is not known.
    pub left: Vec<Address>,
    /// The reason why the node got no more values: it does not respond any more, or the user stopped the program.
    pub ended: Option<Error>,
}

/// The values that make up the configuration of a node: all that can be read and written, except
/// commands, logs, programs and DOMAINs.
pub fn addresses(dictionary: Dictionary<'_>) -> Vec<Address> {
    let entries = dictionary.entries().filter(|entry| {
        let is_command = matches!(
            entry.address.index,
            0x1003 | 0x1010 | 0x1011 | 0x1F50..=0x1F5F
        );
        let is_own = entry.data_type != DataType::Domain && !is_command;
        is_own && entry.access.readable() && entry.access.writable()
    });
    entries.map(|entry| entry.address).collect()
}

/// An address with its value, or with the reason why the transfer failed: an abort, or a violation of the protocol.
pub type Read = (Address, Result<Vec<u8>, Error>);

/// Reads these values. `progress` receives the percentage done.
///
/// # Errors
/// The node does not respond, or the link is lost.
pub fn read(
    master: &mut Master<impl Link>,
    addresses: &[Address],
    mut progress: impl FnMut(u8),
) -> Result<Vec<Read>, Error> {
    let mut values = Vec::new();
    for (at, address) in addresses.iter().enumerate() {
        progress((100 * at / addresses.len()) as u8);
        values.push((*address, Error::or_failed(master.upload(*address))?));
    }
    Ok(values)
}

/// Writes values that differ, and reads them back. PDOs are not valid while their mapping changes.
/// If the transfer of a value fails or the program is interrupted, the written values are restored.
///
/// # Errors
/// The node does not respond, or the link is lost, before the first or after the last value is written.
pub fn apply(
    master: &mut Master<impl Link>,
    settings: &[Setting],
    mut progress: impl FnMut(u8),
) -> Result<Applied, Error> {
    let mut applied = Applied::default();
    let wanted = Values(
        settings
            .iter()
            .map(|one| (one.address, one.bytes.clone()))
            .collect(),
    );
    let addresses: Vec<Address> = wanted.0.keys().copied().collect();
    let (mut new, mut old) = (Values::default(), Values::default());
    for (address, found) in read(master, &addresses, |percent| progress(percent / 2))? {
        let bytes = wanted.0[&address].clone();
        match found {
            Ok(before) if before == bytes || wanted.is_beyond(address) => applied.equal += 1,
            Ok(before) => {
                old.0.insert(address, before);
                new.0.insert(address, bytes);
            }
            Err(_) => applied.wrong.push(wrong(address, bytes, found)),
        }
    }
    if !applied.wrong.is_empty() {
        // Nothing was written yet.
        applied.is_put_back = true;
        return Ok(applied);
    }
    for index in old.pdos() {
        // A value that changes only for a short time has to be restored, too.
        let (cob_id, count) = (Address::new(index, 1), Address::new(index + 0x200, 0));
        let is_mapped_anew = old.0.keys().any(|one| one.index == count.index);
        for address in [Some(cob_id), is_mapped_anew.then_some(count)]
            .into_iter()
            .flatten()
        {
            if !old.0.contains_key(&address)
                && let Ok(bytes) = Error::or_failed(master.upload(address))?
            {
                old.0.insert(address, bytes);
            }
        }
    }
    applied.written = new.0.len();
    match new.write(master) {
        Ok(None) => {}
        stopped => {
            master.link().resume();
            match old.write(master) {
                Ok(None) => applied.is_put_back = true,
                Ok(Some(left)) => applied.left.push(left.setting.address),
                Err(_) => applied.left = old.0.into_keys().collect(),
            }
            match stopped {
                Ok(refused) => applied.wrong.extend(refused),
                Err(ended) => applied.ended = Some(ended),
            }
            return Ok(applied);
        }
    }
    let written: Vec<Address> = new.0.keys().copied().collect();
    for (address, found) in read(master, &written, |percent| progress(50 + percent / 2))? {
        let bytes = new.0[&address].clone();
        if found.as_ref() != Ok(&bytes) {
            applied.wrong.push(wrong(address, bytes, found));
        }
    }
    Ok(applied)
}

fn wrong(address: Address, bytes: Vec<u8>, found: Result<Vec<u8>, Error>) -> Wrong {
    let setting = Setting { address, bytes };
    Wrong { setting, found }
}

#[derive(Default)]
struct Values(BTreeMap<Address, Vec<u8>>);

/// The PDO communication parameter that an address belongs to, with its mapping.
fn pdo(address: Address) -> Option<u16> {
    match address.index {
        index @ (0x1400..=0x15FF | 0x1800..=0x19FF) => Some(index),
        index @ (0x1600..=0x17FF | 0x1A00..=0x1BFF) => Some(index - 0x200),
        _ => None,
    }
}

/// A value whose transfer fails; `None` if the node accepts all.
type Refused = Option<Wrong>;

impl Values {
    fn pdos(&self) -> BTreeSet<u16> {
        self.0.keys().filter_map(|address| pdo(*address)).collect()
    }

    /// A mapping entry after those that sub-index 0 counts: it maps nothing, and many devices
    /// refuse to write it.
    fn is_beyond(&self, address: Address) -> bool {
        let is_mapping = pdo(address).is_some_and(|index| index != address.index);
        let count = self.0.get(&Address::new(address.index, 0));
        let count = count.and_then(|bytes| bytes.first()).copied();
        is_mapping && count.is_some_and(|count| address.sub > count)
    }

    fn write(&self, master: &mut Master<impl Link>) -> Result<Refused, Error> {
        let mut waiting: Vec<_> = self
            .0
            .iter()
            .filter(|(one, _)| pdo(**one).is_none())
            .collect();
        // Values may depend on each other: the node may accept a refused value after the others.
        loop {
            let mut refused = Vec::new();
            let mut first = None;
            for (address, bytes) in &waiting {
                if let Err(failed) = Error::or_failed(master.download(**address, bytes))? {
                    refused.push((*address, *bytes));
                    first.get_or_insert(wrong(**address, bytes.to_vec(), Err(failed)));
                }
            }
            if refused.is_empty() {
                break;
            }
            if refused.len() == waiting.len() {
                return Ok(first);
            }
            waiting = refused;
        }
        for index in self.pdos() {
            let refused = self.write_pdo(master, index)?;
            if refused.is_some() {
                return Ok(refused);
            }
        }
        Ok(None)
    }

    /// CiA 301, chapter 7.5.2.36: not valid, mapping off, entries, mapping on, valid.
    fn write_pdo(&self, master: &mut Master<impl Link>, index: u16) -> Result<Refused, Error> {
        let (cob_id, mapping) = (Address::new(index, 1), index + 0x200);
        let count = Address::new(mapping, 0);
        let put = |master: &mut Master<_>, address: Address, bytes: &[u8]| {
            let done = Error::or_failed(master.download(address, bytes))?;
            Ok::<_, Error>(
                done.err()
                    .map(|failed| wrong(address, bytes.to_vec(), Err(failed))),
            )
        };
        let before = Error::or_failed(master.upload(cob_id))?;
        let last = self.0.get(&cob_id).cloned().or(before.clone().ok());
        if let Ok(Ok(raw)) = before.as_deref().map(<[u8; 4]>::try_from) {
            let raw = u32::from_le_bytes(raw) | NOT_VALID;
            // If the COB-ID of a device is fixed, the other values are still written.
            put(master, cob_id, &raw.to_le_bytes())?;
        }
        if self.0.keys().any(|address| address.index == mapping) {
            let last = match self.0.get(&count) {
                Some(count) => Some(count.clone()),
                None => Error::or_failed(master.upload(count))?.ok(),
            };
            let entries = self
                .0
                .iter()
                .filter(|(one, _)| one.index == mapping && one.sub > 0);
            let mut steps = vec![(count, vec![0])];
            steps.extend(entries.map(|(address, bytes)| (*address, bytes.clone())));
            steps.extend(last.map(|last| (count, last)));
            for (address, bytes) in steps {
                let refused = put(master, address, &bytes)?;
                if refused.is_some() {
                    return Ok(refused);
                }
            }
        }
        for (address, bytes) in self
            .0
            .iter()
            .filter(|(one, _)| one.index == index && one.sub > 1)
        {
            let refused = put(master, *address, bytes)?;
            if refused.is_some() {
                return Ok(refused);
            }
        }
        match last {
            Some(last) if before.as_ref().ok() != Some(&last) || self.0.contains_key(&cob_id) => {
                put(master, cob_id, &last)
            }
            Some(last) => put(master, cob_id, &last).map(|_| None),
            None => Ok(None),
        }
    }
}
