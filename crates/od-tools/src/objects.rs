//! Objects that a user names: by address, name or glob, with a dictionary or without.

use od_model::values;
use od_model::{Address, DataType, Dictionary, Entry, Kind, Literal, ObjectCode, Refused};
use od_wire::AbortCode;

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// A selected value.
#[derive(Clone, PartialEq, Debug)]
pub struct Asked {
    /// Its address.
    pub address: Address,
    /// Its entry, if a dictionary has it.
    pub entry: Option<Entry>,
    /// Whether a glob or an index selects several values.
    pub is_one_of_many: bool,
}

/// Returns the values that `text` names: `6004h`, `1018h:01`, `60*`, `1018:*`, `Position value`, `*position*`.
/// The index of an ARRAY or RECORD selects all its values. A glob leaves out values that cannot be read.
///
/// # Errors
/// A sentence: no value matches.
pub fn select(dictionary: Dictionary<'_>, text: &str) -> Result<Vec<Asked>, Refused> {
    let of = |entry: Entry, is_one_of_many| Asked {
        address: entry.address,
        entry: Some(entry),
        is_one_of_many,
    };
    if is_glob(text) {
        let pattern = Pattern::of(text);
        let entries = dictionary.entries();
        let entries = entries.filter(|entry| entry.access.readable());
        let found: Vec<Asked> = entries
            .filter(|entry| {
                pattern.matches(entry.address) || {
                    let name = values::name(dictionary, entry);
                    matches(text, &name) || matches(text, dictionary.text(entry.name))
                }
            })
            .map(|entry| of(entry, true))
            .collect();
        return if found.is_empty() {
            Err(format!("no object matches `{text}`").into())
        } else {
            Ok(found)
        };
    }
    let whole = values::address(text).filter(|_| !has_sub(text));
    if let Some(object) = whole.and_then(|address| dictionary.object(address.index))
        && object.code.has_members()
    {
        let members = dictionary.members(&object);
        let members = members.filter(|entry| entry.access.readable());
        return Ok(members.map(|entry| of(entry, true)).collect());
    }
    match values::find(dictionary, text) {
        Ok(entry) => Ok(vec![of(entry, false)]),
        // The file may be older than the device.
        Err(why) => match values::address(text) {
            Some(address) => Ok(vec![Asked {
                address,
                entry: None,
                is_one_of_many: false,
            }]),
            None => Err(why),
        },
    }
}

/// As [`select`] without a dictionary: finds on the node which of the objects exist.
///
/// # Errors
/// [`Error::Usage`] if `text` is not an address or a glob of addresses; else as [`Master::upload`].
pub fn probe(master: &mut Master<impl Link>, text: &str) -> Result<Vec<Asked>, Error> {
    let of = |index, sub, is_one_of_many| Asked {
        address: Address::new(index, sub),
        entry: None,
        is_one_of_many,
    };
    if !is_glob(text) {
        let Some(address) = values::address(text) else {
            let why = format!("`{text}` is not an address; add `--eds FILE` for names");
            return Err(Error::Usage(why));
        };
        return Ok(vec![of(address.index, address.sub, false)]);
    }
    let pattern = Pattern::of(text);
    if !pattern.is_address() {
        let why = format!("`{text}` is not a glob of addresses; add `--eds FILE` for names");
        return Err(Error::Usage(why));
    }
    let mut found = Vec::new();
    for index in 0x1000..=u16::MAX {
        if !matches(&pattern.index, &format!("{index:04X}")) {
            continue;
        }
        let Some(first) = exists(master, Address::new(index, 0))? else {
            continue;
        };
        let mut subs = vec![0];
        // A value, or the highest sub-index of an ARRAY or RECORD, which may have gaps.
        if let [count] = *first
            && exists(master, Address::new(index, 1))?.is_some()
        {
            for sub in 1..=count {
                if exists(master, Address::new(index, sub))?.is_some() {
                    subs.push(sub);
                }
            }
        }
        let addresses = subs.into_iter().map(|sub| Address::new(index, sub));
        for address in addresses.filter(|address| pattern.matches(*address)) {
            found.push(of(address.index, address.sub, true));
        }
    }
    if found.is_empty() {
        Err(Error::Node(format!("no object matches `{text}`")))
    } else {
        Ok(found)
    }
}

