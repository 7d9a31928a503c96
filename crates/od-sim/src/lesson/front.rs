//! The front matter: the lines between `+++`, one `key = value` per line as in TOML.

use std::format;
use std::prelude::v1::*;

use od_model::values;

use super::content::Lesson;
use crate::grammar::problem::Problem;

const KEYS: &str = "write title, summary, level, minutes, language, also or absent";

/// Reads one line.
pub(super) fn line(lesson: &mut Lesson, number: u32, text: &str) -> Result<(), Problem> {
    let problem = |message: String, help: &str| Err(Problem::new(number, message, help));
    let text = text.trim();
    if text.is_empty() || text.starts_with('#') {
        return Ok(());
    }
    let Some((key, value)) = text.split_once('=') else {
        return problem(
            "the front matter line has no `=`".into(),
            "write `title = \"Boot-up\"`",
        );
    };
    let (key, value) = (key.trim(), value.trim());
    let quoted = value
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .filter(|inner| !inner.is_empty() && !inner.contains('"'));
    match (key, quoted) {
        ("title", Some(title)) => lesson.title = title.into(),
        ("summary", Some(summary)) => lesson.summary = summary.into(),
        ("language", Some(language)) => lesson.language = language.into(),
        ("also", Some(list)) => {
            lesson.also = list.split(',').map(|name| name.trim().into()).collect();
        }
        ("absent", Some(list)) => {
            for word in list.split(',') {
                match values::address(word) {
                    Some(address) => lesson.absent.push(address),
                    None => {
                        return problem(
                            format!("`{}` is not a valid object address", word.trim()),
                            "write addresses such as \"2FFFh, 1018h:09\"",
                        );
                    }
                }
            }
        }
        ("title" | "summary" | "language" | "also" | "absent", None) => {
            return problem(
                format!("`{key}` is not a text"),
                "write a text that is not empty, in quotes",
            );
        }
        ("level", _) => match value.parse() {
            Ok(level @ 1..=3) => lesson.level = level,
            _ => return problem("the level is not valid".into(), "write 1, 2 or 3"),
        },
        ("minutes", _) => match value.parse() {
            Ok(minutes @ 1..=600) => lesson.minutes = minutes,
            _ => {
                return problem(
                    "the minutes are not valid".into(),
                    "write a number from 1 to 600",
                );
            }
        },
        _ => return problem(format!("key `{key}` does not exist"), KEYS),
    }
    Ok(())
}

/// The key of a line.
pub(super) fn key(text: &str) -> &str {
    text.split_once('=').map_or("", |(key, _)| key.trim())
}

/// Reports the first required key that is not among those of the front matter. A value that is not valid has a message of
/// its own.
pub(super) fn missing(keys: &[&str]) -> Option<Problem> {
    let what = (["title", "level", "minutes"].into_iter()).find(|key| !keys.contains(key))?;
    let help = "begin the file with a line `+++`, then `title = \"…\"`, `level = 1`, `minutes = 10`, and \
                a line `+++`";
    Some(Problem::new(1, format!("the lesson has no {what}"), help))
}
