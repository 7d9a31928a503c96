//! Argument that says how the time of a bus moves.

use crate::faults::Fault;

/// Movement of the time of a bus.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Time {
    /// While all threads that take part wait.
    #[default]
    Virtual,
    /// Like `Virtual`, but it is an error if time follows the clock.
    Strict,
    /// With the clock.
    Real,
}

impl Time {
    /// Reads `virtual`, `strict` or `real`.
    ///
    /// # Errors
    /// It is another word.
    pub(crate) fn parse(word: &str) -> Result<Self, Fault> {
        match word {
            "virtual" => Ok(Self::Virtual),
            "strict" => Ok(Self::Strict),
            "real" => Ok(Self::Real),
            other => Err(Fault::value(format!(
                "time `{other}` is not known; write `virtual`, `strict` or `real`"
            ))),
        }
    }

    /// Its word.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Virtual => "virtual",
            Self::Strict => "strict",
            Self::Real => "real",
        }
    }
}

/// The factor of a caller between the clock and the time of a bus.
///
/// # Errors
/// It is negative or not a number.
pub(crate) fn pace(pace: f64) -> Result<f64, Fault> {
    if pace.is_finite() && pace >= 0.0 {
        return Ok(pace);
    }
    Err(Fault::value(format!(
        "pace is {pace}; it must be 0 or more: seconds on the bus for each second of the clock"
    )))
}
