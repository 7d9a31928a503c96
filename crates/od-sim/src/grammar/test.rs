//! Comparisons of a value: `= 500`, `!= 0`, `in 400..600`.

use std::format;
use std::prelude::v1::*;

use od_model::typed::Scalar;
use od_model::{DataType, Kind, values};

use super::problem::Problem;
use super::tokens::Tokens;

/// A comparison with a value, as written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Test {
    how: How,
    text: String,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum How {
    Equal,
    Unequal,
    Below,
    AtMost,
    Above,
    AtLeast,
    /// `low..high`, both included.
    Between,
}

/// The signs of comparisons.
pub(crate) const SIGNS: [(&str, How); 7] = [
    ("=", How::Equal),
    ("!=", How::Unequal),
    ("<", How::Below),
    ("<=", How::AtMost),
    (">", How::Above),
    (">=", How::AtLeast),
    ("in", How::Between),
];

impl Test {
    /// Reads the value after a sign.
    pub(crate) fn value(how: How, tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let here = *tokens;
        let value = tokens.take_rest();
        let between = value.rest().contains("..");
        if value.is_empty() || (how == How::Between) != between {
            return Err(here.problem(
                "the value is missing",
                "write `= 500`, `!= 0`, `< 10`, `<= 10`, `> 10`, `>= 10` or `in 10..20`",
            ));
        }
        Ok(Self {
            how,
            text: value.rest().to_owned(),
        })
    }

    /// Reads a comparison with a number: `= 5`, or only `5`.
    pub(crate) fn number(tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let sign = tokens.peek();
        let how = SIGNS.iter().find(|(name, _)| *name == sign);
        if how.is_some() {
            tokens.next();
        }
        let here = *tokens;
        let test = Self::value(how.map_or(How::Equal, |(_, how)| *how), tokens)?;
        if test.text.split("..").all(|part| number(part).is_some()) {
            Ok(test)
        } else {
            Err(here.problem(format!("`{}` is not a number", test.text), "write a number"))
        }
    }

    /// Checks that the values fit the type.
    ///
    /// # Errors
    /// The message describes a valid value.
    pub(crate) fn fits(&self, data_type: DataType) -> Result<(), String> {
        for part in self.text.split("..") {
            values::parse(data_type, part)?;
        }
        Ok(())
    }

    /// Returns whether a value of this type meets the comparison.
    ///
    /// # Errors
    /// Reason why it cannot be compared.
    pub(crate) fn holds(&self, data_type: DataType, bytes: &[u8]) -> Result<bool, String> {
        self.fits(data_type)?;
        match self.how {
            How::Equal => Ok(values::parse(data_type, &self.text)? == bytes),
            How::Unequal => Ok(values::parse(data_type, &self.text)? != bytes),
            _ => match as_number(data_type, bytes) {
                Some(value) => Ok(self.holds_number(value)),
                None => Err(format!("{data_type} has no order; write `=` or `!=`")),
            },
        }
    }

    /// Returns a value as the comparison writes its own: in hexadecimal, with all digits of the type, or with both numbers.
    pub(crate) fn show(&self, data_type: DataType, bytes: &[u8]) -> String {
        let is_hexadecimal = self.text.starts_with("0x") || self.text.ends_with('h');
        if !is_hexadecimal || as_number(data_type, bytes).is_none() {
            return values::show(data_type, bytes);
        }
        let digits = bytes.iter().rev().map(|byte| format!("{byte:02X}"));
        format!("{}h", digits.collect::<String>())
    }

    /// Returns whether a number meets the comparison.
    pub(crate) fn holds_number(&self, value: f64) -> bool {
        let (low, high) = self.text.split_once("..").unwrap_or((&self.text, ""));
        let Some(wanted) = number(low) else {
            return false;
        };
        match self.how {
            How::Equal => value == wanted,
            How::Unequal => value != wanted,
            How::Below => value < wanted,
            How::AtMost => value <= wanted,
            How::Above => value > wanted,
            How::AtLeast => value >= wanted,
            How::Between => number(high).is_some_and(|high| (wanted..=high).contains(&value)),
        }
    }

    /// The comparison in words, for use after "is".
    pub(crate) fn words(&self) -> String {
        match self.how {
            How::Equal => self.text.clone(),
            How::Unequal => format!("other than {}", self.text),
            How::Below => format!("below {}", self.text),
            How::AtMost => format!("at most {}", self.text),
            How::Above => format!("above {}", self.text),
            How::AtLeast => format!("at least {}", self.text),
            How::Between => self.text.replace("..", " to "),
        }
    }
}

/// Precise enough for comparisons: practical values are far below 2⁵³.
fn as_number(data_type: DataType, bytes: &[u8]) -> Option<f64> {
    if data_type.size() != Some(bytes.len()) {
        return None;
    }
    match data_type.kind() {
        Kind::Boolean | Kind::Unsigned => Some(u64::from_wire(bytes) as f64),
        Kind::Signed => Some(i64::from_wire(bytes) as f64),
        Kind::Real => match *bytes {
            [a, b, c, d] => Some(f32::from_le_bytes([a, b, c, d]).into()),
            _ => Some(f64::from_bits(u64::from_wire(bytes))),
        },
        Kind::Text | Kind::Bytes | Kind::Record => None,
    }
}

/// Reads a number of a lesson: a whole number in any form, or one with a decimal point.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    match values::integer(text) {
        Some(whole) => Some(whole as f64),
        None => text.parse::<f64>().ok().filter(|value| value.is_finite()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_shown_in_the_base_of_the_comparison() {
        let shown = |text: &str, data_type, bytes: &[u8]| {
            let test = Test {
                how: How::Equal,
                text: text.into(),
            };
            test.show(data_type, bytes)
        };
        assert_eq!(shown("0x0237", DataType::Unsigned16, &[0x50, 2]), "0250h");
        assert_eq!(
            shown("185h", DataType::Unsigned32, &[5, 2, 0, 0]),
            "00000205h"
        );
        assert_eq!(shown("100", DataType::Unsigned16, &[50, 0]), "50 (32h)");
        assert_eq!(shown("h", DataType::VisibleString, b"ab"), "\"ab\"");
    }
}
