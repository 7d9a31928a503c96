//! Sections that describe no object: do they say what CiA 306 knows, and in its form?

use alloc::vec::Vec;

use crate::finding::Finding;
use crate::log::Log;
use crate::rules::lists::{i0211, w0213};
use crate::rules::standard::{i0610, i0611, w0609};
use crate::rules::structure::{i0319, w0318};
use crate::scan::known;
use crate::scan::known::{Form, Known, OBJECT_KEYS};
use crate::scan::names::List;
use crate::scan::number;
use crate::scan::placed::{Placed, Text};
use od_model::Address;

/// Names what is unknown in a section, and values that are not what they should be.
pub(crate) fn check(placed: &Placed<'_>, log: &mut Log) {
    let name = &placed.name;
    if name.is_empty() || known::is_of_objects(name) {
        return;
    }
    let Some((_, known)) = known::section(name) else {
        unknown_section(placed, log);
        return;
    };
    if known.name == "DeviceCommissioning" {
        log.push(i0611::finding(placed.header));
    }
    for (key, value) in &placed.pairs {
        match known::key(known, key) {
            Some((_, form)) => check_value(known, key, value, form, log),
            None => log.push(unknown_key(
                key,
                value,
                known.keys.iter().map(|(key, _)| *key),
            )),
        }
    }
}

fn unknown_section(placed: &Placed<'_>, log: &mut Log) {
    let name = &placed.name;
    let names = known::SECTIONS
        .iter()
        .map(|known| known.name)
        .chain(List::ALL.map(List::name));
    log.push(match known::near(name, names) {
        Some(meant) => w0213::finding(placed, meant),
        None => i0211::finding(placed),
    });
}

/// The finding about a key that nobody reads, with the one that may be meant.
fn unknown_key<'a>(key: &Text<'_>, value: &str, keys: impl Iterator<Item = &'a str>) -> Finding {
    match known::near(key, keys) {
        Some(meant) => w0318::finding(key, value, &meant.replace('#', "1")),
        None => i0319::finding(key),
    }
}

/// Names the keys of an object or a member that nobody reads.
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

fn check_value(known: &Known, key: &str, value: &Text<'_>, form: Form, log: &mut Log) {
    if value.is_empty() || matches!(form, Form::Text) {
        return;
    }
    let text = number::before_comment(value);
    let read = number::integer(text, &mut Vec::new()).map(|number| number.value);
    let fits = match form {
        Form::Text => true,
        Form::Flag => matches!(read, Some(0 | 1)),
        Form::Number(most) => read.is_some_and(|n| (0..=i128::from(most)).contains(&n)),
        Form::Version => is_version(text),
        Form::Date => is_date(value),
        Form::Time => is_time(value),
    };
    if !fits {
        log.push(match form {
            Form::Date | Form::Time => i0610::finding(key, value, form),
            _ => w0609::finding(&known.name.replace('#', "1"), key, value, form),
        });
    }
}

fn is_version(text: &str) -> bool {
    text.split('.')
        .all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()))
}

fn parts(text: &str, at: char) -> Vec<Option<u32>> {
    text.split(at).map(|part| part.parse().ok()).collect()
}

fn is_date(text: &str) -> bool {
    matches!(
        parts(text, '-')[..],
        [Some(1..=12), Some(1..=31), Some(1000..=9999)]
    )
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
        parts(time.trim_end(), ':')[..],
        [Some(0..=12), Some(0..=59)]
    )
}
