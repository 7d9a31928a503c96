//! A YAML text as a tree, with the scalars of YAML 1.1, as PyYAML and therefore dcfgen read them.

use std::collections::BTreeMap;

use od_eds::Span;
use saphyr_parser::{Event, Parser, ScalarStyle};

/// Maximum number of values of a text, including those that aliases repeat.
const LIMIT: usize = 100_000;

/// A value, and the place where it begins. That of an alias is the place of its anchor.
#[derive(Clone, Debug)]
pub(super) struct Yaml {
    value: Value,
    pub(super) span: Span,
}

#[derive(Clone, PartialEq, Debug)]
enum Value {
    Null,
    Bool(bool),
    Integer(i128),
    Real(f64),
    Text(String),
    List(Vec<Yaml>),
    /// Keys and values in the order of the text.
    Map(Vec<(Yaml, Yaml)>),
}

impl PartialEq for Yaml {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl Yaml {
    /// A mapping of these entries, in the place of this value.
    pub(super) fn with(&self, entries: Vec<(Self, Self)>) -> Self {
        Self {
            value: Value::Map(entries),
            span: self.span,
        }
    }

    /// Reads the first document of a text, and its keys that are given twice: each with the first one.
    ///
    /// # Errors
    /// A sentence with the line, if the text is not YAML or is too large.
    pub(super) fn read(text: &str) -> Result<(Self, Vec<(Self, Span)>), String> {
        let mut tree = Tree::default();
        let mut places = Places::new(text);
        for event in Parser::new_from_str(text) {
            let (event, range) = event.map_err(|error| error.to_string())?;
            let (start, end) = (range.start, range.end);
            let from = places.byte(start.index());
            let span = Span {
                start: from,
                // The parser puts the end of a block at the beginning of the next value.
                end: match event {
                    Event::Scalar(..) => places.byte(end.index()),
                    _ => from,
                },
                line: start.line() as u32,
                column: start.col() as u32 + 1,
            };
            match tree.take(event, span) {
                Ok(Some(whole)) => return Ok((whole, tree.twice)),
                Ok(None) => {}
                Err(why) => return Err(format!("line {}: {why}", span.line)),
            }
        }
        let nothing = Self {
            value: Value::Null,
            span: Span::default(),
        };
        Ok((nothing, Vec::new()))
    }

    /// The value of a key; `None` if it is missing.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        self.entries()
            .iter()
            .find(|(own, _)| own.text() == key)
            .map(|(_, value)| value)
    }

    /// The values of a list; empty if this is not one.
    pub(super) fn list(&self) -> &[Self] {
        match &self.value {
            Value::List(list) => list,
            _ => &[],
        }
    }

    /// Keys and values; empty if this is not a mapping.
    pub(super) fn entries(&self) -> &[(Self, Self)] {
        match &self.value {
            Value::Map(entries) => entries,
            _ => &[],
        }
    }

    /// Converted as by Python's `str`.
    pub(super) fn text(&self) -> String {
        match &self.value {
            Value::Null => "None".into(),
            Value::Bool(true) => "True".into(),
            Value::Bool(false) => "False".into(),
            Value::Integer(number) => number.to_string(),
            Value::Real(number) => format!("{number:?}"),
            Value::Text(text) => text.clone(),
            Value::List(_) | Value::Map(_) => String::new(),
        }
    }

    /// Converted as by Python's `int`: a real without its fraction, a text of decimal digits.
    pub(super) fn integer(&self) -> Option<i128> {
        match &self.value {
            Value::Bool(flag) => Some((*flag).into()),
            Value::Integer(number) => Some(*number),
            Value::Real(number) if number.is_finite() => Some(*number as i128),
            Value::Text(text) => text.trim().parse().ok(),
            _ => None,
        }
    }

    /// Converted as by Python's `float`.
    pub(super) fn real(&self) -> Option<f64> {
        match &self.value {
            Value::Real(number) => Some(*number),
            Value::Text(text) => text.trim().parse().ok(),
            _ => self.integer().map(|number| number as f64),
        }
    }

    /// Returns whether the value is a text that is not empty.
    pub(super) fn is_words(&self) -> bool {
        matches!(&self.value, Value::Text(text) if !text.is_empty())
    }

    /// Converted as by Python's `bool`: a text that is not empty is true.
    pub(super) fn is_true(&self) -> bool {
        match &self.value {
            Value::Null => false,
            Value::Bool(flag) => *flag,
            Value::Integer(number) => *number != 0,
            Value::Real(number) => *number != 0.0,
            Value::Text(text) => !text.is_empty(),
            Value::List(list) => !list.is_empty(),
            Value::Map(entries) => !entries.is_empty(),
        }
    }

    fn size(&self) -> usize {
        1 + match &self.value {
            Value::List(list) => list.iter().map(Self::size).sum(),
            Value::Map(entries) => entries
                .iter()
                .map(|(key, value)| key.size() + value.size())
                .sum(),
            _ => 0,
        }
    }
}

