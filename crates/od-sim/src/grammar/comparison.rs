//! Comparisons of a value: `= 500`, `!= 0`, `in 400..600`.

use std::format;
use std::prelude::v1::*;

use od_model::typed::Scalar;
use od_model::{DataType, Kind, values};

use super::problem::Problem;
use super::tokens::Tokens;

/// A comparison with a value, as written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Comparison {
    operator: Operator,
    text: String,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Operator {
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
pub(crate) const SIGNS: [(&str, Operator); 7] = [
    ("=", Operator::Equal),
    ("!=", Operator::Unequal),
    ("<", Operator::Below),
    ("<=", Operator::AtMost),
    (">", Operator::Above),
    (">=", Operator::AtLeast),
    ("in", Operator::Between),
];

impl Comparison {
    /// Reads the value after a sign.
    pub(crate) fn value(operator: Operator, tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let here = *tokens;
        let value = tokens.take_rest();
        let between = value.rest().contains("..");
        if value.is_empty() || (operator == Operator::Between) != between {
            return Err(here.problem(
                "the value is missing",
                "write `= 500`, `!= 0`, `< 10`, `<= 10`, `> 10`, `>= 10` or `in 10..20`",
            ));
        }
        Ok(Self {
            operator,
            text: value.rest().to_owned(),
        })
    }

    /// Reads a comparison with a number: `= 5`, or only `5`.
    pub(crate) fn number(tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let sign = tokens.peek();
        let operator = SIGNS.iter().find(|(name, _)| *name == sign);
        if operator.is_some() {
            tokens.next();
        }
        let here = *tokens;
        let comparison = Self::value(
            operator.map_or(Operator::Equal, |(_, operator)| *operator),
            tokens,
        )?;
        if comparison
            .text
            .split("..")
            .all(|part| number(part).is_some())
        {
            Ok(comparison)
        } else {
            Err(here.problem(
                format!("`{}` is not a number", comparison.text),
                "write a number",
            ))
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
        match self.operator {
            Operator::Equal => Ok(values::parse(data_type, &self.text)? == bytes),
            Operator::Unequal => Ok(values::parse(data_type, &self.text)? != bytes),
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
        match self.operator {
            Operator::Equal => value == wanted,
            Operator::Unequal => value != wanted,
            Operator::Below => value < wanted,
            Operator::AtMost => value <= wanted,
            Operator::Above => value > wanted,
            Operator::AtLeast => value >= wanted,
            Operator::Between => number(high).is_some_and(|high| (wanted..=high).contains(&value)),
        }
    }

    /// The comparison in words, for use after "is".
    pub(crate) fn words(&self) -> String {
        match self.operator {
            Operator::Equal => self.text.clone(),
            Operator::Unequal => format!("other than {}", self.text),
            Operator::Below => format!("below {}", self.text),
            Operator::AtMost => format!("at most {}", self.text),
            Operator::Above => format!("above {}", self.text),
            Operator::AtLeast => format!("at least {}", self.text),
            Operator::Between => self.text.replace("..", " to "),
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

/// Reads a number: a whole number in any form, or one with a decimal point.
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
            let comparison = Comparison {
                operator: Operator::Equal,
                text: text.into(),
            };
            comparison.show(data_type, bytes)
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
