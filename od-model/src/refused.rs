//! Reason why an input was refused.

use alloc::string::String;
use core::error::Error;
use core::fmt;

/// Reason why an input was refused, in words: the error, and what to write instead.
///
/// ```
/// use od_model::{DataType, values};
///
/// let refused = values::parse(DataType::Unsigned8, "300").expect_err("the largest is 255");
/// assert_eq!(refused.to_string(), "UNSIGNED8 goes from 0 to 255");
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Refused(String);

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for Refused {}

impl From<String> for Refused {
    fn from(why: String) -> Self {
        Self(why)
    }
}

impl From<&str> for Refused {
    fn from(why: &str) -> Self {
        Self(String::from(why))
    }
}

impl From<Refused> for String {
    fn from(refused: Refused) -> Self {
        refused.0
    }
}
