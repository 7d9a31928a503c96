//! Sections that describe no object: do they say what CiA 306 knows, and in its form?

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::known;
use crate::scan::known::{Form, Known, OBJECT_KEYS};
use crate::scan::names::List;
use crate::scan::number;
use crate::scan::placed::{Placed, Text};
use od_model::Address;

/// Names what is unknown in a section, and values that are not what they should be.
pub(crate) fn check(placed: &Placed<'_>, log: &mut Vec<Finding>) {
    let name = &placed.name;
    if name.is_empty() || known::is_of_objects(name) {
        return;
    }
    let Some((_, known)) = known::section(name) else {
        unknown_section(placed, log);
        return;
    };
    if known.name == "DeviceCommissioning" {
        log.push(
            rules::I0611
                .told(
                    placed.header,
                    "`DeviceCommissioning` is not how CiA 306 spells it",
                )
                .with_help("write `[DeviceComissioning]`, with one m, as the standard does")
                .fix(Fix::safe().replace(placed.header, "[DeviceComissioning]")),
        );
    }
    for (key, value) in &placed.pairs {
        match known::key(known, key) {
            Some((_, form)) => check_value(known, key, value, form, log),
            None => unknown_key(key, value, known.keys.iter().map(|(key, _)| *key), log),
        }
    }
}

fn unknown_section(placed: &Placed<'_>, log: &mut Vec<Finding>) {
    let name = &placed.name;
    let names = known::SECTIONS
        .iter()
        .map(|known| known.name)
        .chain(List::ALL.map(List::name));
    log.push(match known::near(name, names) {
        Some(meant) => rules::W0213
            .told(
                placed.header,
                format!("there is no section [{}] in CiA 306", name.value),
            )
            .with_help(format!("write `[{meant}]`, if that is meant"))
            .fix(Fix::unsafe_fix().replace(placed.header, format!("[{meant}]"))),
        None => rules::I0211
            .told(
                placed.header,
                format!("[{}] is no section of CiA 306", name.value),
            )
            .with_help("it is kept; if an object is meant, write `[2000]` or `[2000sub1]`"),
    });
}

/// Names a key that nobody reads, and the one that may be meant.
pub(crate) fn unknown_key<'a>(
    key: &Text<'_>,
    value: &str,
    keys: impl Iterator<Item = &'a str>,
    log: &mut Vec<Finding>,
) {
    log.push(match known::near(key, keys) {
        Some(meant) => {
            let meant = meant.replace('#', "1");
            rules::W0318
                .told(key.span, format!("there is no key `{}` here", key.value))
                .with_help(format!("write `{meant}={value}`, if that is meant"))
                .fix(Fix::unsafe_fix().replace(key.span, meant))
        }
        None => rules::I0319
            .told(
                key.span,
                format!("`{}` is no key of CiA 306 here", key.value),
            )
            .with_help("it is kept, and nothing reads it"),
    });
}

/// Names the keys of an object or a member that nobody reads.
pub(crate) fn unknown_object_keys(
    rest: &[(Text<'_>, Text<'_>)],
    address: Address,
    log: &mut Vec<Finding>,
) {
    for (key, value) in rest {
        if !OBJECT_KEYS
            .iter()
            .any(|known| key.eq_ignore_ascii_case(known))
        {
            let mut found = Vec::new();
            unknown_key(key, value, OBJECT_KEYS.into_iter(), &mut found);
            log.extend(found.into_iter().map(|finding| finding.about(address)));
        }
    }
}

fn check_value(known: &Known, key: &str, value: &Text<'_>, form: Form, log: &mut Vec<Finding>) {
    if value.is_empty() || matches!(form, Form::Text) {
        return;
    }
    let text = number::before_comment(value);
    let read = number::integer(text, &mut Vec::new()).map(|number| number.value);
    let section = known.name.replace('#', "1");
    let (fits, expected) = match form {
        Form::Text => return,
        Form::Flag => (matches!(read, Some(0 | 1)), String::from("`0` or `1`")),
        Form::Number(most) => (
            read.is_some_and(|number| (0..=i128::from(most)).contains(&number)),
            match most {
                u32::MAX => "a number such as `0x1A` with at most 32 bits".into(),
                most => format!("a number from 0 to {most}"),
            },
        ),
        Form::Version => (is_version(text), "a version such as `4.0`".into()),
        Form::Date | Form::Time => {
            let fits = match form {
                Form::Date => is_date(value),
                _ => is_time(value),
            };
            if !fits {
                let form = match form {
                    Form::Date => "month, day and year: `07-14-2026`",
                    _ => "hour, minute and half of the day: `09:30AM`",
                };
                log.push(
                    rules::I0610
                        .told(value.span, format!("{key} is written as `{}`", value.value))
                        .with_help(format!("write {form}")),
                );
            }
            return;
        }
    };
    if !fits {
        log.push(
            rules::W0609
                .told(
                    value.span,
                    format!("[{section}]: `{}` is no value of {key}", value.value),
                )
                .with_help(format!("write {expected}, or leave it empty")),
        );
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
