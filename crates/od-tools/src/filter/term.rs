//! One term of a filter.

use od_model::{Address, values};
use od_sim::words::{TAGS, tag};
use od_wire::Frame;

use super::tokens::mistake;
use crate::error::Error;

/// A frame with the properties that a filter tests.
#[derive(Clone, Copy, Debug)]
pub struct FilteredFrame<'f> {
    /// The frame.
    pub frame: &'f Frame,
    /// Whether this program sent it.
    pub sent: bool,
    /// Its meaning in words.
    pub words: &'f str,
}

/// A condition for a frame.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Term {
    /// Names of services, as in a tag.
    Service(&'static [&'static str]),
    /// One PDO: `PDO1`, `RPDO3`.
    Pdo(String),
    /// An error frame of the bus; a link never delivers one.
    Error,
    Sent(bool),
    Remote,
    Abort,
    Masked {
        wanted: u32,
        mask: u32,
    },
    Range {
        low: u32,
        high: u32,
    },
    Node(u8),
    Data(Vec<Option<u8>>),
    Object {
        index: u16,
        sub: Option<u8>,
    },
    Length(u8),
    /// In lower case.
    Words(String),
}

const PDOS: &[&str] = &[
    "PDO1", "RPDO1", "PDO2", "RPDO2", "PDO3", "RPDO3", "PDO4", "RPDO4",
];

impl Term {
    pub(super) fn passes(&self, seen: &FilteredFrame<'_>) -> bool {
        let frame = seen.frame;
        let tag = tag(frame);
        let service = TAGS[usize::from(tag.tag)];
        let id = frame.id().raw();
        match self {
            Self::Service(names) => names.contains(&service),
            Self::Pdo(name) => service == name,
            Self::Error => false,
            Self::Sent(sent) => seen.sent == *sent,
            Self::Remote => frame.is_remote(),
            Self::Abort => service == "SDO" && frame.data().first() == Some(&0x80),
            Self::Masked { wanted, mask } => id & mask == *wanted,
            Self::Range { low, high } => (*low..=*high).contains(&id),
            // An NMT command may address all nodes.
            Self::Node(node) => tag.node == *node || (service == "NMT" && tag.node == 0),
            Self::Data(wanted) => {
                let data = frame.data();
                let mut places = wanted.iter().enumerate();
                places.all(|(at, byte)| match (byte, data.get(at)) {
                    (None, there) => there.is_some(),
                    (Some(byte), there) => there == Some(byte),
                })
            }
            Self::Object { index, sub } => tag.object.is_some_and(
                |Address {
                     index: own,
                     sub: own_sub,
                 }| { own == *index && sub.is_none_or(|sub| sub == own_sub) },
            ),
            Self::Length(length) => frame.dlc() == *length,
            Self::Words(wanted) => {
                let data = values::hex(frame.data()).to_lowercase();
                seen.words.to_lowercase().contains(wanted) || data.contains(wanted)
            }
        }
    }
}

/// Reads a term; `!=` negates it.
pub(super) fn term(text: &str, at: usize) -> Result<(Term, bool), Error> {
    if let Some((name, operator, value)) = field(text) {
        let start = at + text.len() - value.len();
        let term = field_term(&name.to_ascii_lowercase(), value, (start, at))?;
        return Ok((term, operator == "!="));
    }
    plain(text, at).map(|term| (term, false))
}

/// `node:5`, `canopen.cob_id == 181`; not `185:7FF`, which is a mask.
fn field(text: &str) -> Option<(&str, &str, &str)> {
    let end = text.find(|c: char| !(c.is_ascii_alphabetic() || c == '_' || c == '.'))?;
    let (name, rest) = text.split_at(end);
    let operator = [":", "==", "!="]
        .into_iter()
        .find(|one| rest.trim_start().starts_with(one))?;
    let value = rest.trim_start().strip_prefix(operator)?.trim_start();
    let is_digits = name.len() <= 3 && name.bytes().all(|byte| byte.is_ascii_hexdigit());
    (!name.is_empty() && !is_digits).then_some((name, operator, value))
}

fn plain(text: &str, at: usize) -> Result<Term, Error> {
    let lower = text.to_ascii_lowercase();
    let has_digit = lower.bytes().any(|byte| byte.is_ascii_digit());
    Ok(match lower.as_str() {
        "nmt" => Term::Service(&["NMT"]),
        "sync" => Term::Service(&["SYNC"]),
        "time" => Term::Service(&["TIME"]),
        "emcy" => Term::Service(&["EMCY"]),
        "pdo" => Term::Service(PDOS),
        "sdo" => Term::Service(&["SDO"]),
        "hb" | "heartbeat" => Term::Service(&["HB"]),
        "lss" => Term::Service(&["LSS"]),
        "can" => Term::Service(&["CAN"]),
        "err" | "error" => Term::Error,
        "tx" | "rx" => Term::Sent(lower == "tx"),
        "rtr" => Term::Remote,
        "abort" => Term::Abort,
        name if PDOS.contains(&name.to_ascii_uppercase().as_str()) => {
            Term::Pdo(name.to_ascii_uppercase())
        }
        _ => {
            if let Some((wanted, mask)) = pair(&lower, ":") {
                let wanted = wanted & mask;
                return Ok(Term::Masked { wanted, mask });
            }
            if let Some((low, high)) = pair(&lower, "..").or_else(|| pair(&lower, "-")) {
                return if low <= high {
                    Ok(Term::Range { low, high })
                } else {
                    Err(mistake(at, "the range ends before it begins"))
                };
            }
            // Three digits are a COB-ID, four an object.
            let digits = lower.strip_prefix("0x").unwrap_or(&lower);
            if has_digit && digits.len() == 3 && is_hex(digits) {
                return identifier(&lower, at);
            }
            match object(&lower).filter(|_| has_digit) {
                Some(object) => object,
                None => words(text),
            }
        }
    })
}

