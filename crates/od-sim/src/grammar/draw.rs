//! Lines with draws: `random shaft rpm -3000..3000`, `random fault`, `random power cut`.
//!
//! A draw makes the text of an ordinary line, so a run can be repeated by a script without draws.

use std::format;
use std::prelude::v1::*;

use od_model::values;

/// Range of the length of a power cut for which a line names none.
const CUT: &str = "1ms..1s";
/// Units of a duration with their lengths in microseconds; `s` is the end of others.
const UNITS: [(&str, i128); 4] = [
    ("us", 1),
    ("ms", 1000),
    ("min", 60_000_000),
    ("s", 1_000_000),
];
/// Maximum number of digits after a decimal point.
const PLACES: usize = 9;

/// A number of a draw from 0 to a last one.
pub(crate) type Number<'n> = &'n mut dyn FnMut(u64) -> u64;

/// The text of a line with `A..B` replaced by a number from `A` to `B`, and `xx` in a frame by a byte. `faults` are those of
/// the present device, and whether each is active.
///
/// # Errors
/// The draw that is not possible.
pub(crate) fn drawn(
    text: &str,
    faults: &[(&str, bool)],
    number: Number<'_>,
) -> Result<String, String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    match words.as_slice() {
        ["fault"] => {
            let last = faults.len().checked_sub(1);
            let last = last.ok_or("this device does not support any fault of scripts")?;
            let (name, is_active) = faults[number(last as u64) as usize];
            Ok(format!(
                "fault {name} {}",
                if is_active { "off" } else { "on" }
            ))
        }
        ["power", "cut"] => drawn(&format!("power cycle {CUT}"), faults, number),
        ["power", "cut", length] => drawn(&format!("power cycle {length}"), faults, number),
        _ => in_words(text, number),
    }
}

fn in_words(text: &str, number: Number<'_>) -> Result<String, String> {
    let mut out = String::with_capacity(text.len());
    let (mut is_quoted, mut is_frame) = (false, false);
    for word in text.split_inclusive(char::is_whitespace) {
        let blank = word.len() - word.trim_end().len();
        let (word, blank) = word.split_at(word.len() - blank);
        let was_quoted = is_quoted;
        is_quoted ^= word.matches('"').count() % 2 == 1;
        if was_quoted || word.contains('"') {
            out.push_str(word);
        } else if let Some((id, data)) = word.split_once('#') {
            is_frame = true;
            out.push_str(&format!("{id}#{}", with_bytes(data, number)));
        } else if let Some(drawn) = in_range(word, number)? {
            out.push_str(&drawn);
        } else if is_frame {
            out.push_str(&with_bytes(word, number));
        } else {
            out.push_str(word);
        }
        out.push_str(blank);
    }
    Ok(out)
}

/// The data of a frame with a random byte for each `xx`.
fn with_bytes(data: &str, number: Number<'_>) -> String {
    let pieces: Vec<&str> = data.split("xx").collect();
    let mut out = String::new();
    for (place, piece) in pieces.iter().enumerate() {
        if place > 0 {
            out.push_str(&format!("{:02X}", number(0xFF)));
        }
        out.push_str(piece);
    }
    out
}

/// A number of a range `A..B`; `None` if the word is something else.
fn in_range(word: &str, number: Number<'_>) -> Result<Option<String>, String> {
    let Some((low, high)) = word.split_once("..") else {
        return Ok(None);
    };
    let (Some(mut low), Some(high)) = (Written::of(low), Written::of(high)) else {
        return Ok(None);
    };
    if low.micros.is_none() {
        low.micros = high.micros;
    } else if high.micros.is_none() {
        return Err(format!("the end of `{word}` has no unit"));
    }
    if let (Some(one), Some(other)) = (low.micros, high.micros) {
        let (low, high) = (low.whole(one), high.whole(other));
        let (Some(low), Some(high)) = (low, high) else {
            return Err(format!("`{word}` is not in whole microseconds"));
        };
        return Ok(Some(format!("{}us", between(word, low, high, number)?)));
    }
    let places = low.places.max(high.places);
    let value = between(word, low.scaled(places), high.scaled(places), number)?;
    let one = 10_u128.pow(places as u32);
    let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
    let (whole, part) = (size / one, size % one);
    Ok(Some(match places {
        0 => format!("{sign}{whole}"),
        _ => format!("{sign}{whole}.{part:0places$}"),
    }))
}

