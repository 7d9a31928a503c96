//! A value of a made description: its type, access, limits, and bytes.

use od_model::{Address, DataType, Kind};

use crate::choices::Choices;

/// A value of a description.
#[derive(Clone, Debug)]
pub struct Made {
    /// Its object.
    pub address: Address,
    /// Its type.
    pub data_type: DataType,
    /// `AccessType`.
    pub access: &'static str,
    /// `PDOMapping`.
    pub mappable: bool,
    /// Limits of a number.
    pub limits: Option<(i128, i128)>,
    /// The bytes at the start.
    pub value: Vec<u8>,
    /// `DefaultValue`.
    pub(crate) text: String,
}

impl Made {
    /// Returns whether a master may read it.
    pub fn is_readable(&self) -> bool {
        self.access != "wo"
    }

    /// Returns whether a master may write it.
    pub fn is_writable(&self) -> bool {
        !["ro", "const"].contains(&self.access)
    }

    /// Returns whether a TPDO or RPDO may contain the value as whole bytes.
    pub(crate) fn fits_pdo(&self, is_received: bool) -> bool {
        let accesses = if is_received {
            ["wo", "rww", "rw"]
        } else {
            ["ro", "rwr", "rw"]
        };
        let is_whole = self.data_type.size().is_some() && self.data_type != DataType::Boolean;
        self.mappable && is_whole && accesses.contains(&self.access)
    }
}

const TYPES: [DataType; 20] = {
    use DataType::*;
    [
        Unsigned8,
        Unsigned16,
        Unsigned32,
        Integer8,
        Integer16,
        Integer32,
        Boolean,
        Real32,
        VisibleString,
        Integer24,
        Real64,
        Integer40,
        Integer48,
        Integer56,
        Integer64,
        Unsigned24,
        Unsigned40,
        Unsigned48,
        Unsigned56,
        Unsigned64,
    ]
};

/// The node ID of every device here.
pub const NODE: u8 = 1;

/// A value that is valid for its type and limits.
pub(crate) fn value(
    address: Address,
    data_type: Option<DataType>,
    choices: &mut Choices<'_>,
) -> Made {
    let data_type = data_type.unwrap_or_else(|| choices.pick(&TYPES));
    let size = data_type.size().unwrap_or(0);
    let mut limits = None;
    let (text, value) = match (data_type.integer_range(), data_type.kind()) {
        (Some((low, high)), kind) => {
            let mut numbers = [(); 3].map(|()| integer(low, high, choices));
            if kind != Kind::Boolean && choices.once_in(3) {
                numbers.sort_unstable();
                limits = Some((numbers[0], numbers[2]));
            }
            let number = numbers[1];
            let is_hex = low == 0 && choices.once_in(2);
            let text = match number {
                _ if limits.is_none() && size == 4 && low == 0 && choices.once_in(5) => {
                    let offset = (number as u32) >> 1;
                    let value = u64::from(offset) + u64::from(NODE);
                    let bytes = value.to_le_bytes()[..size].to_vec();
                    return Made {
                        text: format!("$NODEID+0x{offset:X}"),
                        value: bytes,
                        ..plain(address, data_type, choices)
                    };
                }
                number if is_hex => format!("0x{number:X}"),
                number => number.to_string(),
            };
            (text, number.to_le_bytes()[..size].to_vec())
        }
        (None, Kind::Real) => {
            let number = f64::from(choices.number() as i16) / 4.0;
            let bytes = match size {
                4 => (number as f32).to_le_bytes().to_vec(),
                _ => number.to_le_bytes().to_vec(),
            };
            (number.to_string(), bytes)
        }
        _ => {
            let letters = b"azAZ09 ;=[]\"$#,.:/";
            let text = (0..choices.below(12)).map(|_| char::from(choices.pick(letters)));
            let text = format!("x{}x", text.collect::<String>());
            (text.clone(), text.into_bytes())
        }
    };
    Made {
        limits,
        value,
        text,
        ..plain(address, data_type, choices)
    }
}

fn plain(address: Address, data_type: DataType, choices: &mut Choices<'_>) -> Made {
    let access = match data_type.size() {
        Some(_) => choices.pick(&["rw", "ro", "rww", "rwr", "wo", "const"]),
        None => choices.pick(&["ro", "const"]),
    };
    Made {
        address,
        data_type,
        access,
        mappable: data_type.size().is_some() && access != "const" && choices.once_in(2),
        limits: None,
        value: Vec::new(),
        text: String::new(),
    }
}

/// A number from `low` to `high`; the ends are more likely than others.
pub fn integer(low: i128, high: i128, choices: &mut Choices<'_>) -> i128 {
    match choices.below(6) {
        0 => 0.clamp(low, high),
        1 => 1.clamp(low, high),
        2 => low,
        3 => high,
        _ => low + i128::from(choices.number()) % (high - low + 1),
    }
}