/// Converts places in characters into places in bytes. The places must come in the order of the text.
struct Places<'a> {
    text: &'a str,
    chars: usize,
    bytes: usize,
}

impl<'a> Places<'a> {
    const fn new(text: &'a str) -> Self {
        let (chars, bytes) = (0, 0);
        Self { text, chars, bytes }
    }

    /// The byte at which this character begins.
    fn byte(&mut self, char: usize) -> u32 {
        let rest = self.text[self.bytes..].chars();
        let passed = rest.take(char.saturating_sub(self.chars));
        self.bytes += passed.map(char::len_utf8).sum::<usize>();
        self.chars = self.chars.max(char);
        self.bytes as u32
    }
}

/// A list or mapping that is not complete yet.
struct Open {
    span: Span,
    is_map: bool,
    anchor: usize,
    values: Vec<Yaml>,
}

#[derive(Default)]
struct Tree {
    open: Vec<Open>,
    anchors: BTreeMap<usize, Yaml>,
    size: usize,
    twice: Vec<(Yaml, Span)>,
}

impl Tree {
    /// Handles the next event; returns the whole value when it is complete.
    fn take(&mut self, event: Event<'_>, span: Span) -> Result<Option<Yaml>, String> {
        let (anchor, value) = match event {
            Event::Scalar(text, style, anchor, tag) => {
                let is_plain = style == ScalarStyle::Plain && tag.is_none();
                let value = if is_plain {
                    scalar(&text)
                } else {
                    Value::Text(text.into_owned())
                };
                (anchor, Yaml { value, span })
            }
            Event::Alias(anchor) => {
                let value = self.anchors.get(&anchor).cloned();
                (0, value.ok_or("an alias without its anchor")?)
            }
            Event::SequenceStart(anchor, _) | Event::MappingStart(anchor, _) => {
                let is_map = matches!(event, Event::MappingStart(..));
                let values = Vec::new();
                self.open.push(Open {
                    span,
                    is_map,
                    anchor,
                    values,
                });
                return Ok(None);
            }
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(open) => {
                    let value = if open.is_map {
                        map(open.values, &mut self.twice)?
                    } else {
                        Value::List(open.values)
                    };
                    let span = open.span;
                    (open.anchor, Yaml { value, span })
                }
                None => return Ok(None),
            },
            _ => return Ok(None),
        };
        self.size += value.size();
        if self.size > LIMIT {
            return Err(format!("more than {LIMIT} values"));
        }
        if anchor > 0 {
            self.anchors.insert(anchor, value.clone());
        }
        match self.open.last_mut() {
            Some(open) => {
                open.values.push(value);
                Ok(None)
            }
            None => Ok(Some(value)),
        }
    }
}

/// A mapping from alternating keys and values: the last of equal keys is used, and `<<` adds missing
/// entries of other mappings. Keys that are given `twice` are added there, with the place of the first.
fn map(values: Vec<Yaml>, twice: &mut Vec<(Yaml, Span)>) -> Result<Value, String> {
    let mut entries = Entries::default();
    let mut merged = Vec::new();
    let mut values = values.into_iter();
    while let (Some(key), Some(value)) = (values.next(), values.next()) {
        if key.value == Value::Text("<<".into()) {
            match value.value {
                Value::Map(others) => merged.extend(others),
                Value::List(lists) => {
                    merged.extend(lists.into_iter().flat_map(|list| list.entries().to_vec()));
                }
                _ => return Err("`<<` needs a mapping".into()),
            }
        } else {
            if let Some(first) = entries.place(&key) {
                twice.push((key.clone(), first));
            }
            entries.set(key, value);
        }
    }
    // Merged entries come first, as in PyYAML.
    let own = std::mem::take(&mut entries);
    for (key, value) in merged {
        if !entries.has(&key) {
            entries.set(key, value);
        }
    }
    for (key, value) in own.all {
        entries.set(key, value);
    }
    Ok(Value::Map(entries.all))
}

/// The entries of a mapping, and the place of each key: an entry is found in the same time in a long mapping.
#[derive(Default)]
struct Entries {
    all: Vec<(Yaml, Yaml)>,
    places: BTreeMap<String, usize>,
}

impl Entries {
    /// The text of a key by which it is found: equal keys have equal texts.
    fn name(key: &Yaml) -> String {
        format!("{:?}", key.value)
    }

    fn has(&self, key: &Yaml) -> bool {
        self.places.contains_key(&Self::name(key))
    }

    /// The place in the text of a key that it has.
    fn place(&self, key: &Yaml) -> Option<Span> {
        let (first, _) = self.all.get(*self.places.get(&Self::name(key))?)?;
        Some(first.span)
    }

    /// Sets the value of a key, which is added if it is new.
    fn set(&mut self, key: Yaml, value: Yaml) {
        let place = *self
            .places
            .entry(Self::name(&key))
            .or_insert(self.all.len());
        match self.all.get_mut(place) {
            Some((_, own)) => *own = value,
            None => self.all.push((key, value)),
        }
    }
}