fn between(word: &str, low: i128, high: i128, number: Number<'_>) -> Result<i128, String> {
    let width = high
        .checked_sub(low)
        .filter(|width| *width >= 0)
        .ok_or_else(|| format!("`{word}` begins above its end"))?;
    let last = u64::try_from(width).map_err(|_| format!("`{word}` is too wide"))?;
    Ok(low + i128::from(number(last)))
}

/// A number as written: `-2.50`, `1000h`, `20ms`.
struct Written {
    /// Its digits without the point.
    digits: i128,
    /// Number of digits after the point.
    places: usize,
    /// The length of its unit in microseconds, for a duration.
    micros: Option<i128>,
}

impl Written {
    fn of(text: &str) -> Option<Self> {
        if let Some(digits) = values::integer(text) {
            return Some(Self {
                digits,
                places: 0,
                micros: None,
            });
        }
        let unit = UNITS.iter().find(|(name, _)| text.ends_with(name));
        let number = &text[..text.len() - unit.map_or(0, |(name, _)| name.len())];
        let (whole, part) = number.split_once('.').unwrap_or((number, ""));
        let size = whole.strip_prefix('-').unwrap_or(whole);
        let is_number = [size, part]
            .iter()
            .all(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
        if !is_number || size.is_empty() || size.len() > 18 || part.len() > PLACES {
            return None;
        }
        let digits: i128 = format!("{size}{part}").parse().ok()?;
        Some(Self {
            digits: if whole.starts_with('-') {
                -digits
            } else {
                digits
            },
            places: part.len(),
            micros: unit.map(|(_, micros)| *micros),
        })
    }

    /// Its digits with this number of digits after the point, which is at least its own.
    fn scaled(&self, places: usize) -> i128 {
        self.digits * 10_i128.pow((places - self.places) as u32)
    }

    /// Its length in microseconds, if that is a whole number.
    fn whole(&self, micros: i128) -> Option<i128> {
        let one = 10_i128.pow(self.places as u32);
        let length = self.digits * micros;
        (length % one == 0).then(|| length / one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn both(text: &str) -> (Result<String, String>, Result<String, String>) {
        let faults = [("battery-low", false), ("internal", true)];
        (
            drawn(text, &faults, &mut |_| 0),
            drawn(text, &faults, &mut |last| last),
        )
    }

    #[test]
    fn both_ends_of_each_range() {
        for (text, low, high) in [
            ("shaft rpm -3000..3000", "shaft rpm -3000", "shaft rpm 3000"),
            (
                "shaft turn -1.5..0.25",
                "shaft turn -1.50",
                "shaft turn 0.25",
            ),
            ("shaft turn -0.5..1", "shaft turn -0.5", "shaft turn 1.0"),
            ("shaft at 0x10..20h", "shaft at 16", "shaft at 32"),
            ("wait 0..20ms", "wait 0us", "wait 20000us"),
            ("wait 20us..1.5ms", "wait 20us", "wait 1500us"),
            ("wait 1s..2min", "wait 1000000us", "wait 120000000us"),
            ("fault", "fault battery-low on", "fault internal off"),
            ("power cut", "power cycle 1000us", "power cycle 1000000us"),
            (
                "power cut 0..2s",
                "power cycle 0us",
                "power cycle 2000000us",
            ),
            ("601#40xx 10 xx", "601#4000 10 00", "601#40FF 10 FF"),
            (
                "send 601#xx 1..3 times",
                "send 601#00 1 times",
                "send 601#FF 3 times",
            ),
            (
                "sdo write 2000h = \"1..3\"",
                "sdo write 2000h = \"1..3\"",
                "sdo write 2000h = \"1..3\"",
            ),
            ("set 6000h:01 = 5", "set 6000h:01 = 5", "set 6000h:01 = 5"),
            ("use a..b", "use a..b", "use a..b"),
        ] {
            assert_eq!(both(text), (Ok(low.into()), Ok(high.into())), "{text}");
        }
    }

    #[test]
    fn a_draw_that_is_not_possible_says_why() {
        for (text, why) in [
            ("shaft rpm 3..1", "`3..1` begins above its end"),
            ("wait 1ms..5", "the end of `1ms..5` has no unit"),
            (
                "wait 0.0001ms..5ms",
                "`0.0001ms..5ms` is not in whole microseconds",
            ),
            ("shaft at -1..0xFFFFFFFFFFFFFFFF", "is too wide"),
        ] {
            let said = both(text).0.expect_err(text);
            assert!(said.contains(why), "{text}: {said}");
        }
        let said = drawn("fault", &[], &mut |_| 0).expect_err("no fault");
        assert_eq!(said, "this device does not support any fault of scripts");
    }
}
