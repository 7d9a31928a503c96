//! Makes a new input from an earlier one.

use crate::random::Random;
use crate::target::Target;

/// Numbers at which behaviour changes.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "7",
    "8",
    "9",
    "127",
    "128",
    "255",
    "256",
    "32767",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999999",
    "0x",
    "0x80000000",
    "$NODEID",
    "1e9",
    "0.0000001",
];

/// A new input: a seed with some changes, sometimes only words and random bytes.
pub fn input(target: &Target, seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = match random.below(20) {
        0 => Vec::new(),
        _ => seeds
            .get(random.below(seeds.len()))
            .cloned()
            .unwrap_or_default(),
    };
    let changes = if bytes.is_empty() {
        1 + random.below(60)
    } else {
        random.size(6)
    };
    for _ in 0..changes {
        change(&mut bytes, target, seeds, random);
    }
    bytes.truncate(target.longest);
    bytes
}

fn change(bytes: &mut Vec<u8>, target: &Target, seeds: &[Vec<u8>], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let some = random.size(8);
    let end = (at + some).min(bytes.len());
    match random.below(if target.is_text { 10 } else { 7 }) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        1 if at < bytes.len() => bytes[at] = random.next() as u8,
        2 => drop(bytes.drain(at..end)),
        3 => {
            let again = bytes[at..end].to_vec();
            insert(bytes, at, &again);
        }
        4 => {
            let noise: Vec<u8> = (0..some.min(16)).map(|_| random.next() as u8).collect();
            insert(bytes, at, &noise);
        }
        5 => {
            // A part of another seed.
            let other = seeds
                .get(random.below(seeds.len()))
                .map_or(&[][..], |seed| seed);
            let from = random.below(other.len() + 1);
            let to = (from + some).min(other.len());
            insert(bytes, at, &other[from..to]);
        }
        7 => {
            // Moves or repeats a line.
            let line = line_at(bytes, at).to_vec();
            let to = line_start(bytes, random.below(bytes.len() + 1));
            insert(bytes, to, &line);
        }
        8 => {
            let start = line_start(bytes, at);
            let len = line_at(bytes, at).len();
            bytes.drain(start..start + len);
        }
        9 => number(bytes, at, random),
        _ => {
            if !target.words.is_empty() {
                insert(bytes, at, random.pick(target.words).as_bytes());
            }
        }
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: &[u8]) {
    bytes.splice(at..at, piece.iter().copied());
}

fn line_start(bytes: &[u8], at: usize) -> usize {
    let before = bytes[..at].iter().rposition(|byte| *byte == b'\n');
    before.map_or(0, |end| end + 1)
}

/// The line around a place, including its end.
fn line_at(bytes: &[u8], at: usize) -> &[u8] {
    let rest = &bytes[line_start(bytes, at)..];
    let end = rest.iter().position(|byte| *byte == b'\n');
    &rest[..end.map_or(rest.len(), |end| end + 1)]
}

/// Replaces the next number.
fn number(bytes: &mut Vec<u8>, at: usize, random: &mut Random) {
    let is_digit = |byte: &u8| byte.is_ascii_hexdigit();
    let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit) else {
        return;
    };
    let start = at + start;
    let len = bytes[start..]
        .iter()
        .take_while(|byte| is_digit(byte))
        .count();
    bytes.splice(start..start + len, random.pick(NUMBERS).bytes());
}