/// Reads an object that exists; empty if it has no value at present.
fn exists(master: &mut Master<impl Link>, address: Address) -> Result<Option<Vec<u8>>, Error> {
    Ok(match Error::or_abort(master.upload(address))? {
        Ok(bytes) => Some(bytes),
        Err(code) => {
            use AbortCode::{NoObject, NoSubIndex, WriteOnly};
            let missing = [NoObject, NoSubIndex, WriteOnly].map(AbortCode::code);
            (!missing.contains(&code)).then(Vec::new)
        }
    })
}

/// The type of a value without a dictionary: that of CiA 301, else one that fits size and content.
pub fn type_of(address: Address, bytes: &[u8]) -> DataType {
    if matches!(address.index, 0x1008..=0x100A) {
        return DataType::VisibleString;
    }
    let is_text = |bytes: &[u8]| {
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        !text.is_empty() && text.iter().all(|byte| matches!(byte, b' '..=b'~'))
    };
    match bytes.len() {
        1 => DataType::Unsigned8,
        2 => DataType::Unsigned16,
        4 => DataType::Unsigned32,
        8 if !is_text(bytes) => DataType::Unsigned64,
        _ if is_text(bytes) => DataType::VisibleString,
        _ => DataType::OctetString,
    }
}

/// The bytes of a value that a user typed, after all checks that do not need the node.
///
/// # Errors
/// A sentence: the value cannot be written, or is not of its type or within its limits.
pub fn encode(entry: &Entry, node: u8, text: &str) -> Result<Vec<u8>, Refused> {
    if !entry.access.writable() {
        return Err(format!("it is `{}` and cannot be written", entry.access).into());
    }
    let bytes = values::parse(entry.data_type, text)?;
    if let Some(size) = entry.data_type.size()
        && size != bytes.len()
    {
        let name = entry.data_type.name();
        return Err(format!("{name} has {size} bytes, not {}", bytes.len()).into());
    }
    let [low, high] = [entry.low, entry.high].map(|limit| number(limit, node));
    if let Some(value) = decimal(entry.data_type, &bytes) {
        let below = low.is_some_and(|low| value < low);
        if below || high.is_some_and(|high| value > high) {
            let shown =
                |limit: Option<f64>| limit.map_or(String::from("…"), |limit| limit.to_string());
            return Err(format!(
                "{} is outside the range {} to {}",
                values::show(entry.data_type, &bytes),
                shown(low),
                shown(high)
            )
            .into());
        }
    }
    Ok(bytes)
}

/// The bytes of a value for an object of this size, without a dictionary.
///
/// # Errors
/// A sentence: the value does not fit.
pub fn encode_by_size(size: usize, text: &str) -> Result<Vec<u8>, Refused> {
    let text = text.trim();
    if text.starts_with(['[', '"']) {
        return values::parse(DataType::OctetString, text);
    }
    let value = match text {
        "true" => 1,
        "false" => 0,
        _ => values::integer(text)
            .ok_or_else(|| format!("`{text}` is not a number, \"a text\" or [01 02 03]"))?,
    };
    let bits = 8 * size as u32;
    if !(1..=64).contains(&bits) {
        return Err(format!(
            "the object has {size} bytes, so it is not a number; write \"a text\" or [01 02 03]"
        )
        .into());
    }
    if value < -(1 << (bits - 1)) || value >= 1 << bits {
        return Err(format!("`{text}` does not fit into {size} bytes").into());
    }
    Ok(value.to_le_bytes()[..size].to_vec())
}

fn number(limit: Literal, node: u8) -> Option<f64> {
    match limit {
        Literal::Real(limit) => Some(limit),
        // Wide limits lose their last digits here, and stay in order.
        limit => limit.integer(node).map(|limit| limit as f64),
    }
}