fn field_term(name: &str, value: &str, (at, start): (usize, usize)) -> Result<Term, Error> {
    if value.is_empty() {
        return Err(mistake(at, format!("the value of `{name}` is missing")));
    }
    match name {
        "node" | "canopen.node_id" => {
            let node = match value
                .strip_prefix("0x")
                .or_else(|| value.strip_prefix("0X"))
            {
                Some(digits) => u8::from_str_radix(digits, 16).ok(),
                None => value.parse().ok(),
            };
            let node = node.filter(|node| (1..=127).contains(node));
            node.map(Term::Node)
                .ok_or_else(|| mistake(at, "a node ID is 1 to 127"))
        }
        "id" | "cob" | "can.id" | "canopen.cob_id" => {
            if value.contains([':', '-']) {
                plain(value, at)
            } else {
                identifier(value, at)
            }
        }
        "data" => {
            let digits: String = value
                .chars()
                .filter(|c| *c != '"' && !c.is_whitespace())
                .collect();
            let wrong = || {
                mistake(
                    at,
                    "write two hexadecimal digits for each byte, or `..` for any",
                )
            };
            if digits.is_empty() || !digits.len().is_multiple_of(2) || !digits.is_ascii() {
                return Err(wrong());
            }
            let pairs = (0..digits.len()).step_by(2).map(|at| &digits[at..at + 2]);
            let bytes = pairs.map(|pair| match pair {
                ".." | "xx" | "XX" => Ok(None),
                pair if is_hex(pair) => u8::from_str_radix(pair, 16).map(Some).map_err(|_| wrong()),
                _ => Err(wrong()),
            });
            bytes.collect::<Result<_, _>>().map(Term::Data)
        }
        "object" | "index" => object(&value.to_ascii_lowercase())
            .ok_or_else(|| mistake(at, "write an object such as 6004 or 1018:01")),
        "len" | "dlc" => match value.parse() {
            Ok(length @ 0..=8) => Ok(Term::Length(length)),
            _ => Err(mistake(at, "a length is 0 to 8")),
        },
        "text" => Ok(words(value)),
        name => Err(mistake(
            start,
            format!("`{name}` is not a field; write node, id, data, object, len or text"),
        )),
    }
}

fn words(text: &str) -> Term {
    Term::Words(text.replace('"', "").to_lowercase())
}

fn identifier(text: &str, at: usize) -> Result<Term, Error> {
    let id = number(&text.to_ascii_lowercase()).filter(|id| *id <= 0x1FFF_FFFF);
    id.map(|id| Term::Range { low: id, high: id })
        .ok_or_else(|| mistake(at, "a COB-ID is a hexadecimal number of at most 29 bits"))
}

/// `6004`, `0x1018:1`, `1018h.02`.
fn object(text: &str) -> Option<Term> {
    let (index, sub) = match text.split_once([':', '.']) {
        Some((index, sub)) => (index, Some(sub)),
        None => (text, None),
    };
    let digits = |text: &str| {
        let text = text.strip_prefix("0x").unwrap_or(text);
        text.strip_suffix('h').unwrap_or(text).to_owned()
    };
    let index = digits(index);
    let index = Some(index).filter(|index| index.len() == 4 && is_hex(index))?;
    let sub = match sub.map(digits) {
        None => None,
        Some(sub) if (1..=2).contains(&sub.len()) && is_hex(&sub) => {
            Some(u8::from_str_radix(&sub, 16).ok()?)
        }
        Some(_) => return None,
    };
    let index = u16::from_str_radix(&index, 16).ok()?;
    Some(Term::Object { index, sub })
}

/// Two hexadecimal numbers.
fn pair(text: &str, between: &str) -> Option<(u32, u32)> {
    let (first, second) = text.split_once(between)?;
    // `h` after a number makes it an object with a sub-index.
    let plain = |text: &str| (!text.ends_with('h')).then(|| number(text)).flatten();
    Some((plain(first)?, plain(second)?))
}

fn number(text: &str) -> Option<u32> {
    let digits = text.strip_prefix("0x").unwrap_or(text);
    let digits = digits.strip_suffix('h').unwrap_or(digits);
    let is_right = (1..=8).contains(&digits.len()) && is_hex(digits);
    u32::from_str_radix(digits, 16).ok().filter(|_| is_right)
}

fn is_hex(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_hexdigit())
}
