//! Durations as text, in scripts, in the list of the master and in recordings: `500ms`, `1.5s`, `20us`, `2min`.

use std::format;
use std::prelude::v1::*;

use crate::logs::stamp;

/// Writes microseconds with the largest unit of `s`, `ms` and `us` that needs no decimal point.
pub(crate) fn duration(micros: u64) -> String {
    match (micros % 1_000_000, micros % 1000) {
        (0, _) if micros > 0 => format!("{}s", micros / 1_000_000),
        (_, 0) => format!("{}ms", micros / 1000),
        _ => format!("{micros}us"),
    }
}

/// Reads a duration in microseconds, at most `u64::MAX`; `None` for a text that is not a duration. A part of a
/// microsecond is cut off.
pub(crate) fn parse(text: &str) -> Option<u64> {
    let unit = text
        .find(|c: char| c.is_ascii_alphabetic())
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(unit);
    let scale = match unit {
        "us" => |seconds| seconds / 1_000_000,
        "ms" => |seconds| seconds / 1000,
        "s" => |seconds| seconds,
        "min" => |seconds: u64| seconds.saturating_mul(60),
        _ => return None,
    };
    match stamp::seconds(number) {
        Some(micros) => Some(scale(micros)),
        None => is_decimal(number).then_some(u64::MAX),
    }
}

/// Returns whether a text has only digits and at most one decimal point, however long it is.
pub(crate) fn is_decimal(text: &str) -> bool {
    text.matches('.').count() <= 1
        && text.bytes().any(|byte| byte.is_ascii_digit())
        && text
            .bytes()
            .all(|byte| byte.is_ascii_digit() || byte == b'.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_duration_is_read_again() {
        for (micros, text) in [
            (0, "0ms"),
            (1, "1us"),
            (1_500, "1500us"),
            (20_000, "20ms"),
            (1_500_000, "1500ms"),
            (3_600_000_000, "3600s"),
        ] {
            assert_eq!(duration(micros), text);
            assert_eq!(parse(text), Some(micros));
        }
    }

    #[test]
    fn a_duration_has_a_number_and_a_unit() {
        assert_eq!(parse("1.5s"), Some(1_500_000));
        assert_eq!(parse("2min"), Some(120_000_000));
        assert_eq!(parse("0.0005ms"), Some(0));
        assert_eq!(parse("99999999999999999999s"), Some(u64::MAX));
        assert_eq!(parse("18446744073709551615min"), Some(u64::MAX));
        for text in ["", "5", "s", "1h", "1.2.3s", "-1s", "1 s", "1S"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
