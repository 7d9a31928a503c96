//! Checks sections that describe no object against CiA 306.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::finding::Finding;
use crate::log::Log;
use crate::rules::lists::reader::{
    i0211_unknown_section, is_rate, w0213_section_misspelled, w0252_bit_rate_unknown,
};
use crate::rules::standard::reader::{
    i0610_date_or_time, i0611_commissioning_spelling, w0609_key_value_not_valid,
};
use crate::rules::structure::reader::{i0319_unknown_key, w0318_key_misspelled};
use crate::rules::structure::w0344_name_too_long::text_too_long;
use crate::rules::text::w0109_comment_after_other;
use crate::scan::forms;
use crate::scan::forms::{Form, OBJECT_KEYS, SectionForm};
use crate::scan::names::List;
use crate::scan::number::{self, Note};
use crate::scan::section::{Text, TextSection};
use od_model::Address;

/// Reports unknown keys of a section, and invalid values.
pub(crate) fn check(placed: &TextSection<'_>, log: &mut Log) {
    let name = &placed.name;
    if name.is_empty() || forms::is_of_objects(name) {
        let is_links = name.to_ascii_lowercase().ends_with("objectlinks");
        for (key, value) in placed.pairs.iter().filter(|_| is_links) {
            if let Some(meant) = forms::near(key, ["ObjectLinks"].into_iter()) {
                log.push(w0318_key_misspelled(key, value, meant));
            }
        }
        return;
    }
    let Some((_, known)) = forms::section(name) else {
        unknown_section(placed, log);
        return;
    };
    if known.name == "DeviceCommissioning" {
        let mut pairs = placed.pairs.iter();
        let is_valid = |(key, value): &(Text<'_>, Text<'_>)| {
            // python-canopen takes the bit rate as a decimal number, and stops at `Baudrate=0x7D`.
            let is_taken = !key.eq_ignore_ascii_case("Baudrate") || value.parse::<u32>().is_ok();
            let form = forms::key(known, key).map(|(_, form)| form);
            form.is_none_or(|form| value.is_empty() || is_taken && fits(value, form))
        };
        let finding = i0611_commissioning_spelling(placed.header, pairs.all(is_valid));
        log.push(finding);
    }
    for (key, value) in &placed.pairs {
        match forms::key(known, key) {
            Some((_, form)) => check_value(known, key, value, form, log),
            None if known.name == "DeviceInfo" && is_rate(key) => {
                log.push(w0252_bit_rate_unknown(key));
            }
            None => log.push(unknown_key(
                key,
                value,
                known.keys.iter().map(|(key, _)| *key),
            )),
        }
    }
}

/// Reports texts of a section that are too long for a line of a file. A line of XML has no limit.
pub(crate) fn lengths(placed: &TextSection<'_>, log: &mut Log) {
    let Some((_, known)) = forms::section(&placed.name) else {
        return;
    };
    for (key, value) in &placed.pairs {
        if let Some((_, Form::Text)) = forms::key(known, key) {
            log.extend(text_too_long(key, value));
        }
    }
}

fn unknown_section(placed: &TextSection<'_>, log: &mut Log) {
    let name = &placed.name;
    let names = forms::SECTIONS
        .iter()
        .map(|known| known.name)
        .chain(List::ALL.map(List::name));
    let object = object_section(name);
    log.push(match object.as_deref().or(forms::near(name, names)) {
        Some(meant) => w0213_section_misspelled(placed, meant),
        None => i0211_unknown_section(placed),
    });
}

/// The section of an object or a sub-object that was probably intended: `2005sub3` for `2005sb3`, `1017` with a zero for
/// `1O17` with a letter.
fn object_section(name: &str) -> Option<String> {
    let (index, rest) = name.split_at_checked(4)?;
    let digits = index.replace(['O', 'o'], "0").replace(['I', 'l'], "1");
    let (index, is_digits) = (digits.as_str(), digits == index);
    let word = rest.trim_end_matches(|c: char| c.is_ascii_hexdigit());
    // The `b` of `sub` is a hexadecimal digit.
    let word = if rest[word.len()..].starts_with(['b', 'B']) {
        rest.get(..word.len() + 1)?
    } else {
        word
    };
    let index = u16::from_str_radix(index, 16).ok()?;
    if rest.is_empty() && !is_digits {
        return Some(format!("{index:04X}"));
    }
    let sub = u8::from_str_radix(rest.get(word.len()..)?, 16).ok()?;
    forms::nearest(word.trim(), ["sub"].into_iter(), 1)?;
    Some(format!("{index:04X}sub{sub:X}"))
}

/// The finding about a key that odkit ignores, with the key that may be intended.
fn unknown_key<'a>(key: &Text<'_>, value: &str, keys: impl Iterator<Item = &'a str>) -> Finding {
    match forms::near(key, keys) {
        Some(meant) => w0318_key_misspelled(key, value, &meant.replace('#', "1")),
        None => i0319_unknown_key(key),
    }
}

/// Reports keys of an object or a sub-object that odkit ignores.
pub(crate) fn unknown_object_keys(rest: &[(Text<'_>, Text<'_>)], address: Address, log: &mut Log) {
    for (key, value) in rest {
        if !OBJECT_KEYS
            .iter()
            .any(|known| key.eq_ignore_ascii_case(known))
        {
            log.push(unknown_key(key, value, OBJECT_KEYS.into_iter()).about(address));
        }
    }
}

fn check_value(known: &SectionForm, key: &str, value: &Text<'_>, form: Form, log: &mut Log) {
    // An empty version is not one of a standard; each other value may be empty.
    let is_due = !value.is_empty() || form == Form::Version;
    if is_due && !fits(value, form) {
        log.push(match form {
            Form::Date | Form::Time => i0610_date_or_time(key, value, form),
            _ => w0609_key_value_not_valid(&known.name.replace('#', "1"), key, value, form),
        });
    } else if form.is_number() {
        let number = number::before_comment(value);
        if number.len() < value.len() {
            log.push(w0109_comment_after_other(key, value, number));
        }
    }
}

fn fits(value: &str, form: Form) -> bool {
    let text = number::before_comment(value);
    let mut notes = Vec::new();
    let read = number::integer(text, &mut notes).map(|number| number.value);
    // Other tools stop at `7AB` and `1.0`.
    let read = read.filter(|_| {
        !notes
            .iter()
            .any(|note| matches!(note, Note::BareHex | Note::Suffix))
    });
    match form {
        Form::Text => true,
        Form::Flag => matches!(read, Some(0 | 1)),
        Form::Number(most) => read.is_some_and(|n| (0..=i128::from(most)).contains(&n)),
        Form::Version => is_version(text),
        Form::Date => forms::day(value).is_some(),
        Form::Time => is_time(value),
    }
}

/// A version of CiA 306 for CANopen 4.
fn is_version(text: &str) -> bool {
    matches!(text, "4.0" | "4.1" | "4.2")
}

fn is_time(text: &str) -> bool {
    let Some((time, half)) = text
        .len()
        .checked_sub(2)
        .and_then(|at| text.split_at_checked(at))
    else {
        return false;
    };
    let half = half.eq_ignore_ascii_case("AM") || half.eq_ignore_ascii_case("PM");
    half && matches!(
        forms::parts(time.trim_end(), ':')[..],
        [Some(0..=12), Some(0..=59)]
    )
}
