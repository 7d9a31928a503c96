//! Tables in docs/PERFORMANCE.md: finds them, reads their numbers, and compares them.

use std::fs;
use std::path::PathBuf;

use crate::error::{Error, Result};
use crate::repo::Repo;

/// docs/PERFORMANCE.md: its path and its text.
pub(crate) fn page(repo: &Repo) -> Result<(PathBuf, String)> {
    let path = repo.root.join("docs/PERFORMANCE.md");
    let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, &e))?;
    Ok((path, text))
}

/// Text before the table with these lines around it, the table, and text after it.
pub(crate) fn split<'t>(text: &'t str, marks: (&str, &str)) -> Result<(&'t str, &'t str, &'t str)> {
    let missing = || Error::Failed(format!("docs/PERFORMANCE.md lacks {}", marks.0.trim_end()));
    let start = text.find(marks.0).ok_or_else(missing)? + marks.0.len();
    let end = text[start..].find(marks.1).ok_or_else(missing)? + start;
    Ok((&text[..start], &text[start..end], &text[end..]))
}

/// A number with a comma before each three digits.
pub(crate) fn grouped(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

/// The name of a row, in backquotes, and its numbers.
pub(crate) fn row(line: &str) -> Option<(&str, Vec<i64>)> {
    let name = line.split('`').nth(1)?;
    let cells = line.split('|').skip(2);
    let cells = cells.map(|cell| cell.trim().replace([',', '+'], ""));
    Some((name, cells.filter_map(|cell| cell.parse().ok()).collect()))
}

/// Returns whether a number is more than 5 % above the one before, or the numbers differ in count.
pub(crate) fn has_grown(before: &[i64], now: &[i64]) -> bool {
    let mut pairs = now.iter().zip(before);
    now.len() != before.len() || pairs.any(|(now, before)| now * 20 > before * 21)
}