/// A plain scalar by the rules of YAML 1.1.
fn scalar(text: &str) -> Value {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Value::Null,
        "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => {
            return Value::Bool(true);
        }
        "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => {
            return Value::Bool(false);
        }
        _ => {}
    }
    let number = number(text)
        .map(Value::Integer)
        .or_else(|| real(text).map(Value::Real));
    number.unwrap_or_else(|| Value::Text(text.into()))
}

fn number(text: &str) -> Option<i128> {
    let (sign, digits) = match text.as_bytes().first()? {
        b'-' => (-1, &text[1..]),
        b'+' => (1, &text[1..]),
        _ => (1, text),
    };
    if !digits.starts_with(|first: char| first.is_ascii_digit()) {
        return None;
    }
    let plain = digits.replace('_', "");
    let (radix, rest) = match plain.as_bytes() {
        [b'0', b'x', ..] => (16, &plain[2..]),
        [b'0', b'b', ..] => (2, &plain[2..]),
        [b'0', _, ..] => (8, &plain[1..]),
        _ => (10, plain.as_str()),
    };
    if radix == 10 && rest.contains(':') {
        // Hours, minutes, seconds.
        let parts = rest.split(':').map(|part| part.parse::<i128>().ok());
        let sum = parts.reduce(|sum, part| {
            sum?.checked_mul(60)?
                .checked_add(part.filter(|part| *part < 60)?)
        });
        return sum.flatten().map(|number| sign * number);
    }
    let is_number = rest.starts_with(|first: char| first.is_ascii_alphanumeric());
    let number = i128::from_str_radix(rest, radix).ok().filter(|_| is_number);
    number.map(|number| sign * number)
}

fn real(text: &str) -> Option<f64> {
    let lower = text.to_ascii_lowercase();
    match lower.trim_start_matches(['+', '-']) {
        ".inf" if lower.starts_with('-') => return Some(f64::NEG_INFINITY),
        ".inf" => return Some(f64::INFINITY),
        ".nan" => return Some(f64::NAN),
        // A real has a point, and its exponent has a sign.
        digits
            if !digits.contains('.')
                || !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') =>
        {
            return None;
        }
        _ => {}
    }
    let has_sign = lower
        .split_once('e')
        .is_none_or(|(_, exponent)| exponent.starts_with(['+', '-']));
    lower.replace('_', "").parse().ok().filter(|_| has_sign)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_are_those_of_yaml_1_1() {
        for (text, expected) in [
            ("0x1F", Value::Integer(31)),
            ("-0x1F", Value::Integer(-31)),
            ("010", Value::Integer(8)),
            ("1_000", Value::Integer(1000)),
            ("1:30", Value::Integer(90)),
            ("0b11", Value::Integer(3)),
            ("089", Value::Text("089".into())),
            ("1.5", Value::Real(1.5)),
            ("1e3", Value::Text("1e3".into())),
            ("1.0e+3", Value::Real(1000.0)),
            ("yes", Value::Bool(true)),
            ("~", Value::Null),
            ("auto", Value::Text("auto".into())),
        ] {
            assert_eq!(scalar(text), expected, "{text}");
        }
    }

    #[test]
    fn aliases_and_merges_are_resolved() {
        let text = ".base: &base {a: 1, b: [1, 2]}\nx:\n  <<: *base\n  a: 3\n  a: 4\n";
        let (whole, _) = Yaml::read(text).expect("YAML");
        let x = whole.get("x").expect("x");
        assert_eq!(x.get("a").and_then(Yaml::integer), Some(4));
        assert_eq!(x.get("b").map(Yaml::size), Some(3));
        let mut bomb = String::from("a0: &a0 [1,1,1,1,1,1,1,1,1,1]\n");
        for level in 1..10 {
            let last = level - 1;
            let ten = vec![format!("*a{last}"); 10].join(",");
            bomb += &format!("a{level}: &a{level} [{ten}]\n");
        }
        assert!(Yaml::read(&bomb).is_err_and(|why| why.contains("100000")));
        assert!(Yaml::read("a: [1").is_err());
    }

    #[test]
    fn values_know_their_places() {
        let text = "# é\na: &x {b: ü, c: 5}\nd:\n  - *x\n  - 7\n";
        let (whole, _) = Yaml::read(text).expect("YAML");
        let place = |yaml: &Yaml| (yaml.span.line, yaml.span.column);
        let c = whole.get("a").and_then(|a| a.get("c")).expect("c");
        assert_eq!(place(c), (2, 17));
        assert_eq!(&text[c.span.start as usize..c.span.end as usize], "5");
        let list = whole.get("d").map_or(&[][..], Yaml::list);
        let lines: Vec<u32> = list.iter().map(|yaml| yaml.span.line).collect();
        assert_eq!(lines, [2, 5], "an alias is where its anchor is");
    }
}
