//! Time stamps of candump: seconds (`-ta`, `-td`, `-tz`, `-L`), or a date (`-tA`).

use crate::cursor::Cursor;

/// Reads the time stamp at the front, `(0.100000)` or `(2026-11-25 15:50:01.123456)`, in microseconds. `None` if it
/// is missing; then the text stays unread.
pub(crate) fn take(rest: &mut Cursor<'_>) -> Option<u64> {
    let (inner, after) = rest.text.strip_prefix('(')?.split_once(')')?;
    if !after.is_empty() && !after.starts_with(char::is_whitespace) {
        return None;
    }
    let micros = seconds(inner).or_else(|| date(inner))?;
    rest.skip(inner.len() + 2);
    Some(micros)
}

/// Microseconds of a decimal number of seconds, with a point or a comma; digits after the sixth are cut off.
pub(crate) fn seconds(text: &str) -> Option<u64> {
    let (whole, fraction) = text.split_once(['.', ',']).unwrap_or((text, ""));
    if !is_digits(whole) || !is_digits(fraction) || whole.len() + fraction.len() == 0 {
        return None;
    }
    let whole: u64 = if whole.is_empty() {
        0
    } else {
        whole.parse().ok()?
    };
    let micros = fraction.bytes().chain([b'0'; 6]).take(6);
    let micros = micros.fold(0, |micros, digit| micros * 10 + u64::from(digit - b'0'));
    whole.checked_mul(1_000_000)?.checked_add(micros)
}

/// Microseconds from 1970 to `2026-11-25 15:50:01.123456`.
pub(crate) fn date(text: &str) -> Option<u64> {
    let (date, time) = text.split_once(' ')?;
    let mut date = date.split('-');
    let year = number(date.next()?, 1970..=9999)?;
    let month = number(date.next()?, 1..=12)?;
    let day = number(date.next()?, 1..=31)?;
    let time = time_of_day(time)?;
    if date.next().is_some() {
        return None;
    }
    // Let a year begin in March, so that its leap day is the last day.
    let (year, month) = match month {
        1 | 2 => (year - 1, month + 9),
        _ => (year, month - 3),
    };
    let days = year * 365 + year / 4 - year / 100 + year / 400 + (month * 153 + 2) / 5 + day - 1;
    Some((days - DAYS_TO_1970) * 86_400_000_000 + time)
}

/// Microseconds from midnight to `15:50:01.123456`.
pub(crate) fn time_of_day(text: &str) -> Option<u64> {
    let mut parts = text.splitn(3, ':');
    let hour = number(parts.next()?, 0..=23)?;
    let minute = number(parts.next()?, 0..=59)?;
    let second = seconds(parts.next()?).filter(|micros| *micros < 61_000_000)?;
    Some((hour * 60 + minute) * 60_000_000 + second)
}

/// Days from 1 March of the year 0 to 1 January 1970.
const DAYS_TO_1970: u64 = 719_468;

fn number(text: &str, allowed: core::ops::RangeInclusive<u64>) -> Option<u64> {
    let number = text.parse().ok().filter(|_| is_digits(text))?;
    allowed.contains(&number).then_some(number)
}

fn is_digits(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_seconds_or_a_date() {
        let read = |text| {
            let mut rest = Cursor::new(text);
            take(&mut rest).map(|micros| (micros, rest.text))
        };
        assert_eq!(read("(0.1) can0"), Some((100_000, "can0")));
        assert_eq!(read("(.5)"), Some((500_000, "")));
        assert_eq!(read("(1970-01-01 00:00:00.5) x"), Some((500_000, "x")));
        assert_eq!(
            read("(2024-02-29 23:59:59.000001) x"),
            Some((1_709_251_199_000_001, "x"))
        );
        assert_eq!(
            read("(2026-11-25 15:50:01) x"),
            Some((1_795_621_801_000_000, "x"))
        );
        for text in [
            "0.1",
            "()",
            "(.)",
            "(x)",
            "(1)x",
            "(1",
            "(99999999999999999999)",
            "(2026-13-01 00:00:00)",
            "(2026-01-00 00:00:00)",
            "(2026-01-01-01 00:00:00)",
            "(2026-01-01 24:00:00)",
            "(2026-01-01 00:60:00)",
            "(2026-01-01 00:00:61)",
            "(2026-01-01 00:00)",
            "(+026-01-01 00:00:00)",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
