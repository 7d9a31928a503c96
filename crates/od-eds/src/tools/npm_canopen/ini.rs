//! Reads lines as the package `ini` does.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::javascript::{Given, is_space, parse_int, trim};
use crate::scan::lines::lines;
use crate::span::Span;

/// A key or a value without its comment and its escapes.
fn plain(text: &str) -> String {
    let text = trim(text);
    let quoted = |sign: char| text.len() > 1 && text.starts_with(sign) && text.ends_with(sign);
    if text == "\"" || text == "'" {
        return if text == "'" {
            String::new()
        } else {
            text.into()
        };
    }
    if quoted('"') || quoted('\'') {
        let inner = &text[1..text.len() - 1];
        let is_json = !inner.contains(['"', '\\']) && inner.chars().all(|c| c >= ' ');
        return if quoted('\'') || is_json {
            inner.into()
        } else {
            text.into()
        };
    }
    let (mut out, mut escaped) = (String::new(), false);
    for c in text.chars() {
        match (escaped, c) {
            (true, '\\' | ';' | '#') => out.push(c),
            (true, _) => out.extend(['\\', c]),
            (false, ';' | '#') => break,
            (false, '\\') => {}
            (false, _) => out.push(c),
        }
        escaped = !escaped && c == '\\';
    }
    if escaped {
        out.push('\\');
    }
    trim(&out).into()
}

/// One section with its keys; later ones replace earlier ones.
#[derive(Default)]
pub(super) struct Section {
    pub(super) name: String,
    pub(super) header: Span,
    pairs: BTreeMap<String, (Given, Span)>,
}

impl Section {
    /// The value of a key.
    pub(super) fn text(&self, key: &str) -> Option<&(Given, Span)> {
        self.pairs.get(key)
    }

    /// The place of the value of a key; the header if the section does not have the key.
    pub(super) fn place(&self, key: &str) -> Span {
        self.text(key).map_or(self.header, |(_, at)| *at)
    }

    /// `parseInt(…) || undefined`
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        let (text, _) = self.text(key)?;
        let Given::Text(text) = text else { return None };
        parse_int(text).filter(|number| *number != 0.0)
    }
}

pub(super) fn sections(text: &str, has_mark: bool) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    let mut current: Option<usize> = None;
    for line in lines(text) {
        let own = line.text;
        let first = own.trim_start_matches(is_space);
        if own.is_empty() || first.starts_with([';', '#']) {
            continue;
        }
        let marked = has_mark && line.number == 1;
        let header = own
            .strip_prefix('[')
            .and_then(|name| name.strip_suffix(']'));
        if let Some(name) = header.filter(|name| !name.contains(']') && !marked) {
            let name = plain(name);
            let next = sections.len();
            let at = *names.entry(name.clone()).or_insert(next);
            if at == next {
                let header = line.span(own);
                sections.push(Section {
                    name,
                    header,
                    ..Section::default()
                });
            }
            current = Some(at);
            continue;
        }
        let (key, value) = match own.split_once('=') {
            Some((key, value)) => (key, Some(value)),
            None => (own, None),
        };
        if key.is_empty() {
            continue;
        }
        let (Some(at), key) = (current, plain(key)) else {
            continue;
        };
        let span = line.span(trim(value.unwrap_or(own)));
        let value = match value.map(plain).as_deref() {
            None | Some("true") => Given::Flag(true),
            Some("false") => Given::Flag(false),
            Some("null") => Given::Null,
            Some(text) => Given::Text(text.to_string()),
        };
        sections[at].pairs.insert(key, (value, span));
    }
    sections
}