fn decimal(data_type: DataType, bytes: &[u8]) -> Option<f64> {
    let mut wide = [0; 8];
    wide.get_mut(..bytes.len())?.copy_from_slice(bytes);
    let unused = 64 - 8 * (bytes.len().max(1) as u32);
    Some(match data_type.kind() {
        Kind::Boolean | Kind::Unsigned => u64::from_le_bytes(wide) as f64,
        Kind::Signed => (i64::from_le_bytes(wide) << unused >> unused) as f64,
        Kind::Real => match *bytes {
            [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::from_le_bytes(wide),
        },
        Kind::Text | Kind::Bytes | Kind::Record => return None,
    })
}

/// The name in the output of `get` and `set`: of a sub-object it follows the name of its object.
pub fn name(dictionary: Option<Dictionary<'_>>, entry: Option<&Entry>) -> String {
    match (dictionary, entry) {
        (Some(dictionary), Some(entry)) => values::name(dictionary, entry),
        _ => String::new(),
    }
}

/// `6004h` for a VAR, `1018h:01` for a sub-object.
pub fn place(dictionary: Option<Dictionary<'_>>, address: Address) -> String {
    let object = dictionary.and_then(|dictionary| dictionary.object(address.index));
    match object.map(|object| object.code) {
        Some(ObjectCode::Array | ObjectCode::Record) => address.to_string(),
        _ if address.sub == 0 => format!("{:04X}h", address.index),
        _ => address.to_string(),
    }
}

fn has_sub(text: &str) -> bool {
    text.contains(':') || text.contains("sub")
}

fn is_glob(text: &str) -> bool {
    text.contains(['*', '?'])
}

/// A glob for addresses: one pattern for the index, one for the sub-index.
struct Pattern {
    index: String,
    sub: String,
}

impl Pattern {
    fn of(text: &str) -> Self {
        let digits = |text: &str| {
            let text = text.trim().to_ascii_lowercase();
            let text = text.strip_prefix("0x").unwrap_or(&text);
            text.strip_suffix('h').unwrap_or(text).to_owned()
        };
        let (index, sub) = text.split_once(':').unwrap_or((text, "*"));
        let sub = digits(sub);
        Self {
            index: digits(index),
            sub: match sub.len() {
                1 if !is_glob(&sub) => format!("0{sub}"),
                _ => sub,
            },
        }
    }

    fn is_address(&self) -> bool {
        let parts = [&self.index, &self.sub];
        let is_digit = |byte: u8| byte.is_ascii_hexdigit() || matches!(byte, b'*' | b'?');
        parts.iter().all(|part| part.bytes().all(is_digit))
    }

    fn matches(&self, address: Address) -> bool {
        matches(&self.index, &format!("{:04X}", address.index))
            && matches(&self.sub, &format!("{:02X}", address.sub))
    }
}

/// Returns whether a pattern with `*` (any characters) and `?` (one character) matches the text; case is ignored.
fn matches(pattern: &str, text: &str) -> bool {
    let pattern: Vec<char> = pattern.to_lowercase().chars().collect();
    let text: Vec<char> = text.to_lowercase().chars().collect();
    // The last `*`, and the first character that it does not match yet.
    let (mut at, mut place, mut star) = (0, 0, None);
    while at < text.len() {
        match pattern.get(place) {
            Some('*') => {
                star = Some((place, at));
                place += 1;
            }
            Some(one) if *one == '?' || *one == text[at] => {
                (at, place) = (at + 1, place + 1);
            }
            _ => match star {
                Some((before, from)) => {
                    star = Some((before, from + 1));
                    (place, at) = (before + 1, from + 1);
                }
                None => return false,
            },
        }
    }
    pattern[place..].iter().all(|one| *one == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glob_stands_for_any_characters() {
        for (pattern, text) in [
            ("60*", "6004"),
            ("*", ""),
            ("6?0*4", "6004"),
            ("*POSITION*", "Position value"),
            ("*a*b", "aXbb"),
        ] {
            assert!(matches(pattern, text), "{pattern} {text}");
        }
        for (pattern, text) in [("60*", "1600"), ("6?", "600"), ("", "a"), ("*a", "ab")] {
            assert!(!matches(pattern, text), "{pattern} {text}");
        }
    }

    #[test]
    fn numbers_fit_their_size() {
        assert_eq!(encode_by_size(1, "255").as_deref(), Ok(&[255][..]));
        assert_eq!(encode_by_size(1, "-128").as_deref(), Ok(&[128][..]));
        assert_eq!(
            encode_by_size(2, "0x1234").as_deref(),
            Ok(&[0x34, 0x12][..])
        );
        assert_eq!(encode_by_size(4, "\"save\"").as_deref(), Ok(&b"save"[..]));
        assert_eq!(encode_by_size(3, "[01 02]").as_deref(), Ok(&[1, 2][..]));
        assert!(encode_by_size(8, "18446744073709551615").is_ok());
        for (size, text) in [(1, "256"), (1, "-129"), (2, "x"), (0, "1"), (9, "1")] {
            assert!(encode_by_size(size, text).is_err(), "{size} {text}");
        }
    }
}
