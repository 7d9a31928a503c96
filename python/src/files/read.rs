//! A description, shared by the classes that show parts of it.

use od_eds::{Description, EntryDescription, Finding, ObjectDescription, Spanned, Value};
use od_model::{Address, values};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::files::source::Source;

/// A description and its source.
pub(crate) struct Read {
    pub(crate) source: Source,
    pub(crate) description: Description,
    pub(crate) findings: Vec<Finding>,
    /// The node ID of the caller, or else that of a DCF.
    pub(crate) node_id: Option<u8>,
}

/// An object, or one value of it.
#[derive(Clone, Copy)]
pub(crate) enum Found {
    Object(u16),
    Entry(Address),
}

impl Read {
    /// Reads and checks.
    pub(crate) fn checked(source: Source, node_id: Option<u8>) -> Self {
        let parsed = source.document.load();
        let node_id = node_id.or_else(|| parsed.description.commissioned_node_id());
        Self {
            source,
            description: parsed.description,
            findings: parsed.findings,
            node_id,
        }
    }

    /// The object or the value of a key: `0x6004`, `(0x1018, 2)`, `"1018h:02"`,
    /// `"Position value"`, `"Identity object.Vendor-ID"`.
    ///
    /// # Errors
    /// `KeyError`: the object does not exist; `TypeError`: the key has another type.
    pub(crate) fn find(&self, key: &Bound<'_, PyAny>) -> PyResult<Found> {
        let objects = &self.description.objects;
        let missing = |what: String| PyKeyError::new_err(format!("{what} does not exist"));
        let address = if let Ok((index, sub)) = key.extract::<(u16, u8)>() {
            Some((Address::new(index, sub), true))
        } else if let Ok(index) = key.extract::<u16>() {
            Some((Address::new(index, 0), false))
        } else {
            let text: &str = &key.extract::<String>()?;
            if let Some(found) = self.named(text) {
                return Ok(found);
            }
            let has_sub = text.contains(':') || text.to_ascii_lowercase().contains("sub");
            values::address(text).map(|address| (address, has_sub))
        };
        match address {
            Some((Address { index, .. }, false)) => {
                if objects.contains_key(&index) {
                    Ok(Found::Object(index))
                } else {
                    Err(missing(format!("object {index:04X}h")))
                }
            }
            Some((address, true)) => match self.description.entry(address) {
                Some(_) => Ok(Found::Entry(address)),
                None => Err(missing(format!("object {address}"))),
            },
            None => {
                let text: String = key.extract()?;
                let names = objects.values().map(|object| object.name.value.as_str());
                let near = match od_eds::nearest(&text, names, 3) {
                    Some(near) => format!("; the nearest name is `{near}`"),
                    None => String::new(),
                };
                let why = format!("object `{text}` does not exist{near}");
                Err(PyKeyError::new_err(why))
            }
        }
    }

    fn named(&self, text: &str) -> Option<Found> {
        let is = |name: &str, text: &str| name.eq_ignore_ascii_case(text);
        let objects = &self.description.objects;
        if let Some((index, _)) = objects.iter().find(|(_, one)| is(&one.name, text)) {
            return Some(Found::Object(*index));
        }
        let parts = text.match_indices('.');
        let mut parts = parts.map(|(at, _)| (&text[..at], &text[at + 1..]));
        parts.find_map(|(object, member)| {
            let (index, object) = objects.iter().find(|(_, one)| is(&one.name, object))?;
            let mut members = object.entries.iter();
            let (sub, _) = members.find(|(_, one)| is(&one.name, member))?;
            Some(Found::Entry(Address::new(*index, *sub)))
        })
    }

    /// An object that exists.
    pub(crate) fn object(&self, index: u16) -> PyResult<&ObjectDescription> {
        let object = self.description.objects.get(&index);
        object.ok_or_else(|| PyKeyError::new_err(format!("object {index:04X}h does not exist")))
    }

    /// A value that exists.
    pub(crate) fn entry(&self, address: Address) -> PyResult<&EntryDescription> {
        let entry = self.description.entry(address);
        entry.ok_or_else(|| PyKeyError::new_err(format!("object {address} does not exist")))
    }

    /// The number in an object: the configured value of a DCF, else the default.
    pub(crate) fn number(&self, index: u16, sub: u8) -> Option<u64> {
        let entry = self.description.entry(Address::new(index, sub))?;
        let value: &Spanned<Value> = entry.parameter.as_ref().or(entry.default.as_ref())?;
        let number = value.value.integer(self.node_id.unwrap_or(0))?;
        u64::try_from(number).ok()
    }

    /// A text of `[DeviceInfo]`; an empty text counts as missing.
    pub(crate) fn info(&self, key: &str) -> Option<&str> {
        let section = self.description.section("DeviceInfo")?;
        let text = section.get(key)?.value.trim();
        (!text.is_empty()).then_some(text)
    }
}
