//! Semantic tokens: headers, keys, numbers, words, texts, comments.

use std::ops::Range;

use od_eds::outline;

use crate::file::File;
use crate::layout::{Layout, Pair};
use crate::mentions::plain;

/// The token types; the index is their number.
pub(crate) const LEGEND: [&str; 7] = [
    "namespace",
    "property",
    "number",
    "string",
    "comment",
    "enumMember",
    "variable",
];

const HEADER: u32 = 0;
const KEY: u32 = 1;
const NUMBER: u32 = 2;
const STRING: u32 = 3;
const COMMENT: u32 = 4;
const WORD: u32 = 5;
const NODE_ID: u32 = 6;

/// The tokens between two bytes, with five numbers each, in the encoding of the protocol.
pub(crate) fn of(file: &File, layout: &Layout, within: &Range<usize>) -> Vec<u32> {
    let mut tokens = Vec::new();
    let from = layout
        .sections
        .partition_point(|section| section.end() < within.start);
    let sections = layout.sections.iter().skip(from);
    for section in sections.take_while(|section| section.header.start < within.end) {
        tokens.push((section.header.clone(), HEADER));
        let pairs = section.pairs.iter();
        pairs.for_each(|pair| of_pair(file, pair, &mut tokens));
    }
    let lines = file.text.line_at(within.start)..=file.text.line_at(within.end);
    for line in lines {
        let line = file.text.line(line);
        let body = file.part(line.clone());
        let start = line.start + (body.len() - body.trim_start().len());
        if body.trim_start().starts_with([';', '#']) {
            tokens.push((start..line.end, COMMENT));
        }
    }
    tokens.retain(|(bytes, _)| {
        !bytes.is_empty() && within.start <= bytes.end && bytes.start < within.end
    });
    tokens.sort_by_key(|(bytes, _)| bytes.start);
    encoded(file, &tokens)
}

fn of_pair(file: &File, pair: &Pair, tokens: &mut Vec<(Range<usize>, u32)>) {
    tokens.push((pair.key.clone(), KEY));
    let key = file.part(pair.key.clone());
    let is_name = key.len() >= 4
        && [
            "ParameterName",
            "Description",
            "CreatedBy",
            "VendorName",
            "ProductName",
        ]
        .iter()
        .any(|name| key.eq_ignore_ascii_case(name));
    let value = if is_name {
        pair.value.clone()
    } else {
        plain(file.str(), pair)
    };
    let text = file.part(value.clone());
    let kind = if is_name {
        STRING
    } else if outline::number(text).is_some() {
        NUMBER
    } else if text.starts_with(['$']) {
        NODE_ID
    } else if key.eq_ignore_ascii_case("AccessType") {
        WORD
    } else {
        STRING
    };
    if value.end < pair.value.end {
        let behind = file.part(value.end..pair.value.end);
        let start = pair.value.end - behind.trim_start().len();
        tokens.push((start..pair.value.end, COMMENT));
    }
    tokens.push((value, kind));
}

/// Each token relative to the previous one.
fn encoded(file: &File, tokens: &[(Range<usize>, u32)]) -> Vec<u32> {
    let mut data = Vec::with_capacity(tokens.len() * 5);
    let (mut line, mut character) = (0, 0);
    for (bytes, kind) in tokens {
        let at = file.text.position(bytes.start);
        let len = file.text.unit().count(file.part(bytes.clone()));
        let lines = at.line - line;
        let characters = if lines == 0 {
            at.character - character
        } else {
            at.character
        };
        data.extend([lines, characters, len, *kind, 0]);
        (line, character) = (at.line, at.character);
    }
    data
}

/// The edit that changes `old` into `new`: where it starts, how many numbers it deletes, and the numbers that
/// it inserts. `None` if both are the same.
pub(crate) fn difference<'n>(old: &[u32], new: &'n [u32]) -> Option<(usize, usize, &'n [u32])> {
    if old == new {
        return None;
    }
    let start = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let (old, new) = (&old[start..], &new[start..]);
    let both = old.iter().rev().zip(new.iter().rev());
    let end = both.take_while(|(a, b)| a == b).count();
    Some((start, old.len() - end, &new[..new.len() - end]))
}
